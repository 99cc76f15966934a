// The report in a real browser: Debian's Chromium, headless, driven by report_in_browser.py. tests/run --all
// installs both; where they are missing the test fails.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <fstream>

#include "cli/report.h"
#include "made_up.h"
#include "report_data.h"

namespace sherd {
namespace {

/// Two by one pixels.
constexpr unsigned char kPng[] = {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d,
                                  0x49, 0x48, 0x44, 0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01,
                                  0x08, 0x02, 0x00, 0x00, 0x00, 0x7b, 0x40, 0xe8, 0xdd, 0x00, 0x00, 0x00,
                                  0x0d, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0xf8, 0xcf, 0x00, 0x04,
                                  0xff, 0x01, 0x07, 0x00, 0x01, 0xff, 0xe2, 0x23, 0x9e, 0x59, 0x00, 0x00,
                                  0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

ReportData hostileReport() {
  const std::string evil =
      "</script><b class=evil>\"'</b><script>window.hurt = 1</script><img src=x onerror='hurt = 1'>";
  ReportData data = test::vaseReport(true);
  data.title = data.command = evil;
  for (ReportNode& node : data.nodes) {
    node.graph = node.type = node.help = node.why = node.error = evil;
    node.name += evil;
    node.messages = node.written = {evil};
    for (ReportPort& port : node.inputs) port.type = port.help = evil;
    for (ReportParam& param : node.params) param.name = param.value = param.help = evil;
  }
  return data;
}

/// Two nodes of more frames than a page shows.
ReportData foldedReport() {
  ReportData data;
  for (int i = 0; i < 100'000; ++i) {
    ReportNode& node = data.nodes.emplace_back();
    node.name = i % 2 == 0 ? "a" : "b";
    node.type = "Made";
    node.state = "run";
    node.context = "frame " + std::to_string(i / 2);
    node.ms = i == 777 * 2 ? 5000 : 1;
  }
  return data;
}

TEST(SlowReport, WorksInABrowser) {
  const test::TemporaryDirectory directory;
  const auto write = [&](const ReportData& data, const std::string& name) {
    const auto written = writeReport(data, (directory.path() / name).string());
    ASSERT_TRUE(written.ok()) << written.error().text();
  };
  const std::string picture = (directory.path() / "picture.png").string();
  std::ofstream(picture, std::ios::binary).write(reinterpret_cast<const char*>(kPng), sizeof kPng);
  ReportData fine = test::vaseReport(false);
  fine.pictures = {picture};
  write(fine, "fine.html");
  write(test::vaseReport(true), "failed.html");
  write(hostileReport(), "hostile.html");
  write(test::randomReport(2000, 1), "large.html");
  write(foldedReport(), "folded.html");
  write({}, "empty.html");

  const std::string command = "/usr/bin/python3 '" SHERD_SOURCE_DIR "/tests/runtime/report_in_browser.py' '" +
                              directory.path().string() + "' 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string said;
  char buffer[4096];
  while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) said.append(buffer, n);
  const int status = pclose(pipe);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0)
      << said << "\n(Chromium and its driver are installed by tests/run --all.)";
}

}  // namespace
}  // namespace sherd
