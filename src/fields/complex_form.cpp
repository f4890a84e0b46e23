#include <maupertuis/fields.hpp>

#include <maupertuis/transform.hpp>

#include <optional>
#include <unordered_map>
#include <unordered_set>

/// Equations of complex fields by E_ψ* = (E_r + i E_i)/2, in ψ, its conjugate and |ψ|.
namespace maupertuis {
namespace {

/// A polynomial in jets with the real and the imaginary part of its coefficients.
struct Polynomial {
  std::vector<Expr> re, im;
};

class ComplexForm {
 public:
  ComplexForm(const FieldEquations& equations, const FieldSystem& system) : equations_(equations), s_(system) {}

  std::optional<std::vector<ComplexEquation>> all() {
    for (std::size_t a = 0; a + 1 < equations_.varied.size(); ++a) {
      const std::size_t f = equations_.varied[a];
      if (s_.fields[f].kind != "complex" || equations_.varied[a + 1] != f + 1) continue;
      const std::string& part = s_.fields[f].name;
      names_[f] = part.substr(0, part.size() - 2);
      ++a;
    }
    std::vector<ComplexEquation> out;
    for (std::size_t a = 0; a < equations_.varied.size(); ++a) {
      const auto name = names_.find(equations_.varied[a]);
      if (name == names_.end()) continue;
      Polynomial sum;
      if (!add(equations_.euler[a], false, sum) || !add(equations_.euler[a + 1], true, sum)) return std::nullopt;
      ++a;
      const Expr half = s_.context->number(Rational(1, 2));
      const Expr re = with_sizes(half * s_.context->sum(sum.re)), im = with_sizes(half * s_.context->sum(sum.im));
      if (!re || !im) return std::nullopt;
      out.push_back({name->second, re, im});
    }
    return out;
  }

 private:
  /// The complex field that a jet is a part of, as its real part's index.
  std::optional<std::size_t> whole_of(const FieldJet& jet) const {
    if (names_.count(jet.field)) return jet.field;
    return jet.field > 0 && names_.count(jet.field - 1) ? std::optional(jet.field - 1) : std::nullopt;
  }
  Expr symbol(std::size_t whole, const FieldJet& jet, bool conjugate) {
    std::string name = s_.jet_name({whole, jet.space, 0});
    name.erase(names_.at(whole).size(), 2);  // ψ_r_x → ψ_x
    const Expr out = s_.context->symbol(conjugate ? "conj(" + name + ")" : name, Role::Coordinate, jet.time);
    if (conjugate) conjugates_.insert(out);
    if (jet.order() == 0) (conjugate ? bare_conjugate_ : bare_)[out] = whole;
    return out;
  }

  /// Adds e, or i e, term by term: ψ_r = (ψ + ψ*)/2, ψ_i = −i (ψ − ψ*)/2. False where e is no polynomial in the jets.
  bool add(Expr e, bool times_i, Polynomial& sum) {
    const Expr flat = expand(s_.expanded(e));
    if (!flat) return false;
    for (std::size_t k = 0; k < (flat.is(Kind::Sum) ? flat.size() : 1); ++k) {
      const Expr term = flat.is(Kind::Sum) ? flat[k] : flat;
      std::vector<Expr> factors;
      int quarter_turns = times_i ? 1 : 0;
      for (std::size_t j = 0; j < (term.is(Kind::Product) ? term.size() : 1); ++j) {
        const Expr factor = term.is(Kind::Product) ? term[j] : term;
        const Expr base = factor.is(Kind::Power) ? factor[0] : factor;
        if (s_.jets_in(factor).empty()) {
          factors.push_back(factor);
          continue;
        }
        const auto jet = s_.jet_of(base);
        const bool whole_power = !factor.is(Kind::Power) || (factor[1].is_number() && factor[1].number().is_integer());
        if (!jet || !whole_power) return false;
        const std::optional<std::size_t> whole = whole_of(*jet);
        if (!whole) {
          factors.push_back(factor);
          continue;
        }
        const int power = factor.is(Kind::Power) ? static_cast<int>(factor[1].number().to_double()) : 1;
        constexpr int most = 16;
        if (power < 1 || power > most) return false;
        const bool imaginary = jet->field != *whole;
        const Expr z = symbol(*whole, *jet, false), c = symbol(*whole, *jet, true);
        const Expr part = s_.context->number(Rational(1, 2)) * (imaginary ? z - c : z + c);
        for (int n = 0; n < power; ++n) factors.push_back(part);
        if (imaginary) quarter_turns += 3 * power;
      }
      const Expr value = s_.context->product(factors);
      const bool negative = quarter_turns % 4 > 1;
      (quarter_turns % 2 ? sum.im : sum.re).push_back(negative ? -value : value);
    }
    return true;
  }

  /// ψ ψ* → abs(ψ)²; an empty handle where another conjugate is left.
  Expr with_sizes(Expr e) {
    const Expr flat = expand(e);
    if (!flat) return {};
    std::vector<Expr> terms;
    for (std::size_t k = 0; k < (flat.is(Kind::Sum) ? flat.size() : 1); ++k) {
      const Expr term = flat.is(Kind::Sum) ? flat[k] : flat;
      std::vector<Expr> factors;
      std::unordered_map<std::size_t, int> plain, conjugate;
      for (std::size_t j = 0; j < (term.is(Kind::Product) ? term.size() : 1); ++j) {
        const Expr factor = term.is(Kind::Product) ? term[j] : term;
        const Expr base = factor.is(Kind::Power) ? factor[0] : factor;
        const int power = factor.is(Kind::Power) ? static_cast<int>(factor[1].number().to_double()) : 1;
        if (const auto z = bare_.find(base); z != bare_.end())
          plain[z->second] += power;
        else if (const auto c = bare_conjugate_.find(base); c != bare_conjugate_.end())
          conjugate[c->second] += power;
        else if (conjugates_.count(base))
          return {};
        else
          factors.push_back(factor);
      }
      for (const auto& [whole, n] : conjugate)
        if (plain[whole] < n) return {};
      for (const auto& [whole, n] : plain) {
        const int pairs = conjugate.count(whole) ? conjugate[whole] : 0;
        const FieldJet none{whole, std::vector<int>(s_.space.size(), 0), 0};
        const Expr size = s_.context->symbol("abs(" + names_.at(whole) + ")", Role::Auxiliary);
        if (pairs) factors.push_back(pow(size, Rational(2 * pairs)));
        if (n > pairs) factors.push_back(pow(symbol(whole, none, false), Rational(n - pairs)));
      }
      terms.push_back(s_.context->product(factors));
    }
    return s_.context->sum(terms);
  }

  const FieldEquations& equations_;
  const FieldSystem& s_;
  std::unordered_map<std::size_t, std::string> names_;  // real part's index → the complex field
  std::unordered_set<Expr, ExprHash> conjugates_;
  std::unordered_map<Expr, std::size_t, ExprHash> bare_, bare_conjugate_;  // ψ, ψ* without derivatives
};

}  // namespace

std::vector<ComplexEquation> complex_equations(const FieldEquations& equations) {
  return ComplexForm(equations, equations.system()).all().value_or(std::vector<ComplexEquation>{});
}

}  // namespace maupertuis
