#pragma once
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace maupertuis::fuzz {

/// One input's own source of chance: the same seed and number give the same input on every machine.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t number) : state_(mixed(seed) ^ mixed(number + 0x9e3779b97f4a7c15u)) {}

  std::uint64_t next() { return mixed(state_ += 0x9e3779b97f4a7c15u); }
  /// From 0 to below `count`, which is positive.
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(next() % count); }
  bool one_in(std::size_t count) { return below(count) == 0; }
  template <class Container>
  const auto& of(const Container& items) {
    return items[below(items.size())];
  }

 private:
  static std::uint64_t mixed(std::uint64_t x) {  // splitmix64
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  }
  std::uint64_t state_;
};

}  // namespace maupertuis::fuzz
