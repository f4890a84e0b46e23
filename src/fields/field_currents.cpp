#include <maupertuis/evaluate.hpp>
#include <maupertuis/fields.hpp>
#include <maupertuis/interrupt_scope.hpp>

#include "fields/noether_ansatz.hpp"
#include "symbolic/evaluate/field_numbers.hpp"
#include "symbolic/evaluate/normalize.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

/// Noether's theorem by linear algebra. Generators ξ^μ ∂_μ + η_a ∂/∂φ_a with ξ affine in t, x and η affine in t, x and
/// the fields; of characteristic Q_a = η_a − ξ^μ φ_a,μ. One is a symmetry of the action exactly where Q·E is a
/// divergence, that is where its Euler operator δ(Q·E)/δφ_b vanishes identically: linear in the coefficients of the
/// ansatz. The null space is found at random points of a prime field, brought to the form with the fewest generators in
/// each vector, and its few coefficients are then solved for as expressions of the parameters. The current is written
/// out from B^μ of the same characteristic and certified: ∂_μ j^μ − Q·E = 0 by the zero test.
namespace maupertuis {
namespace {

using evaluation::FieldNumbers;
using Scalar = FieldNumbers::Value;

Expr power_of(const FieldEquations& equations, const std::vector<Expr>& q) {
  Expr sum = equations.system().context->number(0);
  for (std::size_t a = 0; a < q.size(); ++a) sum = sum + q[a] * equations.system().expanded(equations.euler[a]);
  return sum;
}

/// δf/δφ_b = Σ (−D)^J ∂f/∂φ_b,J
Expr euler_operator(const FieldSystem& s, Expr f, std::size_t field) {
  std::vector<Expr> jets;
  for (const Expr& jet : s.jets_in(f))
    if (s.jet_of(jet)->field == field) jets.push_back(jet);
  const std::vector<Expr> slopes = gradient(f, jets);
  std::vector<Expr> terms;
  for (std::size_t i = 0; i < jets.size(); ++i) {
    Expr term = slopes[i];
    const FieldJet jet = *s.jet_of(jets[i]);
    for (std::size_t x = 0; x < s.space.size(); ++x)
      for (int k = 0; k < jet.space[x]; ++k) term = -s.total_derivative(term, x);
    for (int k = 0; k < jet.time; ++k) term = -s.total_derivative(term, s.space.size());
    terms.push_back(term);
  }
  return s.context->sum(terms);
}

/// [generators × fields]
std::vector<std::vector<Expr>> conditions(const FieldEquations& equations, const std::vector<Generator>& generators) {
  std::vector<std::vector<Expr>> out;
  for (const Generator& g : generators) {
    interrupt_of(*equations.system().context).throw_if_asked();
    const Expr power = power_of(equations, g.characteristic);
    out.emplace_back();
    for (const std::size_t f : equations.varied) out.back().push_back(euler_operator(equations.system(), power, f));
  }
  return out;
}

/// Values of the conditions at one point of the prime field: [fields × generators], rows that are not 0.
using Matrix = std::vector<std::vector<Scalar>>;

class PrimeRows {
 public:
  PrimeRows(const std::vector<std::vector<Expr>>& table)
      : columns_(table.size()),
        fields_(table.front().size()),
        tape_(tape_of(table)),
        hints_(evaluation::field_hints(tape_)),
        primes_(evaluation::agreeing_primes(hints_, 0x6e6f6574686572)) {}

  /// The parameters keep their values from point to point: the seed draws symbols by name, so only jets and places are
  /// drawn anew, by `numbers` below.
  Matrix rows(std::size_t points, const FieldSystem& s) {
    Matrix out;
    FieldNumbers base(primes_, hints_, 1);
    std::vector<Scalar> values;
    for (std::size_t point = 0; point < points; ++point) {
      Numbers numbers{base, s, point + 2};
      try {
        evaluation::run(tape_, numbers, values);
      } catch (const evaluation::Redraw&) {
        continue;
      }
      for (std::size_t f = 0; f < fields_; ++f) {
        out.emplace_back();
        for (std::size_t g = 0; g < columns_; ++g) out.back().push_back(values[tape_.roots()[g * fields_ + f]]);
      }
    }
    return out;
  }
  const evaluation::PrimeField field() const { return FieldNumbers(primes_, hints_, 1).field(); }

