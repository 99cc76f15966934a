// One text for all levels: what differs are the flags it is compiled with (tests/CMakeLists.txt). The
// functions are those of the sources themselves, with the choice at run time taken out.
#include "levels/level.h"

#include "base/clones.h"

#undef SHERD_CLONES
#define SHERD_CLONES
#include "cvd/distance.cpp"
#include "cvd/lane_bounds.cpp"
#include "learn_degree/sums.cpp"

using namespace sherd;

extern "C" __attribute__((visibility("default"))) test::Level sherdLevel() {
  test::Level level;
  level.squaredDistance = &squaredDistance;
  level.addScaled = &addScaled;
  level.sumScaled = &sumScaled;
  level.compareLanes = &compareLanes;
  level.keepBounds = &keepBounds;
  level.findOpenLanes = &findOpenLanes;
  level.lanesWithLabel = &lanesWithLabel;
  level.addProduct = [](const double* m, std::size_t rows, std::size_t columns, const double* a, double* y) {
    addProduct({m, rows, columns}, a, y);
  };
  level.squaredDistances = [](const double* m, std::size_t rows, std::size_t columns, const double* z,
                              double* out) {
    squaredDistances({m, rows, columns}, z, out);
  };
  level.squaredNormOfProduct = [](const double* m, std::size_t rows, const double* a) {
    return squaredNormOfProduct({m, rows, rows}, a);
  };
  level.rootSums = [](const double* v, const double* w, std::size_t size, double* out) {
    const RootSums sums = rootSums({v, size}, {w, size});
    out[0] = sums.half, out[1] = sums.threeQuarters;
  };
  level.runningSums = [](const double* m, std::size_t rows, const double* centre, const double* weight,
                         const int* order, std::size_t count, double* out) {
    runningSums({m, rows, count}, centre, weight, {order, count}, out);
  };
  return level;
}
