// Plots with two logarithmic axes, as SVG.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sherd::bench {

struct Series {
  std::string name;
  std::vector<double> x, y;  ///< positive; others are left out
};

struct Plot {
  std::string title, xLabel, yLabel;
  std::vector<Series> series;
};

/// Side by side in one picture.
void writePlots(const std::filesystem::path& file, const std::vector<Plot>& plots);

}  // namespace sherd::bench
