// The node pack, loaded as the program does, and what the contract accepts of it.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "plugin/loader.h"
#include "runtime/made_up.h"
#include "support/contract.h"
#include "types/scalar_grid_vdb.h"

namespace sherd::test {

inline const Registry& pack() {
  static const Registry registry = [] {
    Registry loaded;
    const auto done = loadPack(SHERD_BINARY_DIR "/lib/sherd_nodes.so", loaded);
    if (!done.ok()) ADD_FAILURE() << done.error().text();
    return loaded;
  }();
  return registry;
}

inline std::vector<std::string> packTypes() {
  std::vector<std::string> names;
  for (const NodeType* type : pack().all()) names.push_back(type->name);
  return names;
}

/// A painted field: a ball of 2 in a background of 1.
inline void writeField(const std::string& path) {
  openvdb::initialize();
  const auto grid = openvdb::FloatGrid::create(1);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.02));
  grid->setName("beta");
  constexpr int kRadius = 4;
  for (int x = -kRadius; x <= kRadius; ++x)
    for (int y = -kRadius; y <= kRadius; ++y)
      for (int z = -kRadius; z <= kRadius; ++z)
        if (x * x + y * y + z * z <= kRadius * kRadius)
          grid->getAccessor().setValueOn(openvdb::Coord(x, y, z), 2);
  openvdb::io::File(path).write({grid});
}

/// The examples, with what they write in a directory of their own.
class PackExamples {
 public:
  explicit PackExamples(std::vector<std::string> vars = {}) {
    const std::string directory = directory_.path().string();
    writeField(directory + "/field.vdb");
    vars.push_back("field=" + directory + "/field.vdb");
    vars.push_back("out=" + directory + "/out");
    auto read = Examples::read(SHERD_SOURCE_DIR "/tests/contract/examples.json", pack(),
                               Environment::ofProcess(SHERD_SOURCE_DIR "/assets"), vars);
    if (read.ok())
      examples_ = std::move(read).value();
    else
      ADD_FAILURE() << read.error().text();
  }

  Examples* get() const { return examples_.get(); }
  std::string scratch() const { return directory_.path().string(); }
  /// Those of a type; empty, with a failure, where there is none.
  std::vector<Example> of(const std::string& type) const {
    if (examples_ == nullptr) return {};
    auto found = examples_->of(*pack().find(type));
    if (found.ok()) return std::move(found).value();
    ADD_FAILURE() << found.error().text();
    return {};
  }

 private:
  TemporaryDirectory directory_;
  std::unique_ptr<Examples> examples_;
};

/// What the pack's nodes may do although it looks wrong.
inline ContractExceptions packExceptions() {
  ContractExceptions exceptions;
  exceptions.dimensionless = {
      // counts
      "CalibrateToughness.pieces", "ContactSheet.columns", "ConvexProxies.max_hulls", "CVD.degree",
      "CVD.max_iterations", "Embed.dimensions", "PredictDegree.degree", "PredictDegree.max_degree",
      "Preview.samples", "Repair.resolution", "SelectPiece.number", "Tetrahedralize.tets",
      "TrainDegree.balls", "TrainDegree.max_degree", "TrainDegree.orientations", "TrainDegree.repeats",
      // seeds
      "CalibrateToughness.seed", "CVD.seed", "PaintBeta.seed", "PredictDegree.seed", "TrainDegree.seed",
      "WarpRest.seed",
      // shares and ratios of equal quantities
      "ConvexProxies.tolerance", "CVD.tolerance", "Embed.tolerance", "Embed.time", "Preview.explode",
      "Preview.slice_at", "Repair.crack", "Repair.leaf", "Repair.small_hole", "SelectPiece.poisson",
      "Simulate.ball_target", "Simulate.friction", "Simulate.obstacle_poisson", "Simulate.poisson",
      "Simulate.restitution", "Tessellate.min_volume", "TrainDegree.error", "TrainDegree.friction",
      "TrainDegree.obstacle_poisson", "TrainDegree.pca_tolerance", "TrainDegree.poisson",
      "TrainDegree.restitution", "TrainDegree.training_error", "WarpRest.elongation",
      // values of whatever is painted
      "PaintBeta.background", "PaintBeta.high", "PaintBeta.low", "PaintBeta.threshold", "Protect.threshold",
      // exponents
      "TrainDegree.alpha", "Weights.alpha",
      // directions
      "Simulate.ball_direction", "WarpRest.axis", "WarpRest.wave_shift", "WarpRest.wave_travel"};
  exceptions.names = {"E_D", "Young's", "Poisson's", "Coulomb's"};
  // How much memory there is decides what is kept at once, not what comes out.
  exceptions.files = {"/proc/meminfo"};
  // Small files are copied before they are read, which must not change them.
  // And Blosc only speaks more when that one is set.
  exceptions.variables = {"OPENVDB_DELAYED_LOAD_COPY_MAX_BYTES", "BLOSC_WARN"};
  return exceptions;
}

inline void expectNone(const Faults& faults) {
  for (const std::string& fault : faults) ADD_FAILURE() << fault;
}

}  // namespace sherd::test
