#include "types/degree_model.h"

#include <fmt/format.h>

#include <iterator>

#include "base/value_type.h"
#include "types/value_bytes.h"

namespace sherd {

static_assert(ArchivedValue<DegreeModel>);
static_assert(sizeof(DegreeErrors) == 5 * sizeof(double), "hashed and saved as it lies in memory");

namespace {

void hashValidity(Hasher& hasher, const DegreeValidity& v) {
  hasher.add(v.tets).add(v.embedding);
  hashBits(hasher, v.material);
  hashBits(hasher, v.gamma);
  hashBits(hasher, v.alpha);
  hasher.add(v.beta);
}

void putValidity(ArchiveWriter& to, const DegreeValidity& v) {
  to.put(v.tets);
  to.put(v.embedding);
  putBits(to, v.material);
  to.put(v.gamma);
  to.put(v.alpha);
  to.put(v.beta);
}

void getValidity(ArchiveReader& from, DegreeValidity& v) {
  v.tets = from.digest();
  v.embedding = from.digest();
  getBits(from, v.material);
  from.get(v.gamma);
  from.get(v.alpha);
  v.beta = from.digest();
}

/// Sizes that belong together are the same.
bool isSound(const DegreeModel& m) {
  const auto method = static_cast<int>(m.method);
  const Eigen::Index features = m.featureScale.rows(), components = m.basis.rows();
  const auto size = [](const auto& list) { return static_cast<Eigen::Index>(list.size()); };
  return method >= 0 && method <= static_cast<int>(DegreeMethod::Exact) && m.basis.cols() == size(m.mean) &&
         (features == 0 || m.featureScale.cols() == 2) &&
         (m.order.empty() || m.mean.empty() || m.order.size() == m.mean.size()) &&
         allInRange(m.order, 0, m.order.size()) &&
         (m.points.cols() == 0 || m.points.rows() == features + components) &&
         allInRange(m.centres, 0, static_cast<std::size_t>(m.points.cols())) &&
         size(m.coefficient) == size(m.centres) &&
         (m.whitening.size() == 0 ||
          (m.whitening.rows() == size(m.centres) && m.whitening.cols() == size(m.centres)));
}

}  // namespace

void hashValue(Hasher& hasher, const DegreeModel& m) {
  hashValidity(hasher, m.validFor);
  hasher.add(static_cast<int>(m.method));
  hashBits(hasher, m.scale);
  hasher.add(m.mean);
  hashBits(hasher, m.basis);
  hashBits(hasher, m.residualFactor);
  hashBits(hasher, m.featureScale);
  hasher.add(m.order);
  hashBits(hasher, m.points);
  hasher.add(m.centres).add(m.coefficient);
  hashBits(hasher, m.bias);
  hashBits(hasher, m.whitening);
  hashBits(hasher, m.variance);
  hashBits(hasher, m.noise);
  hashBits(hasher, m.reach);
  hashBits(hasher, m.errors);
}

std::size_t byteSize(const DegreeModel& m) {
  const auto numbers = m.basis.size() + m.featureScale.size() + m.points.size() + m.whitening.size();
  return (static_cast<std::size_t>(numbers) + m.mean.size() + m.coefficient.size()) * sizeof(double) +
         (m.centres.size() + m.order.size()) * sizeof(Index);
}

void saveValue(ArchiveWriter& to, const DegreeModel& m) {
  putValidity(to, m.validFor);
  to.put(m.method);
  to.put(m.scale);
  to.array(m.mean);
  putBits(to, m.basis);
  to.put(m.residualFactor);
  putBits(to, m.featureScale);
  to.array(m.order);
  putBits(to, m.points);
  to.array(m.centres);
  to.array(m.coefficient);
  to.put(m.bias);
  putBits(to, m.whitening);
  to.put(m.variance);
  to.put(m.noise);
  to.put(m.reach);
  putBits(to, m.errors);
}

std::optional<DegreeModel> loadValue(ArchiveReader& from, std::type_identity<DegreeModel>) {
  std::optional<DegreeModel> model(std::in_place);
  DegreeModel& m = *model;
  getValidity(from, m.validFor);
  from.get(m.method);
  from.get(m.scale);
  from.array(m.mean);
  getBits(from, m.basis);
  from.get(m.residualFactor);
  getBits(from, m.featureScale);
  from.array(m.order);
  getBits(from, m.points);
  from.array(m.centres);
  from.array(m.coefficient);
  from.get(m.bias);
  getBits(from, m.whitening);
  from.get(m.variance);
  from.get(m.noise);
  from.get(m.reach);
  getBits(from, m.errors);
  if (!from.ok() || !isSound(m)) model.reset();
  return model;
}

std::string differences(const DegreeValidity& valid, const DegreeValidity& other) {
  std::string text;
  const auto say = [&](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
  const auto compare = [&](const char* name, double there, double here, const char* unit) {
    if (there != here) say(fmt::format("{} ({:.6g}{} there, {:.6g}{} here)", name, there, unit, here, unit));
  };
  if (valid.tets != other.tets)
    say("the tetrahedral mesh");
  else if (valid.embedding != other.embedding)
    say("the embedding");
  compare("density", valid.material.density, other.material.density, " kg/m³");
  compare("Young's modulus", valid.material.youngModulus, other.material.youngModulus, " Pa");
  compare("Poisson's ratio", valid.material.poissonRatio, other.material.poissonRatio, "");
  compare("γ", valid.gamma, other.gamma, " J·m²");
  compare("α", valid.alpha, other.alpha, "");
  if (valid.beta != other.beta) say("β");
  return text;
}

}  // namespace sherd
