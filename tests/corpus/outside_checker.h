// The checker of exported pieces that stands outside of the project, ../shared/check/fragments.cpp, where it
// is there.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "types/fragments.h"

namespace sherd::test {

class OutsideChecker {
 public:
  /// Builds it into `scratch`; `why()` says why it can't be used otherwise.
  explicit OutsideChecker(std::filesystem::path scratch);
  const std::string& why() const { return why_; }

  struct Verdict {
    bool good = false;
    std::string text;  ///< the checker's own line, or what kept it from speaking
  };
  /// Exports the pieces as OBJ and has them checked against the surface that they were cut from.
  Verdict check(const Fragments& fragments) const;

 private:
  std::filesystem::path scratch_;
  std::string why_;
};

}  // namespace sherd::test
