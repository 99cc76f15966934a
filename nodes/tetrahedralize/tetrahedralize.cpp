#include "tetrahedralize/tetrahedralize.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "geometry/surface_links.h"
#include "tetrahedralize/cage_field.h"
#include "tetrahedralize/contacts.h"
#include "tetrahedralize/enclosure.h"
#include "tetrahedralize/inside_share.h"
#include "tetrahedralize/unit_surface.h"

namespace sherd {
namespace {

constexpr double kTetShape = 0.095;  ///< volume of a typical tetrahedron in cubes of the edge length aimed at
constexpr double kCountTolerance = 0.1;  ///< of the number of tetrahedra, that the search ends at
constexpr int kSearchRuns = 4;           ///< runs of Mesh_3 for the number of tetrahedra
constexpr int kTries = 5;                ///< further ones for enclosure, topology and gaps
constexpr std::size_t kPatience = 3;     ///< of these, that may fail to halve what topology is off by
constexpr int kFew = 3;                  ///< handles and shells: another try may mend these
constexpr double kMoreTets = 4;          ///< times as many where none of these gave a cage
constexpr int kEmptyRuns = 6;            ///< runs of Mesh_3 that may find nothing to fill, each with …
constexpr double kShorterEdge = 0.75;    ///< … so much shorter edges than the one before
constexpr double kPerturbBound = 12, kExudeBound = 14;  ///< degrees
/// Of a needle, whose surface has less than `kNeedle` edges times the diagonal, each node neighbours hundreds
/// of cells outside, and perturbation takes most of all time; exudation alone leaves angles that serve.
constexpr double kNeedle = 2;
constexpr std::size_t kManyTets = 2000;
constexpr std::size_t kMostTets = 20;          ///< times the number aimed at, that gaps may ask for …
constexpr std::size_t kAlwaysAllowed = 40000;  ///< … or this many

/// The edge length with which `tets` fill the volume of the cage.
double edgeForCount(const UnitSurface& surface, double tets) {
  double h = std::cbrt(surface.volume / (kTetShape * tets));
  for (int i = 0; i < 50; ++i)
    h = std::cbrt((surface.volume + surface.area * kOffsetShare * h) / (kTetShape * tets));
  return h;
}

double meanEdge(const Tetrahedra& mesh) {
  std::set<std::pair<Index, Index>> edges;
  double sum = 0;
  for (const Tetra& t : mesh.tets)
    for (const auto& e : kTetraEdge) {
      const auto [a, b] = std::minmax(t[static_cast<std::size_t>(e[0])], t[static_cast<std::size_t>(e[1])]);
      if (edges.emplace(a, b).second) sum += (mesh.nodes[at(a)] - mesh.nodes[at(b)]).norm();
    }
  return sum / static_cast<double>(edges.size());
}

class CageBuilder {
 public:
  CageBuilder(std::shared_ptr<const TriMesh> mesh, UnitSurface surface, const TetrahedralizeParams& params,
              const Exec& exec)
      : mesh_(std::move(mesh)),
        surface_(std::move(surface)),
        params_(params),
        exec_(exec),
        tree_(surface_.positions, surface_.triangles),
        wanted_(topologyOf(surface_.shells)),
        contacts_(countContacts(mesh_->positions, mesh_->triangles, kTouching * surface_.size)) {}

  Result<TetMesh> build() {
    SHERD_ASSIGN(std::optional<TetMesh> cage, attempt());
    if (!cage && !bridgesAreNarrow_ && !isTooNarrow_ && !isSpareNear()) {
      // What is thin or near to another part of the surface at this resolution is less so at a higher one.
      exec_.info("meshing again with more tetrahedra: " + problem_->what);
      params_.tets = static_cast<int>(std::min(kMoreTets * params_.tets, kMostAskedFor));
      params_.edgeLength /= std::cbrt(kMoreTets);
      sizes_ = {};
      smallGapsToo_ = false;
      SHERD_ASSIGN(cage, attempt());
    }
    if (!cage && spare_) {
      exec_.warn(countsText(spareTopology_) + ": it bridges gaps and holes that are smaller than its edges");
      cage = std::move(spare_);
    }
    if (!cage) return *problem_;
    return finish(std::move(*cage));
  }

