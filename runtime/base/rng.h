// Counter-based random numbers (Philox 2x64-10, Salmon et al., SC 2011): number k of stream s under seed r is
// a pure function of (r, s, k), so that results depend neither on the order of calls nor on threads.
#pragma once

#include <array>
#include <cstdint>

namespace sherd {

class Rng {
 public:
  /// `stream` separates independent uses of one seed.
  explicit Rng(std::uint64_t seed, std::uint64_t stream = 0) : seed_(seed), stream_(stream) {}

  /// Number `index` of this stream: 64 random bits.
  std::uint64_t bitsAt(std::uint64_t index) const;
  /// Number `index` of this stream, uniform in [0, 1) with 53 bits.
  double uniformAt(std::uint64_t index) const;

  /// The next number of this stream.
  std::uint64_t bits() { return bitsAt(next_++); }
  double uniform() { return uniformAt(next_++); }
  /// Uniform in [0, n), n > 0, without modulo bias worth speaking of (2^-64 n).
  std::uint64_t below(std::uint64_t n);

 private:
  std::uint64_t seed_, stream_, next_ = 0;
};

}  // namespace sherd
