#include "analysis/invariants/completeness.hpp"

#include "analysis/invariants/field_linear_algebra.hpp"
#include "analysis/invariants/given_numbers.hpp"
#include "analysis/invariants/motion_sampler.hpp"
#include "symbolic/evaluate/normalize.hpp"

#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <map>

namespace maupertuis::invariants {
namespace {

using evaluation::mix;
using Order = std::vector<int>;  // exponents of (q − q₀, t − t₀)

constexpr std::size_t most_unknowns = 700, most_nodes = 30'000;

int total(const Order& a) {
  int sum = 0;
  for (const int x : a) sum += x;
  return sum;
}

/// All exponents of total degree ≤ `degree`, by degree.
std::vector<Order> orders_up_to(std::size_t variables, int degree) {
  std::vector<Order> out{Order(variables, 0)};
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (total(out[i]) == degree) continue;
    std::size_t last = variables;
    while (last > 0 && out[i][last - 1] == 0) --last;
    for (std::size_t k = last > 0 ? last - 1 : 0; k < variables; ++k) {
      Order next = out[i];
      ++next[k];
      out.push_back(std::move(next));
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const Order& a, const Order& b) { return total(a) < total(b); });
  return out;
}

/// Taylor coefficients of L and ∂L/∂q̇_i about a point of (q, t), with q̇ as they are: expressions on one tape.
class TaylorCoefficients {
 public:
  TaylorCoefficients(const EquationsOfMotion& equations, int order) : system_(*equations.system) {
    for (const Coordinate& c : system_.coordinates) variables_.push_back(c.q);
    variables_.push_back(system_.context->time());
    std::vector<Expr> functions{equations.lagrangian_expanded};
    functions.insert(functions.end(), equations.momenta.begin(), equations.momenta.end());
    functions = in_state_variables(system_, functions);
    for (std::size_t f = 0; f < functions.size(); ++f) derive(f, functions[f], order);
  }
  const std::vector<Expr>& roots() const { return roots_; }
  /// Its place among the roots.
  std::size_t place(std::size_t function, const Order& order) const { return places_.at({function, order}); }

 private:
  void derive(std::size_t f, Expr function, int order) {
    std::map<Order, Expr> known;
    for (const Order& a : orders_up_to(variables_.size(), order)) {
      Expr e = function;
      if (total(a) > 0) {
        Order before = a;
        std::size_t k = 0;
        while (before[k] == 0) ++k;
        --before[k];
        e = differentiate(known.at(before), variables_[k]) / Rational(a[k]);
      }
      known.emplace(a, e);
      places_.emplace(std::make_pair(f, a), roots_.size());
      roots_.push_back(e);
    }
  }

  const MechanicalSystem& system_;
  std::vector<Expr> variables_, roots_;
  std::map<std::pair<std::size_t, Order>, std::size_t> places_;
};

/// The determining equation ξ L_t + η·L_q + (Dη − q̇ Dξ)·L_q̇ + L Dξ − Df = 0 and its derivatives, at one point of (q,
/// t).
class DeterminingEquations {
 public:
  DeterminingEquations(const EquationsOfMotion& equations, bool natural, int order, std::uint64_t seed)
      : system_(*equations.system),
        n_(system_.coordinates.size()),
        order_(order),
        natural_(natural),
        taylor_(equations, order),
        tape_(evaluation::flatten_arguments(taylor_.roots())),
        hints_(evaluation::field_hints(tape_)),
        seed_(mix(seed)),
        numbers_(evaluation::agreeing_primes(hints_, seed_), hints_, seed_) {
    orders_ = orders_up_to(n_ + 1, order);
    for (std::size_t function = 0; function < n_ + 2; ++function)
      for (const Order& a : orders_)
        if (is_unknown(function, a)) unknowns_.emplace(std::make_pair(function, a), 0);
    // Low orders first.
    std::size_t next = 0;
    for (const Order& a : orders_)
      for (std::size_t function = 0; function < n_ + 2; ++function)
        if (const auto it = unknowns_.find({function, a}); it != unknowns_.end()) {
          it->second = next++;
          order_of_.push_back(total(a));
        }
  }

  std::size_t unknowns() const { return unknowns_.size(); }
  std::size_t nodes() const { return tape_.size(); }

  /// dim π_j for j = 0 … order: how many independent jets of order j belong to solutions up to `order`. Empty: no
  /// point.
  std::vector<std::size_t> dimensions() {
    const auto rows = matrix();
    if (!rows) return {};
    const PrimeField& field = numbers_.field();
    const std::vector<NullVector> kernel = null_vectors(*rows, field, interrupt_of(*system_.context));
    std::vector<std::size_t> out;
    for (int j = 0; j <= order_; ++j) {
      const auto width =
          static_cast<std::size_t>(std::count_if(order_of_.begin(), order_of_.end(), [j](int o) { return o <= j; }));
      FieldMatrix low(kernel.size(), width);
      for (std::size_t i = 0; i < kernel.size(); ++i)
        for (std::size_t k = 0; k < kernel[i].columns.size(); ++k)
          if (kernel[i].columns[k] < width) low.at(i, kernel[i].columns[k]) = kernel[i].entries[k];
      out.push_back(echelon(low, field, interrupt_of(*system_.context)).size());
    }
    return out;
  }

 private:
  // Functions: 0 ξ, 1 … n η, n + 1 f.
  bool is_unknown(std::size_t function, const Order& a) const {
    if (function == n_ + 1) return total(a) > 0;
    if (function > 0 || !natural_) return true;
    return total(a) == a.back();  // ξ(t)
  }