 private:
  /// Is topology off by much, and by more than half of what it was off by `kPatience` tries before?
  bool isHopeless() const {
    const std::size_t n = offBy_.size();
    return n > kPatience && offBy_[n - 1] > std::max(kFew, offBy_[n - 1 - kPatience] / 2);
  }

  /// Is there a cage that bridges so little that it is not worth four times the tetrahedra?
  bool isSpareNear() const { return spare_ && topologyDifference(spareTopology_, wanted_) <= kFew; }

  /// A cage as promised, or none, and problem_ says why not.
  Result<std::optional<TetMesh>> attempt() {
    nominal_ =
        params_.edgeLength > 0 ? params_.edgeLength / surface_.size : edgeForCount(surface_, params_.tets);
    if (const double least = edgeForCount(surface_, kMostAskedFor); nominal_ < least)
      return failure(fmt::format("edges of {:g} m would take far more than {:g} tetrahedra",
                                 nominal_ * surface_.size, kMostAskedFor),
                     fmt::format("ask for at least {:.2g} m, or for 0 and a number of tetrahedra",
                                 least * surface_.size),
                     params_.edgeLength > 0 ? "edge_length" : "tets");
    nominal_ = std::min(nominal_, 0.25);  // at least a few edges across the object
    exec_.progress(0.02);
    offBy_.clear();
    emptyEdges_.clear();
    SHERD_CHECK(lookForGaps());
    SHERD_ASSIGN(VolumeMesh mesh, searchEdgeLength());
    const auto hasTopology = [this](const Tetrahedra& tetrahedra) {
      const TetMesh cage = toMetres(tetrahedra, surface_);
      const auto shells = splitShells(cage.nodes, cage.boundary);
      return shells.ok() && enclosesTopology(topologyOf(*shells), wanted_, contacts_);
    };
    for (int tries = 0; tries < kTries; ++tries) {
      exec_.progress(0.6 + 0.06 * tries);
      const bool isNeedle = mesh.tetCount() > kManyTets && surface_.area < kNeedle * sizes_.edgeLength;
      SHERD_CHECK(mesh.removeSlivers(isNeedle ? 0 : kPerturbBound, kExudeBound, hasTopology, exec_));
      TetMesh cage = toMetres(mesh.extract(), surface_);
      SHERD_ASSIGN(bool good, verify(cage));
      if (exec_.cancelled()) return cancelledError();
      if (good) return std::optional(std::move(cage));
      if (isTooNarrow_ || isHopeless()) break;
      exec_.info("meshing again, more finely: " + problem_->what);
      SHERD_ASSIGN(mesh, meshOnce());
    }
    return std::optional<TetMesh>();
  }

  Result<void> lookForGaps() {
    const double widest = kOffsetShare * nominal_ * kLargestEdge * 4;
    gaps_ = findGaps(
        surface_.positions, surface_.triangles,
        {.spacing = nominal_ / 3, .widest = widest, .farthest = 2 * nominal_, .touching = contacts_ > 0},
        exec_);
    sizes_.edgeLength = nominal_;
    chooseGaps();
    if (exec_.cancelled()) return cancelledError();
    return {};
  }

  /// Gaps to be kept open: those with a way round of more than an edge, or shorter ones when topology asked
  /// for it; but none whose way round is hardly longer than the way across, as at the bottom of a groove.
  void chooseGaps() {
    sizes_.open.clear();
    for (const Gap& gap : gaps_)
      if (isWorthOpening(gap, smallGapsToo_ ? 0.3 : 1)) sizes_.open.push_back(gap);
    if (between_) sizes_.open.insert(sizes_.open.end(), between_->gaps.begin(), between_->gaps.end());
  }
  bool isWorthOpening(const Gap& gap, double edges) const {
    return gap.detour > std::max(edges * nominal_, 1.3 * gap.width);
  }

  /// In the coordinates of the file that the surface came from, where artists look for it.
  std::string near(const Vec3& metres) const { return "near " + placeText(mesh_->frame.toFile(metres)); }

