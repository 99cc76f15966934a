#include "support/prepared_cells.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "cvd/cvd.h"
#include "embed/embed.h"
#include "load_mesh/load_mesh.h"
#include "support/file_store.h"
#include "tetrahedralize/tetrahedralize.h"

namespace sherd::test {
namespace {

Result<std::shared_ptr<const Embedding>> embeddingOf(const std::shared_ptr<const TriMesh>& surface,
                                                     const PrepareParams& params) {
  TetrahedralizeParams cage;
  cage.tets = params.tets;
  SHERD_ASSIGN(TetMesh tets, tetrahedralize(surface, cage, Exec{}));
  EmbedParams metric;
  if (params.euclidean) metric.metric = EmbedParams::Metric::Euclidean;
  SHERD_ASSIGN(Embedding embedding, embed(std::make_shared<const TetMesh>(std::move(tets)), metric, Exec{}));
  return std::make_shared<const Embedding>(std::move(embedding));
}

/// Raised with the implementation of any node that the cells come from, so that what is kept is made anew.
constexpr int kImplementation = 4;

Result<PreparedCells> prepare(const std::shared_ptr<const TriMesh>& surface, const std::string& key,
                              const PrepareParams& params, FileStore& store) {
  PreparedCells made;
  const std::string name =
      fmt::format("{}-{}-{}{}", key, kImplementation, params.tets, params.euclidean ? "-euclidean" : "");
  made.embedding = store.find<Embedding>(name);
  if (!made.embedding) {
    SHERD_ASSIGN(made.embedding, embeddingOf(surface, params));
    store.keep(name, made.embedding);
  }
  const WeightField weights = volumeWeights(made.embedding->tets);
  Sites sites;
  for (const int count : params.counts) {
    const std::string own = fmt::format("{}-{}", name, count);
    auto cells = store.find<Partition>(own);
    if (!cells) {
      CvdParams search;
      search.degree = count;
      const Sites* start = sites.positions.cols() > 0 ? &sites : nullptr;
      SHERD_ASSIGN(Partition grown, cvd(made.embedding, weights, start, search, Exec{}));
      cells = std::make_shared<const Partition>(std::move(grown));
      store.keep(own, cells);
    }
    sites.positions = cells->sites;
    sites.energy = cells->energy;
    made.cells.push_back(std::move(cells));
  }
  return made;
}

}  // namespace

std::filesystem::path defaultStore() {
  const char* set = std::getenv("SHERD_TEST_STORE");
  return set ? std::filesystem::path(set) : std::filesystem::path(SHERD_BINARY_DIR) / "prepared";
}

WeightField volumeWeights(const std::shared_ptr<const TetMesh>& tets) {
  WeightField field;
  field.tets = tets;
  field.volume = lumpedVolumes(*tets);
  field.weight = field.volume;
  return field;
}

Result<PreparedCells> prepareCells(const std::string& file, const PrepareParams& params,
                                   const std::filesystem::path& store) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(in), {});
  LoadMeshParams load;
  load.file = file;
  SHERD_ASSIGN(TriMesh surface, loadMesh(load, Exec{}));
  FileStore files(store);
  return prepare(std::make_shared<const TriMesh>(std::move(surface)), Hasher().add(bytes).digest().hex(),
                 params, files);
}

Result<PreparedCells> prepareCells(std::shared_ptr<const TriMesh> surface, const std::string& name,
                                   const PrepareParams& params, const std::filesystem::path& store) {
  FileStore files(store);
  return prepare(surface, name, params, files);
}

}  // namespace sherd::test
