#include <maupertuis/switches.hpp>

#include "symbolic/evaluate/branch_search.hpp"
#include "symbolic/evaluate/real100.hpp"
#include "symbolic/evaluate/real_numbers.hpp"
#include "symbolic/evaluate/switch_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

/// A jump is told from a kink by its size at two distances: √|x| at 1e-40 is small beside √|x| at 1e-20, step x is not.
/// So no scale of the function is needed, and no tolerance beside the digits.
namespace maupertuis {
namespace {

using evaluation::Branches;
using evaluation::BranchSearch;
using evaluation::Position;
using evaluation::Real100;
using evaluation::Tape;

const Real100 far_off("1e-20"), close_by("1e-40"), root_width("1e-90"), rounding("1e-70"), beyond_secant("1e-12");
constexpr double falls = 1e-2;        // what vanishes like a power of the distance above 0.1 falls by at least that
constexpr double grows = 1e3;         // from 1e-20 to 1e-40: a singularity
constexpr double beside_root = 1e-9;  // of its size: what switches there as well is evaluated on both of its sides
constexpr int most_halvings = 700;
constexpr int most_brackets_of_a_line = 3;
constexpr std::size_t most_together = 24;  // switches whose combinations of signs are looked for

/// A point and a stretch along one symbol over which g changes its sign.
struct Bracket {
  Bindings point;
  Expr symbol;
  double low = 0, high = 0;
};

std::vector<Real100> precise_values(const Tape& tape, const Bindings& at, Expr symbol, const Real100& value) {
  evaluation::RealNumbers<Real100> numbers([&](Expr s) { return s == symbol ? value : Real100(at.at(s)); });
  std::vector<Real100> nodes, out;
  evaluation::run(tape, numbers, nodes);
  for (const Position root : tape.roots()) out.push_back(nodes[root]);
  return out;
}

/// Where g = 0 within the bracket, by regula falsi with a bisection every other turn; g rises or falls there.
struct Root {
  Real100 at;
  bool rises = false;
};

std::optional<Root> refine(const Tape& g, const Bracket& bracket) {
  const auto value = [&](const Real100& x) { return precise_values(g, bracket.point, bracket.symbol, x).front(); };
  Real100 low = bracket.low, high = bracket.high, at_low = value(low), at_high = value(high);
  if (!isfinite(at_low) || !isfinite(at_high) || at_low * at_high >= 0) return std::nullopt;
  const bool rises = at_high > 0;
  const Real100 narrow = root_width * (abs(low) + abs(high));
  for (int turn = 0; turn < most_halvings && high - low > narrow; ++turn) {
    Real100 middle = (low + high) / 2;
    if (turn % 2 == 1) {
      // A little beyond the secant's root, so that it closes in from both sides.
      const Real100 secant = low - at_low * (high - low) / (at_high - at_low), margin = (high - low) * beyond_secant;
      middle = turn % 4 == 1 ? secant - margin : secant + margin;
      if (!(middle > low && middle < high)) middle = (low + high) / 2;
    }
    const Real100 here = value(middle);
    if (!isfinite(here)) return std::nullopt;
    if (here == 0) return Root{middle, rises};
    if ((here > 0) == rises)
      high = middle, at_high = here;
    else
      low = middle, at_low = here;
  }
  return Root{(low + high) / 2, rises};
}

double difference(const Real100& above_far, const Real100& below_far, const Real100& above, const Real100& below) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const Real100* x : {&above_far, &below_far, &above, &below})
    if (!isfinite(*x)) return none;
  const Real100 far = abs(above_far - below_far), near = abs(above - below);
  const Real100 size = abs(above) + abs(below), far_size = abs(above_far) + abs(below_far);
  if (size > grows * far_size && near > grows * far) return none;
  if (near <= rounding * (size + far_size) || near <= Real100(falls) * far) return 0;
  return static_cast<double>(Real100(above - below));
}

/// Those next to the base first.
std::vector<Bracket> brackets(const BranchSearch& own, const Bindings& base, std::size_t symbol) {
  std::vector<Bracket> out;
  const Expr x = own.moving()[symbol];
  Bindings point = base;
  double before = 0, at_before = 0;
  std::vector<double> tried = own.values_to_try(symbol);
  // A root at the largest constant of all lies between two values as well.
  tried.insert(tried.begin(), 2 * tried.front());
  tried.push_back(2 * tried.back());
  for (const double value : tried) {
    point[x] = value;
    const double here = own.values(point).front();
    if (!(std::isfinite(here)) || here == 0) continue;  // the next one brackets a root that is met exactly
    if (at_before * here < 0) out.push_back({base, x, before, value});
    before = value, at_before = here;
  }
  const double own_value = base.at(x);
  std::stable_sort(out.begin(), out.end(), [&](const Bracket& a, const Bracket& b) {
    return std::abs(a.low / 2 + a.high / 2 - own_value) < std::abs(b.low / 2 + b.high / 2 - own_value);
  });
  if (out.size() > most_brackets_of_a_line) out.resize(most_brackets_of_a_line);
  return out;
}