  static std::string remedy(const std::string& inTheModel, bool moreMayHelp) {
    return inTheModel +
           ", or put Repair with the mode `rebuild` before this node, which closes what is narrow" +
           (moreMayHelp ? "; or ask for more tetrahedra" : "");
  }

  std::string gapText(const Gap& gap) const {
    return fmt::format("the gap of {:.3g} m {}", gap.width * surface_.size,
                       near(surface_.toMetres(gap.middle())));
  }

  static std::string edgesText(double metres) {
    return fmt::format("edges of about {:.2g} m there would keep it open", metres);
  }
  std::string edgesText(const Gap& gap) const { return edgesText(kEdgeOfGap * gap.width * surface_.size); }

  /// Points a whole edge apart can be too few for Mesh_3 to see what is thin and small between them.
  Result<VolumeMesh> meshOnce() {
    for (int run = 1;; ++run) {
      SHERD_ASSIGN(VolumeMesh mesh, meshWithEdges());
      if (mesh.tetCount() > 0) return mesh;
      emptyEdges_.push_back(sizes_.edgeLength);
      if (run == kEmptyRuns)
        return failure(fmt::format("the body is too thin or too small for edges of {:.3g} m: no tetrahedron "
                                   "fits in",
                                   sizes_.edgeLength * surface_.size),
                       "ask for more tetrahedra, or for a shorter edge",
                       params_.edgeLength > 0 ? "edge_length" : "tets");
      sizes_.edgeLength *= kShorterEdge;
    }
  }

  /// The edge length that meshOnce() comes down to from this one, as far as earlier runs tell.
  double afterEmptyRuns(double edgeLength) const {
    while (std::find(emptyEdges_.begin(), emptyEdges_.end(), edgeLength) != emptyEdges_.end())
      edgeLength *= kShorterEdge;
    return edgeLength;
  }

  Result<VolumeMesh> meshWithEdges() {
    field_ = std::make_unique<CageField>(surface_, tree_, sizes_, levelSet_, exec_);
    if (exec_.cancelled()) return cancelledError();
    if (const double expected = field_->expectedTets(); expected > static_cast<double>(mostTets()))
      return tooMany(expected);
    const VolumeToMesh volume = field_->volume();
    if (exec_.cancelled()) return cancelledError();
    return VolumeMesh::refine(volume, exec_);
  }

  std::size_t mostTets() const {
    return std::max(kAlwaysAllowed, kMostTets * static_cast<std::size_t>(aimedTets()));
  }

  double aimedTets() const {
    if (params_.edgeLength <= 0) return params_.tets;
    return (surface_.volume + surface_.area * kOffsetShare * nominal_) / (kTetShape * std::pow(nominal_, 3));
  }

  Error tooMany(double expected) const {
    const auto narrowest = std::min_element(sizes_.open.begin(), sizes_.open.end(),
                                            [](const Gap& a, const Gap& b) { return a.width < b.width; });
    if (narrowest == sizes_.open.end())
      return failure(fmt::format("about {:.0f} tetrahedra would be needed", expected),
                     "ask for a longer edge or more tetrahedra", "mesh");
    return failure(fmt::format("{} cannot be kept open: {}, about {:.0f} tetrahedra in all",
                               gapText(*narrowest), edgesText(*narrowest), expected),
                   remedy("close or widen the gap in the model", true), "mesh");
  }

