#include "simulate/sparse_cholesky.h"

#include <cholmod.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <string>

#include "simulate/supernodal_solve.h"

extern "C" {
void openblas_set_num_threads(int threads);
// Part of libgomp, which CHOLMOD brings along where it was built with OpenMP.
void omp_set_max_active_levels(int levels) __attribute__((weak));
}

namespace sherd {
namespace {

/// CHOLMOD's settings and workspace: one per call, since it may not be shared by threads.
struct Common {
  Common() {
    cholmod_start(&c);
    c.print = 0;
    c.supernodal = CHOLMOD_SUPERNODAL;
    c.nmethods = 1;
    c.method[0].ordering = CHOLMOD_GIVEN;
    c.postorder = 1;
    // Larger supernodes than CHOLMOD's: a third less time at the sizes that bodies have.
    constexpr std::size_t columns[] = {16, 64, 192};
    std::copy(std::begin(columns), std::end(columns), c.nrelax);
    c.zrelax[0] = 0.9;
    c.quick_return_if_not_posdef = 1;
  }
  ~Common() { cholmod_finish(&c); }
  Common(const Common&) = delete;
  Common& operator=(const Common&) = delete;
  cholmod_common c;
};

void useOneThread() {
  static const bool once = (openblas_set_num_threads(1), true);
  (void)once;
  // CHOLMOD asks for four threads by itself, whatever their number is set to: small tasks that mostly wait
  // for each other. Regions that may not be active run on the thread that comes to them.
  if (omp_set_max_active_levels != nullptr) omp_set_max_active_levels(0);
}

/// A view of arrays as a CHOLMOD matrix, lower triangle.
cholmod_sparse lowerMatrix(std::vector<int>& begin, std::vector<int>& row, double* values) {
  cholmod_sparse m{};
  m.nrow = m.ncol = begin.size() - 1;
  m.nzmax = row.size();
  m.p = begin.data();
  m.i = row.data();
  m.x = values;
  m.stype = -1;
  m.itype = CHOLMOD_INT;
  m.xtype = values != nullptr ? CHOLMOD_REAL : CHOLMOD_PATTERN;
  m.dtype = CHOLMOD_DOUBLE;
  m.sorted = 1;
  m.packed = 1;
  return m;
}

/// The order of the nodes' coordinates.
std::vector<int> expandOrder(std::span<const Index> nodes) {
  std::vector<int> order;
  for (const Index node : nodes)
    for (int axis = 0; axis < 3; ++axis) order.push_back(3 * node + axis);
  return order;
}

struct Scalars {
  std::vector<int> begin{0}, row;
  std::vector<double> value;
};

std::size_t byteSize(const Scalars& s) {
  return s.begin.size() * sizeof(int) + s.row.size() * (sizeof(int) + sizeof(double));
}

Scalars expand(const BlockMatrix& matrix) {
  Scalars s;
  s.row.reserve(9 * matrix.row.size());
  s.value.reserve(9 * matrix.row.size());
  for (std::size_t column = 0; column < matrix.size(); ++column)
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t e = at(matrix.begin[column]); e < at(matrix.begin[column + 1]); ++e) {
        const bool diagonal = at(matrix.row[e]) == column;
        for (int i = diagonal ? axis : 0; i < 3; ++i) {
          s.row.push_back(3 * matrix.row[e] + i);
          s.value.push_back(matrix.block[e](i, axis));
        }
      }
      s.begin.push_back(static_cast<int>(s.row.size()));
    }
  return s;
}

}  // namespace

struct SparseCholesky::Impl {
  ~Impl() {
    Common common;
    cholmod_free_factor(&factor, &common.c);
  }
  cholmod_factor* factor = nullptr;
  std::size_t nodes = 0, peakBytes = 0;
};

SparseCholesky::SparseCholesky(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;

Result<SparseCholesky> SparseCholesky::factor(const BlockMatrix& matrix, std::span<const Index> nodes) {
  if (9.0 * static_cast<double>(matrix.row.size()) > std::numeric_limits<int>::max())
    return failure(
        "the tetrahedral mesh is too large for statics (" + std::to_string(matrix.size()) + " nodes)",
        "ask for fewer tetrahedra");
  useOneThread();
  Common common;
  std::vector<int> order = expandOrder(nodes);
  Scalars scalars = expand(matrix);
  cholmod_sparse a = lowerMatrix(scalars.begin, scalars.row, scalars.value.data());
  auto impl = std::make_unique<Impl>();
  impl->nodes = matrix.size();
  impl->factor = cholmod_analyze_p(&a, order.data(), nullptr, 0, &common.c);
  if (impl->factor != nullptr) cholmod_factorize(&a, impl->factor, &common.c);
  if (common.c.status == CHOLMOD_OUT_OF_MEMORY || common.c.status == CHOLMOD_TOO_LARGE)
    return failure(
        "not enough memory to factorize the stiffness of " + std::to_string(matrix.size()) + " nodes",
        "ask for fewer tetrahedra");
  if (impl->factor == nullptr || common.c.status != CHOLMOD_OK)
    return failure("the stiffness matrix is singular at node " +
                       (impl->factor != nullptr && impl->factor->minor < order.size()
                            ? std::to_string(static_cast<int*>(impl->factor->Perm)[impl->factor->minor] / 3)
                            : std::string("?")),
                   "the tetrahedra around it must hang together by faces and have volume; or the body is too "
                   "flat, or its "
                   "Poisson's ratio too close to 1/2, for these tetrahedra");
  impl->peakBytes =
      common.c.memory_usage + byteSize(scalars) + matrix.block.size() * (sizeof(Mat3) + sizeof(Index));
  return SparseCholesky(std::move(impl));
}

namespace {

SupernodalFactor viewOf(const cholmod_factor& f) {
  return {f.nsuper,
          static_cast<const int*>(f.super),
          static_cast<const int*>(f.pi),
          static_cast<const int*>(f.px),
          static_cast<const int*>(f.s),
          static_cast<const double*>(f.x)};
}

}  // namespace

void SparseCholesky::solve(std::span<Vec3> x) const {
  const int* order = static_cast<const int*>(impl_->factor->Perm);
  std::vector<double> permuted(3 * x.size());
  for (std::size_t r = 0; r < permuted.size(); ++r) permuted[r] = x[at(order[r] / 3)][order[r] % 3];
  solveSupernodal(viewOf(*impl_->factor), permuted.data(), 1);
  for (std::size_t r = 0; r < permuted.size(); ++r) x[at(order[r] / 3)][order[r] % 3] = permuted[r];
}

void SparseCholesky::solve(std::span<std::vector<Vec3>* const> xs) const {
  if (xs.size() < kWorthABlock) {
    for (std::vector<Vec3>* x : xs) solve(*x);
    return;
  }
  const int* order = static_cast<const int*>(impl_->factor->Perm);
  const std::size_t rows = 3 * impl_->nodes;
  std::vector<double> permuted(kSolveWidth * rows, 0.0);
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t w = 0; w < xs.size(); ++w)
      permuted[kSolveWidth * r + w] = (*xs[w])[at(order[r] / 3)][order[r] % 3];
  solveSupernodal(viewOf(*impl_->factor), permuted.data(), kSolveWidth);
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t w = 0; w < xs.size(); ++w)
      (*xs[w])[at(order[r] / 3)][order[r] % 3] = permuted[kSolveWidth * r + w];
}

double SparseCholesky::factorSize() const { return static_cast<double>(impl_->factor->xsize); }
std::size_t SparseCholesky::peakBytes() const { return impl_->peakBytes; }

}  // namespace sherd
