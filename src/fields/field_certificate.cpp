#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/fields.hpp>
#include <maupertuis/interrupt_scope.hpp>

#include "symbolic/evaluate/degree.hpp"
#include "symbolic/evaluate/field_numbers.hpp"
#include "symbolic/evaluate/jet_numbers.hpp"
#include "symbolic/evaluate/leaves.hpp"
#include "symbolic/evaluate/normalize.hpp"

#include <fmt/format.h>

#include <algorithm>

/// δℒ(η) − E·η = ∂_μ B^μ at random points of prime fields, along fields φ and η whose derivatives there are random
/// numbers: those of random polynomials. Nothing is differentiated as an expression here: δℒ is the part of ℒ(φ + ε η)
/// linear in ε, ∂_μ B^μ that of B(φ, η) along the line x + s e_μ linear in s, both by the arithmetic of truncated
/// series.
namespace maupertuis {
namespace {

using evaluation::FieldNumbers;
using Numbers = evaluation::JetNumbers<FieldNumbers>;
using Scalar = FieldNumbers::Value;

constexpr int points_per_prime = 3;

struct FieldRoots {
  std::vector<Expr> roots;  // [answers × asked] ℒ, E, B; as they are, or on sides of switches, one after the other
  std::size_t euler = 1, boundary = 1, asked = 1;
};

FieldRoots certificate_roots(const FieldEquations& equations) {
  FieldRoots out;
  const FieldSystem& s = equations.system();
  out.roots.push_back(s.expanded(s.density));
  for (const Expr& e : equations.euler) out.roots.push_back(s.expanded(e));
  out.boundary = out.roots.size();
  for (const Expr& b : equations.boundary_terms) out.roots.push_back(s.expanded(b));
  out.asked = out.roots.size();
  return out;
}

/// One point of one prime field.
class FieldPoint {
 public:
  FieldPoint(const FieldEquations& equations, const FieldRoots& roots, const evaluation::Tape& tape,
             FieldNumbers& numbers)
      : equations_(equations), s_(equations.with_variations), roots_(roots), tape_(tape), numbers_(numbers) {}

  /// Whether both sides agree, in all answers.
  bool holds() {
    differences_.assign(roots_.roots.size() / roots_.asked, numbers_.number(0));
    subtract_varied_density();
    for (std::size_t mu = 0; mu <= s_.space.size(); ++mu) add_divergence(mu);
    return std::all_of(differences_.begin(), differences_.end(), [](Scalar x) { return x == 0; });
  }

 private:
  Scalar value(Expr symbol) const { return numbers_.symbol(symbol); }
  Numbers::Value at(std::size_t answer, std::size_t root) const {
    return values_[tape_.roots()[answer * roots_.asked + root]];
  }

  /// δℒ(η) − E·η
  void subtract_varied_density() {
    run([&](Expr symbol) {
      Numbers::Value out = constant(value(symbol));
      if (const auto jet = s_.jet_of(symbol); jet && varies(jet->field))
        out(1, 0) = value(s_.jet_symbol(variation(*jet)));
      return out;
    });
    for (std::size_t k = 0; k < differences_.size(); ++k) {
      differences_[k] = numbers_.subtract(differences_[k], at(k, 0)(1, 0));
      for (std::size_t a = 0; a < equations_.varied.size(); ++a) {
        const FieldJet eta{equations_.variation_of(a), std::vector<int>(s_.space.size(), 0), 0};
        const Scalar work = numbers_.multiply(at(k, roots_.euler + a)(0, 0), value(s_.jet_symbol(eta)));
        differences_[k] = numbers_.add(differences_[k], work);
      }
    }
  }
  /// ∂_μ B^μ of one μ
  void add_divergence(std::size_t mu) {
    const bool by_time = mu == s_.space.size();
    run([&](Expr symbol) {
      Numbers::Value out = constant(value(symbol));
      if (auto jet = s_.jet_of(symbol)) {
        ++(by_time ? jet->time : jet->space[mu]);
        out(0, 1) = value(s_.jet_symbol(*jet));
      } else if (by_time ? symbol.role() == Role::Time : symbol == s_.space[mu].symbol) {
        out(0, 1) = numbers_.number(1);
      }
      return out;
    });
    for (std::size_t k = 0; k < differences_.size(); ++k)
      differences_[k] = numbers_.add(differences_[k], at(k, roots_.boundary + mu)(0, 1));
  }

  bool varies(std::size_t field) const { return field < equations_.system().fields.size() && !s_.fields[field].given; }
  FieldJet variation(FieldJet jet) const {
    for (std::size_t a = 0; a < equations_.varied.size(); ++a)
      if (equations_.varied[a] == jet.field) return jet.field = equations_.variation_of(a), jet;
    return jet;
  }
  Numbers::Value constant(const Scalar& value) const {
    Numbers::Value out;
    for (auto& part : out.c) part.fill(numbers_.number(0));
    out(0, 0) = value;
    return out;
  }
  void run(const Numbers::Lookup& lookup) {
    Numbers series(numbers_, 2, lookup);
    evaluation::run(tape_, series, values_);
  }

