#include "train_degree/model_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/atomic_file.h"
#include "base/hash.h"
#include "base/partial_file.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "sherd DegreeModel ";

std::string firstLine() { return fmt::format("{}{}\n", kMagic, DegreeModel::archiveVersion); }

Digest digestOfContent(std::string_view content) { return Hasher().add(content).digest(); }

Result<std::string> contentOf(const std::string& file) {
  std::error_code error;
  if (fs::is_directory(file, error)) return failure(file + " is a folder", "name the model in it", "file");
  if (!fs::exists(file, error))
    return failure(file + ": no such file", "check the path, or write it with WriteModel", "file");
  std::ifstream in(file, std::ios::binary);
  std::string content(std::istreambuf_iterator<char>(in), {});
  if (!in) return failure(file + " can't be read", "check the disk and the file's permissions", "file");
  return content;
}

}  // namespace

std::string modelBytes(const DegreeModel& model) {
  ArchiveWriter to;
  saveValue(to, model);
  return firstLine() + to.bytes() + digestOfContent(to.bytes()).hex();
}

Result<DegreeModel> modelFrom(std::string_view bytes) {
  if (!bytes.starts_with(kMagic)) return failure("this is no model of WriteModel", "check the path", "file");
  const char* again = "train it anew, and write it again";
  if (!bytes.starts_with(firstLine()))
    return failure("this model was written by another version of sherd", again, "file");
  bytes.remove_prefix(firstLine().size());
  const std::size_t digestSize = Digest().hex().size();
  if (bytes.size() < digestSize) return failure("this model's file is cut short", again, "file");
  const std::string_view content = bytes.substr(0, bytes.size() - digestSize);
  ArchiveReader from(content, {});
  std::optional<DegreeModel> model = loadValue(from, std::type_identity<DegreeModel>());
  if (digestOfContent(content).hex() != bytes.substr(content.size()) || !model || !from.atEnd())
    return failure("this model's file is damaged", again, "file");
  return std::move(*model);
}

Result<void> writeModel(const DegreeModel& model, const ModelFileParams& params, const Exec& exec) {
  const std::string bytes = modelBytes(model);
  if (exec.cancelled()) return cancelledError();
  const auto write = [&]() -> Result<void> {
    const fs::path directory = fs::path(params.file).parent_path();
    if (!directory.empty()) SHERD_CHECK(makeDirectory(directory.string()));
    const auto written = writeFileAtomically(params.file, bytes);
    if (!written.ok()) return written.error();
    return removeAbandoned(params.file);
  };
  Result<void> written = write();
  if (written.ok()) return written;
  Error error = written.error();
  if (error.kind != Error::Kind::Cancelled) error.port = "file";
  return error;
}

Result<DegreeModel> readModel(const ModelFileParams& params, const Exec& exec) {
  SHERD_ASSIGN(const std::string content, contentOf(params.file));
  if (exec.cancelled()) return cancelledError();
  Result<DegreeModel> model = modelFrom(content);
  if (model.ok()) return model;
  return failure(params.file + ": " + model.error().what, model.error().remedy, "file");
}

}  // namespace sherd
