#include "base/rng.h"

namespace sherd {
namespace {

__extension__ using Wide = unsigned __int128;

constexpr std::uint64_t kMultiplier = 0xD2B74407B1CE6E93ULL;
constexpr std::uint64_t kWeyl = 0x9E3779B97F4A7C15ULL;

}  // namespace

std::uint64_t Rng::bitsAt(std::uint64_t index) const {
  std::uint64_t left = index, right = stream_, key = seed_;
  for (int round = 0; round < 10; ++round) {
    const Wide product = static_cast<Wide>(kMultiplier) * left;
    left = static_cast<std::uint64_t>(product >> 64) ^ key ^ right;
    right = static_cast<std::uint64_t>(product);
    key += kWeyl;
  }
  return left;
}

double Rng::uniformAt(std::uint64_t index) const {
  return static_cast<double>(bitsAt(index) >> 11) * 0x1.0p-53;
}

std::uint64_t Rng::below(std::uint64_t n) {
  return static_cast<std::uint64_t>((static_cast<Wide>(bits()) * n) >> 64);
}

}  // namespace sherd
