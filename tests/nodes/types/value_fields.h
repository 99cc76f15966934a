// The fields of every value type, for tests that must reach all of them. A field that is added to a type and
// not here does not compile.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "types/degree_model.h"
#include "types/fields.h"
#include "types/fragments.h"
#include "types/partition.h"
#include "types/proxies.h"
#include "types/rest_shape.h"
#include "types/surface_looks.h"
#include "types/tet_mesh.h"
#include "types/tri_mesh.h"

namespace sherd::fields {

template <class S, class... T>
concept OneOf = (std::same_as<std::remove_const_t<S>, T> || ...);

/// All fields of a value, by their number.
auto of(OneOf<FileFrame, TriMesh::UvSet, TriMesh::ColorSet, ImageFile, MtlStatement, SurfaceLooks, Digest,
              RestShape, Proxies> auto& v) {
  auto& [a, b] = v;
  return std::tie(a, b);
}
auto of(OneOf<SolidSums, Material, ConvexHull> auto& v) {
  auto& [a, b, c] = v;
  return std::tie(a, b, c);
}
auto of(OneOf<Contact, RigidMotion, Embedding> auto& v) {
  auto& [a, b, c, d] = v;
  return std::tie(a, b, c, d);
}
auto of(OneOf<Texture, TetQuality, EnergyField, DegreeErrors, Sites> auto& v) {
  auto& [a, b, c, d, e] = v;
  return std::tie(a, b, c, d, e);
}
auto of(OneOf<Impact, WeightField, DegreeValidity> auto& v) {
  auto& [a, b, c, d, e, f] = v;
  return std::tie(a, b, c, d, e, f);
}
auto of(OneOf<FractureCounts> auto& v) {
  auto& [a, b, c, d, e, f, g] = v;
  return std::tie(a, b, c, d, e, f, g);
}
auto of(OneOf<Partition, PieceProxy> auto& v) {
  auto& [a, b, c, d, e, f, g, h, i] = v;
  return std::tie(a, b, c, d, e, f, g, h, i);
}
auto of(OneOf<Fragments> auto& v) {
  auto& [a, b, c, d, e, f, g, h, i, j] = v;
  return std::tie(a, b, c, d, e, f, g, h, i, j);
}
auto of(OneOf<TriMesh, Piece> auto& v) {
  auto& [a, b, c, d, e, f, g, h, i, j, k] = v;
  return std::tie(a, b, c, d, e, f, g, h, i, j, k);
}
auto of(OneOf<TetMesh> auto& v) {
  auto& [a, b, c, d, e, f, g, h, i, j, k, l] = v;
  return std::tie(a, b, c, d, e, f, g, h, i, j, k, l);
}
auto of(OneOf<Look> auto& v) {
  auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = v;
  return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m);
}
auto of(OneOf<DegreeModel> auto& v) {
  auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q] = v;
  return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q);
}
auto of(OneOf<TrianglePatches> auto& v) {
  auto& [a, b, patchOf, d, e, f, g, h] = v;
  return std::tie(a, b, d, e, f, g, h);  // patchOf says what a and b say
}

template <class T>
concept Described = requires(T& value) {
  of(value);
};

template <class T>
bool sameBits(const T& a, const T& b);

inline bool sameBits(const std::string& a, const std::string& b) { return a == b; }
inline bool sameBits(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         (a.size() == 0 ||
          std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0);
}

