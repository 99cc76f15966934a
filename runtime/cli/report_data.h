// What the report page shows of a run.
#pragma once

#include <string>
#include <vector>

#include "cli/report.h"
#include "cli/shots.h"
#include "eval/plan.h"

namespace sherd {

/// `plan` is that of just before the run: it says why nodes ran, and holds those that weren't needed.
ReportData reportOf(const Shots& shots, const std::string& command, const std::vector<PlanEntry>& plan,
                    const EvalReport& report);

}  // namespace sherd
