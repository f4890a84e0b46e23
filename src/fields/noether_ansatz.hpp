#pragma once
#include <maupertuis/fields.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace maupertuis {

/// One generator of the ansatz: ξ^μ = factor, or η_a = factor.
struct Generator {
  bool moves_space = false;
  std::size_t index = 0;             // μ (space variables, then t), or a
  Expr factor;                       // 1, t, x, φ_b
  std::vector<Expr> characteristic;  // [varied]
};

/// Symmetries are looked for among their sums.
class Ansatz {
 public:
  explicit Ansatz(const FieldEquations& equations)
      : equations_(equations), s_(equations.system()), n_(s_.space.size()) {
    std::vector<Expr> places{s_.context->number(1), s_.context->time()};
    for (const SpaceVariable& x : s_.space) places.push_back(x.symbol);
    for (std::size_t mu = 0; mu <= n_; ++mu)
      for (const Expr& factor : places) add_motion(mu, factor);
    for (std::size_t a = 0; a < equations.varied.size(); ++a) {
      for (const Expr& factor : places) add_shift(a, factor);
      for (const std::size_t b : equations.varied) add_shift(a, field(b));
    }
    // A boost of waves of first order in time turns their phase by an angle that grows with the place.
    if (equations.varied.size() > 1 && is_first_order()) add_turns_along_space();
  }
  std::vector<Generator> generators;

 private:
  bool is_first_order() const {
    const std::vector<Expr> jets = s_.jets_in(s_.density);
    return std::all_of(jets.begin(), jets.end(), [&](const Expr& one) {
      return s_.jet_of(one)->time == 0 || std::all_of(jets.begin(), jets.end(), [&](const Expr& two) {
               return s_.jet_of(two)->time == 0 || differentiate(differentiate(s_.density, one), two).is_zero();
             });
    });
  }
  void add_turns_along_space() {
    for (std::size_t a = 0; a < equations_.varied.size(); ++a)
      for (std::size_t b = 0; b < equations_.varied.size(); ++b)
        for (const SpaceVariable& x : s_.space)
          if (a != b) add_shift(a, x.symbol * field(equations_.varied[b]));
  }
  Expr field(std::size_t f) const { return s_.jet_symbol({f, std::vector<int>(n_, 0), 0}); }
  void add_motion(std::size_t mu, Expr factor) {
    Generator g{true, mu, factor, {}};
    for (const std::size_t f : equations_.varied)
      g.characteristic.push_back(-(factor * s_.total_derivative(field(f), mu)));
    generators.push_back(std::move(g));
  }
  void add_shift(std::size_t a, Expr factor) {
    Generator g{false, a, factor, std::vector<Expr>(equations_.varied.size(), s_.context->number(0))};
    g.characteristic[a] = factor;
    generators.push_back(std::move(g));
  }
  const FieldEquations& equations_;
  const FieldSystem& s_;
  std::size_t n_;
};

/// What a current is called.
struct NamedCurrent {
  std::string name, meaning;
  bool reversed = false;  // −T^0_i is the density of momentum
};
/// Of a symmetry that is a sum of generators, each with a coefficient.
NamedCurrent name_of(const FieldEquations& equations, const std::vector<const Generator*>& parts);
/// Whether e is below zero wherever it is not zero, as far as random fields tell: |ψ|² with the other sign.
bool is_nowhere_positive(const FieldEquations& equations, Expr e);

}  // namespace maupertuis
