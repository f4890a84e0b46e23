#include "kernel/disks/least_modulus.hpp"
#include "kernel/disks/node.hpp"
#include "kernel/disks/residual_terms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

/// What of a program is bounded, and what its rows tell of it.
namespace maupertuis {
namespace {

/// The degree of what depends on a coordinate: its series has no end.
constexpr int not_polynomial = 1'000'000;
constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

Disks::~Disks() = default;
Disks::Disks(Disks&&) noexcept = default;

Disks::Disks(const Program& program, std::span<const std::uint32_t> slots)
    : program_(program), rows_(std::make_unique<ResidualTerms>(program)) {
  std::vector<bool> made(program.slots, false);
  maker_.assign(program.slots, -1);
  for (const maupertuis::Term& t : program.terms) terms_.push_back({0, t.coefficient, t.a, t.b, t.shift});
  for (const Section section : {Dynamics, Along})
    for (const Run& run : program.runs[section])
      for (std::uint32_t i = run.first; i < run.last; ++i) {
        const Instruction& instruction = program.instructions[i];
        maker_[instruction.out] = static_cast<int>(nodes_.size());
        nodes_.push_back({instruction, 0});
        made[instruction.out] = true;
        if (instruction.second != no_slot) made[instruction.second] = true;
      }
  for (const Slot slot : program.residual) residual_.push_back(slot == no_slot ? -1 : maker_[slot]);
  for (auto* values : {&reach_, &tail_, &low_, &high_, &reach_before_, &tail_before_, &series_, &rounding_})
    values->assign(program.slots, 0.0);
  for (auto& values : rate_reach_) values.assign(program.unknowns, 0.0);
  upper_.assign(program.unknowns, 0.0);
  find_degrees();
  find_series(made);
  find_bases();
  find_needs(slots, true);
}

void Disks::bound_only(std::span<const std::uint32_t> slots) {
  bounds_residual_ = false;
  needed_.clear();
  derived_.clear();
  most_rates_ = 0;
  find_needs(slots, false);
  few_.clear();
  for (const std::uint32_t at : needed_)
    for (const Slot slot : {nodes_[at].instruction.out, nodes_[at].instruction.second})
      if (slot != no_slot && has_series_[slot]) few_.push_back(slot);
  constexpr std::size_t much_less = 8;
  only_few_ = few_.size() * much_less < program_.stored_end[2];
}

/// Backwards from the tails that are asked for. The tail of a sum needs the tails of its terms and the reaches of what
/// it multiplies; that of a function needs the reach of its operand.
void Disks::find_needs(std::span<const std::uint32_t> slots, bool residual) {
  needs_reach_.assign(program_.slots, 0);
  needs_tail_.assign(program_.slots, 0);
  for (const Slot slot : program_.residual)
    if (residual && slot != no_slot) needs_tail_[slot] = 1;
  for (const Slot slot : slots) needs_tail_[slot] = needs_reach_[slot] = 1;
  for (std::size_t at = nodes_.size(); at-- > 0;) {
    const Instruction& i = nodes_[at].instruction;
    const auto needs = [&](Slot slot) { return slot != no_slot && (needs_tail_[slot] || needs_reach_[slot]); };
    if (!needs(i.out) && !needs(i.second)) continue;
    needed_.push_back(static_cast<std::uint32_t>(at));
    need_operands(nodes_[at]);
  }
  std::reverse(needed_.begin(), needed_.end());
  find_derived();
}

/// What is differentiated other than coordinates, and what that is made of.
void Disks::find_derived() {
  std::vector<bool> wanted(program_.slots, false);
  const auto want = [&](Slot slot) {
    if (slot != no_slot && slot >= program_.unknowns && slot != program_.time) wanted[slot] = true;
  };
  for (const std::uint32_t at : needed_) {
    const Instruction& i = nodes_[at].instruction;
    if (i.op == Op::Derivative && needs_reach_[i.out]) want(i.a);
    const std::uint32_t last = i.op == Op::Linear ? i.last_term : i.op == Op::Products ? i.first_product : i.first_term;
    for (std::uint32_t t = i.first_term; t < last && needs_reach_[i.out]; ++t)
      if (terms_[t].shift > 0) want(terms_[t].a);
  }
  for (auto at = needed_.rbegin(); at != needed_.rend(); ++at) {
    const Instruction& i = nodes_[*at].instruction;
    if (!wanted[i.out] && !(i.second != no_slot && wanted[i.second])) continue;
    derived_.push_back(*at);
    want(i.a), want(i.b);
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) want(terms_[t].a), want(terms_[t].b);
  }
  std::reverse(derived_.begin(), derived_.end());
}

void Disks::need_operands(const Node& node) {
  const Instruction& i = node.instruction;
  const auto need = [this](Slot slot, std::uint32_t shift, bool reach) {
    needs_tail_[slot] = 1;
    if (!reach) return;
    needs_reach_[slot] = 1;
    if (slot < program_.unknowns) most_rates_ = std::max(most_rates_, static_cast<int>(shift));
  };
  const bool hands_on = i.op == Op::Linear || i.op == Op::Products || i.op == Op::Derivative || i.op == Op::Select;
  const bool reach = needs_reach_[i.out] != 0;
  for (const Slot slot : {i.a, i.b})
    if (slot != no_slot) need(slot, i.op == Op::Derivative ? 1 : 0, !hands_on || reach);
  if (!hands_on) return;
  for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
    const Term& term = terms_[t];
    const bool is_product = i.op == Op::Products && t >= i.first_product;
    need(term.a, term.shift, is_product || reach);
    if (is_product) need(term.b, 0, true);
  }
}

