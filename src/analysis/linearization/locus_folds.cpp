#include "analysis/linearization/locus_parts.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

class FoldSearch {
 public:
  FoldSearch(BranchFollower& follow, Locus& locus) : follow_(follow), locus_(locus) {}

  /// A branch that begins or ends between two values of the sweep, and out of no other one, turns back there. The arms
  /// beyond are branches too, also where no start led to them.
  void run() {
    if (follow_.in_time()) return;
    constexpr std::size_t most_branches = 1000;
    for (std::size_t b = 0; b < std::min(most_branches, locus_.branches.size()); ++b)
      for (const bool front : {true, false}) {
        const LocusPoint end = end_of(b, front);
        const auto beyond = value_next_to(locus_, end.parameter, front);
        if (!beyond || !follow_.is_followed(end.equilibrium) || !follow_.is_regular(end)) continue;
        const BranchWalk walk = follow_.walk_from(end, *beyond);
        if (!walk.folds.empty()) add_folds(b, front, end, walk);
      }
  }

  /// A fold at a value of the sweep is found by the search too, as a point of no branch.
  void drop_points_of_folds() {
    constexpr double of_double_root = 1e-4;  // as far as rounding of the forces leaves it open
    std::vector<std::size_t> numbers;        // new ones
    std::vector<LocusBranch> left;
    for (const LocusBranch& b : locus_.branches) {
      const LocusPoint& x = b.points.front();
      const bool is_fold =
          b.points.size() == 1 && std::any_of(locus_.folds.begin(), locus_.folds.end(), [&](const Fold& f) {
            return f.parameter == x.parameter && follow_.distance(f.equilibrium, x.equilibrium) <= of_double_root;
          });
      numbers.push_back(left.size());
      if (!is_fold) left.push_back(b);
    }
    locus_.branches = std::move(left);
    for (Fold& f : locus_.folds)
      for (std::size_t& b : f.branches) b = numbers[b];
    for (Fold& f : locus_.folds) std::sort(f.branches.begin(), f.branches.end());
  }

 private:
  LocusPoint end_of(std::size_t b, bool front) const {
    const auto& points = locus_.branches[b].points;
    return front ? points.front() : points.back();
  }

  /// From the end of a branch through all folds of the walk: arms within one step of the sweep have points at their
  /// folds and one between, the last one goes on from where the walk ends.
  void add_folds(std::size_t b, bool front, const LocusPoint& end, const BranchWalk& walk) {
    std::size_t fold = add_fold(b, front, end, walk.folds.front());
    for (std::size_t k = 0; k < walk.arms.size(); ++k) {
      const Fold next = fold_at(end, walk.folds[k + 1]);
      const std::size_t there = known_fold(next);
      if (there < locus_.folds.size() && locus_.folds[there].branches.size() > 1) return;  // the arms are there
      const LocusPoint middle = judged_at(end, walk.arms[k]);
      // Of two folds one is met first along the sweep.
      const bool forward = (walk.folds[k + 1].value - walk.folds[k].value) * follow_.step() > 0;
      locus_.branches.push_back({{middle}});
      const std::size_t arm = locus_.branches.size() - 1;
      attach_to(fold, arm, forward, middle);
      fold = add_fold(arm, !forward, middle, walk.folds[k + 1]);
    }
    if (walk.end == BranchWalk::End::Lost) return;
    const bool returned = walk.end == BranchWalk::End::Returned;
    add_last_arm(fold, returned == front, end, walk.last);
  }

  /// `front`: whether the arm begins at the fold, in the direction of the sweep.
  void add_last_arm(std::size_t fold, bool front, const LocusPoint& like, const RestAt& place) {
    const auto there = follow_.settled(like.equilibrium, place);
    if (!there) return;
    auto arm = branch_at(follow_, locus_, place.value, *there);
    const bool is_new = !arm;
    if (is_new) {
      arm = locus_.branches.size();
      locus_.branches.push_back({{follow_.judged(place.value, *there)}});
    }
    if (const LocusPoint end = end_of(*arm, front); end.parameter == place.value) attach_to(fold, *arm, front, end);
    if (is_new) extend_branch(follow_, locus_, *arm, !front);
  }

  Fold fold_at(const LocusPoint& like, const RestAt& place) const {
    Equilibrium x = like.equilibrium;
    x.point = place.rest;
    return {place.value, x, {}};
  }
  LocusPoint judged_at(const LocusPoint& like, const RestAt& place) {
    return follow_.judged(place.value, fold_at(like, place).equilibrium);
  }

  /// Its number; that of a new one where there is none.
  std::size_t known_fold(const Fold& fold) const {
    const auto found = std::find_if(locus_.folds.begin(), locus_.folds.end(), [&](const Fold& f) {
      return std::abs(f.parameter - fold.parameter) <= one_place * std::abs(follow_.step()) &&
             follow_.distance(f.equilibrium, fold.equilibrium) <= one_place;
    });
    return static_cast<std::size_t>(found - locus_.folds.begin());
  }

  std::size_t add_fold(std::size_t b, bool front, const LocusPoint& end, const RestAt& turn) {
    const Fold fold = fold_at(end, turn);
    const std::size_t number = known_fold(fold);
    if (number == locus_.folds.size()) locus_.folds.push_back(fold);
    attach_to(number, b, front, end);
    return number;
  }

  /// The fold is the last point of the branch there, with the verdict of its neighbour.
  void attach_to(std::size_t number, std::size_t b, bool front, const LocusPoint& end) {
    Fold& fold = locus_.folds[number];
    if (std::find(fold.branches.begin(), fold.branches.end(), b) != fold.branches.end() || fold.branches.size() > 1)
      return;
    fold.branches.push_back(b);
    LocusPoint last = follow_.judged(fold.parameter, fold.equilibrium);
    last.stability = end.stability;
    auto& points = locus_.branches[b].points;
    points.insert(front ? points.begin() : points.end(), last);
  }

  BranchFollower& follow_;
  Locus& locus_;
};

}  // namespace

void find_folds(BranchFollower& follow, Locus& locus) {
  FoldSearch search(follow, locus);
  search.run();
  search.drop_points_of_folds();
}

}  // namespace maupertuis
