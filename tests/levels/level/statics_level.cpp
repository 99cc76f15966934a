// As level.cpp, those of statics. What is written apart for each level is here in all forms for all of them.
#include "base/clones.h"
#include "levels/level.h"

#undef SHERD_VERSIONS
#undef SHERD_CLONES
#undef SHERD_BASELINE
#define SHERD_CLONES
#define SHERD_BASELINE
#include "simulate/element_response.cpp"
#include "simulate/supernodal_solve.cpp"

using namespace sherd;

extern "C" __attribute__((visibility("default"))) test::StaticsLevel sherdStaticsLevel() {
  using Count = std::size_t;
  test::StaticsLevel level;
  level.down = [](const double* l, Count stride, Count columns, Count rows, const double* x, double* y) {
    subtractDown({l, stride, columns, rows}, x, y);
  };
  level.downWide = [](const double* l, Count stride, Count columns, Count rows, const double* x, double* y) {
    subtractAllRows<Four>({l, stride, columns, rows}, x, y);
  };
  level.downWidest = [](const double* l, Count stride, Count columns, Count rows, const double* x,
                        double* y) {
    subtractAllRows<Eight>({l, stride, columns, rows}, x, y);
  };
  level.up = [](const double* l, Count stride, Count columns, Count rows, const double* y, double* x) {
    subtractUp({l, stride, columns, rows}, y, x);
  };
  level.upWide = [](const double* l, Count stride, Count columns, Count rows, const double* y, double* x) {
    subtractAllColumns<Four>({l, stride, columns, rows}, y, x);
  };
  level.upWidest = [](const double* l, Count stride, Count columns, Count rows, const double* y, double* x) {
    subtractAllColumns<Eight>({l, stride, columns, rows}, y, x);
  };
  level.solve = [](const SupernodalFactor& factor, double* x, Count width) {
    solveSupernodal(factor, x, width);
  };
  level.respond = [](const ElementResponse& response, const ElementResponse::Block& block) {
    response.add(block);
  };
  return level;
}
