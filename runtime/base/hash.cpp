#include "base/hash.h"

#include <xxhash.h>

#include <array>
#include <cstring>
#include <new>

namespace sherd {

std::uint64_t checksum64(const void* data, std::size_t size) { return XXH3_64bits(data, size); }

Digest checksum128(const void* data, std::size_t size) {
  const XXH128_hash_t h = XXH3_128bits(data, size);
  return {h.high64, h.low64};
}

struct Hasher::State {
  XXH3_state_t* xxh = XXH3_createState();
  ~State() { XXH3_freeState(xxh); }
};

Hasher::Hasher() : state_(std::make_unique<State>()) {
  if (state_->xxh == nullptr) throw std::bad_alloc();
  XXH3_128bits_reset(state_->xxh);
}

Hasher::~Hasher() = default;

Hasher& Hasher::bytes(const void* data, std::size_t size) {
  const std::uint64_t length = size;
  XXH3_128bits_update(state_->xxh, &length, sizeof length);
  if (size != 0) XXH3_128bits_update(state_->xxh, data, size);
  return *this;
}

Digest Hasher::digest() const {
  const XXH128_hash_t h = XXH3_128bits_digest(state_->xxh);
  return {h.high64, h.low64};
}

Digest digestOf(const Digest& first, std::span<const std::byte> rest) {
  constexpr std::size_t kOnStack = 512;
  if (sizeof first + rest.size() <= kOnStack) {
    std::array<std::byte, kOnStack> block;
    std::memcpy(block.data(), &first, sizeof first);
    if (!rest.empty()) std::memcpy(block.data() + sizeof first, rest.data(), rest.size());
    const XXH128_hash_t h = XXH3_128bits(block.data(), sizeof first + rest.size());
    return {h.high64, h.low64};
  }
  const XXH128_hash_t h = XXH3_128bits_withSeed(rest.data(), rest.size(), first.low);
  return Hasher().add(first).add(Digest{h.high64, h.low64}).digest();
}

std::string Digest::hex() const {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text(32, '0');
  for (std::size_t i = 0; i < 16; ++i) {
    text[15 - i] = kDigits[(high >> (4 * i)) & 15];
    text[31 - i] = kDigits[(low >> (4 * i)) & 15];
  }
  return text;
}

}  // namespace sherd
