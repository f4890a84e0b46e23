#include "analysis/invariants/search.hpp"

#include <maupertuis/interrupt_scope.hpp>

#include "analysis/invariants/parameter_fit.hpp"

#include <algorithm>
#include <numeric>
#include <set>

namespace maupertuis::invariants {
namespace {

constexpr std::size_t rows_to_spare = 12;  // a wrong null vector passes one with probability 2^-60 each

struct ValueAndRate {
  Value value, rate;
};

ValueAndRate evaluate_monomial(const Monomial& m, const MotionSampler::Sample& at, const PrimeField& field) {
  ValueAndRate out{field.one(), 0};
  for (const Factor& f : m) {
    const Value x = at.values[f.generator], rate = at.rates.empty() ? 0 : at.rates[f.generator];
    for (int k = 0; k < f.exponent; ++k) {
      out.rate = field.add(field.multiply(out.rate, x), field.multiply(out.value, rate));
      out.value = field.multiply(out.value, x);
    }
  }
  return out;
}

/// One search over one family of functions: of rates (conserved combinations) or of values (vanishing ones).
class Search {
 public:
  Search(const MotionRows& rows, const Generators& generators, const Basis& basis, const std::vector<Expr>& known,
         bool of_rates, std::uint64_t seed)
      : generators_(generators),
        basis_(basis),
        known_(known),
        of_rates_(of_rates),
        roots_(roots_of_numbers(needed(generators, basis))),
        sampler_(rows, with_known(with_known(needed(generators, basis), known), roots_), true, seed),
        field_(sampler_.field()) {}

  SearchResult carry_out(std::size_t work) {
    SearchResult result;
    if (basis_.monomials.empty()) return result;
    const bool affordable = sampler_.nodes() * basis_.monomials.size() <= work;
    const auto roots = affordable ? sampler_.usable_parameters() : std::nullopt;
    result.sampled = roots && draw(*roots, basis_.monomials.size() + rows_to_spare);
    result.singular = sampler_.singular();
    if (!result.sampled) return result;
    std::vector<std::size_t> all(basis_.monomials.size());
    std::iota(all.begin(), all.end(), 0u);
    std::vector<NullVector> vectors =
        null_vectors(matrix(all, of_rates_, samples_.size()), field_, interrupt_of(generators_.context()));
    std::stable_sort(vectors.begin(), vectors.end(),
                     [](const NullVector& a, const NullVector& b) { return a.columns.size() < b.columns.size(); });
    if (of_rates_) vectors = new_functions(vectors);
    result.dimension = vectors.size();
    write_in_parameters(vectors, result);
    return result;
  }

 private:
  /// The generators that stand in the basis, and 1 in the places of the others: roots that only these hold need not
  /// exist.
  static std::vector<Expr> needed(const Generators& generators, const Basis& basis) {
    std::vector<Expr> out(generators.values().size(), generators.context().number(1));
    for (const Monomial& m : basis.monomials)
      for (const Factor& f : m) out[f.generator] = generators.values()[f.generator];
    return out;
  }

  /// Also √2 of √(2 k/m).
  static std::vector<Expr> roots_of_numbers(const std::vector<Expr>& functions) {
    std::vector<Expr> out;
    for (const Expr& node : topological_order(functions)) {
      if (!node.is(Kind::Power) || !node[1].is_number()) continue;
      if (!(node[1].number() * Rational(2)).is_integer() || node[1].number().is_integer()) continue;
      const Expr number = node[0].is(Kind::Product) ? node[0][0] : node[0];
      if (!number.is_number() || number.number().sign() <= 0) continue;
      const Expr root = sqrt(number);
      if (!root.is_number() && std::find(out.begin(), out.end(), root) == out.end()) out.push_back(root);
    }
    return out;
  }

  /// Their images are the same at all samples.
  std::vector<NumberRoot> images_of_roots() const {
    std::vector<NumberRoot> out;
    const std::size_t first = generators_.values().size() + known_.size();
    for (std::size_t k = 0; k < roots_.size(); ++k) out.push_back({roots_[k], samples_.front().values[first + k]});
    return out;
  }

  static std::vector<Expr> with_known(std::vector<Expr> functions, const std::vector<Expr>& known) {
    functions.insert(functions.end(), known.begin(), known.end());
    return functions;
  }

  bool draw(const ParameterRoots& roots, std::size_t count) {
    samples_.clear();
    for (std::size_t i = 0; i < count; ++i) {
      auto sample = sampler_.draw(roots);
      if (!sample) return false;
      samples_.push_back(std::move(*sample));
    }
    return true;
  }

  FieldMatrix matrix(const std::vector<std::size_t>& columns, bool rates, std::size_t rows) const {
    FieldMatrix m(rows, columns.size());
    for (std::size_t i = 0; i < rows; ++i) {
      interrupt_of(generators_.context()).throw_if_asked();
      for (std::size_t k = 0; k < columns.size(); ++k) {
        const ValueAndRate v = evaluate_monomial(basis_.monomials[columns[k]], samples_[i], field_);
        m.at(i, k) = rates ? v.rate : v.value;
      }
    }
    return m;
  }

