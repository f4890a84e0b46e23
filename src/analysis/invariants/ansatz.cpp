#include "analysis/invariants/ansatz.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/print.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

namespace maupertuis::invariants {
namespace {

using Monomials = std::vector<Monomial>;

struct MonomialHash {
  std::size_t operator()(const Monomial& m) const {
    std::uint64_t h = m.size();
    for (const Factor& f : m)
      h = h * 0x9e3779b97f4a7c15 + (std::uint64_t{f.generator} << 8) + static_cast<unsigned>(f.exponent);
    return static_cast<std::size_t>(h ^ h >> 32);
  }
};

/// Each monomial once, in the order in which they come.
class Distinct {
 public:
  void add(Monomial m) {
    if (seen_.insert(m).second) list_.push_back(std::move(m));
  }
  Monomials take() { return std::move(list_); }

 private:
  Monomials list_;
  std::unordered_set<Monomial, MonomialHash> seen_;
};

Monomials products(const Monomials& a, const Monomials& b) {
  Distinct out;
  for (const Monomial& x : a)
    for (const Monomial& y : b) out.add(product(x, y));
  return out.take();
}

Monomials joined(std::initializer_list<Monomials> lists) {
  Distinct out;
  for (const Monomials& list : lists)
    for (const Monomial& m : list) out.add(m);
  return out.take();
}

/// 1 and the functions of a list that are independent.
Monomials with_one(const MotionRows& rows, const Generators& g, const Monomials& list, std::uint64_t seed) {
  Monomials out = independent_functions(rows, g, list, seed);
  out.insert(out.begin(), Monomial{});
  return out;
}

void append(Monomials& out, const Monomials& more) {
  for (const Monomial& m : more)
    if (!m.empty()) out.push_back(m);
}

/// All products of `degree` of the given generators.
Monomials powers(const Monomials& generators, int degree) {
  Monomials out{Monomial{}};
  for (int d = 0; d < degree; ++d) {
    Monomials next;
    for (const Monomial& m : out)
      for (const Monomial& g : generators)
        if (m.empty() || m.back().generator <= g[0].generator) next.push_back(product(m, g));
    out = std::move(next);
  }
  return out;
}

std::string names_of(const Generators& g, const Monomials& list, const ReadingOrder& order) {
  constexpr std::size_t most = 12;
  std::string out;
  for (std::size_t i = 0; i < std::min(most, list.size()); ++i)
    out += (out.empty() ? "" : ", ") + to_plain(g.expression(list[i]), order);
  return list.size() <= most ? out : fmt::format("{}, … ({} in all)", out, list.size());
}

/// 1, t, …, t^degree; with e^{gt}, sin Wt, … and their products in pairs, of few in threes.
Monomials time_functions(Ansatz& a, int degree) {
  Monomials out{Monomial{}};
  const Monomial t = a.generators.add(a.generators.context().time());
  for (int k = 1; k <= degree; ++k) out.push_back({{t[0].generator, k}});
  out = joined({out, a.atoms.time});
  const Monomials pairs = products(a.atoms.time, a.atoms.time);
  out = joined({out, pairs});
  if (a.momenta.size() == 1 && a.atoms.time.size() <= 4) out = joined({out, products(pairs, a.atoms.time)});
  return out;
}

bool is_reversible(const MotionRows& rows) {
  if (rows.constraint.rows > 0) return false;
  ExprMap reversed;
  for (const Coordinate& c : rows.system->coordinates) reversed.emplace(c.velocity, -c.velocity);
  std::vector<Expr> all = rows.bias;
  all.insert(all.end(), rows.mass.entries.begin(), rows.mass.entries.end());
  const auto mirrored = substitute(all, reversed);
  std::vector<Expr> differences;
  for (std::size_t i = 0; i < all.size(); ++i) differences.push_back(all[i] - mirrored[i]);
  return zero_test(differences).verdict == Verdict::Zero;
}

/// Body rates and the vertical in body axes: in them the integrals of tops are polynomials.
void take_body(Ansatz& a, const MechanicalSystem& system) {
  if (system.bodies.size() != 1 || system.space_dimension != 3 || system.coordinates.size() > 4) return;
  const Body& body = system.bodies[0];
  a.velocities = in_state_variables(system, body.angular_velocity);
  for (std::size_t axis = 0; axis < 3; ++axis) a.directions.push_back(body.rotation.at(2, axis));
  a.directions = in_state_variables(system, a.directions);
}

}  // namespace

Ansatz make_ansatz(const EquationsOfMotion& equations, const MotionRows& rows) {
  const MechanicalSystem& system = *equations.system;
  Ansatz a{Generators(*system.context), {}, {}, {}, {}, {}, {}};
  a.atoms = collect_atoms(equations, a.generators);
  a.world = world_of(equations);
  a.energy = in_state_variables(system, {equations.energy_function}).front();
  a.momenta = in_state_variables(system, equations.momenta);
  for (const Coordinate& c : system.coordinates) a.velocities.push_back(c.velocity);
  take_body(a, system);
  a.constant_mass = std::all_of(rows.mass.entries.begin(), rows.mass.entries.end(), is_parametric);
  for (const auto* list : {&rows.bias, &rows.mass.entries, &rows.constraint.entries, &rows.velocity})
    for (const Expr& e : *list) a.explicit_time |= depends_on_time_itself(e);
  a.reversible = is_reversible(rows);
  return a;
}

namespace {

/// How rich a basis of charges is.
struct Richness {
  int time_degree;
  enum { Constant, Affine, Functions, Pairs, Quadratic } displacements;  // of what the η are combinations
};

/// Where M is constant, no richer η than affine ones belong to symmetries.
Monomials displacement_functions(const Ansatz& a, Richness r) {
  if (r.displacements == Richness::Constant) return {};
  if (r.displacements == Richness::Affine || a.constant_mass) return a.atoms.coordinates;
  const Monomials& functions = a.atoms.functions;
  Monomials out = joined({a.atoms.coordinates, functions, a.atoms.products});
  if (r.displacements >= Richness::Pairs) out = joined({out, products(functions, functions)});
  // x² − y² and x y: an isometry of the half-plane (dx² + dy²)/y²
  return r.displacements == Richness::Quadratic ? joined({out, products(a.atoms.coordinates, a.atoms.coordinates)})
                                                : out;
}

Monomials gauge_functions(const Ansatz& a, Richness r) {
  const Atoms& atoms = a.atoms;
  if (r.displacements == Richness::Constant) return {};
  if (r.displacements == Richness::Affine && !a.constant_mass) return atoms.coordinates;
  Monomials out = joined({atoms.coordinates, products(atoms.coordinates, atoms.coordinates), atoms.functions,
                          products(atoms.functions, atoms.coordinates), atoms.products});
  // cos φ/sin θ: what the field of a monopole takes in spherical coordinates
  return r.displacements >= Richness::Pairs && !a.constant_mass
             ? joined({out, products(atoms.functions, atoms.functions)})
             : out;
}

/// The physical candidates first: total momentum, angular momentum, moment of mass.
void add_candidates(Ansatz& a, Monomials& out) {
  const Monomial t = a.generators.add(a.generators.context().time());
  for (const ExprVector* list : {&a.world.momentum, &a.world.angular_momentum, &a.world.mass_moment})
    for (const Expr& e : *list)
      if (!is_parametric(e)) out.push_back(a.generators.add(e));
  for (const Expr& e : a.world.momentum)
    if (!is_parametric(e)) out.push_back(product(t, a.generators.add(e)));
  const Orbit orbit = orbit_of(a.world);
  if (!orbit.relative || !a.constant_mass) return;
  for (const Expr& x : orbit.position)
    for (const Expr& v : orbit.velocity) out.push_back(product(a.generators.add(x), a.generators.add(v)));
}

/// No monomials where there would be more than `largest`: told from the lists, before it costs something to find which
/// of their functions are independent.
Basis charges(Ansatz& a, const MotionRows& rows, Richness r, std::size_t largest, std::uint64_t seed) {
  const Atoms& atoms = a.atoms;
  Generators& g = a.generators;
  Monomials displacements = displacement_functions(a, r), gauges = gauge_functions(a, r);
  if ((1 + displacements.size()) * a.momenta.size() + gauges.size() > largest) return {};
  displacements = with_one(rows, g, displacements, seed);
  gauges = with_one(rows, g, gauges, seed + 1);
  const Monomials few = with_one(rows, g, time_functions(a, r.time_degree), seed + 2),
                  more = with_one(rows, g, time_functions(a, r.time_degree + 1), seed + 3);
  Basis basis;
  add_candidates(a, basis.monomials);
  append(basis.monomials, products(gauges, more));
  Monomials p;
  for (const Expr& momentum : a.momenta) p.push_back(g.add(momentum));
  append(basis.monomials, products(products(displacements, few), p));
  Monomials energy =
      products({g.add(a.energy)}, with_one(rows, g, time_functions(a, std::min(2, r.time_degree)), seed + 4));
  if (!atoms.natural) energy = joined({energy, products(energy, atoms.coordinates)});
  append(basis.monomials, energy);
  basis.description = fmt::format(
      "point symmetries ξ(t{}), η(q, t) up to gauge f(q, t): ξ of degree {} in t; η from {} functions of position, f "
      "from {}, "
      "with t up to degree {} and {}",
      atoms.natural ? "" : ", q", std::min(2, r.time_degree), displacements.size(), gauges.size(), r.time_degree,
      r.time_degree + 1);
  ReadingOrder order;
  if (!atoms.functions.empty() || !atoms.time.empty())
    basis.description += "; atoms " + names_of(g, joined({atoms.functions, atoms.time}), order);
  return basis;
}

}  // namespace

Basis noether_basis(Ansatz& a, const MotionRows& rows, std::size_t largest, std::uint64_t seed) {
  const bool few = a.momenta.size() <= 3;
  const int richest = few ? 3 : 2;
  using R = Richness;
  for (const Richness r :
       {R{richest, few ? R::Quadratic : R::Pairs}, R{richest, R::Pairs}, R{1, R::Pairs}, R{1, R::Functions},
        R{0, R::Functions}, R{1, R::Affine}, R{0, R::Affine}, R{0, R::Constant}}) {
    Basis basis = charges(a, rows, r, largest, seed);
    if (!basis.monomials.empty() && basis.monomials.size() <= largest) return basis;
  }
  return {};
}

namespace {

/// Functions of position, some of which may depend on others: level 2 and 3 multiply in pairs.
Monomials positions(Ansatz& a, int level) {
  const Atoms& atoms = a.atoms;
  if (!a.directions.empty()) {
    Monomials g;
    for (const Expr& e : a.directions) g.push_back(a.generators.add(e));
    return level > 1 ? joined({g, powers(g, 2)}) : g;
  }
  const Monomials first = joined({atoms.coordinates, atoms.functions, atoms.products});
  if (level == 1) return first;
  const Monomials simple = joined({atoms.coordinates, atoms.functions});
  return joined({first, products(simple, simple)});
}

/// How many products of velocities there are, of a degree and of those below it with its parity (−1: all).
std::size_t count_of_powers(std::size_t velocities, int degree, int parity) {
  std::size_t out = 0, of_degree = 1;  // C(n + d − 1, d)
  for (int d = 0; d <= degree; ++d) {
    if (parity < 0 || d % 2 == parity) out += of_degree;
    of_degree = of_degree * (velocities + static_cast<std::size_t>(d)) / (static_cast<std::size_t>(d) + 1);
  }
  return out;
}

/// Coefficients of velocity degree d are functions of position times as many terms of V as there are pairs of
/// velocities less than at the top, as in the energy: `coefficients[j]` stands beside degree − 2j and degree − 2j − 1.
std::vector<Monomials> coefficients_by_degree(Ansatz& a, const MotionRows& rows, const Monomials& top, int degree,
                                              bool with_potentials, std::uint64_t seed) {
  std::vector<Monomials> out{top};
  for (int j = 1; 2 * j <= degree; ++j) {
    if (!with_potentials)
      out.push_back(top);
    else
      out.push_back(with_one(rows, a.generators, joined({out.back(), products(out.back(), a.atoms.potentials)}), seed));
  }
  return out;
}

Monomials polynomial(Ansatz& a, const std::vector<Monomials>& coefficients, const Monomials& times, int degree,
                     int parity) {
  Monomials velocities, out;
  for (const Expr& v : a.velocities) velocities.push_back(a.generators.add(v));
  for (int d = 0; d <= degree; ++d)
    if (parity < 0 || d % 2 == parity)
      append(out, products(products(coefficients[static_cast<std::size_t>((degree - d) / 2)], times),
                           powers(velocities, d)));
  return out;
}

}  // namespace

namespace {

/// Of two particles: polynomials in their relative velocity alone.
Basis relative_basis(Ansatz& a, const MotionRows& rows, int degree, std::uint64_t seed) {
  const Orbit orbit = orbit_of(a.world);
  if (!orbit.relative || !a.constant_mass || !a.reversible) return {};
  Monomials positions, velocities;
  for (const Expr& x : orbit.position) positions.push_back(a.generators.add(x));
  for (const Expr& v : orbit.velocity) velocities.push_back(a.generators.add(v));
  positions = with_one(
      rows, a.generators,
      joined({positions, a.atoms.functions, products(positions, joined({positions, a.atoms.functions}))}), seed);
  Basis basis;
  for (int d = degree % 2; d <= degree; d += 2) append(basis.monomials, products(positions, powers(velocities, d)));
  basis.description = fmt::format(
      "polynomials of degree {} in the relative velocity, coefficients from {} functions of relative position: {} "
      "functions",
      degree, positions.size(), basis.monomials.size());
  return basis;
}

/// Whether the coordinate itself is the argument of a sine or a cosine.
bool is_angle(const Ansatz& a, const Monomial& q) {
  const std::vector<Expr>& values = a.generators.values();
  return std::any_of(a.atoms.functions.begin(), a.atoms.functions.end(), [&](const Monomial& f) {
    const Expr e = values[f[0].generator];
    return f.size() == 1 && (e.is(Kind::Sin) || e.is(Kind::Cos)) && e[0] == values[q[0].generator];
  });
}

/// Of two coordinates of which one or both are angles: products of powers of the one and of sines and cosines of half
/// the other, up to the third. In them the integral of the swinging Atwood machine is a polynomial.
Basis half_angle_basis(Ansatz& a, const MotionRows& rows, int degree, int parity, std::uint64_t seed) {
  constexpr int highest = 3;
  if (a.atoms.coordinates.size() != 2 || a.explicit_time || rows.constraint.rows > 0 || !a.directions.empty())
    return {};
  Monomials functions{Monomial{}};
  bool any = false;
  const Monomials coordinates = a.atoms.coordinates;
  for (const Monomial& q : coordinates) {
    const bool angle = is_angle(a, q);
    any |= angle;
    const Expr half = a.generators.values()[q[0].generator] * Rational(1, 2);
    const Monomials of_one = angle ? Monomials{a.generators.add(sin(half)), a.generators.add(cos(half))} : Monomials{q};
    Monomials list{Monomial{}};
    for (int k = 1; k <= highest; ++k) list = joined({list, powers(of_one, k)});
    functions = products(functions, list);
  }
  if (!any) return {};
  Basis basis{polynomial(a,
                         std::vector<Monomials>(static_cast<std::size_t>(degree) / 2 + 1,
                                                with_one(rows, a.generators, functions, seed)),
                         {Monomial{}}, degree, parity),
              {}};
  basis.description = fmt::format(
      "polynomials {}of degree {} in the velocities, coefficients from sines and cosines of half the angles and powers "
      "of coordinates up to "
      "degree {}: {} functions",
      parity < 0   ? ""
      : parity % 2 ? "odd "
                   : "even ",
      degree, highest, basis.monomials.size());
  return basis;
}

}  // namespace

PolynomialBases polynomial_bases(Ansatz& a, const MotionRows& rows, int degree, std::size_t largest,
                                 std::uint64_t seed) {
  PolynomialBases out;
  Monomials times{Monomial{}};
  if (a.explicit_time) times = joined({times, a.atoms.time});
  const std::vector<int> parities = a.reversible ? std::vector<int>{degree % 2, 1 - degree % 2} : std::vector<int>{-1};
  for (const int level : {3, 2, 1}) {
    Monomials functions = positions(a, level);
    // Few functions depend on others: where even a quarter of them would be too many, it is not asked which.
    constexpr std::size_t dependent = 4;
    const std::size_t expected =
        (1 + functions.size()) * times.size() * count_of_powers(a.velocities.size(), degree, parities.front());
    if (expected > dependent * largest) {
      out.needed = expected;
      continue;
    }
    functions = with_one(rows, a.generators, functions, seed);
    if (level == 3 && (a.atoms.potentials.size() * functions.size() > largest || !a.directions.empty())) continue;
    const auto coefficients = coefficients_by_degree(a, rows, functions, degree, level == 3, seed + 1);
    out.bases.clear();
    out.needed = 0;
    for (const int parity : parities) {
      Basis basis{polynomial(a, coefficients, times, degree, parity), {}};
      out.needed = std::max(out.needed, basis.monomials.size());
      basis.description =
          fmt::format("polynomials {}of degree {} in {}, coefficients from {} functions of position{}: {} functions",
                      parity < 0   ? ""
                      : parity % 2 ? "odd "
                                   : "even ",
                      degree, a.directions.empty() ? "the velocities" : "the body rates", functions.size(),
                      level == 3 ? ", in the lower terms times those of V" : "", basis.monomials.size());
      if (!basis.monomials.empty()) out.bases.push_back(std::move(basis));
    }
    if (out.needed > largest) {
      out.bases.clear();
      continue;
    }
    if (Basis relative = relative_basis(a, rows, degree, seed + 2); !relative.monomials.empty())
      out.bases.insert(out.bases.begin(), std::move(relative));
    for (const int parity : parities)
      if (Basis half = half_angle_basis(a, rows, degree, parity, seed + 3);
          !half.monomials.empty() && half.monomials.size() <= largest)
        out.bases.push_back(std::move(half));
    return out;
  }
  return out;
}

}  // namespace maupertuis::invariants
