#include "bench/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>

namespace sherd::bench {
namespace {

constexpr double kHeight = 360, kLeft = 62, kRight = 16, kTop = 34, kBottom = 50;
constexpr double kLegendLine = 16, kPoint = 3, kCap = 3;
constexpr const char* kColours[] = {"#0b6fa4", "#d1495b", "#3a7d44", "#8a5a00",
                                    "#6d597a", "#444444", "#999999"};

/// From values to shares of an axis' length, with the places of its marks.
struct Axis {
  bool isLogarithmic = true;
  double low = 0, high = 1;
  std::vector<std::pair<double, std::string>> marks;

  double share(double v) const { return ((isLogarithmic ? std::log10(v) : v) - low) / (high - low); }
};

/// Whole powers of ten around the values. `room`: share of their range that is left free above them.
Axis logarithmic(const std::vector<double>& values, double room) {
  Axis axis;
  double least = HUGE_VAL, most = 0;
  for (const double v : values)
    if (v > 0) least = std::min(least, v), most = std::max(most, v);
  if (most == 0) return axis;
  axis.low = std::floor(std::log10(least));
  axis.high = std::max(axis.low + 1, std::ceil(std::log10(most)));
  for (double e = axis.low; e <= axis.high; ++e)
    axis.marks.emplace_back(std::pow(10, e), fmt::format("1e{}", e));
  axis.high += room * (axis.high - axis.low);
  return axis;
}

/// Steps of 1, 2 or 5 times a power of ten, five or so of them, from 0 or below.
Axis linear(const std::vector<double>& values, double room) {
  Axis axis;
  axis.isLogarithmic = false;
  double least = 0, most = 0;
  for (const double v : values) least = std::min(least, v), most = std::max(most, v);
  if (most == least) most = least + 1;
  double step = std::pow(10, std::floor(std::log10((most - least) / 5)));
  for (const double factor : {2.0, 2.5, 2.0})
    if ((1 + room) * (most - least) / step > 8) step *= factor;
  axis.low = step * std::floor(least / step);
  axis.high = room > 0 ? most + room * (most - axis.low) : step * std::ceil(most / step);
  for (int k = 0; axis.low + k * step <= axis.high; ++k)
    axis.marks.emplace_back(axis.low + k * step, fmt::format("{:.6g}", axis.low + k * step));
  return axis;
}

Axis categorical(const Plot& plot) {
  Axis axis;
  axis.isLogarithmic = false;
  axis.low = plot.groups ? 0 : -0.5;
  axis.high = axis.low + static_cast<double>(plot.categories.size());
  for (std::size_t k = 0; k < plot.categories.size(); ++k)
    axis.marks.emplace_back(static_cast<double>(k) + (plot.groups ? 0.5 : 0), plot.categories[k]);
  return axis;
}

std::string text(double x, double y, const std::string& anchor, const std::string& words,
                 const std::string& more = "") {
  return fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}' {}>{}</text>\n", x, y, anchor, more,
                     words);
}

class Drawing {
 public:
  explicit Drawing(const Plot& plot)
      : plot_(plot), w_(plot.width - kLeft - kRight), h_(kHeight - kTop - kBottom) {
    std::vector<double> xs, ys;
    std::size_t named = 0;
    for (const Series& s : plot.series) {
      named += s.name.empty() ? 0 : 1;
      xs.insert(xs.end(), s.x.begin(), s.x.end());
      for (const auto* values : {&s.y, &s.low, &s.high}) ys.insert(ys.end(), values->begin(), values->end());
    }
    const bool isLinear = plot.scale == Plot::Scale::Linear;
    // The legend stands above all that is drawn.
    const double legend = kLegendLine * static_cast<double>(named) + 8;
    x_ = !plot.categories.empty() ? categorical(plot) : isLinear ? linear(xs, 0) : logarithmic(xs, 0);
    const double room = legend / (h_ - legend);
    y_ = isLinear ? linear(ys, room) : logarithmic(ys, room);
  }

  std::string svg() const {
    std::string out = axes();
    double line = 0;
    for (std::size_t k = 0; k < plot_.series.size(); ++k) {
      const Series& s = plot_.series[k];
      const std::size_t colour = s.colour < 0 ? k : static_cast<std::size_t>(s.colour);
      out += drawn(s, kColours[colour % std::size(kColours)]);
      if (!s.name.empty()) out += legend(s, kColours[colour % std::size(kColours)], line++);
    }
    return out;
  }

