// Multiversioned functions as they are compiled for one level of processors, in a shared object of its own.
#pragma once

#include <cstddef>
#include <span>

#include "cvd/lane_bounds.h"
#include "simulate/element_response.h"
#include "simulate/supernodal_solve.h"

namespace sherd::test {

/// squaredDistance, addScaled and sumScaled of cvd/distance.h and all of cvd/lane_bounds.h; the others of
/// learn_degree/sums.h, with matrices of `rows` times `columns` column by column.
struct Level {
  double (*squaredDistance)(const double* a, const double* b, std::size_t size);
  void (*addScaled)(double* sum, const double* a, double weight, std::size_t size);
  void (*sumScaled)(double* out, const double* points, const double* weight, std::span<const int> list,
                    std::size_t size);
  unsigned (*compareLanes)(const LaneValues* block, const LaneSite& site, std::size_t dimensions,
                           const float* up, LaneValues& low, LaneValues& high);
  void (*keepBounds)(const LaneValues& low, float drift, LaneValues& kept);
  void (*findOpenLanes)(const LaneValues* bound, const float* drift, std::size_t count, const float* up,
                        std::uint16_t* open);
  unsigned (*lanesWithLabel)(const int* labels, int label);
  void (*addProduct)(const double* m, std::size_t rows, std::size_t columns, const double* a, double* y);
  void (*squaredDistances)(const double* m, std::size_t rows, std::size_t columns, const double* z,
                           double* out);
  double (*squaredNormOfProduct)(const double* m, std::size_t rows, const double* a);
  void (*rootSums)(const double* v, const double* w, std::size_t size, double* out);
  void (*runningSums)(const double* m, std::size_t rows, const double* centre, const double* weight,
                      const int* order, std::size_t count, double* out);
};

/// Those of statics: y −= L x and x −= Lᵀ y with dense columns of L, `stride` apart, for one load or (`Wide`)
/// kSolveWidth of them, and what is made of these.
struct StaticsLevel {
  using Subtract = void (*)(const double* l, std::size_t stride, std::size_t columns, std::size_t rows,
                            const double* from, double* to);
  Subtract down, downWide, downWidest, up, upWide, upWidest;  ///< with vectors of four and of eight loads
  void (*solve)(const SupernodalFactor& factor, double* x, std::size_t width);
  void (*respond)(const ElementResponse& response, const ElementResponse::Block& block);
};

}  // namespace sherd::test

/// Of the shared object; their names there.
extern "C" sherd::test::Level sherdLevel();
extern "C" sherd::test::StaticsLevel sherdStaticsLevel();