SwitchSample both_sides(Branches& functions, std::span<const Expr> beside, const Bracket& bracket, const Root& root) {
  SwitchSample out;
  const Real100 size = abs(root.at) + Real100(bracket.high - bracket.low);
  out.at = bracket.point;
  Bindings from = out.at, to = out.at;
  from[bracket.symbol] = static_cast<double>(Real100(root.at - size * Real100(beside_root)));
  to[bracket.symbol] = static_cast<double>(Real100(root.at + size * Real100(beside_root)));
  out.at[bracket.symbol] = static_cast<double>(root.at);
  std::vector<Expr> around = functions.in_force(from, to);
  around.insert(around.end(), beside.begin(), beside.end());
  const Tape tape(around);
  if (abs(root.at) < size * Real100(1e-16)) out.at[bracket.symbol] = 0;
  const auto values = [&](const Real100& off) {
    return precise_values(tape, bracket.point, bracket.symbol,
                          root.rises ? root.at + size * off : root.at - size * off);
  };
  const auto above_far = values(far_off), below_far = values(-far_off), above = values(close_by),
             below = values(-close_by);
  for (std::size_t i = 0; i < above.size(); ++i) {
    out.below.push_back(static_cast<double>(below[i]));
    out.above.push_back(static_cast<double>(above[i]));
    out.jump.push_back(difference(above_far[i], below_far[i], above[i], below[i]));
  }
  return out;
}

}  // namespace

struct SwitchSampler::Impl {
  Impl(std::vector<Expr> f, std::span<const Expr> switches, SwitchSearch s)
      : search(std::move(s)), functions(std::move(f)) {
    bases.push_back(search.center);
    BranchSearch all(switches, search);
    if (all.moving().size() < 2 && search.moving.size() < 2) return;  // the root is the same from any other base
    if (switches.size() <= most_together) {
      const BranchPoints branches = points_in_branches(switches, search);
      bases.insert(bases.end(), branches.points.begin(), branches.points.end());
    }
    for (int k = 0; k < search.points; ++k) bases.push_back(all.draw());
  }

  std::vector<SwitchSample> sample(Expr which, std::span<const Expr> beside) {
    std::vector<SwitchSample> out;
    const Tape g({&which, 1});
    const BranchSearch own({&which, 1}, search);
    const auto enough = [&] { return out.size() >= static_cast<std::size_t>(search.points); };
    for (std::size_t k = 0; !enough() && k < bases.size(); ++k)
      for (std::size_t i = 0; i < own.moving().size() && !enough(); ++i)
        for (const Bracket& bracket : brackets(own, bases[k], i))
          if (const auto root = refine(g, bracket)) out.push_back(both_sides(functions, beside, bracket, *root));
    return out;
  }

  SwitchSearch search;
  Branches functions;
  std::vector<Bindings> bases;
};

SwitchSampler::SwitchSampler(std::vector<Expr> functions, SwitchSearch search) {
  const std::vector<Expr> switches = switches_of(functions);
  impl_ = std::make_unique<Impl>(std::move(functions), switches, std::move(search));
}
SwitchSampler::~SwitchSampler() = default;
SwitchSampler::SwitchSampler(SwitchSampler&&) noexcept = default;
SwitchSampler& SwitchSampler::operator=(SwitchSampler&&) noexcept = default;

const std::vector<Expr>& SwitchSampler::functions() const { return impl_->functions.functions(); }
const SwitchSearch& SwitchSampler::search() const { return impl_->search; }
std::vector<SwitchSample> SwitchSampler::sample(Expr g, std::span<const Expr> beside) const {
  return impl_->sample(g, beside);
}

std::vector<SwitchSample> sample_switches(std::span<const Expr> functions, std::span<const Expr> switches,
                                          const SwitchSearch& search) {
  std::vector<SwitchSample> out;
  if (switches.empty()) return out;
  SwitchSampler::Impl sampler({functions.begin(), functions.end()}, switches, search);
  for (std::size_t k = 0; k < switches.size(); ++k)
    for (SwitchSample& x : sampler.sample(switches[k], {})) {
      x.which = k;
      out.push_back(std::move(x));
    }
  return out;
}

}  // namespace maupertuis
