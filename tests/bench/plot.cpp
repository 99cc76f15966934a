#include "bench/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace sherd::bench {
namespace {

constexpr double kWidth = 460, kHeight = 340, kLeft = 70, kRight = 20, kTop = 34, kBottom = 50;
constexpr const char* kColours[] = {"#0b6fa4", "#d1495b", "#3a7d44", "#8a5a00", "#6d597a", "#444444"};

/// Whole powers of ten around the values.
struct Axis {
  int low = 0, high = 1;
  explicit Axis(const std::vector<double>& values) {
    double least = HUGE_VAL, most = 0;
    for (const double v : values)
      if (v > 0) least = std::min(least, v), most = std::max(most, v);
    if (most == 0) return;
    low = static_cast<int>(std::floor(std::log10(least)));
    high = std::max(low + 1, static_cast<int>(std::ceil(std::log10(most))));
  }
  double share(double v) const { return (std::log10(v) - low) / (high - low); }
};

std::string text(double x, double y, const std::string& anchor, const std::string& words,
                 const char* more = "") {
  return fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}' {}>{}</text>\n", x, y, anchor, more,
                     words);
}

std::string axes(const Plot& plot, const Axis& ax, const Axis& ay) {
  const double w = kWidth - kLeft - kRight, h = kHeight - kTop - kBottom;
  std::string svg = fmt::format("<rect x='{}' y='{}' width='{}' height='{}' fill='none' stroke='#888'/>\n",
                                kLeft, kTop, w, h);
  for (int e = ax.low; e <= ax.high; ++e) {
    const double x = kLeft + w * (e - ax.low) / (ax.high - ax.low);
    svg += fmt::format("<path d='M{0:.1f} {1}V{2}' stroke='#ddd'/>\n", x, kTop, kTop + h);
    svg += text(x, kTop + h + 15, "middle", fmt::format("1e{}", e));
  }
  for (int e = ay.low; e <= ay.high; ++e) {
    const double y = kTop + h * (1 - static_cast<double>(e - ay.low) / (ay.high - ay.low));
    svg += fmt::format("<path d='M{1} {0:.1f}H{2}' stroke='#ddd'/>\n", y, kLeft, kLeft + w);
    svg += text(kLeft - 6, y + 4, "end", fmt::format("1e{}", e));
  }
  svg += text(kLeft + w / 2, 20, "middle", plot.title, "font-weight='bold'");
  svg += text(kLeft + w / 2, kTop + h + 36, "middle", plot.xLabel);
  return svg + text(0, 0, "middle", plot.yLabel,
                    fmt::format("transform='translate(16 {}) rotate(-90)'", kTop + h / 2).c_str());
}

std::string drawn(const Plot& plot) {
  std::vector<double> xs, ys;
  for (const Series& s : plot.series) {
    xs.insert(xs.end(), s.x.begin(), s.x.end());
    ys.insert(ys.end(), s.y.begin(), s.y.end());
  }
  const Axis ax(xs), ay(ys);
  const double w = kWidth - kLeft - kRight, h = kHeight - kTop - kBottom;
  std::string svg = axes(plot, ax, ay);
  for (std::size_t k = 0; k < plot.series.size(); ++k) {
    const Series& s = plot.series[k];
    const char* colour = kColours[k % std::size(kColours)];
    std::string path;
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      if (!(s.x[i] > 0 && s.y[i] > 0)) continue;
      const double x = kLeft + w * ax.share(s.x[i]), y = kTop + h * (1 - ay.share(s.y[i]));
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x, y);
      svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3' fill='{}'/>\n", x, y, colour);
    }
    svg += fmt::format("<path d='{}' fill='none' stroke='{}'/>\n", path, colour);
    svg += text(kLeft + 10, kTop + 16 + 15 * static_cast<double>(k), "start", s.name,
                fmt::format("fill='{}'", colour).c_str());
  }
  return svg;
}

}  // namespace

void writePlots(const std::filesystem::path& file, const std::vector<Plot>& plots) {
  std::ofstream out(file);
  out << fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{1}' font-family='sans-serif' "
      "font-size='11'>\n<rect width='{0}' height='{1}' fill='white'/>\n",
      kWidth * static_cast<double>(plots.size()), kHeight);
  for (std::size_t i = 0; i < plots.size(); ++i)
    out << fmt::format("<g transform='translate({} 0)'>\n{}</g>\n", kWidth * static_cast<double>(i),
                       drawn(plots[i]));
  out << "</svg>\n";
}

}  // namespace sherd::bench