 private:
  double atX(double x) const { return kLeft + w_ * x_.share(x); }
  double atY(double y) const { return kTop + h_ * (1 - y_.share(y)); }
  bool canBeSeen(double x, double y) const {
    return plot_.scale == Plot::Scale::Linear || ((!plot_.categories.empty() || x > 0) && y > 0);
  }

  std::string axes() const {
    std::string out;
    for (const auto& [value, label] : x_.marks) {
      const double x = atX(value), line = plot_.groups ? atX(value + 0.5) : x;
      out += fmt::format("<path d='M{0:.1f} {1}V{2}' stroke='#ddd'/>\n", line, kTop, kTop + h_);
      out += text(x, kTop + h_ + 15, "middle", label);
    }
    for (const auto& [value, label] : y_.marks) {
      out += fmt::format("<path d='M{1} {0:.1f}H{2}' stroke='#ddd'/>\n", atY(value), kLeft, kLeft + w_);
      out += text(kLeft - 6, atY(value) + 4, "end", label);
    }
    out += fmt::format("<rect x='{}' y='{}' width='{}' height='{}' fill='none' stroke='#888'/>\n", kLeft,
                       kTop, w_, h_);
    out += text(kLeft + w_ / 2, 20, "middle", plot_.title, "font-weight='bold'");
    out += text(kLeft + w_ / 2, kTop + h_ + 36, "middle", plot_.xLabel);
    return out + text(0, 0, "middle", plot_.yLabel,
                      fmt::format("transform='translate(16 {}) rotate(-90)'", kTop + h_ / 2));
  }

  static std::string stroke(const Series& s) {
    return s.style == Series::Style::Dashed ? " stroke-dasharray='5 4'" : "";
  }

  std::string drawn(const Series& s, const char* colour) const {
    std::string out, path;
    const bool hasLine = s.style != Series::Style::Points,
               hasPoints = s.style == Series::Style::Points || s.style == Series::Style::LineAndPoints;
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      if (!canBeSeen(s.x[i], s.y[i])) continue;
      const double x = atX(s.x[i]), y = atY(s.y[i]);
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x, y);
      if (!s.low.empty())
        out += fmt::format(
            "<path d='M{0:.1f} {1:.1f}V{2:.1f}M{3:.1f} {1:.1f}h{4}M{3:.1f} {2:.1f}h{4}' stroke='{5}'/>\n", x,
            atY(s.low[i]), atY(s.high[i]), x - kCap, 2 * kCap, colour);
      if (hasPoints)
        out += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{}' fill='{}'/>\n", x, y, kPoint, colour);
    }
    if (hasLine && !path.empty())
      out += fmt::format("<path d='{}' fill='none' stroke='{}'{}/>\n", path, colour, stroke(s));
    return out;
  }

  std::string legend(const Series& s, const char* colour, double line) const {
    const double x = kLeft + 10, y = kTop + 14 + kLegendLine * line;
    std::string out;
    if (s.style != Series::Style::Points)
      out += fmt::format("<path d='M{} {}h18' stroke='{}'{}/>\n", x, y, colour, stroke(s));
    if (s.style == Series::Style::Points || s.style == Series::Style::LineAndPoints)
      out += fmt::format("<circle cx='{}' cy='{}' r='{}' fill='{}'/>\n", x + 9, y, kPoint, colour);
    return out + text(x + 24, y + 4, "start", s.name, fmt::format("fill='{}'", colour));
  }

  const Plot& plot_;
  double w_, h_;
  Axis x_, y_;
};

}  // namespace

void writePlots(const std::filesystem::path& file, const std::vector<Plot>& plots) {
  double width = 0;
  for (const Plot& plot : plots) width += plot.width;
  std::ofstream out(file);
  out << fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{1}' viewBox='0 0 {0} {1}' "
      "font-family='sans-serif' font-size='11'>\n<rect width='{0}' height='{1}' fill='white'/>\n",
      width, kHeight);
  double x = 0;
  for (const Plot& plot : plots) {
    out << fmt::format("<g transform='translate({} 0)'>\n{}</g>\n", x, Drawing(plot).svg());
    x += plot.width;
  }
  out << "</svg>\n";
}

}  // namespace sherd::bench