template <class T>
bool sameBits(const std::shared_ptr<const T>& a, const std::shared_ptr<const T>& b) {
  return a == nullptr || b == nullptr ? a == b : sameBits(*a, *b);
}
template <class T>
bool sameBits(const std::optional<T>& a, const std::optional<T>& b) {
  return a && b ? sameBits(*a, *b) : a.has_value() == b.has_value();
}
template <class T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!sameBits(a[i], b[i])) return false;
  return true;
}
/// Whether all fields, those of parts too, are equal by their bits.
template <class T>
bool sameBits(const T& a, const T& b) {
  if constexpr (Described<const T>) {
    return [&]<class... F>(const std::tuple<F&...>& x, const std::tuple<F&...>& y) {
      return [&]<std::size_t... I>(std::index_sequence<I...>) {
        return (sameBits(std::get<I>(x), std::get<I>(y)) && ...);
      }
      (std::index_sequence_for<F...>());
    }(of(a), of(b));
  } else {
    static_assert(std::is_trivially_destructible_v<T>);
    return std::memcmp(&a, &b, sizeof a) == 0;
  }
}

/// Calls `check` with one bit or one entry changed, for everything in `value` that can be; of long arrays the
/// first and the last entry. Parts are changed in copies.
template <class Check>
void changeEach(double& number, const Check& check) {
  const double kept = number;
  number = -number;
  check();
  number = std::bit_cast<double>(std::bit_cast<std::uint64_t>(kept) ^ 1);
  check();
  number = kept;
}
template <class T, class Check>
requires(std::is_integral_v<T> || std::is_enum_v<T>) void changeEach(T& number, const Check& check) {
  const T kept = number;
  number = static_cast<T>(static_cast<std::int64_t>(number) ^ 1);
  check();
  number = kept;
}
template <class Check>
void changeEach(std::string& text, const Check& check) {
  text.push_back('x');
  check();
  text.pop_back();
}
template <class Check>
void changeEach(Eigen::MatrixXd& m, const Check& check) {
  if (m.size() > 0) changeEach(m(m.rows() - 1, m.cols() - 1), check);
  if (m.rows() == m.cols()) return;
  const Eigen::MatrixXd kept = m;
  m = Eigen::Map<const Eigen::MatrixXd>(kept.data(), kept.cols(), kept.rows());
  check();
  m = kept;
}
template <class Scalar, int Rows, int Columns, class Check>
requires(Rows > 0 && Columns > 0) void changeEach(Eigen::Matrix<Scalar, Rows, Columns>& m,
                                                  const Check& check) {
  for (Scalar& entry : m.reshaped()) changeEach(entry, check);
}
template <class Check>
void changeEach(Eigen::Quaterniond& q, const Check& check) {
  changeEach(q.coeffs(), check);
}
template <class T, std::size_t N, class Check>
void changeEach(std::array<T, N>& tuple, const Check& check) {
  for (T& entry : tuple) changeEach(entry, check);
}
template <class T, class Check>
void changeEach(std::vector<T>& list, const Check& check);
template <class T, class Check>
void changeEach(std::shared_ptr<const T>& part, const Check& check);
template <class T, class Check>
void changeEach(std::optional<T>& maybe, const Check& check);

template <Described T, class Check>
void changeEach(T& value, const Check& check) {
  std::apply([&](auto&... field) { (changeEach(field, check), ...); }, of(value));
}
template <class T, class Check>
void changeEach(std::vector<T>& list, const Check& check) {
  if (!list.empty()) changeEach(list.back(), check);
  if (list.size() > 1) changeEach(list.front(), check);
  list.emplace_back();
  check();
  list.pop_back();
}
template <class T, class Check>
void changeEach(std::shared_ptr<const T>& part, const Check& check) {
  const auto kept = part;
  if (kept != nullptr) {
    T copy = *kept;
    changeEach(copy, [&] {
      part = std::make_shared<const T>(copy);
      check();
    });
  }
  part = kept == nullptr ? std::make_shared<const T>() : nullptr;
  check();
  part = kept;
}
template <class T, class Check>
void changeEach(std::optional<T>& maybe, const Check& check) {
  const std::optional<T> kept = maybe;
  if (maybe) changeEach(*maybe, check);
  maybe = kept ? std::nullopt : std::optional<T>(std::in_place);
  check();
  maybe = kept;
}

}  // namespace sherd::fields
