#include "repair/repair.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <new>

#include "geometry/edge_table.h"
#include "geometry/orient.h"
#include "geometry/self_intersections.h"
#include "geometry/surface_tree.h"
#include "repair/clean.h"
#include "repair/holes.h"
#include "repair/hull.h"
#include "repair/leaves.h"
#include "repair/patchwork.h"
#include "repair/rebuild.h"
#include "repair/separate.h"
#include "repair/shells.h"
#include "repair/stitch.h"
#include "repair/thicken.h"

namespace sherd {
namespace {

constexpr std::size_t kPairLimit = 20000;  ///< per 1024 triangles: an exact union of more takes too long
constexpr int kRoundings = 8;              ///< times that rounding may make the surface meet itself anew
constexpr double kSolidShare = 0.005;      ///< of area · diagonal: an open part with less volume is a leaf
constexpr double kApart = 1e-6;            ///< of the diagonal
constexpr double kLargePocket = 0.005;     ///< of the diagonal: what was left out for being inside out
constexpr int kFinest = 4;                 ///< times the resolution

std::string counted(std::size_t n, const std::string& one, const std::string& several) {
  return std::to_string(n) + " " + (n == 1 ? one : several);
}

std::string length(double metres) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g m", metres);
  return text;
}

std::string area(double squareMetres) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g m²", squareMetres);
  return text;
}

std::string percent(double share) {
  char text[40];
  std::snprintf(text, sizeof text, share < 0.1 ? "%.2g %%" : "%.0f %%", 100 * share);
  return text;
}

/// One surface on its way up the ladder.
class Ladder {
 public:
  Ladder(TriMesh& mesh, const RepairParams& params, const Exec& exec)
      : given_(mesh),
        params_(params),
        exec_(exec),
        name_(mesh.source.empty() ? "the mesh" : mesh.source.substr(mesh.source.find_last_of('/') + 1)),
        diagonal_(boxOf(mesh.positions).diagonal()),
        sheets_({.thin = kSolidShare,
                 .thickness = params.leaf * diagonal_,
                 .touching = params.crack * diagonal_,
                 .small = std::pow(params.smallHole * diagonal_, 2)}) {}

  Result<Repaired> climb() {
    report_.found = inspectSurface(given_, exec_);
    if (exec_.cancelled()) return cancelledError();
    const std::string name = given_.source.empty() ? "the mesh" : given_.source;
    if (report_.found.empty || report_.found.nonFinite) return *refusal(report_.found, name);
    const bool isRebuilt = params_.mode == RepairParams::Mode::Rebuild;
    if (report_.found.sound() && !isRebuilt) return Repaired{std::move(given_), std::move(report_)};
    if (params_.mode == RepairParams::Mode::Strict) return *refusal(report_.found, name);
    surface_ = patchworkOf(given_);
    joinEqual(surface_);
    mend();
    if (exec_.cancelled()) return cancelledError();
    if (!isRebuilt && isSound()) return done(RepairStage::Mended);
    exec_.progress(0.3);
    const Patchwork mended = surface_;
    if (!isRebuilt && unite(false)) {
      const Patchwork united = surface_;
      const double off = backwardDistance();
      if (off <= kLargePocket * diagonal_) {
        sayBackward(off);
        return done(RepairStage::Hull);
      }
      // More than folds: parts whose outside can't be told.
      surface_ = mended;
      if (!unite(true)) {
        surface_ = united;
        sayBackward(off);
      }
      return done(RepairStage::Hull);
    }
    if (exec_.cancelled()) return cancelledError();
    exec_.progress(0.6);
    surface_ = mended;
    ofUnion_.clear();
    SHERD_CHECK(fromLevelSet());
    if (!isSound())
      return failure(name_ + ": even a surface made anew from a level set is not sound" +
                         (why_.empty() ? "" : " (" + why_ + ")"),
                     "set another `resolution`", "file");
    return done(RepairStage::LevelSet);
  }

