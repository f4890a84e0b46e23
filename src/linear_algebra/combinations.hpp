#pragma once
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace maupertuis {

/// All combinations of options, those with the least changes of the first ones first; made as they are asked for.
class Combinations {
 public:
  /// counts: of options, one number a place.
  Combinations(std::vector<std::size_t> counts, std::size_t most) : counts_(std::move(counts)), most_(most) {
    made_.emplace_back(counts_.size(), 0);
  }
  /// Nothing beyond the last, and beyond `most`.
  const std::vector<std::size_t>* number(std::size_t turn) {
    while (made_.size() <= turn && made_.size() < most_ && done_ < made_.size()) extend(made_[done_++]);
    return turn < std::min(made_.size(), most_) ? &made_[turn] : nullptr;
  }

 private:
  /// Only entries from the last changed one on are changed, so that each combination comes once.
  void extend(const std::vector<std::size_t> from) {
    std::size_t last = 0;
    for (std::size_t k = 0; k < from.size(); ++k)
      if (from[k] != 0) last = k;
    for (std::size_t k = last; k < from.size(); ++k)
      if (from[k] + 1 < counts_[k]) {
        made_.push_back(from);
        ++made_.back()[k];
      }
  }

  std::vector<std::size_t> counts_;
  std::size_t most_;
  std::vector<std::vector<std::size_t>> made_;
  std::size_t done_ = 0;  // of made_, whose changes have been made
};

}  // namespace maupertuis