  /// Runs Mesh_3 until number of tetrahedra or mean edge length is as asked for, by the secant rule on
  /// logarithms.
  Result<VolumeMesh> searchEdgeLength() {
    double exponent = params_.edgeLength > 0 ? 1 : -2.6;  // of the measure as a function of the edge length
    double lastEdge = 0, lastMeasure = 0;
    for (int run = 0;; ++run) {
      exec_.progress(0.1 + 0.1 * run);
      SHERD_ASSIGN(VolumeMesh mesh, meshOnce());
      const double measure =
          params_.edgeLength > 0 ? meanEdge(mesh.extract()) : static_cast<double>(mesh.tetCount());
      const double goal = params_.edgeLength > 0 ? params_.edgeLength / surface_.size : params_.tets;
      if (std::abs(measure / goal - 1) <= kCountTolerance || run + 1 == kSearchRuns) return mesh;
      if (lastEdge > 0 && lastEdge != sizes_.edgeLength) {
        const double slope = std::log(measure / lastMeasure) / std::log(sizes_.edgeLength / lastEdge);
        exponent = params_.edgeLength > 0 ? std::clamp(slope, 0.3, 2.0) : std::clamp(slope, -5.0, -1.0);
      }
      lastEdge = sizes_.edgeLength, lastMeasure = measure;
      const double next =
          std::min(sizes_.edgeLength * std::pow(goal / measure, 1 / exponent), kLargestEdge * nominal_);
      if (afterEmptyRuns(next) == sizes_.edgeLength)
        return mesh;  // gaps or thin parts ask for more tetrahedra, and no larger edge is sensible
      sizes_.edgeLength = next;
    }
  }

  /// True if the cage is as promised. Otherwise notes the problem and asks for finer meshing where it is.
  Result<bool> verify(TetMesh& cage) {
    auto shells = splitShells(cage.nodes, cage.boundary);
    if (!shells.ok()) return wantMore(failure("the cage's boundary is no manifold: " + shells.error().what));
    if (const auto got = topologyOf(*shells); !enclosesTopology(got, wanted_, contacts_)) {
      keepAsSpare(cage, got);
      return wantTopology(cage, got);
    }
    std::vector<Breach> breaches =
        findBreaches(cage, mesh_->positions, mesh_->triangles, surface_.shells, exec_);
    breaches =
        pushOutward(cage, std::move(breaches), mesh_->positions, mesh_->triangles, surface_.shells, exec_);
    if (!breaches.empty()) return wantEnclosure(cage, breaches);
    return wantOpenGaps(cage);
  }

  /// A cage that keeps apart what is apart by more than an edge serves where no better one comes.
  void keepAsSpare(TetMesh cage, const std::vector<std::pair<bool, int>>& got) {
    if (!joinsNoBodies(got, wanted_)) return;
    if (spare_ && topologyDifference(got, wanted_) >= topologyDifference(spareTopology_, wanted_)) return;
    std::vector<Breach> breaches =
        findBreaches(cage, mesh_->positions, mesh_->triangles, surface_.shells, exec_);
    breaches =
        pushOutward(cage, std::move(breaches), mesh_->positions, mesh_->triangles, surface_.shells, exec_);
    if (!breaches.empty() || exec_.cancelled()) return;
    std::vector<Gap> gaps;
    for (const Gap& gap : gaps_)
      if (isWorthOpening(gap, 1)) gaps.push_back(gap);
    if (!closedGaps(cage, gaps).empty()) return;
    spare_ = std::move(cage);
    spareTopology_ = got;
  }

  bool wantMore(Error problem) {
    problem_ = std::move(problem);
    sizes_.edgeLength *= 0.85;
    return false;
  }

  bool wantEnclosure(const TetMesh& cage, const std::vector<Breach>& breaches) {
    problem_ =
        failure(fmt::format("the surface could not be enclosed: it comes through the cage {} and in {} "
                            "other places",
                            near(breaches.front().place), breaches.size() - 1),
                "ask for more tetrahedra, or repair the surface there", "mesh");
    for (const Breach& b : breaches) {
      Vec3 middle = Vec3::Zero();
      for (const Index n : cage.boundary[at(b.facet)]) middle += cage.nodes[at(n)] / 3;
      addFiner((middle - surface_.centre) / surface_.size, 0.6);
    }
    return false;
  }

  void addFiner(const Vec3& place, double share) {
    sizes_.finer.push_back({place, share * field_->edgeLength(place)});
  }

  /// Gaps whose middle should be outside but is in the cage.
  std::vector<Gap> closedGaps(const TetMesh& cage, const std::vector<Gap>& gaps) const {
    const SurfaceTree boundary(cage.nodes, cage.boundary);
    std::vector<Gap> closed;
    for (const Gap& gap : gaps)
      if ((*field_)(gap.middle()) > 0.5 * field_->offset(gap.middle()) &&
          boundary.contains(surface_.toMetres(gap.middle())))
        closed.push_back(gap);
    return closed;
  }