/// Polynomials in t alone have no tail. A power with a constant exponent is not looked into.
void Disks::find_degrees() {
  degree_.assign(program_.slots, 0);
  for (Slot i = 0; i < program_.unknowns; ++i) degree_[i] = not_polynomial;
  if (program_.time != no_slot) degree_[program_.time] = 1;
  linear_.assign(program_.slots, true);
  const auto product = [](int a, int b) { return std::min(not_polynomial, a + b); };
  for (const Node& node : nodes_) {
    const Instruction& i = node.instruction;
    int degree = not_polynomial;
    bool linear = false;
    if (i.op == Op::Linear || i.op == Op::Products || i.op == Op::Select) {
      degree = 0, linear = true;
      for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
        const Term& term = terms_[t];
        const bool is_product = i.op == Op::Products && t >= i.first_product;
        degree = std::max(degree, is_product ? product(degree_[term.a], degree_[term.b]) : degree_[term.a]);
        linear =
            linear && linear_[term.a] && (!is_product || product(degree_[term.a], degree_[term.b]) < not_polynomial);
      }
    } else if (i.op == Op::Square) {
      degree = product(degree_[i.a], degree_[i.a]);
      linear = degree < not_polynomial;
    } else if (i.op == Op::Derivative) {
      degree = degree_[i.a];
      linear = linear_[i.a];
    }
    degree_[i.out] = degree;
    linear_[i.out] = linear;
    if (i.second != no_slot) degree_[i.second] = not_polynomial, linear_[i.second] = false;
  }
  for (const Slot slot : program_.residual)
    residual_has_tails_ = residual_has_tails_ || (slot != no_slot && !linear_[slot]);
}

/// Stored slots hold all orders; so do those that nothing corrects, since no acceleration moves them.
void Disks::find_series(const std::vector<bool>& made) {
  has_series_.assign(program_.slots, 0);
  for (Slot slot = static_cast<Slot>(program_.unknowns); slot < program_.slots; ++slot) {
    if (!made[slot]) continue;
    const bool stored = slot < program_.stored_end[2];
    has_series_[slot] = stored || program_.tangent_lags[slot] == Program::unmoved;
    if (has_series_[slot] && !stored) alone_.push_back(slot);
  }
}

