#include "system/kinetic_form.hpp"

#include <maupertuis/kinds.hpp>

#include <cmath>
#include <set>
#include <unordered_map>

/// The second derivatives of L by the velocities, as a quadratic form over the nodes of L. It begins sparse: a square
/// of a velocity component has one entry. Two kinds of variables leave it, from the root of L down:
///
///     a node x = f(a, b, …)    is replaced by its tangent, dx = f_a da + f_b db + …
///     a velocity that no node holds any more    is minimized over: a step of Cholesky's factorization
///
/// M is positive definite where every pivot of the second kind is positive. Of a chain of points the tip goes first:
/// its velocity is that of its neighbour and one angle rate, the rate is minimized over, and the form has moved to the
/// neighbour.
namespace maupertuis::lint_rules {
namespace {

constexpr double smallest_pivot = 1e-9;     // of the terms that it is the sum of
constexpr std::size_t most_factors = 8;     // of a product that depend on velocities
constexpr std::size_t few_neighbours = 10;  // of a rate that is minimized over as soon as it is free
constexpr double most_updates = 2e7;        // of entries of the form: then M is as well looked at itself

using Place = std::uint32_t;

struct Slope {
  Place place;
  double value;
};

class KineticForm {
 public:
  KineticForm(const Subject& s, const Bindings& point) : nodes_(topological_order({&s.lagrangian, 1})) {
    const std::size_t count = nodes_.size();
    values_ = evaluate(nodes_, point);
    moves_.resize(count), uses_.resize(count), inputs_.resize(count), adjoints_.resize(count);
    rows_.resize(count), sizes_.resize(count);
    places_.reserve(count);
    for (Place k = 0; k < count; ++k) places_.emplace(nodes_[k].id(), k);
    for (const Expr& v : s.velocities) {
      const auto place = places_.find(v.id());
      if (place == places_.end()) return;  // L does not know it: M is singular
      moves_[place->second] = true;
    }
    complete_ = gather();
  }

  bool is_definite() {
    if (!complete_) return false;
    for (Place k = 0; k < nodes_.size(); ++k)
      if (moves_[k] && uses_[k] == 0) get_ready(k);
    while (!ready_nodes_.empty() || !ready_rates_.empty()) {
      const bool rate =
          !ready_rates_.empty() && (ready_nodes_.empty() || ready_rates_.begin()->first <= few_neighbours);
      const Place k = rate ? ready_rates_.begin()->second : *ready_nodes_.rbegin();
      if (rate)
        ready_rates_.erase(ready_rates_.begin());
      else
        ready_nodes_.erase(k);
      if (rate && !minimize(k)) return false;
      if (!rate) replace(k);
      if (updates_ > most_updates) return false;
    }
    return true;
  }

 private:
  /// Slopes of the nodes, adjoints from the root down, and the second derivatives. False on a node that is neither sum,
  /// product nor power.
  bool gather() {
    for (Place k = 0; k < nodes_.size(); ++k)
      if (!moves_[k] && !take_slopes(k)) return false;
    adjoints_.back() = 1;
    for (Place k = static_cast<Place>(nodes_.size()); k-- > 0;) {
      if (adjoints_[k] == 0 || inputs_[k].empty()) continue;
      for (const Slope& in : inputs_[k]) adjoints_[in.place] += adjoints_[k] * in.value;
      if (!take_curvature(k)) return false;
    }
    return moves_.back();
  }

  bool take_slopes(Place k) {
    const Expr node = nodes_[k];
    std::vector<std::size_t> moving;
    for (std::size_t i = 0; i < node.size(); ++i)
      if (moves_[place(node, i)]) moving.push_back(i);
    if (moving.empty()) return true;
    moves_[k] = true;
    for (const std::size_t i : moving) {
      const double slope = node.is(Kind::Sum)       ? 1
                           : node.is(Kind::Product) ? product_without(node, i, i)
                                                    : power_slope(node);
      if (!std::isfinite(slope)) return false;
      inputs_[k].push_back({place(node, i), slope});
      ++uses_[place(node, i)];
    }
    if (node.is(Kind::Sum)) return true;
    return node.is(Kind::Product) ? moving.size() <= most_factors : node.is(Kind::Power) && !moves_[place(node, 1)];
  }

