// Merging and checking the segments of a RecordLog.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <tuple>

#include "base/partial_file.h"
#include "eval/record_log.h"
#include "eval/worth.h"

namespace sherd::store {
namespace {

/// A segment that may be merged: nobody appends to it.
struct Input {
  std::string path;
  Descriptor file;  ///< of a young one, locked
  std::unique_ptr<Mapping> young;
  std::unique_ptr<MergedSegment> merged;

  std::string_view bytes() const { return young ? young->bytes() : merged->bytes(); }
  std::size_t begin() const { return young ? kYoungHead : merged->framesBegin(); }
};

struct Inputs {
  std::vector<Input> young, merged;
  std::uint64_t freed = 0;  ///< of files that aren't segments
};

std::uint64_t bytesOf(const std::vector<Input>& inputs) {
  std::uint64_t bytes = 0;
  for (const Input& input : inputs) bytes += input.bytes().size();
  return bytes;
}

std::uint64_t removeFile(const std::string& path) {
  const std::uint64_t bytes = fileBytes(path);
  return ::unlink(path.c_str()) == 0 ? bytes : 0;
}

Inputs freeSegments(const std::string& folder) {
  Inputs inputs;
  for (const std::string& name : namesIn(folder)) {
    const std::string path = folder + '/' + name;
    if (name.starts_with("s-")) {
      Input input{path, openToRead(path), nullptr, nullptr};
      if (!lockIfFree(input.file)) continue;
      input.young = std::make_unique<Mapping>(input.file);
      if (isYoung(input.bytes()))
        inputs.young.push_back(std::move(input));
      else
        inputs.freed += removeFile(path);
    } else if (name.starts_with("m-")) {
      if (auto merged = MergedSegment::open(path))
        inputs.merged.push_back({path, Descriptor(), nullptr, std::move(merged)});
      else
        inputs.freed += removeFile(path);
    }
  }
  return inputs;
}

struct Candidate {
  std::uint64_t bits;
  std::int64_t time, used;
  Frame frame;
  double worth = 0;
};

/// Bytes of a merged segment for this frame, with its share of the indices.
std::uint64_t bytesOf(Frame frame) {
  constexpr std::uint64_t kMostOfIndices = 64;
  return sizeOf(frame) + kMostOfIndices;
}

/// Drops the frames of the least worth where all together have more than mostBytes. Not just to the bound:
/// the next run would have to merge everything again.
void dropLeastWorth(std::vector<Candidate>& frames, std::uint64_t mostBytes) {
  std::uint64_t bytes = 0;
  for (const Candidate& candidate : frames) bytes += bytesOf(candidate.frame);
  if (bytes <= mostBytes) return;
  const std::int64_t now = RecordLog::now();
  for (Candidate& candidate : frames)
    candidate.worth = worth(costOf(candidate.frame), sizeOf(candidate.frame),
                            1e-9 * static_cast<double>(std::max<std::int64_t>(0, now - candidate.used)));
  std::stable_sort(frames.begin(), frames.end(),
                   [](const Candidate& a, const Candidate& b) { return a.worth < b.worth; });
  std::size_t dropped = 0;
  while (bytes > mostBytes - mostBytes / 8) bytes -= bytesOf(frames[dropped++].frame);
  frames.erase(frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(dropped));
}

/// The newest frame of each key, as far as they fit into mostBytes.
std::vector<Frame> newestFrames(const std::vector<Input>& inputs, std::uint64_t mostBytes) {
  std::vector<Candidate> all;
  for (const Input& input : inputs)
    eachFrame(input.bytes(), input.begin(), [&](Frame frame) {
      all.push_back({mixed(keyOf(frame)), timeOf(frame), usedOf(frame), frame});
    });
  const auto older = [](const Candidate& a, const Candidate& b) {
    return std::tie(a.bits, a.time, a.used) < std::tie(b.bits, b.time, b.used);
  };
  std::stable_sort(all.begin(), all.end(), older);
  std::vector<Candidate> newest;
  for (const Candidate& candidate : all) {
    if (!newest.empty() && newest.back().bits == candidate.bits &&
        keyOf(newest.back().frame) == keyOf(candidate.frame))
      newest.pop_back();
    newest.push_back(candidate);
  }
  dropLeastWorth(newest, mostBytes);
  std::vector<Frame> frames;
  frames.reserve(newest.size());
  for (const Candidate& candidate : newest) frames.push_back(candidate.frame);
  return frames;
}

/// Takes along the merged segments that aren't much larger than what is merged anyway, so that each record is
/// copied a logarithmic number of times and a logarithmic number of segments remains.
std::vector<Input> chosen(Inputs&& inputs, bool all) {
  std::vector<Input> chosen = std::move(inputs.young);
  std::sort(inputs.merged.begin(), inputs.merged.end(),
            [](const Input& a, const Input& b) { return a.bytes().size() < b.bytes().size(); });
  std::uint64_t bytes = bytesOf(chosen);
  for (Input& merged : inputs.merged) {
    if (!all && merged.bytes().size() > 4 * bytes) break;
    bytes += merged.bytes().size();
    chosen.push_back(std::move(merged));
  }
  return chosen;
}

}  // namespace

std::uint64_t RecordLog::merge(std::uint64_t mostBytes, bool all) {
  const std::lock_guard lock(merging_);
  const std::string folder = directory_.at("records");
  const Descriptor self(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!directory_.writable() || !lockIfFree(self)) return 0;
  Inputs inputs = freeSegments(folder);
  std::uint64_t freed = inputs.freed;
  if (!all && inputs.young.size() <= kMostSegments && bytesOf(inputs.young) <= kMostYoungBytes) return freed;
  const std::vector<Input> from = chosen(std::move(inputs), all);
  if (from.empty()) return freed;
  const std::vector<Frame> frames = newestFrames(from, mostBytes);
  const OwnFile to = directory_.create("tmp", "");
  int error = to.error;
  if (error == 0) error = writeMerged(to.descriptor.number(), frames);
  if (error != 0) {
    if (to.descriptor.isOpen()) ::unlink(to.path.c_str());
    directory_.writeFailed(error);
    return freed;
  }
  const std::string name = "records/m-" + randomName();
  if (!directory_.moveInto(to, name)) return freed;
  for (const Input& input : from) freed += removeFile(input.path);
  const std::uint64_t written = fileBytes(directory_.at(name));
  return freed > written ? freed - written : 0;
}

std::vector<std::string> RecordLog::verify() const {
  std::vector<std::string> lines;
  const std::string folder = directory_.at("records");
  for (const std::string& name : namesIn(folder)) {
    const std::string path = folder + '/' + name;
    const Descriptor file = openToRead(path);
    const Mapping mapping(file);
    const auto merged = name.starts_with("m-") ? MergedSegment::open(path) : nullptr;
    if (merged == nullptr && !isYoung(mapping.bytes())) {
      if (!mapping.bytes().empty()) lines.push_back("records/" + name + ": not a segment of this format");
      continue;
    }
    const std::string_view bytes = merged ? merged->bytes() : mapping.bytes();
    const std::size_t begin = merged ? merged->framesBegin() : kYoungHead;
    bool lost = false;
    const FrameScan scan = eachFrame(bytes, begin, [&](Frame frame) {
      if (merged != nullptr && merged->find(keyOf(frame)) != frame) lost = true;
    });
    // The end of one in use may be half written at this moment.
    const bool complete = merged != nullptr || lockIfFree(file);
    const std::size_t damaged = scan.damaged + (complete ? bytes.size() - scan.end : 0);
    if (damaged > 0)
      lines.push_back("records/" + name + ": " + std::to_string(damaged) + " bytes are damaged");
    else if (lost)
      lines.push_back("records/" + name + ": its index is damaged");
  }
  return lines;
}

}  // namespace sherd::store
