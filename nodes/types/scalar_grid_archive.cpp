#include <openvdb/io/Archive.h>
#include <openvdb/io/io.h>

#include <sstream>

#include "base/value_type.h"
#include "types/scalar_grid_vdb.h"
#include "types/value_bytes.h"

namespace sherd {

static_assert(ArchivedValue<ScalarGrid>);

namespace {

using openvdb::FloatGrid;
using openvdb::FloatTree;
namespace io = openvdb::io;

/// Never with COMPRESS_ACTIVE_MASK, which takes −0 for 0 in inactive voxels.
std::uint32_t compression() {
  return io::Archive::hasBloscCompression() ? io::COMPRESS_BLOSC : io::COMPRESS_NONE;
}

/// Part by part and not through io::Stream: that one adds metadata, halves floats where the grid asks for it,
/// and stamps each archive with a random number.
std::string bytesOf(const FloatGrid& grid) {
  std::ostringstream out(std::ios::binary);
  io::setDataCompression(out, compression());
  grid.writeMeta(out);
  grid.transform().write(out);
  grid.tree().writeTopology(out, /*saveFloatAsHalf=*/false);
  grid.tree().writeBuffers(out, /*saveFloatAsHalf=*/false);
  return std::move(out).str();
}

FloatGrid::Ptr gridFrom(const std::string& bytes, std::uint32_t compressedAs) {
  initializeOpenVdb();
  std::istringstream in(bytes, std::ios::binary);
  in.exceptions(std::ios::failbit | std::ios::badbit);
  io::setCurrentVersion(in);
  io::setDataCompression(in, compressedAs);
  openvdb::MetaMap metadata;
  metadata.readMeta(in);
  const auto transform = std::make_shared<openvdb::math::Transform>();
  transform->read(in);
  const auto tree = std::make_shared<FloatTree>();
  tree->readTopology(in, /*saveFloatAsHalf=*/false);
  tree->readBuffers(in, /*saveFloatAsHalf=*/false);
  const FloatGrid::Ptr grid = FloatGrid::create(tree);
  grid->setTransform(transform);
  grid->clearMetadata();
  grid->insertMeta(metadata);
  return grid;
}

Digest checksumOf(const std::string& bytes) { return Hasher().add(std::string_view(bytes)).digest(); }

void putGrid(ArchiveWriter& to, const FloatGrid& grid) {
  const std::string bytes = bytesOf(grid);
  to.put(std::uint32_t{openvdb::OPENVDB_LIBRARY_VERSION});
  to.put(compression());
  to.put(checksumOf(bytes));
  to.text(bytes);
}

/// Null where there is no grid of this version of OpenVDB.
FloatGrid::Ptr getGrid(ArchiveReader& from) {
  const auto version = from.get<std::uint32_t>(), compressedAs = from.get<std::uint32_t>();
  const Digest checksum = from.digest();
  const std::string bytes = from.text();
  // OpenVDB trusts the lengths and masks that it reads, so damage has to be found before.
  if (!from.ok() || version != openvdb::OPENVDB_LIBRARY_VERSION || checksumOf(bytes) != checksum)
    return nullptr;
  try {
    return gridFrom(bytes, compressedAs);
  } catch (const std::exception&) {  // a compression or a kind of transform that this build doesn't have
    return nullptr;
  }
}

}  // namespace

void saveValue(ArchiveWriter& to, const ScalarGrid& grid) {
  const ScalarGrid::Impl& impl = grid.impl();
  to.text(impl.name);
  putBits(to, impl.frame);
  to.put(impl.constant);
  to.put(impl.grid != nullptr);
  if (impl.grid != nullptr) putGrid(to, *impl.grid);
}

std::optional<ScalarGrid> loadValue(ArchiveReader& from, std::type_identity<ScalarGrid>) {
  auto impl = std::make_shared<ScalarGrid::Impl>();
  impl->name = from.text();
  getBits(from, impl->frame);
  from.get(impl->constant);
  if (from.get<bool>()) {
    impl->grid = getGrid(from);
    if (impl->grid == nullptr) from.fail();
  }
  if (!from.ok()) return std::nullopt;
  impl->content = contentOf(*impl);
  return ScalarGrid(std::move(impl));
}

}  // namespace sherd