void Disks::set_constants(const double* constants) {
  constants_ = constants;
  rows_->set_constants(constants);
  for (Term& term : terms_) term.size = std::abs(constants[term.coefficient]);
  for (Node& node : nodes_)
    if (node.instruction.op == Op::Power) node.exponent = constants[node.instruction.constant];
}

int Disks::last_order(std::uint32_t slot) const { return now_.order + 1 - program_.lags[slot]; }

double Disks::centre(std::uint32_t slot, std::uint32_t shift) const {
  if (shift == 0) return coefficient(0, slot);
  const double c = coefficient(static_cast<int>(shift), slot) / now_.unit;
  return shift == 1 ? c : 2 * c / now_.unit;
}

void Disks::begin(const SlotCoefficients& coefficients) {
  now_ = coefficients;
  rounding_length_ = 0;
  previous_ = radius_ = 0;
  rows_->begin();
  powers_.resize(static_cast<std::size_t>(now_.order) + 8);
}

void Disks::evaluate(double radius, Depth depth) {
  previous_ = radius_;
  radius_ = radius;
  if (previous_ > 0) {
    reach_before_.swap(reach_);
    tail_before_.swap(tail_);
  }
  find_powers();
  const double ratio = previous_ > radius ? radius / previous_ : 0;
  for (std::size_t lag = 0; lag < passed_on_.size(); ++lag)
    passed_on_[lag] = ratio > 0 ? std::pow(ratio, now_.order + 2 - static_cast<int>(lag)) / (1 - ratio) : infinity;
  evaluate_coordinates();
  by_coefficients_ = depth == Depth::Coefficients && previous_ > radius_;
  if (by_coefficients_) evaluate_series();
  if (program_.one != no_slot) set(program_.one, {0, 0, 1, 1});
  if (program_.time != no_slot) {
    const double t = std::abs(centre(program_.time));
    set(program_.time, {radius, 0, std::max(0.0, t - radius), t + radius});
  }
  for (const std::uint32_t at : depth == Depth::Derivatives ? derived_ : needed_) evaluate(nodes_[at]);
  if (has_bases() && bounds_residual_ && depth != Depth::Derivatives) add_disk();
}

void Disks::add_disk() {
  rows_->add_disk(radius_, [this](const ResidualTerms::Term& term) {
    if (term.b == no_slot) return shifted_tail({1, 0, term.a, no_slot, term.shift});
    return degree_[term.a] + degree_[term.b] < now_.order ? 0.0 : product(term.a, term.b).tail;
  });
}

void Disks::find_left_out(double h, std::uint32_t without) { rows_->find_left_out(h, now_.order, without); }
double Disks::residual_left_out(std::size_t j) const { return rows_->left_out(j); }
const std::vector<double>& Disks::radii() const { return rows_->radii(); }

/// In four strands, since each product waits for the one before.
void Disks::find_powers() {
  const double x = radius_ / now_.unit, second = x * x, fourth = second * second;
  double* const power = powers_.data();
  power[0] = 1, power[1] = x, power[2] = second, power[3] = second * x;
  for (std::size_t k = 4; k < powers_.size(); ++k) power[k] = power[k - 4] * fourth;
}

