#include "export/float_rounding.h"

namespace sherd {

double roundedToFloat(double x) { return static_cast<double>(static_cast<float>(x)) + 0.0; }

}  // namespace sherd