 private:
  Result<Repaired> done(RepairStage stage) {
    if (exec_.cancelled()) return cancelledError();
    for (auto& [line, visible] : ofUnion_) say(std::move(line), visible);
    report_.stage = stage;
    exec_.progress(1);
    return Repaired{finished(surface_, given_), std::move(report_)};
  }

  void say(std::string line, bool visible = false) {
    report_.visible = report_.visible || visible;
    line = name_ + ": " + line;
    visible ? exec_.warn(line) : exec_.info(line);
    report_.done.push_back(std::move(line));
  }
  /// Said only if the union stands in the end.
  void sayOfUnion(std::string line, bool visible = false) { ofUnion_.emplace_back(std::move(line), visible); }
  std::string near(const Vec3& metres) const { return " near " + placeInFile(given_.frame.toFile(metres)); }

  bool isSound() { return inspectSurface(bare(surface_), exec_).sound(); }

  /// Rungs 1 to 4.
  void mend() {
    if (const Defect twice = dropDuplicates(surface_))
      say("left out " + counted(twice.count, "face", "faces") +
          (twice.count == 1 ? " that was" : " that were") + " there twice" + near(twice.place));
    if (const Defect flat = dropFlat(surface_, exec_))
      say("dissolved " + counted(flat.count, "face", "faces") + " of no area" + near(flat.place));
    if (const Stitched stitched = stitch(surface_, params_.crack * diagonal_, exec_);
        stitched.joined + stitched.split > 0)
      say("closed cracks" + near(stitched.place) + ": joined " +
          counted(stitched.joined, "vertex", "vertices") + " and split " +
          counted(stitched.split, "edge", "edges") + ", moving nothing by more than " +
          length(stitched.moved));
    dropDuplicates(surface_);
    dropFlat(surface_, exec_);
    if (exec_.cancelled()) return;
    if (const Defect turned = makeCoherent(surface_))
      say("turned " + counted(turned.count, "face", "faces") +
          " that faced the other way than the neighbours" + near(turned.place));
    sheets_.takeHanging(surface_, exec_);
    fill();
    thickenSheets();
    if (exec_.cancelled()) return;
    face();
  }

  void fill() {
    const std::vector<Hole> holes = fillHoles(surface_, exec_);
    std::size_t small = 0;
    const Hole *largest = nullptr, *firstSmall = nullptr;
    for (const Hole& hole : holes) {
      if (hole.size <= params_.smallHole * diagonal_) {
        if (small++ == 0) firstSmall = &hole;
      } else if (largest == nullptr || hole.size > largest->size) {
        largest = &hole;
      }
    }
    if (small > 0) say("filled " + counted(small, "small hole", "small holes") + near(firstSmall->place));
    if (largest != nullptr) {
      openings_ = holes.size() - small;
      largestOpening_ = *largest;
    }
    dropFlat(surface_, exec_);
  }

  void thickenSheets() {
    const std::size_t found = sheets_.thicken(surface_, exec_);
    openings_ = openings_ > found ? openings_ - found : 0;  // theirs are no holes
    if (const SheetCount& strays = sheets_.strays(); strays.count > 0)
      say("left out " + counted(strays.count, "stray sheet", "stray sheets") + " of " + area(strays.area) +
              " on the solid, bounding nothing," + near(strays.place) + " (up to a size of " +
              percent(params_.smallHole) + " of the object, parameter `small_hole`)",
          true);
    if (const SheetCount& within = sheets_.within(); within.count > 0)
      say("left out " + counted(within.count, "sheet", "sheets") + " of " + area(within.area) +
          " within the solid" + near(within.place));
    if (const SheetCount& freed = sheets_.freed(); freed.count > 0)
      say(thickened(freed.count, freed.place), true);
    if (const SheetCount& united = sheets_.united(); united.count > 0)
      say("made " + counted(united.count, "sheet", "sheets") + " of " + area(united.area) +
              " that stood on the solid " + length(params_.leaf * diagonal_) + " thick and one with it" +
              near(united.place) + " (parameter `leaf`)",
          true);
    if (openings_ > 0)
      say("filled " + counted(openings_, "large hole", "large holes") + ", of up to " +
              length(largestOpening_.size) + " (" + percent(largestOpening_.size / diagonal_) +
              " of the object)" + near(largestOpening_.place),
          true);
  }
  std::string thickened(std::size_t parts, const Vec3& place) const {
    return "made " + counted(parts, "part", "parts") +
           (parts == 1 ? " without a solid behind it " : " without a solid behind them ") +
           length(params_.leaf * diagonal_) + " thick" + near(place) + " (parameter `leaf`)";
  }

