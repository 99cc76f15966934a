// Plots as SVG.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sherd::bench {

struct Series {
  enum class Style { LineAndPoints, Line, Dashed, Points };
  std::string name;  ///< in the legend; empty: not there
  std::vector<double> x, y;
  std::vector<double> low = {}, high = {};  ///< ends of a bar through each point; empty: none
  Style style = Style::LineAndPoints;
  int colour = -1;  ///< which of the palette; -1: by its place among the series
};

struct Plot {
  enum class Scale { Logarithmic, Linear };
  std::string title, xLabel, yLabel;
  std::vector<Series> series;
  Scale scale = Scale::Logarithmic;  ///< of both axes; logarithmic: what isn't positive is left out
  /// What stands below x = 0, 1, … in place of numbers, or between the borders of such groups where `groups`.
  std::vector<std::string> categories = {};
  bool groups = false;
  double width = 460;
};

/// Side by side in one picture.
void writePlots(const std::filesystem::path& file, const std::vector<Plot>& plots);

}  // namespace sherd::bench
