// Keeps values between runs of a slow test or benchmark, in a directory that may be removed at any time.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>

#include "base/value_type.h"

namespace sherd::test {

/// Whoever uses it puts everything that a value depends on into its name: nothing else tells an old value
/// from a new one.
class FileStore {
 public:
  explicit FileStore(std::filesystem::path directory) : directory_(std::move(directory)) {
    std::filesystem::create_directories(directory_);
  }

  template <class T>
  void keep(const std::string& name, const std::shared_ptr<const T>& value) {
    const Digest digest = put(valueType<T>(), value);
    write(directory_ / (name + ".name"), digest.hex());
  }

  /// Null where there is none, or where it can't be read.
  template <class T>
  std::shared_ptr<const T> find(const std::string& name) const {
    const std::string hex = read(directory_ / (name + ".name"));
    return hex.empty() ? nullptr : std::static_pointer_cast<const T>(get(valueType<T>(), hex));
  }

 private:
  std::filesystem::path fileOf(const ValueType& type, const std::string& hex) const {
    return directory_ / (type.name + "-" + hex);
  }

  static std::string read(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  }

  static void write(const std::filesystem::path& path, const std::string& bytes) {
    const std::filesystem::path half = path.string() + ".half";
    std::ofstream(half, std::ios::binary) << bytes;
    std::filesystem::rename(half, path);
  }

  Digest put(const ValueType& type, const std::shared_ptr<const void>& value) {
    const Digest digest = type.digest(value.get());
    if (std::filesystem::exists(fileOf(type, digest.hex()))) return digest;
    ArchiveWriter to;
    type.save(to, value.get());
    for (const ArchivePart& part : to.parts()) put(*part.type, part.data);
    write(fileOf(type, digest.hex()), to.bytes());
    return digest;
  }

  std::shared_ptr<const void> get(const ValueType& type, const std::string& hex) const {
    const std::string bytes = read(fileOf(type, hex));
    ArchiveReader from(bytes, [this](const ValueType& t, const Digest& d) { return get(t, d.hex()); });
    return bytes.empty() ? nullptr : type.load(from);
  }

  std::filesystem::path directory_;
};

}  // namespace sherd::test
