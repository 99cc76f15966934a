// Reports for the tests: with several states, frames, messages and pictures.
#pragma once

#include <string>

#include "cli/report.h"

namespace sherd::test {

/// A dozen nodes like those of a vase that breaks, of which one is not needed, one failed and one was
/// skipped.
ReportData vaseReport(bool failed);

/// `count` nodes, each wired to up to three of the twenty before it.
ReportData randomReport(int count, unsigned seed);

}  // namespace sherd::test
