// The graph as inline SVG.
#pragma once

#include <string>

#include "cli/report_groups.h"

namespace sherd {

/// One <svg> element with a box per group and a curve per wire; graphs stand below each other under their
/// names where there are several. Boxes carry data-group, their number, for the page's script.
std::string drawGraphs(const ReportData& data, const ReportGroups& grouped);

}  // namespace sherd