  bool wantOpenGaps(const TetMesh& cage) {
    const std::vector<Gap> closed = closedGaps(cage, sizes_.open);
    if (closed.empty()) return true;
    problem_ = failure(gapText(closed.front()) + " could not be kept open: " + edgesText(closed.front()),
                       remedy("widen or close it in the model", true), "mesh");
    for (const Gap& gap : closed) addFiner(gap.middle(), 0.6);
    return false;
  }

  bool wantTopology(const TetMesh& cage, const std::vector<std::pair<bool, int>>& got) {
    offBy_.push_back(topologyDifference(got, wanted_));
    if (joinsSome(got, wanted_)) return wantBodiesApart(cage, got);
    const bool bridged = refineBridges(cage);
    problem_ =
        failure(closedGapText(cage, countsText(got)),
                remedy("widen or close narrow gaps and holes in the model", !bridgesAreNarrow_), "mesh");
    return wantFiner(bridged);
  }

  std::string countsText(const std::vector<std::pair<bool, int>>& got) const {
    return fmt::format("the cage has {} where the surface has {}", describeTopology(got),
                       describeTopology(wanted_));
  }

  /// Where the cage spans no gap it can be told to keep to the surface.
  bool wantFiner(bool bridged) {
    if (bridged) return false;
    if (smallGapsToo_) sizes_.closeness *= 0.6;
    smallGapsToo_ = true;
    chooseGaps();
    return false;
  }

  /// The cage joins bodies. Gaps between these that no look along a normal saw are kept open from now on, if
  /// there is room for a cage in them.
  bool wantBodiesApart(const TetMesh& cage, const std::vector<std::pair<bool, int>>& got) {
    const bool isFirst = !between_;
    if (isFirst)
      between_ = gapsBetweenBodies(surface_.positions, surface_.triangles, surface_.shells, kTouching,
                                   nominal_, mostTets() / kTetsAtGap, exec_);
    const std::optional<Gap>& narrowest = between_->narrowest;
    // Those that are known have had their share; what is wrong there, finer meshing may mend.
    const bool isKnown = narrowest && std::any_of(gaps_.begin(), gaps_.end(), [&](const Gap& gap) {
                           return gap.width <= 2 * narrowest->width;
                         });
    if (isFirst && isKnown) between_->gaps.clear();
    isTooNarrow_ = !isKnown && narrowest && (between_->isTooMany || narrowest->width < kNarrowestGap);
    problem_ = failure(fmt::format("{}{}", countsText(got),
                                   narrowest ? "; it closes " + gapText(*narrowest) +
                                                   " between two bodies: " + edgesText(*narrowest)
                                             : ""),
                       "join the bodies or move them apart in the model", "mesh");
    if (isTooNarrow_) return false;
    if (isFirst && narrowest && !isKnown) {
      chooseGaps();
      return false;
    }
    return wantFiner(refineBridges(cage));
  }

  /// What a cage closes, where that is known, else what it has: counts of the surface and of the cage.
  std::string closedGapText(const TetMesh& cage, const std::string& counts) const {
    const SurfaceTree boundary(cage.nodes, cage.boundary);
    const Gap* narrowest = nullptr;
    for (const Gap& gap : gaps_)
      if ((narrowest == nullptr || gap.width < narrowest->width) &&
          boundary.contains(surface_.toMetres(gap.middle())))
        narrowest = &gap;
    if (narrowest == nullptr && !bridge_) return counts;
    const double width = narrowest != nullptr ? narrowest->width : 2 * tree_.closest(*bridge_).distance;
    const Vec3 place = narrowest != nullptr ? narrowest->middle() : *bridge_;
    return fmt::format("the tetrahedra around the model close the gap of about {:.3g} m {}: {} ({})",
                       width * surface_.size, near(surface_.toMetres(place)),
                       edgesText(kEdgeOfGap * width * surface_.size), counts);
  }