 private:
  struct Numbers : FieldNumbers {
    Numbers(const FieldNumbers& base, const FieldSystem& s, std::uint64_t point)
        : FieldNumbers(base), system(s), point(point) {}
    Value symbol(Expr e) {
      bool varies = e.role() == Role::Time || system.jet_of(e).has_value();
      for (const SpaceVariable& x : system.space) varies = varies || e == x.symbol;
      return varies ? random(0x6a6574 + point, e.id()) : FieldNumbers::symbol(e);
    }
    const FieldSystem& system;
    std::uint64_t point;
  };
  static evaluation::Tape tape_of(const std::vector<std::vector<Expr>>& table) {
    std::vector<Expr> roots;
    for (const auto& row : table) roots.insert(roots.end(), row.begin(), row.end());
    return evaluation::Tape::with_gaussians(evaluation::flatten_arguments(roots));
  }
  std::size_t columns_, fields_;
  evaluation::Tape tape_;
  evaluation::FieldHints hints_;
  evaluation::PrimeTriple primes_;
};

/// Reduced row echelon form; the pivot columns.
std::vector<std::size_t> reduce(Matrix& m, std::size_t columns, const evaluation::PrimeField& f,
                                const std::vector<std::size_t>& order) {
  std::vector<std::size_t> pivots;
  std::size_t row = 0;
  for (const std::size_t c : order) {
    std::size_t p = row;
    while (p < m.size() && m[p][c] == 0) ++p;
    if (p == m.size()) continue;
    std::swap(m[p], m[row]);
    const Scalar inverse = f.inverse(m[row][c]);
    for (std::size_t j = 0; j < columns; ++j) m[row][j] = f.multiply(m[row][j], inverse);
    for (std::size_t i = 0; i < m.size(); ++i) {
      if (i == row || m[i][c] == 0) continue;
      const Scalar factor = m[i][c];
      for (std::size_t j = 0; j < columns; ++j) m[i][j] = f.subtract(m[i][j], f.multiply(factor, m[row][j]));
    }
    pivots.push_back(c);
    ++row;
  }
  m.resize(row);
  return pivots;
}

/// The generators of a symmetry that stand in it with a factor other than 0, the first with 1; `numbers`: the factors
/// that are numbers of few digits, whatever the parameters are.
struct Support {
  std::vector<std::size_t> generators;
  std::vector<std::optional<Rational>> numbers;
};

/// A number of few digits with this image; one of a parameter is as good as never taken for it.
std::optional<Rational> small_number(Scalar value, const evaluation::PrimeField& f) {
  constexpr std::uint64_t most = 1000;
  for (std::uint64_t denominator = 1; denominator <= 12; ++denominator) {
    const std::uint64_t r = f.residue(f.multiply(value, f.from_residue(denominator)));
    const auto d = static_cast<std::int64_t>(denominator);
    if (r <= most) return Rational(static_cast<std::int64_t>(r), d);
    if (f.prime() - r <= most) return Rational(-static_cast<std::int64_t>(f.prime() - r), d);
  }
  return std::nullopt;
}

/// Shifts and motions that are simplest come last in the elimination, so that they stay free and each vector has few
/// others.
std::vector<Support> supports(Matrix rows, std::size_t columns, const evaluation::PrimeField& f) {
  std::vector<std::size_t> order;
  for (std::size_t c = columns; c-- > 0;) order.push_back(c);
  const std::vector<std::size_t> pivots = reduce(rows, columns, f, order);
  std::vector<Support> out;
  for (std::size_t free = 0; free < columns; ++free) {
    if (std::find(pivots.begin(), pivots.end(), free) != pivots.end()) continue;
    Support support{{free}, {Rational(1)}};
    for (std::size_t r = 0; r < pivots.size(); ++r)
      if (rows[r][free] != 0) {
        support.generators.push_back(pivots[r]);
        support.numbers.push_back(small_number(f.subtract(0, rows[r][free]), f));
      }
    out.push_back(std::move(support));
  }
  return out;
}

// ------------------------------------------------------------------------------------- coefficients as expressions

/// Values of jets and places: small integers, so that what is left are the parameters.
ExprMap integer_point(const FieldSystem& s, const std::vector<Expr>& expressions, std::uint64_t seed) {
  ExprMap out;
  for (const Expr& symbol : symbols_of(expressions)) {
    bool varies = symbol.role() == Role::Time || s.jet_of(symbol);
    for (const SpaceVariable& x : s.space) varies = varies || symbol == x.symbol;
    if (!varies) continue;
    seed = evaluation::mix(seed);
    out[symbol] = s.context->number(static_cast<std::int64_t>(seed % 13) - 6);
  }
  return out;
}

/// The coefficients of a symmetry, that of its first generator 1; empty where they were not found. Those that are
/// numbers are taken as such, and the currents are certified afterwards.
std::vector<Expr> coefficients(const FieldEquations& equations, const std::vector<std::vector<Expr>>& table,
                               const Support& support) {
  const FieldSystem& s = equations.system();
  Context& context = *s.context;
  std::vector<std::size_t> unknown;  // in the support
  for (std::size_t j = 0; j < support.generators.size(); ++j)
    if (!support.numbers[j]) unknown.push_back(j);
  const std::size_t unknowns = unknown.size();
  std::vector<std::vector<Expr>> rows;  // [unknowns × (unknowns + 1)], the last: minus what the others give
  std::vector<Expr> all;
  for (const std::size_t g : support.generators) all.insert(all.end(), table[g].begin(), table[g].end());
  for (std::uint64_t point = 1; point < 12 + 2 * unknowns && rows.size() < unknowns; ++point) {
    const ExprMap values = integer_point(s, all, point);
    for (std::size_t f = 0; f < table.front().size() && rows.size() < unknowns; ++f) {
      const auto at = [&](std::size_t j) { return substitute(table[support.generators[j]][f], values); };
      std::vector<Expr> row;
      for (const std::size_t j : unknown) row.push_back(at(j));
      row.push_back(context.number(0));
      for (std::size_t j = 0; j < support.generators.size(); ++j)
        if (support.numbers[j]) row.back() = row.back() - *support.numbers[j] * at(j);
      for (std::size_t r = 0; r < rows.size(); ++r) {  // eliminate with the rows so far, whose pivot is column r
        const Expr factor = row[r];
        if (factor.is_zero()) continue;
        for (std::size_t j = 0; j <= unknowns; ++j) row[j] = row[j] - factor * rows[r][j];
      }
      const std::size_t pivot = rows.size();
      std::size_t column = pivot;
      while (column < unknowns && vanishes_identically(row[column])) ++column;
      if (column == unknowns) continue;
      if (column != pivot) return {};  // columns are not exchanged: such a symmetry is told with numbers alone
      const Expr divisor = row[pivot];
      for (Expr& x : row) x = readable(x / divisor, equations.order).value;
      for (auto& other : rows) {
        const Expr factor = other[pivot];
        for (std::size_t j = 0; j <= unknowns; ++j)
          other[j] = readable(other[j] - factor * row[j], equations.order).value;
      }
      rows.push_back(std::move(row));
    }
  }
  if (rows.size() < unknowns) return {};
  std::vector<Expr> out;
  std::size_t next = 0;
  for (const auto& number : support.numbers) out.push_back(number ? context.number(*number) : rows[next++].back());
  return out;
}

// ---------------------------------------------------------------------------------------------------------- currents

/// B^μ(Q): the boundary terms with the jets of η replaced by derivatives of Q.
std::vector<Expr> boundary_of(const FieldEquations& equations, const std::vector<Expr>& q) {
  const FieldSystem& s = equations.with_variations;
  std::vector<Expr> out;
  for (const Expr& written : equations.boundary_terms) {
    const Expr b = s.expanded(written);
    ExprMap map;
    for (const Expr& symbol : s.jets_in(b)) {
      const FieldJet jet = *s.jet_of(symbol);
      if (jet.field < equations.system().fields.size()) continue;
      Expr value = q[jet.field - equations.system().fields.size()];
      for (std::size_t x = 0; x < s.space.size(); ++x)
        for (int k = 0; k < jet.space[x]; ++k) value = s.total_derivative(value, x);
      for (int k = 0; k < jet.time; ++k) value = s.total_derivative(value, s.space.size());
      map[symbol] = value;
    }
    out.push_back(substitute(b, map));
  }
  return out;
}

/// K^μ with δℒ(Q) = ∂_μ K^μ: −ξ^μ ℒ, and for what is left a polynomial in t, x and φ of an ansatz of its own; here: η
/// alone leaves 0 or the derivative of a linear function, which is found by parts.
std::vector<Expr> gauge_of(const FieldEquations& equations, const std::vector<Expr>& xi) {
  const FieldSystem& s = equations.system();
  std::vector<Expr> out;
  for (std::size_t mu = 0; mu <= s.space.size(); ++mu) out.push_back(-(xi[mu] * s.expanded(s.density)));
  return out;
}

/// δℒ(Q) = Σ ∂ℒ/∂φ_J D_J Q
Expr varied_density(const FieldEquations& equations, const std::vector<Expr>& q) {
  const FieldSystem& s = equations.system();
  const Expr density = s.expanded(s.density);
  const std::vector<Expr> jets = s.jets_in(density);
  const std::vector<Expr> slopes = gradient(density, jets);
  std::vector<Expr> terms;
  for (std::size_t i = 0; i < jets.size(); ++i) {
    const FieldJet jet = *s.jet_of(jets[i]);
    const auto at = std::find(equations.varied.begin(), equations.varied.end(), jet.field);
    if (at == equations.varied.end()) continue;
    Expr value = q[static_cast<std::size_t>(at - equations.varied.begin())];
    for (std::size_t x = 0; x < s.space.size(); ++x)
      for (int k = 0; k < jet.space[x]; ++k) value = s.total_derivative(value, x);
    for (int k = 0; k < jet.time; ++k) value = s.total_derivative(value, s.space.size());
    terms.push_back(slopes[i] * value);
  }
  return s.context->sum(terms);
}

/// The homotopy of a divergence that is linear in the fields or of first degree in one jet at a time: f = D_μ K^μ for
/// f = Σ c_J(t, x) φ_J. Nothing where f is more than that.
std::optional<std::vector<Expr>> linear_gauge(const FieldEquations& equations, Expr f) {
  const FieldSystem& s = equations.system();
  std::vector<Expr> out(s.space.size() + 1, s.context->number(0));
  for (int round = 0; round < 8; ++round) {
    if (vanishes_identically(f)) return out;
    const std::vector<Expr> jets = s.jets_in(f);
    const std::vector<Expr> slopes = gradient(f, jets);
    bool moved = false;
    for (std::size_t i = 0; i < jets.size() && !moved; ++i) {
      FieldJet jet = *s.jet_of(jets[i]);
      const Expr slope = expand(slopes[i]);
      if (!slope || jet.order() == 0 || vanishes_identically(slope)) continue;
      for (std::size_t mu = 0; mu <= s.space.size() && !moved; ++mu) {
        int& count = mu == s.space.size() ? jet.time : jet.space[mu];
        if (count == 0) continue;
        --count;
        const Expr lower = s.jet_symbol(jet);
        ++count;
        // slope·D_μ lower: where the slope holds only `lower` itself, the integral over it
        const Expr in_slope = differentiate(slope, lower);
        const Expr part = vanishes_identically(in_slope) ? slope * lower : Rational(1, 2) * (slope * lower);
        out[mu] = out[mu] + part;
        f = f - s.total_derivative(part, mu);
        const Expr flat = expand(f);
        if (flat) f = flat;
        moved = true;
      }
    }
    if (!moved) return std::nullopt;
  }
  return std::nullopt;
}

/// Q·E on motions, which friction and forces make other than 0; an empty handle where they do not.
Expr source_of(const FieldEquations& equations, const std::vector<Expr>& q) {
  const FieldSystem& s = equations.system();
  Expr sum = s.context->number(0);
  for (std::size_t a = 0; a < q.size(); ++a) sum = sum + q[a] * s.expanded(equations.euler[a] + equations.residuals[a]);
  return vanishes_identically(sum) ? Expr{} : sum;
}

std::optional<FieldCurrent> current_of(const FieldEquations& equations, const std::vector<Generator>& generators,
                                       const std::vector<std::size_t>& support, const std::vector<Expr>& c) {
  const FieldSystem& s = equations.system();
  const std::size_t n = s.space.size();
  std::vector<Expr> q(equations.varied.size(), s.context->number(0)), xi(n + 1, s.context->number(0));
  for (std::size_t i = 0; i < support.size(); ++i) {
    const Generator& g = generators[support[i]];
    for (std::size_t a = 0; a < q.size(); ++a) q[a] = q[a] + c[i] * g.characteristic[a];
    if (g.moves_space) xi[g.index] = xi[g.index] + c[i] * g.factor;
  }
  // δℒ(Q) = Q·E + ∂B(Q) = ∂K, so that ∂(K − B) = Q·E.
  std::vector<Expr> k = gauge_of(equations, xi);
  Expr left = varied_density(equations, q);
  for (std::size_t mu = 0; mu <= n; ++mu) left = left - s.total_derivative(k[mu], mu);
  const auto rest = linear_gauge(equations, left);
  if (!rest) return std::nullopt;
  const std::vector<Expr> b = boundary_of(equations, q);
  std::vector<Expr> j;
  for (std::size_t mu = 0; mu <= n; ++mu) j.push_back(k[mu] + (*rest)[mu] - b[mu]);
  FieldCurrent out;
  std::vector<const Generator*> parts;
  for (const std::size_t i : support) parts.push_back(&generators[i]);
  const NamedCurrent named = name_of(equations, parts);
  const bool inner = std::none_of(parts.begin(), parts.end(), [](const Generator* g) { return g->moves_space; });
  if (named.reversed || (inner && is_nowhere_positive(equations, j[n]))) {
    for (Expr& x : q) x = -x;
    for (Expr& x : j) x = -x;
  }
  out.name = named.name;
  out.meaning = named.meaning;
  Expr difference = -power_of(equations, q);
  for (std::size_t mu = 0; mu <= n; ++mu) difference = difference + s.total_derivative(j[mu], mu);
  out.certified = vanishes_identically(difference);
  if (!out.certified) return std::nullopt;
  out.characteristic = q;
  out.density = j[n];
  out.fluxes.assign(j.begin(), j.begin() + static_cast<std::ptrdiff_t>(n));
  out.source = source_of(equations, q);
  return out;
}

}  // namespace

FieldCurrents field_currents(const FieldEquations& equations) {
  FieldCurrents out;
  const FieldSystem& s = equations.system();
  const bool forced = s.dissipation ||
                      std::any_of(s.forces.begin(), s.forces.end(), [](const Expr& f) { return static_cast<bool>(f); });
  out.basis =
      "Looked for among symmetries ξ ∂ + η ∂/∂φ with ξ affine in space and time, η affine in space, time and the "
      "fields; each is certified by ∂_μ j^μ = Q·E.";
  if (forced)
    out.basis +=
        " Forces and dissipation do not come from the density. Where they change what flows, the divergence is not 0 "
        "on motions but what is shown beside the current.";
  const std::vector<Generator> generators = Ansatz(equations).generators;
  const std::vector<std::vector<Expr>> table = conditions(equations, generators);
  PrimeRows prime(table);
  const auto found = supports(prime.rows(generators.size() + 8, s), generators.size(), prime.field());
  std::size_t unwritten = 0;
  for (const Support& support : found) {
    interrupt_of(*s.context).throw_if_asked();
    const std::vector<Expr> c = coefficients(equations, table, support);
    auto current = c.empty() ? std::nullopt : current_of(equations, generators, support.generators, c);
    if (current)
      out.currents.push_back(std::move(*current));
    else
      ++unwritten;
  }
  const auto place = [](const FieldCurrent& c) {
    return c.name == "energy" ? 0 : c.name.rfind("momentum", 0) == 0 ? 1 : c.name == "angular momentum" ? 2 : 3;
  };
  std::stable_sort(out.currents.begin(), out.currents.end(),
                   [&](const FieldCurrent& a, const FieldCurrent& b) { return place(a) < place(b); });
  if (unwritten)
    out.basis += fmt::format(" {} more symmetries were found whose currents are not written out here.", unwritten);
  return out;
}

}  // namespace maupertuis
