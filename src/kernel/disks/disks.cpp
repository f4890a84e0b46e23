#include "kernel/disks/node.hpp"

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

Disks::Disks(const Program& program) : program_(program) {
  std::vector<bool> made(program.slots, false);
  std::vector<int> maker(program.slots, -1);
  for (const maupertuis::Term& t : program.terms) terms_.push_back({0, t.coefficient, t.a, t.b, t.shift});
  for (const Section section : {Dynamics, Along})
    for (const Run& run : program.runs[section])
      for (std::uint32_t i = run.first; i < run.last; ++i) {
        const Instruction& instruction = program.instructions[i];
        maker[instruction.out] = static_cast<int>(nodes_.size());
        nodes_.push_back({instruction, 0});
        made[instruction.out] = true;
        if (instruction.second != no_slot) made[instruction.second] = true;
      }
  for (const Slot slot : program.residual) residual_.push_back(slot == no_slot ? -1 : maker[slot]);
  for (auto* values : {&reach_, &tail_, &low_, &high_, &reach_before_, &tail_before_, &series_, &rounding_}) values->assign(program.slots, 0.0);
  for (auto& values : rate_reach_) values.assign(program.unknowns, 0.0);
  find_degrees();
  find_series(made);
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
        linear = linear && linear_[term.a] && (!is_product || product(degree_[term.a], degree_[term.b]) < not_polynomial);
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
  for (const Slot slot : program_.residual) residual_has_tails_ = residual_has_tails_ || (slot != no_slot && !linear_[slot]);
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
  powers_.resize(static_cast<std::size_t>(now_.order) + 8);
}

void Disks::evaluate(double radius) {
  previous_ = radius_;
  radius_ = radius;
  if (previous_ > 0) {
    reach_before_.swap(reach_);
    tail_before_.swap(tail_);
  }
  const double x = radius / now_.unit;
  powers_[0] = 1;
  for (std::size_t k = 1; k < powers_.size(); ++k) powers_[k] = powers_[k - 1] * x;
  const double ratio = previous_ > radius ? radius / previous_ : 0;
  for (std::size_t lag = 0; lag < passed_on_.size(); ++lag)
    passed_on_[lag] = ratio > 0 ? std::pow(ratio, now_.order + 2 - static_cast<int>(lag)) / (1 - ratio) : infinity;
  evaluate_coordinates();
  evaluate_series();
  if (program_.one != no_slot) set(program_.one, {0, 0, 1, 1});
  if (program_.time != no_slot) {
    const double t = std::abs(centre(program_.time));
    set(program_.time, {radius, 0, std::max(0.0, t - radius), t + radius});
  }
  for (const Node& node : nodes_) evaluate(node);
}

/// q, q̇ and q̈ of the coordinates, and of what multipliers are the second derivatives of: polynomials that are known whole.
void Disks::evaluate_coordinates() {
  const std::size_t n = program_.unknowns;
  std::fill_n(reach_.begin(), n, 0.0);
  for (auto& values : rate_reach_) std::fill(values.begin(), values.end(), 0.0);
  for (int k = 1; k <= now_.order + 1; ++k) {
    const double* const row = now_.rows + static_cast<std::size_t>(k) * now_.stride;
    const double power = powers_[static_cast<std::size_t>(k)];
    const double rate = k > 1 ? k * powers_[static_cast<std::size_t>(k - 1)] / now_.unit : 0;
    const double second = k > 2 ? k * (k - 1) * powers_[static_cast<std::size_t>(k - 2)] / (now_.unit * now_.unit) : 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double c = std::abs(row[i * now_.step]);
      reach_[i] += c * power;
      rate_reach_[0][i] += c * rate;
      rate_reach_[1][i] += c * second;
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double c = std::abs(coefficient(0, static_cast<Slot>(i)));
    set(static_cast<Slot>(i), {reach_[i], 0, std::max(0.0, c - reach_[i]), c + reach_[i]});
  }
}

/// Σ_{k≥1} |f_k| r^k of slots whose coefficients are in the rows.
void Disks::evaluate_series() {
  if (!(previous_ > radius_)) return;
  Slot first = static_cast<Slot>(program_.unknowns);
  for (int lag = 0; lag <= 2; ++lag) {
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
  for (const Slot slot : alone_) {
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
  if (has_series_[slot] && previous_ > radius_) {
    const int lag = std::max<int>(0, program_.lags[slot]);
    const double by_series = series_[slot] + tail_before_[slot] * passed_on_[static_cast<std::size_t>(lag)];
    if (by_series < b.reach) b.reach = by_series;
  }
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
