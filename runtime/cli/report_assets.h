// The report's style and script, as they stand in the page.
#pragma once

namespace sherd {

extern const char* const kReportStyle;
extern const char* const kReportScript;
/// The marks of the states, as SVG symbols with the ids m-run, m-hit, m-failed, m-skipped, m-unneeded.
extern const char* const kReportMarks;

}  // namespace sherd