  void face() {
    const IntersectingPairs met =
        intersectingPairs(surface_.positions, surface_.triangles, exec_, kPairLimit);
    std::vector<bool> crossing(surface_.triangles.size(), false);
    for (const auto& pair : met.pairs)
      for (const Index t : pair) crossing[at(t)] = true;
    const bool dropInner = params_.innerShells == RepairParams::InnerShells::Solid;
    const Shells shells = faceOutward(surface_, dropInner, crossing, exec_);
    joinEqual(surface_);
    if (shells.inverted)
      say("turned " + counted(shells.inverted.count, "part that was", "parts that were") + " inside out" +
          near(shells.inverted.place));
    if (shells.inner)
      say("left out " + counted(shells.inner.count, "part", "parts") +
          " within the solid that faced outward" + near(shells.inner.place) +
          " (parameter `inner_shells` makes voids of them)");
  }

  /// Rungs 5 and 6; true where that made it sound.
  bool unite(bool bothWays) {
    ofUnion_.clear();
    std::size_t pairs = 0;
    bool isThickened = false;
    for (int round = 0; round < kRoundings && !exec_.cancelled(); ++round) {
      Result<Hull> hull = outerHull(surface_, bothWays && round == 0, kPairLimit, exec_);
      if (!hull.ok()) {
        why_ = hull.error().what;
        return false;
      }
      if (round == 0) {
        pairs = hull->pairs;
        backward_ = std::move(hull->backward);
      }
      if (!hull->lost.empty() && !isThickened) {
        isThickened = true;
        const Vec3 place = surface_.positions[at(surface_.triangles[at(hull->lost[0])][0])];
        addSlabs(surface_, hull->lost, params_.leaf * diagonal_);
        sayOfUnion(thickened(1, place), true);
        continue;
      }
      surface_ = std::move(hull->surface);
      cancelOpposite(surface_);
      dropFlat(surface_, exec_);
      if (surface_.triangles.empty()) return false;
      const IntersectingPairs met =
          intersectingPairs(surface_.positions, surface_.triangles, exec_, kPairLimit);
      if (met.pairs.empty()) return drawApart(pairs);
      // Rounding moved faces onto or through each other. Coarser numbers make one vertex of what is that
      // near.
      if (round > 0) coarsen(surface_, met.pairs, std::ldexp(diagonal_, -50 + 4 * round));
    }
    why_ = "rounding makes the united surface meet itself again and again";
    return false;
  }

  /// How far what was left out around space of negative winding number lies off the surface, as seen from
  /// outside.
  double backwardDistance() const {
    if (backward_.empty()) return 0;
    const TriMesh mesh = bare(surface_);
    const auto shells = surfaceParts(mesh.triangles, buildEdgeTable(mesh.triangles, mesh.positions.size()));
    const Nesting nesting = nestShells(mesh, shells);
    std::vector<Triangle> outer;  // without the walls of voids, which nobody sees
    for (std::size_t s = 0; s < shells.size(); ++s)
      for (const Index t : shells[s].triangles)
        if (nesting.volume[s] > 0) outer.push_back(mesh.triangles[at(t)]);
    const SurfaceTree tree(mesh.positions, outer);
    double most = 0;
    for (const Vec3& p : backward_) {
      if (exec_.cancelled()) break;
      if (const double d = tree.closest(p).distance; d > most && !tree.contains(p)) most = d;
    }
    return most;
  }
  void sayBackward(double distance) {
    if (distance <= params_.crack * diagonal_) return;
    report_.hausdorff = distance;
    report_.relativeHausdorff = distance / diagonal_;
    sayOfUnion("left out folds that were turned inside out; they lay up to " + length(distance) + " (" +
                   percent(report_.relativeHausdorff) + " of the object) off the surface",
               true);
  }

