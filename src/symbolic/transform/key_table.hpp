#pragma once
#include <cstdint>
#include <vector>

namespace maupertuis::terms {

/// A number for each 64-bit key, in one piece of memory: a table of the standard library takes a piece for each.
class KeyTable {
 public:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  /// To be set where it is `none`: the key is new. Valid until the next call.
  std::uint32_t& operator[](std::uint64_t key) {
    if (2 * count_ >= slots_.size()) grow();
    Slot& slot = slot_of(key);
    if (slot.value == none) {
      slot.key = key;
      ++count_;
    }
    return slot.value;
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t value = none;
  };

  Slot& slot_of(std::uint64_t key) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = (key * 0x9E3779B97F4A7C15ull >> 32) & mask;
    while (slots_[at].value != none && slots_[at].key != key) at = (at + 1) & mask;
    return slots_[at];
  }
  void grow() {
    std::vector<Slot> old(slots_.empty() ? 32 : 4 * slots_.size());  // a power of two
    old.swap(slots_);
    count_ = 0;  // keys that were asked for and not set are forgotten
    for (const Slot& slot : old) {
      if (slot.value == none) continue;
      slot_of(slot.key) = slot;
      ++count_;
    }
  }

  std::vector<Slot> slots_;
  std::size_t count_ = 0;
};

}  // namespace maupertuis::terms
