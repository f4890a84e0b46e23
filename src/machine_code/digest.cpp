#include "machine_code/digest.hpp"

#include <cstring>

namespace maupertuis::machine_code {
namespace {

constexpr std::uint64_t c1 = 0x87c37b91114253d5u, c2 = 0x4cf5ad432745937fu;

std::uint64_t rotate(std::uint64_t x, int r) { return (x << r) | (x >> (64 - r)); }

std::uint64_t finish(std::uint64_t x) {
  x = (x ^ (x >> 33)) * 0xff51afd7ed558ccdu;
  x = (x ^ (x >> 33)) * 0xc4ceb9fe1a85ec53u;
  return x ^ (x >> 33);
}

}  // namespace

std::string Digest::hex() const {
  static constexpr char digits[] = "0123456789abcdef";
  std::string out;
  for (const std::uint64_t half : {high, low})
    for (int shift = 60; shift >= 0; shift -= 4) out += digits[(half >> shift) & 15u];
  return out;
}

void Digester::mix(std::uint64_t first, std::uint64_t second) {
  high_ ^= rotate(first * c1, 31) * c2;
  high_ = (rotate(high_, 27) + low_) * 5 + 0x52dce729u;
  low_ ^= rotate(second * c2, 33) * c1;
  low_ = (rotate(low_, 31) + high_) * 5 + 0x38495ab5u;
}

void Digester::add(std::uint64_t word) {
  if (count_++ % 2 == 0)
    pending_ = word;
  else
    mix(pending_, word);
}

void Digester::add_double(double value) {
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  add(bits);
}

void Digester::add_text(std::string_view text) {
  add(text.size());
  for (std::size_t at = 0; at < text.size(); at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, text.data() + at, std::min<std::size_t>(8, text.size() - at));
    add(word);
  }
}

Digest Digester::digest() const {
  Digester last = *this;
  last.add(count_);
  if (last.count_ % 2 == 1) last.add(0);
  std::uint64_t high = last.high_ ^ last.count_, low = last.low_ ^ last.count_;
  high += low, low += high;
  high = finish(high), low = finish(low);
  high += low, low += high;
  return {high, low};
}

Digest digest_of(std::span<const char> bytes) {
  Digester d;
  d.add_text({bytes.data(), bytes.size()});
  return d.digest();
}

}  // namespace maupertuis::machine_code
