#include <maupertuis/degenerate.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/momentum.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

/// A fraction with a small denominator; nothing where x is none.
std::optional<Rational> small_fraction(double x) {
  constexpr int largest = 60;
  for (int denominator = 1; denominator <= largest; ++denominator) {
    const double numerator = std::round(x * denominator);
    if (std::abs(numerator) <= 1000 && std::abs(x * denominator - numerator) < 1e-9)
      return Rational(static_cast<std::int64_t>(numerator), denominator);
  }
  return std::nullopt;
}

/// What the free functions move of the coordinates, a row a direction and a point, and the rows eliminated.
class MovedCoordinates {
 public:
  MovedCoordinates(const MechanicalSystem& system, const DegenerateAnalysis& analysis)
      : system_(system), n_(system.coordinates.size()) {
    for (const Bindings& point : analysis.chain.where->points())
      for (const StateDirection& direction : analysis.orbits) {
        std::vector<double> row = evaluate(direction, point);
        row.resize(n_);
        add(std::move(row));
      }
  }

  /// Combinations that none of them moves, each a coordinate that is no pivot with those that are.
  ExprVector unmoved() const {
    ExprVector out;
    for (std::size_t j = 0; j < n_; ++j)
      if (std::none_of(rows_.begin(), rows_.end(), [&](const Row& r) { return r.pivot == j; }))
        if (const Expr e = combination(j)) out.push_back(e);
    return out;
  }

 private:
  struct Row {
    std::size_t pivot;
    std::vector<double> entries;
  };

  static void subtract(std::vector<double>& from, const Row& row) {
    const double factor = from[row.pivot];
    for (std::size_t k = 0; k < from.size(); ++k) from[k] -= factor * row.entries[k];
  }

  void add(std::vector<double> row) {
    double size = 0, left = 0;
    for (const double x : row) size = std::max(size, std::abs(x));
    for (const Row& r : rows_) subtract(row, r);
    // The last one that moves at all: x - y is written with x first.
    std::size_t pivot = n_;
    for (std::size_t k = 0; k < n_; ++k) left = std::max(left, std::abs(row[k]));
    if (!(left > 1e-9 * size) || !std::isfinite(size)) return;
    for (std::size_t k = 0; k < n_; ++k)
      if (std::abs(row[k]) > 1e-3 * left) pivot = k;
    const double scale = row[pivot];
    for (double& x : row) x /= scale;
    const Row made{pivot, std::move(row)};
    for (Row& r : rows_) subtract(r.entries, made);
    rows_.push_back(made);
  }

  Expr combination(std::size_t j) const {
    const auto& all = system_.coordinates;
    ExprVector terms{all[j].q};
    for (const Row& row : rows_) {
      const auto factor = small_fraction(row.entries[j]);
      if (!factor) return {};
      if (factor->is_zero()) continue;
      if (!(all[row.pivot].dimension == all[j].dimension)) return {};
      terms.push_back(-*factor * all[row.pivot].q);
    }
    return terms.size() > 1 ? system_.context->sum(terms) : Expr();
  }

  const MechanicalSystem& system_;
  std::size_t n_;
  std::vector<Row> rows_;
};

}  // namespace

std::vector<DeterminedQuantity> determined_quantities(const EquationsOfMotion& equations) {
  std::vector<DeterminedQuantity> out;
  if (!has_free_functions(equations)) return out;
  const MechanicalSystem& system = *equations.system;
  const DegenerateAnalysis& analysis = *equations.degenerate;
  const auto add = [&](std::string name, Expr value, const Dimension& dimension) {
    const std::vector<Expr> symbols = symbols_of({&value, 1});
    const bool shown_anyway = std::all_of(symbols.begin(), symbols.end(), [&](const Expr& s) {
      return s.role() != Role::Coordinate || analysis.is_determined(s);
    });
    if (!shown_anyway && analysis.is_determined(value)) out.push_back({std::move(name), value, dimension});
  };
  const ExprVector combinations = MovedCoordinates(system, analysis).unmoved();
  for (const bool rate : {false, true})
    for (const Expr& e : combinations) {
      const Expr value = rate ? total_time_derivative(e) : e;
      const std::vector<Expr> symbols = symbols_of({&e, 1});
      const auto first = std::find_if(system.coordinates.begin(), system.coordinates.end(),
                                      [&](const Coordinate& c) { return c.q == symbols.front(); });
      add(to_plain(value, equations.order), value,
          rate ? first->dimension / system.independent_dimension : first->dimension);
    }
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    const Expr momentum = expand_time_derivatives(in_terms_of_motion(system, {&equations.momenta[i], 1}).front());
    if (analysis.chain.where->vanishes(momentum) != Verdict::Nonzero) continue;
    add(momentum_name(system, i), momentum,
        system.lagrangian_dimension * system.independent_dimension / system.coordinates[i].dimension);
  }
  return out;
}

}  // namespace maupertuis
