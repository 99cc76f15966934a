// Debian's Blender, without a window.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <string>
#include <vector>

namespace sherd {

/// What Blender prints as it runs a Python script with these arguments. A failure of the calling test where
/// it does not end with 0. `home`: a directory of its own, for its settings.
inline std::string blenderSays(const std::string& script, const std::vector<std::string>& arguments,
                               const std::string& home) {
  std::string command = "HOME='" + home +
                        "' blender --background --factory-startup --python-exit-code 1 --python '" + script +
                        "' --";
  for (const std::string& argument : arguments) command += " '" + argument + "'";
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) {
    ADD_FAILURE() << "no process for " << command;
    return {};
  }
  std::string said;
  char buffer[4096];
  while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) said.append(buffer, n);
  const int status = pclose(pipe);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0)
      << said << "\n(Blender is installed by tests/run --all.)";
  return said;
}

}  // namespace sherd