  bool drawApart(std::size_t pairs) {
    const std::optional<Separated> apart = separate(surface_, kApart * diagonal_, exec_);
    if (!apart || !isSound()) {
      why_ = "solids touch in a way that they can't be drawn apart";
      return false;
    }
    if (pairs > 0)
      sayOfUnion("joined " + counted(pairs, "pair", "pairs") +
                 " of faces that met each other into one outer surface");
    if (apart->vertices > 0)
      sayOfUnion("drew solids apart that touched at " + counted(apart->vertices, "vertex", "vertices") +
                 near(apart->place) + ", by no more than " + length(apart->moved));
    return true;
  }

  Result<void> fromLevelSet() {
    Result<Rebuilt> made = rebuild(surface_, params_.resolution, kFinest * params_.resolution, exec_);
    if (exec_.cancelled()) return cancelledError();
    if (!made.ok())
      return failure(
          name_ + " can't be repaired: " + (why_.empty() ? "" : why_ + ", and ") + made.error().what,
          "repair it where it was modelled", "file");
    surface_ = std::move(made->surface);
    report_.hausdorff = made->hausdorff;
    report_.relativeHausdorff = made->hausdorff / diagonal_;
    say("made the surface anew from a level set with voxels of " + length(made->voxel) +
            (why_.empty() ? "" : ", since " + why_) + "; it lies up to " + length(made->hausdorff) + " (" +
            percent(report_.relativeHausdorff) + " of the object) off the old one",
        true);
    return {};
  }

  TriMesh& given_;
  const RepairParams& params_;
  const Exec& exec_;
  std::string name_;
  double diagonal_;
  Patchwork surface_;
  RepairReport report_;
  LooseSheets sheets_;
  std::size_t openings_ = 0;  ///< large holes
  Hole largestOpening_;
  std::vector<Vec3> backward_;  ///< corners of what the union left out for being inside out
  std::vector<std::pair<std::string, bool>> ofUnion_;
  std::string why_;  ///< why the rung before was not enough
};

Result<void> check(const RepairParams& params) {
  const auto isShare = [](double x) { return std::isfinite(x) && x >= 0 && x <= 1; };
  if (!isShare(params.crack))
    return failure("crack is not between 0 and 1", "a share of the diagonal", "crack");
  if (!isShare(params.smallHole))
    return failure("small_hole is not between 0 and 1", "a share of the diagonal", "small_hole");
  if (!isShare(params.leaf) || params.leaf == 0)
    return failure("leaf is not between 0 and 1", "a share of the diagonal, such as 0.01", "leaf");
  if (params.resolution < 8) return failure("resolution is below 8", "128, or some hundreds", "resolution");
  return {};
}

}  // namespace

Result<Repaired> repair(TriMesh mesh, const RepairParams& params, const Exec& exec) {
  SHERD_CHECK(check(params));
  try {
    return Ladder(mesh, params, exec).climb();
  } catch (const std::bad_alloc&) {
    return failure((mesh.source.empty() ? "the mesh" : mesh.source) + ": not enough memory to repair it",
                   "use one of fewer triangles", "file");
  }
}

std::string nameOf(RepairStage stage) {
  switch (stage) {
    case RepairStage::None:
      return "none";
    case RepairStage::Mended:
      return "mended";
    case RepairStage::Hull:
      return "hull";
    case RepairStage::LevelSet:
      return "level set";
  }
  return "";
}

}  // namespace sherd
