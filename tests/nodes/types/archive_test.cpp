// Every value type but ScalarGrid: saved, loaded, hashed and damaged.
#include <gtest/gtest.h>

#include "base/rng.h"
#include "nodes/types/made_values.h"
#include "nodes/types/memory_store.h"
#include "nodes/types/value_fields.h"

namespace sherd {
namespace {

template <class T>
T full();
template <>
TriMesh full() {
  return made::triMesh();
}
template <>
SurfaceLooks full() {
  return made::surfaceLooks();
}
template <>
TetMesh full() {
  return made::tetMesh();
}
template <>
Impact full() {
  return made::impact();
}
template <>
EnergyField full() {
  return made::energyField();
}
template <>
WeightField full() {
  return made::weightField();
}
template <>
DegreeModel full() {
  return made::degreeModel();
}
template <>
Embedding full() {
  return made::embedding();
}
template <>
RestShape full() {
  return made::restShape();
}
template <>
Sites full() {
  return made::sites();
}
template <>
Partition full() {
  return made::partition();
}
template <>
Fragments full() {
  return made::fragments();
}

template <>
Proxies full() {
  return made::proxies();
}

template <class T>
class Archive : public testing::Test {
 protected:
  static void expectRoundTrip(const T& value) {
    MemoryStore store;
    const auto given = std::make_shared<const T>(value);
    const Digest digest = store.keep(given);
    const auto loaded = store.load<T>(digest);
    ASSERT_NE(loaded, nullptr);
    EXPECT_NE(loaded, given);
    EXPECT_TRUE(fields::sameBits(*loaded, *given));
    EXPECT_EQ(valueType<T>().digest(loaded.get()), digest);
    EXPECT_EQ(valueType<T>().bytes(loaded.get()), valueType<T>().bytes(given.get()));
  }
};

using Types = testing::Types<TriMesh, SurfaceLooks, TetMesh, Impact, EnergyField, WeightField, DegreeModel,
                             Embedding, RestShape, Sites, Partition, Fragments, Proxies>;
TYPED_TEST_SUITE(Archive, Types);

TYPED_TEST(Archive, AnEmptyValueComesBack) { this->expectRoundTrip(TypeParam()); }

TYPED_TEST(Archive, AFullValueComesBackBitForBit) { this->expectRoundTrip(full<TypeParam>()); }

TYPED_TEST(Archive, EveryFieldIsInTheDigestAndInTheBytes) {
  const ValueType& type = valueType<TypeParam>();
  TypeParam value = full<TypeParam>();
  const auto written = [&] {
    ArchiveWriter to;
    type.save(to, &value);
    return to.bytes();
  };
  const Digest digest = type.digest(&value);
  const std::string bytes = written();
  std::size_t changes = 0, unhashed = 0, unwritten = 0;
  fields::changeEach(value, [&] {
    ++changes;
    unhashed += type.digest(&value) == digest;
    unwritten += written() == bytes;
  });
  EXPECT_GT(changes, 5u);
  EXPECT_EQ(unhashed, 0u) << "of " << changes;
  EXPECT_EQ(unwritten, 0u) << "of " << changes;
  EXPECT_EQ(type.digest(&value), digest);
}

TYPED_TEST(Archive, TruncatedAndTooLongBytesAreRefused) {
  MemoryStore store;
  const ValueType& type = valueType<TypeParam>();
  const Digest digest = store.keep(std::make_shared<const TypeParam>(full<TypeParam>()));
  const std::string whole = store.bytes(type, digest);
  const auto parts = [&](const ValueType& t, const Digest& d) { return store.load(t, d); };
  for (std::size_t size = 0; size < whole.size(); ++size) {
    // A copy of this very size, so that the address sanitizer sees a read past its end.
    const std::vector<char> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    ArchiveReader from(std::string_view(cut.data(), cut.size()), parts);
    ASSERT_EQ(type.load(from), nullptr) << size << " of " << whole.size();
  }
  const std::string extended = whole + '\0';
  ArchiveReader longer(extended, parts);
  EXPECT_EQ(type.load(longer), nullptr);
}

TYPED_TEST(Archive, DamagedBytesMakeNoValueOrASoundOne) {
  MemoryStore store;
  const ValueType& type = valueType<TypeParam>();
  const Digest digest = store.keep(std::make_shared<const TypeParam>(full<TypeParam>()));
  const std::string whole = store.bytes(type, digest);
  const auto parts = [&](const ValueType& t, const Digest& d) { return store.load(t, d); };
  const Rng rng(11);
  std::size_t refused = 0;
  for (std::uint64_t round = 0; round < 3000; ++round) {
    std::string damaged = whole;
    for (std::uint64_t k = 0; k < 1 + round % 4; ++k) {
      const double where = rng.uniformAt(8 * round + 2 * k), what = rng.uniformAt(8 * round + 2 * k + 1);
      auto& byte = damaged[static_cast<std::size_t>(where * static_cast<double>(whole.size()))];
      byte = static_cast<char>(byte ^ static_cast<char>(1 + static_cast<int>(what * 255)));
    }
    ArchiveReader from(damaged, parts);
    const auto value = type.load(from);
    refused += value == nullptr;
    if (value == nullptr) continue;
    // What was let through has to be as good as any other: hashed, sized and saved, which reads all of it.
    ArchiveWriter to;
    type.save(to, value.get());
    EXPECT_EQ(to.bytes(), damaged);
    EXPECT_LE(type.bytes(value.get()), 4 * whole.size() + 100000);
  }
  EXPECT_GT(refused, 0u);
  EXPECT_LT(refused, 3000u);
}

TYPED_TEST(Archive, AMissingPartIsAMiss) {
  MemoryStore store;
  const ValueType& type = valueType<TypeParam>();
  const Digest digest = store.keep(std::make_shared<const TypeParam>(full<TypeParam>()));
  if (store.entries() == 1) return;  // a type without parts
  ArchiveReader none(store.bytes(type, digest), [](const ValueType&, const Digest&) { return nullptr; });
  EXPECT_EQ(type.load(none), nullptr);
  ArchiveReader nowhere(store.bytes(type, digest), nullptr);
  EXPECT_EQ(type.load(nowhere), nullptr);
}

TEST(ArchiveParts, AreOnDiskOnceAndSharedAgain) {
  const auto tets = made::sharedTets();
  EnergyField energy = made::energyField();
  Embedding embedding = made::embedding();
  Fragments fragments = made::fragments();
  energy.tets = embedding.tets = fragments.tets = tets;
  MemoryStore store;
  const Digest e = store.keep(std::make_shared<const EnergyField>(energy));
  const Digest m = store.keep(std::make_shared<const Embedding>(embedding));
  const Digest f = store.keep(std::make_shared<const Fragments>(fragments));
  EXPECT_EQ(store.entries(), 6u);  // these three, the tetrahedra, the surface and its looks
  const auto loaded = store.load<EnergyField>(e);
  ASSERT_NE(loaded, nullptr);
  EXPECT_EQ(loaded->tets, store.load<Embedding>(m)->tets);
  EXPECT_EQ(loaded->tets, store.load<Fragments>(f)->tets);
}

/// What a loader says to a value that the writer took as it was.
template <class T, class Spoil>
bool accepted(const Spoil& spoil) {
  T value = full<T>();
  spoil(value);
  MemoryStore store;
  return store.load<T>(store.keep(std::make_shared<const T>(value))) != nullptr;
}

TEST(ArchiveChecks, SurfaceLooks) {
  const auto first = [](SurfaceLooks& looks) -> Look& { return *looks.looks[0]; };
  EXPECT_TRUE(accepted<SurfaceLooks>([](SurfaceLooks&) {}));
  EXPECT_FALSE(accepted<SurfaceLooks>([&](SurfaceLooks& l) { first(l).normalTexture.image = 2; }));
  EXPECT_FALSE(accepted<SurfaceLooks>([&](SurfaceLooks& l) { first(l).colourTexture.image = -2; }));
  EXPECT_FALSE(accepted<SurfaceLooks>([&](SurfaceLooks& l) { first(l).colourTexture.uvSet = -1; }));
  EXPECT_FALSE(accepted<SurfaceLooks>([&](SurfaceLooks& l) { first(l).mtl[1].image = 2; }));
  EXPECT_FALSE(
      accepted<SurfaceLooks>([&](SurfaceLooks& l) { first(l).alpha = static_cast<Look::Alpha>(3); }));
  EXPECT_FALSE(accepted<SurfaceLooks>(
      [&](SurfaceLooks& l) { first(l).occlusionTexture.wrapV = static_cast<Texture::Wrap>(3); }));
}

TEST(ArchiveChecks, TriMesh) {
  EXPECT_TRUE(accepted<TriMesh>([](TriMesh&) {}));
  EXPECT_TRUE(accepted<TriMesh>([](TriMesh& m) { m.normals.clear(); }));
  EXPECT_FALSE(accepted<TriMesh>([](TriMesh& m) { m.triangles[3][1] = 8; }));
  EXPECT_FALSE(accepted<TriMesh>([](TriMesh& m) { m.triangles[3][1] = -1; }));
  EXPECT_FALSE(accepted<TriMesh>([](TriMesh& m) { m.normals.pop_back(); }));
  EXPECT_FALSE(accepted<TriMesh>([](TriMesh& m) { m.uvSets[1].uv.pop_back(); }));
  EXPECT_FALSE(accepted<TriMesh>([](TriMesh& m) { m.colorSets[0].rgba.clear(); }));
  EXPECT_FALSE(accepted<TriMesh>([](TriMesh& m) { m.materialOf.pop_back(); }));
  EXPECT_FALSE(accepted<TriMesh>([](TriMesh& m) { m.materialOf[0] = 3; }));
  EXPECT_FALSE(accepted<TriMesh>([](TriMesh& m) { m.frame.up = static_cast<FileFrame::Up>(2); }));
}

TEST(ArchiveChecks, TetMesh) {
  EXPECT_FALSE(accepted<TetMesh>([](TetMesh& m) { m.tets[0][3] = 8; }));
  EXPECT_FALSE(accepted<TetMesh>([](TetMesh& m) { m.neighbours[0][3] = 6; }));
  EXPECT_FALSE(accepted<TetMesh>([](TetMesh& m) { m.neighbours[0][3] = -2; }));
  EXPECT_FALSE(accepted<TetMesh>([](TetMesh& m) { m.neighbours.pop_back(); }));
  EXPECT_FALSE(accepted<TetMesh>([](TetMesh& m) { m.boundary[0][0] = 8; }));
  EXPECT_FALSE(accepted<TetMesh>([](TetMesh& m) { m.held[0] = 12; }));
  EXPECT_FALSE(accepted<TetMesh>([](TetMesh& m) { m.heldBegin.back() -= 1; }));
  EXPECT_FALSE(accepted<TetMesh>([](TetMesh& m) { m.heldBegin[1] = m.heldBegin[2] + 1; }));
  EXPECT_FALSE(accepted<TetMesh>([](TetMesh& m) { m.heldBegin[0] = -1; }));
  EXPECT_FALSE(accepted<TetMesh>([](TetMesh& m) { m.heldBegin.clear(); }));
  EXPECT_FALSE(accepted<TetMesh>([](TetMesh& m) { m.insideFraction.pop_back(); }));
  EXPECT_FALSE(accepted<TetMesh>([](TetMesh& m) { m.surface = nullptr; }));
}

TEST(ArchiveChecks, Fields) {
  EXPECT_FALSE(accepted<EnergyField>([](EnergyField& f) { f.tets = nullptr; }));
  EXPECT_FALSE(accepted<EnergyField>([](EnergyField& f) { f.tetEnergy.pop_back(); }));
  EXPECT_FALSE(accepted<EnergyField>([](EnergyField& f) { f.nodeEnergy.pop_back(); }));
  EXPECT_FALSE(accepted<EnergyField>([](EnergyField& f) { f.displacement.pop_back(); }));
  EXPECT_TRUE(accepted<EnergyField>([](EnergyField& f) { f.displacement.clear(); }));
  EXPECT_FALSE(accepted<WeightField>([](WeightField& f) { f.weight.pop_back(); }));
  EXPECT_FALSE(accepted<WeightField>([](WeightField& f) { f.volume.pop_back(); }));
}

TEST(ArchiveChecks, DegreeModel) {
  EXPECT_FALSE(accepted<DegreeModel>([](DegreeModel& m) { m.method = static_cast<DegreeMethod>(3); }));
  EXPECT_FALSE(accepted<DegreeModel>([](DegreeModel& m) { m.mean.pop_back(); }));
  EXPECT_FALSE(accepted<DegreeModel>([](DegreeModel& m) { m.featureScale.resize(3, 1); }));
  EXPECT_FALSE(accepted<DegreeModel>([](DegreeModel& m) { m.points.resize(4, 7); }));
  EXPECT_FALSE(accepted<DegreeModel>([](DegreeModel& m) { m.centres[0] = 7; }));
  EXPECT_FALSE(accepted<DegreeModel>([](DegreeModel& m) { m.centres[0] = -1; }));
  EXPECT_FALSE(accepted<DegreeModel>([](DegreeModel& m) { m.coefficient.pop_back(); }));
  EXPECT_FALSE(accepted<DegreeModel>([](DegreeModel& m) { m.order.pop_back(); }));
  EXPECT_FALSE(accepted<DegreeModel>([](DegreeModel& m) { m.order[1] = 4; }));
  EXPECT_FALSE(accepted<DegreeModel>([](DegreeModel& m) { m.whitening.resize(2, 1); }));
}

TEST(ArchiveChecks, EmbeddingSitesAndPartition) {
  using Metric = Embedding::Metric;
  EXPECT_FALSE(accepted<Embedding>([](Embedding& e) { e.metric = static_cast<Metric>(2); }));
  EXPECT_FALSE(accepted<Embedding>([](Embedding& e) { e.coordinates.resize(5, 3); }));
  EXPECT_FALSE(accepted<Embedding>([](Embedding& e) { e.coordinates.resize(0, e.coordinates.cols()); }));
  EXPECT_FALSE(accepted<Embedding>([](Embedding& e) { e.tets = nullptr; }));
  EXPECT_TRUE(accepted<Sites>([](Sites& s) { s.positions.resize(5, s.pinned = 0); }));
  EXPECT_FALSE(accepted<Sites>([](Sites& s) { s.positions.resize(5, 1); }));
  EXPECT_TRUE(accepted<Sites>([](Sites& s) { s.pinned = 3; }));
  EXPECT_FALSE(accepted<Sites>([](Sites& s) { s.pinned = 4; }));
  EXPECT_FALSE(accepted<Sites>([](Sites& s) { s.pinned = -1; }));
  EXPECT_FALSE(accepted<Sites>([](Sites& s) { s.positions.resize(0, 5); }));
  EXPECT_FALSE(accepted<Partition>([](Partition& p) { p.label.pop_back(); }));
  EXPECT_FALSE(accepted<Partition>([](Partition& p) { p.label[0] = 3; }));
  EXPECT_FALSE(accepted<Partition>([](Partition& p) { p.label[0] = -1; }));
  EXPECT_FALSE(accepted<Partition>([](Partition& p) { p.sites.resize(4, 3); }));
  EXPECT_FALSE(accepted<Partition>([](Partition& p) { p.embedding = nullptr; }));
}

TEST(ArchiveChecks, Fragments) {
  EXPECT_FALSE(accepted<Fragments>([](Fragments& f) { f.pieces[0].surface[0][0] = 4; }));
  EXPECT_FALSE(accepted<Fragments>([](Fragments& f) { f.pieces[0].crack[0][0] = -1; }));
  EXPECT_FALSE(accepted<Fragments>([](Fragments& f) { f.pieces[1].surfaceSource[0] = 12; }));
  EXPECT_FALSE(accepted<Fragments>([](Fragments& f) { f.pieces[1].surfaceSource.pop_back(); }));
  EXPECT_FALSE(accepted<Fragments>([](Fragments& f) { f.pieces[1].surfaceCut[0] = 1; }));
  EXPECT_FALSE(accepted<Fragments>([](Fragments& f) { f.pieces[1].surfaceCut.pop_back(); }));
  EXPECT_FALSE(accepted<Fragments>([](Fragments& f) { f.pieces[1].crackNeighbour[0] = 2; }));
  EXPECT_FALSE(accepted<Fragments>([](Fragments& f) { f.pieces[1].crackNeighbour.clear(); }));
  EXPECT_FALSE(accepted<Fragments>([](Fragments& f) { f.pieces[1].crackSheet[0] = -1; }));
  EXPECT_FALSE(accepted<Fragments>([](Fragments& f) { f.pieces[1].crackSheet.clear(); }));
  EXPECT_FALSE(accepted<Fragments>([](Fragments& f) { f.tets = nullptr; }));
}

TEST(ArchiveChecks, Proxies) {
  EXPECT_FALSE(accepted<Proxies>([](Proxies& p) { p.pieces[0].hulls[0].triangles[0][2] = 3; }));
  EXPECT_FALSE(accepted<Proxies>([](Proxies& p) { p.pieces[1].hulls[0].triangles[1][0] = -1; }));
  EXPECT_FALSE(accepted<Proxies>([](Proxies& p) { p.frame.up = static_cast<FileFrame::Up>(2); }));
}

}  // namespace
}  // namespace sherd
