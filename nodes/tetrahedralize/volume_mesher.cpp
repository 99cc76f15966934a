#include "tetrahedralize/volume_mesher.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_3/Slivers_exuder.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Random.h>
#include <CGAL/assertions_behaviour.h>
#include <CGAL/perturb_mesh_3.h>
#include <CGAL/refine_mesh_3.h>

#include <unordered_map>

namespace sherd {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain, CGAL::Default, CGAL::Sequential_tag>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
namespace option = CGAL::parameters;

Vec3 toVec(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }

// Mesh_3's criteria are about circumradii. These factors make the mean edge come out near the length aimed
// at.
constexpr double kFacetRadius = 0.72;
constexpr double kCellRadius = 0.80;
constexpr double kFacetAngle = 25;        ///< degrees; refinement is proven to end up to 30
constexpr double kRadiusEdgeRatio = 2.5;  ///< proven to end from 2

/// Thrown through CGAL, which has no other way to be stopped that does not leave half a mesh behind.
struct Cancelled {};

void throwIfCancelled(const CancelToken* cancel) {
  if (cancel != nullptr && cancel->cancelled()) throw Cancelled{};
}

/// The smallest dihedral angle, CGAL's own criterion, which perturbation and exudation evaluate all the time:
/// the place from which they can be stopped.
class SliverCriterion : public CGAL::Mesh_3::Min_dihedral_angle_criterion<Triangulation> {
  using Angle = CGAL::Mesh_3::Min_dihedral_angle_criterion<Triangulation>;

 public:
  SliverCriterion(double bound, const Triangulation& triangulation, const CancelToken* cancel)
      : Angle(bound, triangulation), cancel_(cancel) {}
  double operator()(Cell_handle cell) const override {
    throwIfCancelled(cancel_);
    return Angle::operator()(cell);
  }
  double operator()(const Tetrahedron_3& tet) const override {
    throwIfCancelled(cancel_);
    return Angle::operator()(tet);
  }

 private:
  const CancelToken* cancel_;
};

/// A function on space in the form that Mesh_3 takes sizes in.
struct SizeField {
  using FT = double;
  using Point_3 = Kernel::Point_3;
  using Index = Domain::Index;
  std::function<double(const Vec3&)> size;
  double factor;
  const CancelToken* cancel;
  FT operator()(const Point_3& p, int, const Index&) const {
    throwIfCancelled(cancel);
    return factor * size(toVec(p));
  }
};

}  // namespace

struct VolumeMesh::Impl {
  std::unique_ptr<Domain> domain;
  Complex complex;
};

VolumeMesh::VolumeMesh() : impl_(std::make_unique<Impl>()) {}
VolumeMesh::~VolumeMesh() = default;
VolumeMesh::VolumeMesh(VolumeMesh&&) noexcept = default;
VolumeMesh& VolumeMesh::operator=(VolumeMesh&&) noexcept = default;

Result<VolumeMesh> VolumeMesh::refine(const VolumeToMesh& volume, const Exec& exec) {
  // CGAL would print that there is nothing to start from, which callers see from the number of tetrahedra.
  static const auto quiet =
      CGAL::set_warning_handler([](const char*, const char*, const char*, int, const char*) {});
  static_cast<void>(quiet);
  // Mesh_3 draws from a generator of the thread, which CGAL seeds by the time.
  CGAL::get_default_random() = CGAL::Random(1);
  VolumeMesh mesh;
  try {
    const CGAL::Bbox_3 box(volume.box.low.x(), volume.box.low.y(), volume.box.low.z(), volume.box.high.x(),
                           volume.box.high.y(), volume.box.high.z());
    const auto field = volume.field;
    mesh.impl_->domain = std::make_unique<Domain>(
        [field, cancel = exec.cancel](const Kernel::Point_3& p) {
          throwIfCancelled(cancel);
          return field(toVec(p)) < 0 ? 1 : 0;
        },
        box, volume.precision / volume.box.diagonal());
    std::vector<std::pair<Kernel::Point_3, Domain::Index>> seeds;
    const Domain::Index onBoundary = mesh.impl_->domain->index_from_surface_patch_index({0, 1});
    for (const Vec3& p : volume.seeds) seeds.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()), onBoundary);
    mesh.impl_->complex.insert_surface_points(seeds.begin(), seeds.end());
    const Criteria criteria(option::facet_angle = kFacetAngle,
                            option::facet_size = SizeField{volume.edgeLength, kFacetRadius, exec.cancel},
                            option::facet_distance = SizeField{volume.facetDistance, 1.0, exec.cancel},
                            option::cell_radius_edge_ratio = kRadiusEdgeRatio,
                            option::cell_size = SizeField{volume.edgeLength, kCellRadius, exec.cancel});
    CGAL::refine_mesh_3(mesh.impl_->complex, *mesh.impl_->domain, criteria, option::no_perturb(),
                        option::no_exude(), option::no_lloyd(), option::no_odt(), option::no_reset_c3t3(),
                        option::manifold());
  } catch (const Cancelled&) {
    return cancelledError();
  } catch (const std::exception& e) {
    return failure(std::string("meshing the volume failed in CGAL: ") + e.what());
  }
  if (exec.cancelled()) return cancelledError();
  return mesh;
}

std::size_t VolumeMesh::tetCount() const { return impl_->complex.number_of_cells_in_complex(); }

Result<void> VolumeMesh::removeSlivers(double perturbBound, double exudeBound,
                                       const std::function<bool(const Tetrahedra&)>& good, const Exec& exec) {
  if (!good(extract())) return {};  // will be meshed again anyway
  CGAL::get_default_random() = CGAL::Random(2);
  try {
    const Complex before = impl_->complex;
    for (const double share : {1.0, 0.7}) {
      if (!(perturbBound > 0)) break;
      CGAL::perturb_mesh_3(impl_->complex, *impl_->domain, option::time_limit = 0,
                           option::sliver_criterion = SliverCriterion(
                               share * perturbBound, impl_->complex.triangulation(), exec.cancel));
      throwIfCancelled(exec.cancel);
      if (good(extract())) break;
      impl_->complex = before;
    }
    // exude_mesh_3 takes no criterion; the class that it calls does.
    CGAL::Mesh_3::Slivers_exuder<Complex, SliverCriterion> exuder(
        impl_->complex, SliverCriterion(exudeBound, impl_->complex.triangulation(), exec.cancel));
    exuder.set_time_limit(0);
    exuder();
  } catch (const Cancelled&) {
    return cancelledError();
  } catch (const std::exception& e) {
    return failure(std::string("removing slivers failed in CGAL: ") + e.what());
  }
  return {};
}

Tetrahedra VolumeMesh::extract() const {
  Tetrahedra out;
  std::unordered_map<std::size_t, Index> numberOf;  // by time stamp, which does not depend on addresses
  const auto& complex = impl_->complex;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell) {
    Tetra tet;
    for (int c = 0; c < 4; ++c) {
      const auto vertex = cell->vertex(c);
      const auto [found, isNew] =
          numberOf.try_emplace(vertex->time_stamp(), static_cast<Index>(out.nodes.size()));
      if (isNew) out.nodes.push_back(toVec(vertex->point().point()));
      tet[static_cast<std::size_t>(c)] = found->second;
    }
    out.tets.push_back(tet);
  }
  return out;
}

}  // namespace sherd
