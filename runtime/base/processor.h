// What kind of processor this is. Results may differ in their last bits between kinds (a library may choose
// its code by them), so that caches which machines share keep them apart.
#pragma once

#include <string>

namespace sherd {

/// "x86-64-v3" and the like, by the features that the compiler's levels ask for; elsewhere the architecture's
/// name.
const std::string& processorLevel();

}  // namespace sherd
