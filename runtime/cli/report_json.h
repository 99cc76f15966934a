// What the report's script knows of the nodes.
#pragma once

#include <string>

#include "cli/report_groups.h"

namespace sherd {

/// JSON that may stand inside of <script>: every "<" is escaped. Bytes that aren't UTF-8 are replaced.
std::string reportJson(const ReportData& data, const ReportGroups& grouped);

}  // namespace sherd
