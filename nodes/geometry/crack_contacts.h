// The crack faces of a fracture, twin by twin.
#pragma once

#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "types/fragments.h"

namespace sherd {

/// The two triangles, with the same three vertices, in which two pieces touch.
struct CrackTwin {
  Index low, high;  ///< crack triangles of the contact's two pieces
};

/// All of one sheet between two pieces.
struct CrackContact {
  Index low, high;  ///< pieces, low < high
  Index sheet;
  std::vector<CrackTwin> twins;  ///< by the order of the lower piece's triangles
};

/// By (low, high, sheet). Fails where a crack triangle has no twin, and when cancelled. Parallel over pieces.
/// Cost O(n log n).
Result<std::vector<CrackContact>> crackContacts(const Fragments& fragments, const Exec& exec);

}  // namespace sherd