  std::optional<FieldMatrix> matrix() {
    const std::size_t equations_a_point = orders_up_to(n_ + 1, order_ - 1).size();
    const std::size_t points = (natural_ ? (n_ + 1) * (n_ + 2) / 2 : 2 * unknowns() / equations_a_point) + 4;
    FieldMatrix out(points * equations_a_point, unknowns());
    if (!find_point()) return std::nullopt;
    std::size_t row = 0;
    for (std::size_t p = 0; p < points; ++p) {
      interrupt_of(*system_.context).throw_if_asked();
      for (int attempt = 0;; ++attempt) {
        if (attempt == 200) return std::nullopt;
        if (try_velocities()) break;
      }
      for (const Order& a : orders_)
        if (total(a) < order_) fill(out, row++, a);
    }
    return out;
  }

  /// A configuration at which L has a value, for some velocities.
  bool find_point() {
    for (int attempt = 0; attempt < 200; ++attempt) {
      numbers_.set_seed(seed_ = mix(seed_));
      if (try_velocities()) return true;
    }
    return false;
  }

  bool try_velocities() {
    velocities_.clear();
    for (const Coordinate& c : system_.coordinates) {
      velocities_.push_back(numbers_.field().from_residue((draw_ = mix(draw_ ^ seed_)) % numbers_.field().prime()));
      numbers_.give(c.velocity, velocities_.back());
    }
    numbers_.symbols_changed();
    try {
      evaluation::run(tape_, numbers_, at_);
      return true;
    } catch (const evaluation::Redraw&) {
      return false;
    }
  }

  Value coefficient(std::size_t function, const Order& a) const {
    return at_[tape_.roots()[taylor_.place(function, a)]];
  }

  void add(FieldMatrix& m, std::size_t row, std::size_t function, const Order& a, Value value) const {
    const auto it = unknowns_.find({function, a});
    if (it == unknowns_.end() || value == 0) return;
    Value& entry = m.at(row, it->second);
    entry = numbers_.field().add(entry, value);
  }

  /// Coefficient `b` of D(function), times `factor`.
  void add_total_derivative(FieldMatrix& m, std::size_t row, std::size_t function, const Order& b, Value factor) const {
    const PrimeField& field = numbers_.field();
    for (std::size_t k = 0; k <= n_; ++k) {
      Order next = b;
      ++next[k];
      const Value by = field.multiply(factor, field.from(Rational(next[k])));
      add(m, row, function, next, k < n_ ? field.multiply(by, velocities_[k]) : by);
    }
  }

  /// Coefficient `a` of the determining equation.
  void fill(FieldMatrix& m, std::size_t row, const Order& a) const {
    const PrimeField& field = numbers_.field();
    for (const Order& b : orders_) {
      Order c = a;  // b + c = a
      bool below = true;
      for (std::size_t k = 0; k <= n_; ++k) below &= (c[k] -= b[k]) >= 0;
      if (!below) continue;
      for (std::size_t k = 0; k <= n_; ++k) {  // η_k L_{q_k}, ξ L_t
        Order next = c;
        ++next[k];
        add(m, row, k < n_ ? 1 + k : 0, b, field.multiply(coefficient(0, next), field.from(Rational(next[k]))));
      }
      Value energy = coefficient(0, c);  // L − q̇·L_q̇, the factor of Dξ
      for (std::size_t i = 0; i < n_; ++i) {
        const Value p = coefficient(1 + i, c);
        energy = field.subtract(energy, field.multiply(velocities_[i], p));
        add_total_derivative(m, row, 1 + i, b, p);
      }
      add_total_derivative(m, row, 0, b, energy);
    }
    add_total_derivative(m, row, n_ + 1, a, field.negate(field.one()));
  }

  const MechanicalSystem& system_;
  std::size_t n_;
  int order_;
  bool natural_;
  TaylorCoefficients taylor_;
  evaluation::Tape tape_;
  evaluation::FieldHints hints_;
  std::uint64_t seed_, draw_ = 0x76656c;
  GivenNumbers numbers_;
  std::vector<Order> orders_;
  std::map<std::pair<std::size_t, Order>, std::size_t> unknowns_;
  std::vector<int> order_of_;
  std::vector<Value> velocities_, at_;
};

std::size_t unknowns_of_order(std::size_t n, int order) {
  double count = 1;
  for (std::size_t k = 1; k <= n + 1; ++k)
    count = count * static_cast<double>(static_cast<std::size_t>(order) + k) / static_cast<double>(k);
  return static_cast<std::size_t>(count) * (n + 2);
}

}  // namespace

std::optional<std::size_t> symmetry_bound(const EquationsOfMotion& equations, bool natural, std::size_t found,
                                          std::uint64_t seed) {
  const std::size_t n = equations.system->coordinates.size();
  std::optional<std::size_t> best;
  constexpr int highest = 7;
  for (int order = 3; order <= highest && unknowns_of_order(n, order) <= most_unknowns; ++order) {
    DeterminingEquations determining(equations, natural, order, seed);
    if (determining.nodes() > most_nodes) break;
    const auto dimensions = determining.dimensions();
    for (std::size_t j = 0; j + 1 < dimensions.size(); ++j)
      if (dimensions[j] == dimensions[j + 1]) {
        best = std::min(best.value_or(dimensions[j]), dimensions[j]);
        break;
      }
    if (best && *best <= found) break;
  }
  return best;
}

}  // namespace maupertuis::invariants
