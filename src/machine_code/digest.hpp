#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace maupertuis::machine_code {

/// 128 bits that name a content. Not for cryptography: against mistakes, not against malice.
struct Digest {
  std::uint64_t high = 0, low = 0;
  bool operator==(const Digest& other) const { return high == other.high && low == other.low; }
  std::string hex() const;
};

/// Digests what is added, in order (MurmurHash3 x64 128 by Austin Appleby, word by word).
class Digester {
 public:
  void add(std::uint64_t word);
  void add_double(double value);
  /// With its length, so that texts side by side do not run together.
  void add_text(std::string_view text);
  Digest digest() const;

 private:
  void mix(std::uint64_t first, std::uint64_t second);
  std::uint64_t high_ = 0, low_ = 0, count_ = 0, pending_ = 0;
};

Digest digest_of(std::span<const char> bytes);

}  // namespace maupertuis::machine_code
