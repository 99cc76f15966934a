#include <algorithm>
#include <charconv>

#include "graph/graph.h"
#include "graph/suggest.h"

namespace sherd {
namespace {

constexpr std::int64_t kMostFrames = 1000000;
constexpr std::int64_t kLargestFrame = 1000000000;

/// Reads a number off the front of `text`.
std::optional<std::int64_t> takeNumber(std::string_view& text) {
  std::int64_t number = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (problem != std::errc() || number < -kLargestFrame || number > kLargestFrame) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

struct Range {
  std::int64_t first = 0, last = 0, step = 1;
};

std::optional<Range> takeRange(std::string_view text) {
  Range range;
  const auto first = takeNumber(text);
  if (!first) return std::nullopt;
  range.first = range.last = *first;
  if (text.starts_with('-')) {
    text.remove_prefix(1);
    const auto last = takeNumber(text);
    if (!last) return std::nullopt;
    range.last = *last;
    if (text.starts_with('x')) {
      text.remove_prefix(1);
      const auto step = takeNumber(text);
      if (!step || *step < 1) return std::nullopt;
      range.step = *step;
    }
  }
  if (!text.empty() || range.last < range.first) return std::nullopt;
  return range;
}

}  // namespace

Result<FrameList> parseFrames(const std::string& text) {
  FrameList list;
  const auto wrong = [&](std::string what) {
    return Error{std::move(what),
                 "write \"1001-1040\", \"1001-1100x2\" for every second one, or \"1,5,8-10\"",
                 {},
                 Error::Kind::Input};
  };
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    std::string_view part = std::string_view(text).substr(begin, end - begin);
    while (part.starts_with(' ')) part.remove_prefix(1);
    while (part.ends_with(' ')) part.remove_suffix(1);
    const auto range = takeRange(part);
    if (!range) return wrong(inQuotes(text) + " is no range of frames");
    if ((range->last - range->first) / range->step >=
        kMostFrames - static_cast<std::int64_t>(list.frames.size()))
      return wrong(inQuotes(text) + " is more than a million frames");
    for (std::int64_t frame = range->first; frame <= range->last; frame += range->step)
      list.frames.push_back(frame);
    begin = end + 1;
  }
  std::sort(list.frames.begin(), list.frames.end());
  list.frames.erase(std::unique(list.frames.begin(), list.frames.end()), list.frames.end());
  return list;
}

std::string framesText(const std::vector<std::int64_t>& frames) {
  std::string text;
  for (std::size_t i = 0; i < frames.size();) {
    std::size_t end = i + 1;
    const std::int64_t step = end < frames.size() ? frames[end] - frames[i] : 1;
    while (end < frames.size() && frames[end] - frames[end - 1] == step) ++end;
    if (end - i == 2 && step != 1) end = i + 1;  // two frames far apart are no range
    text += (text.empty() ? "" : ",") + std::to_string(frames[i]);
    if (end - i > 1) text += '-' + std::to_string(frames[end - 1]);
    if (end - i > 1 && step != 1) text += 'x' + std::to_string(step);
    i = end;
  }
  return text;
}

}  // namespace sherd
