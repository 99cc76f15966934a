#include "types/partition.h"

#include "base/value_type.h"
#include "types/value_bytes.h"

namespace sherd {

static_assert(ArchivedValue<Embedding> && ArchivedValue<Sites> && ArchivedValue<Partition>);

namespace {

std::size_t matrixBytes(const Eigen::MatrixXd& m) {
  return static_cast<std::size_t>(m.size()) * sizeof(double);
}

bool isSound(const Embedding& embedding) {
  const bool known =
      embedding.metric == Embedding::Metric::Euclidean || embedding.metric == Embedding::Metric::Interior;
  const std::size_t nodes = embedding.tets ? embedding.tets->nodes.size() : 0;
  return known && static_cast<std::size_t>(embedding.coordinates.cols()) == nodes;
}

/// Sites lie in the embedding, and every node has one of them.
bool isSound(const Partition& partition) {
  if (partition.embedding == nullptr) return partition.label.empty();
  const Eigen::MatrixXd& coordinates = partition.embedding->coordinates;
  return partition.label.size() == static_cast<std::size_t>(coordinates.cols()) &&
         allInRange(partition.label, 0, partition.siteCount()) &&
         (partition.sites.cols() == 0 || partition.sites.rows() == coordinates.rows());
}

}  // namespace

void hashValue(Hasher& hasher, const Embedding& embedding) {
  hashPart(hasher, embedding.tets);
  hasher.add(static_cast<int>(embedding.metric));
  hashBits(hasher, embedding.diameter);
  hashBits(hasher, embedding.coordinates);
}

void hashValue(Hasher& hasher, const Sites& sites) {
  hashBits(hasher, sites.positions);
  hashBits(hasher, sites.energy);
  hashBits(hasher, sites.gamma);
  hasher.add(sites.degreeGiven).add(sites.pinned);
}

void hashValue(Hasher& hasher, const Partition& partition) {
  hashPart(hasher, partition.embedding);
  hashBits(hasher, partition.material);
  hashBits(hasher, partition.sites);
  hasher.add(partition.label);
  hashBits(hasher, partition.energy);
  hashBits(hasher, partition.gamma);
  hasher.add(partition.degreeGiven);
  hasher.add(partition.iterations).add(partition.converged);
}

std::size_t byteSize(const Embedding& embedding) { return matrixBytes(embedding.coordinates); }
std::size_t byteSize(const Sites& sites) { return matrixBytes(sites.positions); }
std::size_t byteSize(const Partition& partition) {
  return matrixBytes(partition.sites) + partition.label.size() * sizeof(Index);
}

void saveValue(ArchiveWriter& to, const Embedding& embedding) {
  to.part(embedding.tets);
  to.put(embedding.metric);
  putBits(to, embedding.coordinates);
  to.put(embedding.diameter);
}

std::optional<Embedding> loadValue(ArchiveReader& from, std::type_identity<Embedding>) {
  std::optional<Embedding> embedding(std::in_place);
  embedding->tets = from.part<TetMesh>();
  from.get(embedding->metric);
  getBits(from, embedding->coordinates);
  from.get(embedding->diameter);
  if (!from.ok() || !isSound(*embedding)) embedding.reset();
  return embedding;
}

void saveValue(ArchiveWriter& to, const Sites& sites) {
  putBits(to, sites.positions);
  to.put(sites.energy);
  to.put(sites.gamma);
  to.put(sites.degreeGiven);
  to.put(sites.pinned);
}

std::optional<Sites> loadValue(ArchiveReader& from, std::type_identity<Sites>) {
  std::optional<Sites> sites(std::in_place);
  getBits(from, sites->positions);
  from.get(sites->energy);
  from.get(sites->gamma);
  from.get(sites->degreeGiven);
  from.get(sites->pinned);
  if (!from.ok() || sites->pinned < 0 || sites->pinned > sites->positions.cols()) sites.reset();
  return sites;
}

void saveValue(ArchiveWriter& to, const Partition& partition) {
  to.part(partition.embedding);
  putBits(to, partition.material);
  putBits(to, partition.sites);
  to.array(partition.label);
  to.put(partition.energy);
  to.put(partition.gamma);
  to.put(partition.degreeGiven);
  to.put(partition.iterations);
  to.put(partition.converged);
}

std::optional<Partition> loadValue(ArchiveReader& from, std::type_identity<Partition>) {
  std::optional<Partition> loaded(std::in_place);
  Partition& partition = *loaded;
  partition.embedding = from.part<Embedding>();
  getBits(from, partition.material);
  getBits(from, partition.sites);
  from.array(partition.label);
  from.get(partition.energy);
  from.get(partition.gamma);
  from.get(partition.degreeGiven);
  from.get(partition.iterations);
  from.get(partition.converged);
  if (!from.ok() || !isSound(partition)) loaded.reset();
  return loaded;
}

}  // namespace sherd
