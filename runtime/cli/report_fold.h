// What of a large run a page shows: more than somebody can look at makes a page that no browser opens.
#pragma once

#include <cstdint>

#include "cli/report_groups.h"

namespace sherd {

/// What the boxes, rows and details of a page may come to. Pictures have a bound of their own.
constexpr std::uint64_t kMostNodeBytes = 9'000'000;

/// Leaves out of `grouped` what doesn't fit into about `mostBytes` of page: nodes, and frames and wedges of
/// nodes. What matters most stays: the worst state first, of that the slowest; of every node that stays, at
/// least one run. Counts, times and sizes remain those of all. Changes nothing where everything fits. O(nodes
/// log).
void foldReport(const ReportData& data, ReportGroups& grouped, std::uint64_t mostBytes = kMostNodeBytes);

}  // namespace sherd