  /// Those that are no combinations of 1, of what is known and of shorter ones, as functions.
  std::vector<NullVector> new_functions(const std::vector<NullVector>& vectors) const {
    const std::size_t first = 1 + known_.size(),
                      rows = std::min(samples_.size(), first + vectors.size() + rows_to_spare);
    FieldMatrix values(rows, first + vectors.size());
    for (std::size_t i = 0; i < rows; ++i) {
      values.at(i, 0) = field_.one();
      for (std::size_t k = 0; k < known_.size(); ++k)
        values.at(i, 1 + k) = samples_[i].values[generators_.values().size() + k];
      for (std::size_t v = 0; v < vectors.size(); ++v) {
        Value sum = 0;
        for (std::size_t k = 0; k < vectors[v].columns.size(); ++k)
          sum = field_.add(
              sum,
              field_.multiply(vectors[v].entries[k],
                              evaluate_monomial(basis_.monomials[vectors[v].columns[k]], samples_[i], field_).value));
        values.at(i, first + v) = sum;
      }
    }
    std::vector<NullVector> out;
    for (const std::size_t pivot : echelon(values, field_, interrupt_of(generators_.context())))
      if (pivot >= first) out.push_back(vectors[pivot - first]);
    return out;
  }

  /// The entries of each vector at other parameters: on its own columns the null space has dimension 1.
  std::optional<std::vector<std::vector<Value>>> entries_at(const ParameterRoots& roots,
                                                            const std::vector<NullVector>& vectors) {
    std::size_t longest = 0;
    for (const NullVector& v : vectors) longest = std::max(longest, v.columns.size());
    if (!draw(roots, longest + 2)) return std::nullopt;
    std::vector<std::vector<Value>> out;
    for (const NullVector& v : vectors) {
      const auto again = null_vectors(matrix(v.columns, of_rates_, v.columns.size() + 2), field_);
      if (again.size() != 1 || again[0].columns.size() != v.columns.size()) return std::nullopt;
      out.push_back(again[0].entries);
    }
    return out;
  }

  void write_in_parameters(const std::vector<NullVector>& vectors, SearchResult& result) {
    if (vectors.empty()) return;
    ParameterFit fit(
        sampler_, [&](const ParameterRoots& roots) { return entries_at(roots, vectors); }, images_of_roots());
    if (!fit.prepare()) {
      result.too_long = vectors.size();
      return;
    }
    for (std::size_t v = 0; v < vectors.size(); ++v) {
      std::vector<Coefficient> coefficients;
      for (std::size_t k = 0; k < vectors[v].columns.size(); ++k) {
        auto c = fit.find(v, k);
        if (!c) break;
        coefficients.push_back(std::move(*c));
      }
      if (coefficients.size() < vectors[v].columns.size())
        ++result.too_long;
      else
        result.found.push_back(assemble(vectors[v], std::move(coefficients)));
    }
  }

  /// Denominators cleared: powers of parameters at least 0 and one of them 0, integers without a common factor.
  void clear_denominators(std::vector<Coefficient>& coefficients) const {
    std::vector<Expr> denominators;
    for (const Coefficient& c : coefficients)
      if (c.denominator && !c.denominator.is_number() &&
          std::find(denominators.begin(), denominators.end(), c.denominator) == denominators.end())
        denominators.push_back(c.denominator);
    for (Coefficient& c : coefficients)
      for (const Expr& d : denominators) {
        if (c.denominator && c.denominator == d)
          c.denominator = Expr();
        else
          c.numerator = c.numerator ? c.numerator * d : d;
      }
    for (std::size_t i = 0; i < sampler_.parameters().size(); ++i) {
      Rational least = coefficients[0].exponents[i];
      for (const Coefficient& c : coefficients) least = c.exponents[i] < least ? c.exponents[i] : least;
      for (Coefficient& c : coefficients) c.exponents[i] = c.exponents[i] - least;
    }
    make_integers(coefficients);
  }

  static void make_integers(std::vector<Coefficient>& coefficients) {
    std::int64_t denominators = 1, numerators = 0;
    for (const Coefficient& c : coefficients) {
      const auto parts = c.number.small();
      if (!parts || parts->denominator > 1'000'000) return;
      denominators = std::lcm(denominators, parts->denominator);
      if (denominators > 1'000'000'000) return;
    }
    for (const Coefficient& c : coefficients) {
      const auto integer = (c.number * Rational(denominators)).as_integer();
      numerators = std::gcd(numerators, integer ? *integer : 1);
    }
    const int sign = coefficients.back().number.sign() < 0 ? -1 : 1;
    for (Coefficient& c : coefficients)
      c.number = c.number * Rational(sign * denominators, std::max<std::int64_t>(1, numerators));
  }

  Combination assemble(const NullVector& vector, std::vector<Coefficient> coefficients) const {
    clear_denominators(coefficients);
    Combination out;
    std::vector<Expr> sum;
    for (std::size_t k = 0; k < coefficients.size(); ++k) {
      out.terms.push_back({expression(coefficients[k], sampler_.parameters(), generators_.context()),
                           basis_.monomials[vector.columns[k]]});
      sum.push_back(out.terms.back().coefficient * generators_.expression(out.terms.back().monomial));
    }
    out.value = generators_.context().sum(sum);
    return out;
  }

  const Generators& generators_;
  const Basis& basis_;
  const std::vector<Expr>& known_;
  bool of_rates_;
  std::vector<Expr> roots_;  // of numbers, √3 in exp(√3 x)
  MotionSampler sampler_;
  const PrimeField& field_;
  std::vector<MotionSampler::Sample> samples_;
};

}  // namespace

SearchResult conserved_combinations(const MotionRows& rows, const Generators& generators, const Basis& basis,
                                    const std::vector<Expr>& known, std::size_t work, std::uint64_t seed) {
  return Search(rows, generators, basis, known, true, seed).carry_out(work);
}

SearchResult vanishing_combinations(const MotionRows& rows, const Generators& generators, const Basis& basis,
                                    std::uint64_t seed) {
  return Search(rows, generators, basis, {}, false, seed).carry_out(~std::size_t{0});
}

}  // namespace maupertuis::invariants
