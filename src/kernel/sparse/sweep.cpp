#include "kernel/sparse/sweep.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace maupertuis::sparse {
namespace {
/// Shorter recurrences are not worth their beginning.
constexpr std::size_t shortest_recurrence = 4;
}  // namespace

class SweepOrder {
 public:
  SweepOrder(const std::vector<SweepSum>& sums, const std::vector<std::uint32_t>& operands, LoopSweep& out)
      : sums_(sums), operands_(operands), out_(out) {}

  void run() {
    find_levels();
    for (std::size_t level = 0; level < levels_.size();) {
      const std::vector<Link> links = links_from(level);
      if (links.size() >= shortest_recurrence) {
        write(links);
        level += 2 * links.size();
      } else {
        write(levels_[level++]);
      }
    }
    out_.scale_.assign(out_.sums_.size(), 1.0);
    out_.factors_.assign(out_.operand_.size(), 0.0);
  }

 private:
  using Products = std::vector<std::uint32_t>;
  /// Sums of a recurrence, and the products of its joint in the order of the sides.
  struct Link {
    std::vector<std::uint32_t> sides;
    std::uint32_t joint = 0;
    Products of_joint;
  };

  Products products_of(std::uint32_t sum) const {
    Products out(sums_[sum].last - sums_[sum].first);
    std::iota(out.begin(), out.end(), sums_[sum].first);
    return out;
  }

  /// What nothing reads has a level of its own, the last.
  void find_levels() {
    std::unordered_map<std::uint32_t, std::size_t> level_of;  // cells
    std::unordered_map<std::uint32_t, bool> is_read;
    std::size_t most = 0;
    for (const SweepSum& sum : sums_) {
      std::size_t level = 0;
      for (std::uint32_t k = sum.first; k < sum.last; ++k) {
        is_read[operands_[k]] = true;
        if (const auto found = level_of.find(operands_[k]); found != level_of.end())
          level = std::max(level, found->second + 1);
      }
      level_of[sum.target] = level;
      most = std::max(most, level + 1);
    }
    levels_.resize(most + 1);
    for (std::uint32_t i = 0; i < sums_.size(); ++i)
      levels_[is_read[sums_[i].target] ? level_of[sums_[i].target] : most].push_back(i);
  }

  std::vector<Link> links_from(std::size_t level) const {
    std::vector<Link> out;
    for (Link link; level + 1 < levels_.size() && levels_[level + 1].size() == 1; level += 2) {
      link.sides = levels_[level], link.joint = levels_[level + 1][0], link.of_joint = products_of(link.joint);
      if (!goes_on(out.empty() ? nullptr : &out.back(), link)) break;
      out.push_back(link);
    }
    return out;
  }

  /// Whether the link is one of a recurrence, and follows `before`; its sides get that one's order.
  bool goes_on(const Link* before, Link& link) const {
    std::vector<std::uint32_t>& sides = link.sides;
    if (sides.empty() || sides.size() > most_sides || link.of_joint.size() != sides.size()) return false;
    if (!sums_[link.joint].starts || (before && before->sides.size() != sides.size())) return false;
    const bool start = sums_[before ? before->sides[0] : sides[0]].starts;
    const auto is_side = [&](std::uint32_t i) {
      return sums_[i].last - sums_[i].first == 2 && sums_[i].starts == start;
    };
    if (!std::all_of(sides.begin(), sides.end(), is_side)) return false;
    const std::uint32_t joint_before = before ? sums_[before->joint].target : operands_[sums_[sides[0]].first + 1];
    for (std::size_t j = 0; j < sides.size(); ++j) {
      const auto follows = [&](std::uint32_t i) {
        return !before || operands_[sums_[i].first] == sums_[before->sides[j]].target;
      };
      const auto side = std::find_if(sides.begin() + j, sides.end(), follows);
      if (side == sides.end() || operands_[sums_[*side].first + 1] != joint_before) return false;
      std::swap(sides[j], *side);
      const auto product = std::find_if(link.of_joint.begin() + j, link.of_joint.end(),
                                        [&](std::uint32_t k) { return operands_[k] == sums_[sides[j]].target; });
      if (product == link.of_joint.end()) return false;
      std::swap(link.of_joint[j], *product);
    }
    return true;
  }

  void open(std::uint32_t sides) {
    const auto first = static_cast<std::uint32_t>(out_.sums_.size());
    out_.runs_.push_back({first, first, sides});
  }

  void write(const std::vector<Link>& links) {
    open(static_cast<std::uint32_t>(links[0].sides.size()));
    for (const Link& link : links) {
      for (const std::uint32_t side : link.sides) write(side, products_of(side));
      write(link.joint, link.of_joint);
      write_product(operands_[sums_[link.sides[0]].first + 1], 0);  // set() makes its factor
    }
  }

  /// Sums of one shape after each other, so that a loop over them has no branches of its own.
  void write(std::vector<std::uint32_t>& level) {
    const auto shape = [this](std::uint32_t i) { return std::pair(sums_[i].last - sums_[i].first, sums_[i].starts); };
    std::stable_sort(level.begin(), level.end(), [&](std::uint32_t i, std::uint32_t j) { return shape(i) < shape(j); });
    for (std::size_t i = 0; i < level.size(); ++i) {
      if (i == 0 || shape(level[i - 1]) != shape(level[i])) open(0);
      write(level[i], products_of(level[i]));
    }
  }

  void write(std::uint32_t sum, const Products& products) {
    const auto first = static_cast<std::uint32_t>(out_.operand_.size());
    out_.sums_.push_back(sums_[sum]);
    out_.sums_.back().first = out_.sums_.back().last = first;
    for (const std::uint32_t k : products) write_product(operands_[k], k);
    ++out_.runs_.back().last;
  }

  void write_product(std::uint32_t operand, std::uint32_t source) {
    out_.operand_.push_back(operand);
    out_.source_.push_back(source);
    out_.sum_of_product_.push_back(static_cast<std::uint32_t>(out_.sums_.size() - 1));
    ++out_.sums_.back().last;
  }

  const std::vector<SweepSum>& sums_;
  const std::vector<std::uint32_t>& operands_;
  LoopSweep& out_;
  std::vector<std::vector<std::uint32_t>> levels_;  // sums that do not wait for each other
};

LoopSweep::LoopSweep(const std::vector<SweepSum>& sums, const std::vector<std::uint32_t>& operands) {
  SweepOrder(sums, operands, *this).run();
}

void LoopSweep::set(const double* factors, const double* inverse_pivots) {
  if (inverse_pivots)
    for (std::size_t i = 0; i < sums_.size(); ++i) scale_[i] = inverse_pivots[sums_[i].pivot];
  for (std::size_t k = 0; k < factors_.size(); ++k) factors_[k] = -scale_[sum_of_product_[k]] * factors[source_[k]];
  for (const SweepRun& run : runs_)
    for (std::uint32_t joint = run.first + run.sides; run.sides > 0 && joint < run.last; joint += run.sides + 1) {
      double& through_sides = factors_[sums_[joint].last - 1];
      through_sides = 0;
      for (std::uint32_t j = 0; j < run.sides; ++j)
        through_sides += factors_[sums_[joint].first + j] * factors_[sums_[joint - run.sides + j].first + 1];
    }
}

}  // namespace maupertuis::sparse
