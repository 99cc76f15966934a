// Doubles that carry a bound of their own error: the first, cheap stage of exact predicates.
#pragma once

#include <cmath>

namespace sherd {

/// |true value − value| ≤ error, through any expression of sums and products (rounding to nearest; a running
/// error analysis in the manner of Wilkinson). The bounds are a little generous, so that they hold for their
/// own rounding too, and never fall to nothing where a product underflows.
struct Approx {
  double value = 0, error = 0;

  constexpr Approx() = default;
  constexpr Approx(double v) : value(v) {}  // NOLINT: a double is an exact Approx
  constexpr Approx(double v, double e) : value(v), error(e) {}

  /// +1 or −1 where the sign is certain, else 0.
  int sign() const { return value > error ? 1 : value < -error ? -1 : 0; }

  friend Approx operator+(const Approx& a, const Approx& b) {
    const double v = a.value + b.value;
    return {v, (a.error + b.error + kUnit * std::abs(v)) * kRound};
  }
  friend Approx operator-(const Approx& a, const Approx& b) {
    const double v = a.value - b.value;
    return {v, (a.error + b.error + kUnit * std::abs(v)) * kRound};
  }
  friend Approx operator*(const Approx& a, const Approx& b) {
    const double v = a.value * b.value;
    return {v, (std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error +
                kUnit * std::abs(v) + kTiny) *
                   kRound};
  }
  friend Approx operator-(const Approx& a) { return {-a.value, a.error}; }

 private:
  static constexpr double kUnit = 0x1p-53, kRound = 1 + 0x1p-49, kTiny = 0x1p-1070;
};

}  // namespace sherd