  const FieldEquations& equations_;
  const FieldSystem& s_;
  const FieldRoots& roots_;
  const evaluation::Tape& tape_;
  FieldNumbers& numbers_;
  std::vector<Numbers::Value> values_;
  std::vector<Scalar> differences_;  // [answers]
};

/// The symbols that the points give values to, beside those of the roots: the tape's hints cover the latter alone, and
/// what they do not name is drawn freely. `check` gets its verdict.
void compare_at_points(const FieldEquations& equations, const FieldRoots& roots, std::uint64_t seed,
                       CertificateCheck& check) {
  const auto tape = evaluation::Tape::with_gaussians(evaluation::flatten_arguments(roots.roots));
  const evaluation::FieldHints hints = evaluation::field_hints(tape);
  evaluation::Complexity size = evaluation::complexity(tape);
  const int wanted = evaluation::points_needed(size, points_per_prime);
  double smallest_group = 1;
  check.points = 0;
  for (int prime = 0; prime < 2; ++prime) {
    int found = 0, mends_left = evaluation::mends_allowed(tape);
    for (int attempt = 0; attempt < 200 && found < wanted; ++attempt) {
      interrupt_of(*equations.system().context).throw_if_asked();
      seed = evaluation::mix(seed);
      const evaluation::PrimeTriple primes = evaluation::agreeing_primes(hints, seed);
      smallest_group = static_cast<double>(std::min(primes.q, primes.r));
      FieldNumbers numbers(primes, hints, seed);
      for (bool again = true; again;) {
        again = false;
        try {
          if (!FieldPoint(equations, roots, tape, numbers).holds()) {
            check.verdict = Verdict::Nonzero;
            check.reason = "The two sides differ at a random point.";
            return;
          }
          ++found;
        } catch (const evaluation::Redraw& redraw) {
          again = !redraw.another_prime && mends_left-- > 0 && numbers.mend(redraw);
        }
      }
    }
    check.points += found;
    if (found < wanted) {
      check.reason = "No point was found at which all roots are real.";
      return;
    }
  }
  check.verdict = Verdict::Zero;
  size.degree = 4 * size.degree + 1;
  size.height = 4 * size.height + 8;
  check.error_bound = evaluation::error_bound(size, wanted, smallest_group);
}

enum class Sides { Proved, Differ, Open };

/// On each side of each switch, as a formula: signs that come up by chance do not meet the pieces of a long table.
/// `check` gets its verdict where all are proved.
Sides compare_by_sides(const FieldEquations& equations, const FieldRoots& roots, std::uint64_t seed,
                       CertificateCheck& check) {
  constexpr std::size_t together = 64;
  evaluation::Products products;
  for (const Expr& root : roots.roots) products.push_back({root});
  const auto leaves = evaluation::joint_leaves(roots.roots, products);
  if (!leaves) return Sides::Open;
  CertificateCheck all = check;
  all.error_bound = 0;
  for (std::size_t from = 0; from < leaves->all.size(); from += together) {
    FieldRoots here = roots;
    here.roots.clear();
    for (std::size_t k = from; k < std::min(leaves->all.size(), from + together); ++k)
      here.roots.insert(here.roots.end(), leaves->all[k].formulas.begin(), leaves->all[k].formulas.end());
    CertificateCheck some;
    compare_at_points(equations, here, seed, some);
    if (some.verdict != Verdict::Zero) return some.verdict == Verdict::Nonzero ? Sides::Differ : Sides::Open;
    all.points += some.points;
    all.error_bound = std::max(all.error_bound, some.error_bound);
  }
  check = all;
  check.verdict = Verdict::Zero;
  return Sides::Proved;
}

CertificateCheck boundary_identity(const FieldEquations& equations, std::uint64_t seed) {
  constexpr double certain = 1e-6;  // of signs that come up by chance: the probability that some never did
  CertificateCheck check;
  check.name = "divergence";
  check.statement = "δℒ(η) − E·η is the divergence ∂_μ B^μ along random fields.";
  const FieldRoots roots = certificate_roots(equations);
  const bool switches = evaluation::complexity(evaluation::Tape(roots.roots)).switches > 0;
  const Sides sides = switches ? compare_by_sides(equations, roots, seed, check) : Sides::Open;
  if (sides == Sides::Proved) return check;
  compare_at_points(equations, roots, seed, check);
  // Formulas may agree on their side alone, as √(x²) and x where x > 0: then random signs tell, if they meet all sides.
  if (sides == Sides::Differ && check.verdict == Verdict::Zero && check.error_bound > certain) {
    check.verdict = Verdict::Undecided;
    check.reason = "On one side of a switch the two formulas differ, and random points did not meet that side.";
  }
  return check;
}

/// The readable equations against the computed ones.
CertificateCheck readable_forms(const FieldEquations& equations) {
  CertificateCheck check;
  check.name = "forms_agree";
  check.statement = "The equations shown are the computed ones.";
  std::vector<Expr> differences;
  for (std::size_t a = 0; a < equations.varied.size(); ++a) {
    const ReadableForm form = readable_residual(equations, a);
    Expr shown = form.value;
    for (auto i = form.intermediates.rbegin(); i != form.intermediates.rend(); ++i)
      shown = substitute(shown, {{i->symbol, i->value}});
    differences.push_back(equations.system().expanded(shown - equations.residuals[a]));
  }
  const ZeroTest test = zero_test(differences);
  check.verdict = test.verdict;
  check.points = test.points;
  check.error_bound = test.error_bound;
  check.reason = test.reason;
  return check;
}

}  // namespace

Certificate certify(const FieldEquations& equations, std::uint64_t seed) {
  Certificate out{{boundary_identity(equations, seed), readable_forms(equations)}};
  certify_bodies(equations, out);
  return out;
}

}  // namespace maupertuis
