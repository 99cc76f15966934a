#include "types/partition.h"

#include "types/fields.h"

namespace sherd {
namespace {

void hashMatrix(Hasher& hasher, const Eigen::MatrixXd& m) {
  hasher.add(m.rows()).add(m.cols()).bytes(m.data(), static_cast<std::size_t>(m.size()) * sizeof(double));
}

std::size_t matrixBytes(const Eigen::MatrixXd& m) {
  return static_cast<std::size_t>(m.size()) * sizeof(double);
}

}  // namespace

void hashValue(Hasher& hasher, const Embedding& embedding) {
  if (embedding.tets) hashValue(hasher, *embedding.tets);
  hasher.add(static_cast<int>(embedding.metric)).add(embedding.diameter);
  hashMatrix(hasher, embedding.coordinates);
}

void hashValue(Hasher& hasher, const Sites& sites) {
  hashMatrix(hasher, sites.positions);
  hasher.add(sites.energy).add(sites.gamma).add(sites.degreeGiven);
}

void hashValue(Hasher& hasher, const Partition& partition) {
  if (partition.embedding) hashValue(hasher, *partition.embedding);
  hashValue(hasher, partition.material);
  hashMatrix(hasher, partition.sites);
  hasher.add(partition.label).add(partition.energy).add(partition.gamma);
  hasher.add(partition.degreeGiven);
  hasher.add(partition.iterations).add(partition.converged);
}

std::size_t byteSize(const Embedding& embedding) { return matrixBytes(embedding.coordinates); }
std::size_t byteSize(const Sites& sites) { return matrixBytes(sites.positions); }
std::size_t byteSize(const Partition& partition) {
  return matrixBytes(partition.sites) + partition.label.size() * sizeof(Index);
}

}  // namespace sherd