/// q, q̇ and q̈ of the coordinates, and of what multipliers are the second derivatives of: polynomials that are known
/// whole.
void Disks::evaluate_coordinates() {
  const int degree = now_.order + 1, half = now_.order / 2;
  for (std::size_t i = 0; i < program_.unknowns; ++i) {
    const Slot slot = static_cast<Slot>(i);
    if (!needs_reach_[slot]) continue;
    const auto sum = [&](int first, int end) {
      double even = 0, odd = 0;
      for (int k = first; k < end; k += 2) {
        even += std::abs(coefficient(k, slot)) * powers_[static_cast<std::size_t>(k)];
        if (k + 1 < end) odd += std::abs(coefficient(k + 1, slot)) * powers_[static_cast<std::size_t>(k) + 1];
      }
      return even + odd;
    };
    upper_[i] = sum(half, degree + 1);
    const double reach = sum(1, half) + upper_[i];
    for (int shift = 1; shift <= most_rates_; ++shift)
      rate_reach_[static_cast<std::size_t>(shift) - 1][i] = reach_of_rate(slot, shift);
    const double c = std::abs(coefficient(0, slot));
    reach_[slot] = reach, tail_[slot] = 0;
    low_[slot] = std::max(0.0, c - reach), high_[slot] = c + reach;
  }
}

double Disks::reach_of_rate(std::uint32_t slot, int shift) const {
  double sum = 0;
  for (int k = shift + 1; k <= now_.order + 1; ++k) {
    const double weight = shift == 1 ? k : static_cast<double>(k) * (k - 1);
    sum += std::abs(coefficient(k, slot)) * (weight * powers_[static_cast<std::size_t>(k - shift)]);
  }
  return sum / (shift == 1 ? now_.unit : now_.unit * now_.unit);
}

/// Σ_{k≥1} |f_k| r^k of slots whose coefficients are in the rows.
void Disks::evaluate_series() {
  Slot first = static_cast<Slot>(program_.unknowns);
  for (int lag = 0; lag <= 2 && !only_few_; ++lag) {
    const Slot last = std::max(first, program_.stored_end[static_cast<std::size_t>(lag)]);
    std::fill(series_.begin() + first, series_.begin() + last, 0.0);
    for (int k = 1; k <= now_.order + 1 - lag; ++k) {
      const double* const row = now_.rows + static_cast<std::size_t>(k) * now_.stride;
      const double power = powers_[static_cast<std::size_t>(k)];
      if (now_.step == 1)
        for (Slot s = first; s < last; ++s) series_[s] += std::abs(row[s]) * power;
      else
        for (Slot s = first; s < last; ++s) series_[s] += std::abs(row[s * now_.step]) * power;
    }
    first = last;
  }
  for (const Slot slot : only_few_ ? few_ : alone_) {
    double sum = 0;
    for (int k = 1; k <= now_.order + 1 - std::max<int>(0, program_.lags[slot]); ++k)
      sum += std::abs(coefficient(k, slot)) * powers_[static_cast<std::size_t>(k)];
    series_[slot] = sum;
  }
}

/// What an instruction says of its result, and where the coefficients and a larger disk say less, those.
void Disks::set(std::uint32_t slot, Bounds b) {
  const double c = std::abs(centre(slot));
  if (!(b.reach < infinity)) b.reach = infinity;
  if (!(b.tail < infinity)) b.tail = infinity;
  if (by_coefficients_ && has_series_[slot]) {
    const int lag = std::max<int>(0, program_.lags[slot]);
    const double by_series = series_[slot] + tail_before_[slot] * passed_on_[static_cast<std::size_t>(lag)];
    if (by_series < b.reach) b.reach = by_series;
  }
  if (is_base_[slot]) b.low = std::max(b.low, low_of_base(slot));
  const double least = c - b.reach, most = c + b.reach;
  reach_[slot] = b.reach;
  tail_[slot] = b.tail;
  low_[slot] = b.low > least ? b.low : std::max(0.0, least);
  high_[slot] = b.high < most ? b.high : most;
}

double Disks::residual_tail(std::size_t j) const {
  return residual_[j] < 0 ? 0.0 : tail_[nodes_[static_cast<std::size_t>(residual_[j])].instruction.out];
}

double Disks::residual_rounding(std::size_t j, double length) {
  if (residual_[j] < 0) return 0;
  if (rounding_length_ != length) find_roundings(length);
  return rounding_[nodes_[static_cast<std::size_t>(residual_[j])].instruction.out];
}

}  // namespace maupertuis