  bool take_curvature(Place k) {
    const Expr node = nodes_[k];
    if (node.is(Kind::Sum)) return true;
    if (node.is(Kind::Power)) {
      const double x = values_[place(node, 0)], e = values_[place(node, 1)];
      const double second = e * (e - 1) * (e == 2 ? 1 : std::pow(x, e - 2));
      add(place(node, 0), place(node, 0), adjoints_[k] * second);
      return std::isfinite(second);
    }
    for (std::size_t i = 0; i < node.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (moves_[place(node, i)] && moves_[place(node, j)])
          add(place(node, i), place(node, j), adjoints_[k] * product_without(node, i, j));
    return true;
  }

  Place place(Expr node, std::size_t argument) const { return places_.at(node.argument_ids()[argument]); }

  double product_without(Expr node, std::size_t i, std::size_t j) const {
    double out = 1;
    for (std::size_t k = 0; k < node.size(); ++k)
      if (k != i && k != j) out *= values_[place(node, k)];
    return out;
  }

  double power_slope(Expr node) const {
    if (!node.is(Kind::Power)) return std::nan("");
    const double e = values_[place(node, 1)];
    return e * std::pow(values_[place(node, 0)], e - 1);
  }

  /// x_k = Σ slope · input in every entry that x_k has.
  void replace(Place k) {
    for (const auto& [j, h] : rows_[k])
      for (const Slope& in : inputs_[k]) {
        if (j != k)
          add(in.place, j, (j == in.place ? 2 : 1) * in.value * h);
        else
          for (const Slope& other : inputs_[k])
            if (other.place <= in.place) add(in.place, other.place, in.value * other.value * h);
      }
    leave(k);
    for (const Slope& in : inputs_[k])
      if (--uses_[in.place] == 0) get_ready(in.place);
  }

  bool minimize(Place k) {
    const auto diagonal = rows_[k].find(k);
    if (diagonal == rows_[k].end() || !(diagonal->second > smallest_pivot * sizes_[k])) return false;
    for (const auto& [i, hi] : rows_[k])
      for (const auto& [j, hj] : rows_[k])
        if (i != k && j != k && j <= i) add(i, j, -hi * hj / diagonal->second);
    leave(k);
    return true;
  }

  void add(Place i, Place j, double h) {
    if (h == 0) return;
    ++updates_;
    if (i == j) sizes_[i] += std::abs(h);
    change(i, j, h);
    if (i != j) change(j, i, h);
  }

  void change(Place i, Place j, double h) {
    const std::size_t before = rows_[i].size();
    rows_[i][j] += h;
    if (rows_[i].size() != before) moved_in_line(i, before);
  }

  void leave(Place k) {
    for (const auto& entry : rows_[k])
      if (const Place j = entry.first; j != k) {
        const std::size_t before = rows_[j].size();
        rows_[j].erase(k);
        moved_in_line(j, before);
      }
    rows_[k].clear();
  }

  void get_ready(Place k) {
    if (inputs_[k].empty())
      ready_rates_.emplace(rows_[k].size(), k);
    else
      ready_nodes_.insert(k);
  }

  void moved_in_line(Place k, std::size_t before) {
    if (ready_rates_.erase({before, k}) != 0) ready_rates_.emplace(rows_[k].size(), k);
  }

  std::vector<Expr> nodes_;
  std::unordered_map<NodeId, Place> places_;
  std::vector<double> values_, adjoints_;
  std::vector<bool> moves_;                              // depends on a velocity
  std::vector<std::vector<Slope>> inputs_;               // empty: a velocity
  std::vector<std::size_t> uses_;                        // nodes not yet replaced that hold it
  std::vector<std::unordered_map<Place, double>> rows_;  // of the form, symmetric
  std::vector<double> sizes_;                            // Σ |terms| of a diagonal entry
  std::set<Place> ready_nodes_;                          // the newest first: what stands at the tip of a chain
  std::set<std::pair<std::size_t, Place>> ready_rates_;  // by their entries in the form, few first
  double updates_ = 0;
  bool complete_ = false;
};

}  // namespace

bool kinetic_form_is_definite(const Subject& s, const Bindings& point) { return KineticForm(s, point).is_definite(); }

}  // namespace maupertuis::lint_rules
