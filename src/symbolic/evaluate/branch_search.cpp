#include "symbolic/evaluate/branch_search.hpp"

#include "symbolic/evaluate/real_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace maupertuis::evaluation {
namespace {

constexpr double unreached = 1e6;  // of one sign that is undefined
constexpr int rounds = 4;
constexpr std::size_t most_constants = 40;

/// What does not move in a tape: numbers, symbols that keep their value, and all that is made of them alone, as l sin α
/// and a b, at which a switch may stand. Those that stand beside what moves come first.
std::vector<double> constants_of(const Tape& tape, const std::vector<Expr>& moving, const Bindings& center) {
  RealNumbers<double> numbers([&](Expr symbol) { return center.at(symbol); });
  std::vector<double> values;
  run(tape, numbers, values);
  std::vector<bool> moves(tape.size(), false), beside(tape.size(), false);
  for (Position at = 0; at < tape.size(); ++at) {
    const Expr e = tape.expression(at);
    moves[at] = e.is_symbol() && std::find(moving.begin(), moving.end(), e) != moving.end();
    for (const Position argument : tape.arguments(at)) moves[at] = moves[at] || moves[argument];
    if (!moves[at]) continue;
    for (const Position argument : tape.arguments(at)) beside[argument] = true;
  }
  std::vector<double> out;
  for (const bool first : {true, false})
    for (Position at = 0; at < tape.size() && out.size() < most_constants; ++at) {
      const double x = std::abs(values[at]);
      const bool counts = !moves[at] && beside[at] == first && x > 1e-12 && x < 1e12;
      if (counts && std::find(out.begin(), out.end(), x) == out.end()) out.push_back(x);
    }
  return out;
}

/// In rising order, with what lies halfway between two.
std::vector<double> with_midpoints(const std::set<double>& values) {
  std::vector<double> out;
  for (const double x : values) {
    if (!out.empty()) out.push_back(out.back() / 2 + x / 2);
    out.push_back(x);
  }
  return out;
}

}  // namespace

BranchSearch::BranchSearch(std::span<const Expr> functions, const SwitchSearch& search)
    : tape_(functions), search_(search), random_(search.seed) {
  for (const Expr& symbol : search.moving)
    for (Position at = 0; at < tape_.size(); ++at)
      if (tape_.expression(at) == symbol) moving_.push_back(symbol);
  const std::vector<double> constants = constants_of(tape_, moving_, search.center);
  for (const Expr& symbol : moving_) {
    std::set<double> values{0, search.center.at(symbol)};
    for (const double c : constants) values.insert({c, -c});
    for (int k = -8; k <= 12; ++k) values.insert({std::pow(10, k / 2.0), -std::pow(10, k / 2.0)});
    tried_.push_back(with_midpoints(values));
  }
}

Bindings BranchSearch::draw() {
  const auto unit = [&] { return std::generate_canonical<double, 53>(random_); };
  Bindings out = search_.center;
  for (const Expr& symbol : search_.moving) {
    const auto known = std::find(moving_.begin(), moving_.end(), symbol);
    const double u = 2 * unit() - 1, own = search_.center.at(symbol), pick = unit(), way = unit();
    if (known != moving_.end() && way < 0.4) {
      const std::vector<double>& tried = tried_[static_cast<std::size_t>(known - moving_.begin())];
      out[symbol] = tried[static_cast<std::size_t>(pick * static_cast<double>(tried.size()))] * (1 + 0.3 * u);
    } else {
      out[symbol] =
          way < 0.8 ? own + 0.3 * u * (own != 0 ? std::abs(own) : 1) : std::copysign(std::pow(10, 4 * pick - 2), u);
    }
  }
  return out;
}

std::vector<double> BranchSearch::values(const Bindings& at) const {
  RealNumbers<double> numbers([&](Expr symbol) { return at.at(symbol); });
  std::vector<double> nodes, out;
  run(tape_, numbers, nodes);
  for (const Position root : tape_.roots()) out.push_back(nodes[root]);
  return out;
}

Signs BranchSearch::signs(const Bindings& at) const {
  Signs out;
  for (const double g : values(at)) out.push_back(static_cast<std::int8_t>((g > 0) - (g < 0)));
  return out;
}

/// 0 where the signs are as wanted; each that is not counts 1 to 2, the farther the more.
double BranchSearch::distance(const Bindings& at, const Signs& wanted) const {
  const std::vector<double> g = values(at);
  double sum = 0;
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (wanted[i] == 0 || wanted[i] * g[i] > 0) continue;
    const double off = std::abs(g[i]);
    sum += std::isfinite(off) ? 1 + std::sqrt(off) / (1 + std::sqrt(off)) : unreached;
  }
  return sum;
}

bool BranchSearch::reach(Bindings& point, const Signs& wanted) const {
  double best = distance(point, wanted);
  for (int round = 0; round < rounds && best > 0; ++round) {
    const double before = best;
    for (std::size_t i = 0; i < moving_.size() && best > 0; ++i) {
      double kept = point[moving_[i]];
      for (const double x : tried_[i]) {
        point[moving_[i]] = x;
        if (const double here = distance(point, wanted); here < best) best = here, kept = x;
      }
      point[moving_[i]] = kept;
    }
    if (best >= before) break;
  }
  return best == 0;
}

}  // namespace maupertuis::evaluation