  /// Asks for finer meshing where the cage lies clearly outside the level set, as where it spans a gap.
  bool refineBridges(const TetMesh& cage) {
    std::size_t bridges = 0, narrow = 0;
    bridge_.reset();
    for (const Tetra& t : cage.tets)
      for (const auto& e : kTetraEdge) {
        const Vec3 middle = 0.5 * (cage.nodes[at(t[static_cast<std::size_t>(e[0])])] +
                                   cage.nodes[at(t[static_cast<std::size_t>(e[1])])]);
        const Vec3 x = (middle - surface_.centre) / surface_.size;
        if (!((*field_)(x) > 0.5 * field_->offset(x))) continue;
        if (bridges++ == 0) bridge_ = x;
        if (field_->edgeLength(x) < kNarrow * nominal_) ++narrow;
        addFiner(x, 0.6);
      }
    // More tetrahedra make edges shorter where nothing but their number tells how long they are.
    bridgesAreNarrow_ = 2 * narrow > bridges;
    return bridges > 0;
  }

  Result<TetMesh> finish(TetMesh cage) {
    exec_.progress(0.92);
    cage.surface = mesh_;
    holdTriangles(cage, mesh_->positions, mesh_->triangles, exec_);
    fillInsideFractions(cage, mesh_->positions, mesh_->triangles, exec_);
    linkSurface(cage, exec_);
    if (exec_.cancelled()) return cancelledError();
    cage.quality = measureQuality(cage, mesh_->positions, mesh_->triangles);
    exec_.progress(1);
    return cage;
  }

  static constexpr double kMostAskedFor = 5e6;   ///< tetrahedra
  static constexpr std::size_t kTetsAtGap = 10;  ///< that keeping it open takes, at least
  static constexpr double kNarrowestGap = 1e-5;  ///< of the diagonal, between bodies
  static constexpr double kNarrow = 0.25;      ///< nominal edge lengths that an edge in a gap is shorter than
  static constexpr double kLargestEdge = 1.5;  ///< nominal edge lengths that the search may go up to

  std::shared_ptr<const TriMesh> mesh_;
  UnitSurface surface_;
  TetrahedralizeParams params_;
  const Exec& exec_;
  SurfaceTree tree_;
  std::vector<std::pair<bool, int>> wanted_;
  std::size_t contacts_;  ///< where the surface touches itself
  double nominal_ = 0;    ///< the edge length that the number of tetrahedra stands for without any gap
  std::vector<Gap> gaps_;
  bool smallGapsToo_ = false;
  CageSizes sizes_;
  std::shared_ptr<const LevelSet> levelSet_;
  std::unique_ptr<CageField> field_;
  std::optional<Error> problem_;
  std::vector<double>
      emptyEdges_;          ///< edge lengths with which Mesh_3 saw nothing to fill, while they are sought
  std::vector<int> offBy_;  ///< what topology was off by, each time that it was
  bool bridgesAreNarrow_ = false;
  std::optional<Vec3> bridge_;       ///< a place where the last cage spanned a gap
  std::optional<BodyGaps> between_;  ///< once they were looked for
  bool isTooNarrow_ = false;         ///< for any cage with about as many tetrahedra
  std::optional<TetMesh> spare_;     ///< with other handles or voids than the surface, but sound
  std::vector<std::pair<bool, int>> spareTopology_;
};

}  // namespace

Result<TetMesh> tetrahedralize(std::shared_ptr<const TriMesh> surface, const TetrahedralizeParams& params,
                               const Exec& exec) {
  if (!surface) return failure("there is no surface", "connect one", "mesh");
  if (params.tets < 1 && params.edgeLength <= 0)
    return failure("the number of tetrahedra is not positive", "ask for some hundreds or thousands", "tets");
  SHERD_ASSIGN(UnitSurface unit, checkedUnitSurface(*surface));
  try {
    return CageBuilder(std::move(surface), std::move(unit), params, exec).build();
  } catch (const std::exception& e) {  // CGAL's and OpenVDB's
    return failure(std::string("tetrahedralizing failed: ") + e.what(), "repair the surface", "mesh");
  }
}

}  // namespace sherd
