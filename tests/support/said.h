// Collects what a step says, so that tests can look at it.
#pragma once

#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/exec.h"

namespace sherd {

struct Said {
  std::vector<std::pair<LogLevel, std::string>> lines;
  Exec exec;
  std::mutex mutex;

  Said() {
    exec.onMessage = [this](LogLevel level, const std::string& line) {
      const std::lock_guard lock(mutex);
      lines.emplace_back(level, line);
    };
  }
  bool has(LogLevel level, const std::string& part) const {
    for (const auto& [l, line] : lines)
      if (l == level && line.find(part) != std::string::npos) return true;
    return false;
  }
  bool info(const std::string& part) const { return has(LogLevel::Info, part); }
  bool warning(const std::string& part) const { return has(LogLevel::Warning, part); }
};

}  // namespace sherd
