#include "system/kinetic_form.hpp"
#include "system/lint_manifold.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

/// Whether M = ∂²L/∂q̇∂q̇ can be solved for the accelerations, seen from numbers: M is sampled near the start. Under
/// constraints it may be singular, as long as it is regular on the directions that they leave.
namespace maupertuis::lint_rules {
namespace {

/// Beyond this number of coordinates M is made only where the form of the kinetic energy leaves a question.
constexpr std::size_t largest_looked_at_whole = 40;

/// M at a point. Up to a dozen freedoms by exact second derivatives; beyond, by unit differences of the momenta, which
/// are exact where T is quadratic in the velocities. Empty where L is undefined.
class MassMatrix {
 public:
  explicit MassMatrix(const Subject& s) : s_(s) {
    if (s.freedoms() > 12) return;
    for (const Expr& p : s.momenta)
      for (const Expr& entry : gradient(p, s.velocities)) exact_.push_back(entry);
  }

  Matrix at(Bindings point) const {
    const std::size_t n = s_.freedoms();
    Matrix m(n, Row(n));
    if (!exact_.empty()) {
      const Row flat = evaluate(exact_, point);
      for (std::size_t i = 0; i < n * n; ++i) m[i / n][i % n] = flat[i];
    } else {
      const Row base = evaluate(s_.momenta, point);
      for (std::size_t j = 0; j < n; ++j) {
        point[s_.velocities[j]] += 1;
        const Row moved = evaluate(s_.momenta, point);
        point[s_.velocities[j]] -= 1;
        for (std::size_t i = 0; i < n; ++i) m[i][j] = moved[i] - base[i];
      }
    }
    for (const Row& row : m)
      for (const double x : row)
        if (!std::isfinite(x)) return {};
    return m;
  }

 private:
  const Subject& s_;
  ExprVector exact_;  // [n × n], or empty
};

/// What M is at every sample where it is defined.
struct Findings {
  bool defined = false;
  bool singular = false;
  bool positive = true;
  std::vector<Row> null;  // of M on the directions that the constraints leave
  Row massless;           // not 0 for coordinates without kinetic energy, where the constraints tie them
};

/// `whole`: only where L has a value, too. Beyond it its derivatives may go on: 1/(1 - x²) of √(1 - x²) is negative
/// there.
Findings examine_where(bool whole, const Subject& s, const MassMatrix& matrix, const Manifold& manifold,
                       const Bindings& changed) {
  Findings out;
  for (int attempt = 0, good = 0; attempt < 9 && good < 2; ++attempt) {
    Bindings point = sample(s, attempt);
    for (const auto& [symbol, value] : changed) point[symbol] = value;
    if (!manifold.reach(point)) continue;
    if (whole && !std::isfinite(evaluate(s.lagrangian, point))) continue;
    const Matrix m = matrix.at(point), a = manifold.rows(point);
    if (m.empty()) continue;
    ++good;
    out.defined = true;
    const ReducedMass reduced = reduce(m, a);
    out.null = reduced.null;
    out.singular = !out.null.empty();
    if (out.singular) continue;
    out.positive = reduced.positive;
    for (const Row& row : m)
      out.massless.push_back(!a.empty() && std::all_of(row.begin(), row.end(), [](double x) { return x == 0; }));
    return out;
  }
  return out;
}

Findings examine(const Subject& s, const MassMatrix& matrix, const Manifold& manifold, const Bindings& changed) {
  const Findings inside = examine_where(true, s, matrix, manifold, changed);
  return inside.defined ? inside : examine_where(false, s, matrix, manifold, changed);
}

/// A parameter whose value 0 alone makes M singular.
const Parameter* zero_parameter_at_fault(const Subject& s, const MassMatrix& matrix, const Manifold& manifold) {
  for (const Parameter& p : s.system.parameters) {
    if (p.si_value != 0) continue;
    const Findings found = examine(s, matrix, manifold, {{p.symbol, 1.0}});
    if (found.defined && !found.singular) return &p;
  }
  return nullptr;
}

bool kinetic_energy_of_masses_alone(const MechanicalSystem& s) {
  if (s.lagrangian_given || s.kinetic.empty() || !s.lagrangian_extra.empty()) return false;
  return std::none_of(s.kinetic.begin(), s.kinetic.end(), [](const EnergyTerm& t) { return t.origin == "T"; });
}

/// "1 in x' and -1 in y'"
std::string combination(const Subject& s, const Row& v, double unit) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < v.size(); ++i)
    if (v[i] != 0) parts.push_back(fmt::format("{}' by {:.4g}", s.system.coordinates[i].name, v[i] / unit));
  std::string out;
  for (std::size_t i = 0; i < parts.size(); ++i)
    out += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
  return out;
}

std::string names(const Subject& s, const Row& v) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < v.size(); ++i)
    if (v[i] != 0) parts.push_back("`" + s.system.coordinates[i].name + "`");
  std::string out;
  for (std::size_t i = 0; i < parts.size(); ++i)
    out += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
  return out;
}

/// x as a fraction with a small denominator; nothing if it is none.
std::optional<Rational> small_fraction(double x) {
  for (std::int64_t below = 1; below <= 12; ++below) {
    const double above = std::round(x * static_cast<double>(below));
    if (std::abs(x * static_cast<double>(below) - above) < 1e-9 && std::abs(above) < 1000)
      return Rational(static_cast<std::int64_t>(above), below);
  }
  return std::nullopt;
}

/// "x + u and y - u": the combinations that T knows, where the null direction is the same everywhere; else empty.
std::string known_combinations(const Subject& s, const Row& v, std::size_t last) {
  std::vector<Rational> direction;
  ExprVector terms;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const auto part = small_fraction(v[i] / v[last]);
    if (!part) return {};
    direction.push_back(*part);
    terms.push_back(*part * s.momenta[i]);
  }
  const auto null = gradient(s.system.context->sum(terms), s.velocities);
  if (zero_test(null).verdict != Verdict::Zero) return {};
  std::string out;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (i == last || direction[i].is_zero()) continue;
    const Expr known = s.system.coordinates[i].q - direction[i] * s.system.coordinates[last].q;
    out += (out.empty() ? "" : " and ") + s.show(known);
  }
  return out;
}

/// Under constraints: nor do they.
std::string nor_constraint(const Subject& s, const char* does) {
  return s.system.constrained() ? fmt::format(", and no constraint {}", does) : "";
}

/// Where no time stands in L there is no kinetic energy either, and the condition is Legendre's.
bool is_in_time(const Subject& s) { return s.system.independent == "t"; }

void report_massless(Subject& s, std::size_t coordinate) {
  const Coordinate& c = s.system.coordinates[coordinate];
  if (!is_in_time(s)) {
    s.diagnostics.error(
        "E0407", c.span, fmt::format("the integrand is not curved in `{}'`", c.name),
        fmt::format("∂²L/∂{0}'² vanishes, so that the Euler-Lagrange equation does not give {0}''.", c.name),
        "Check the derivatives in L, or remove the coordinate.");
    return;
  }
  const bool from_masses = kinetic_energy_of_masses_alone(s.system);
  const std::string tied = nor_constraint(s, "determines it");
  s.diagnostics.error(
      "E0407", c.span, fmt::format("the coordinate `{}` has no kinetic energy", c.name),
      from_masses
          ? fmt::format("No mass moves when {0} changes{1}, so that no equation gives its acceleration {0}''.", c.name,
                        tied)
          : fmt::format("{0}' does not enter T{1}, so that no equation gives its acceleration {0}''.", c.name, tied),
      from_masses ? "Give a point that moves with it a mass, or a body its inertia."
                  : fmt::format("Add its part to T, or remove the coordinate.", c.name));
}

/// The norm of the quaternion that turns in this direction; null if none does.
const Constraint* quaternion_in(const Subject& s, const Row& v) {
  for (const Constraint& c : s.system.constraints)
    for (std::size_t i = 0; i < v.size() && !c.body.empty(); ++i)
      if (v[i] != 0 && s.system.coordinates[i].name.rfind(c.body + ".q", 0) == 0) return &c;
  return nullptr;
}

void report_massless_turn(Subject& s, const Constraint& norm) {
  s.diagnostics.error("E0407", norm.span, fmt::format("a rotation of `{}` has no kinetic energy", norm.body),
                      "Some turn of it moves no mass, so that no equation gives its angular acceleration.",
                      "Give the body its inertia about all three axes.");
}

void report_combination(Subject& s, const Row& v) {
  std::size_t last = 0;
  for (std::size_t i = 0; i < v.size(); ++i)
    if (v[i] != 0) last = i;
  const Coordinate& c = s.system.coordinates[last];
  const std::string change = combination(s, v, v[last]), known = known_combinations(s, v, last);
  const std::string only =
      known.empty() ? ""
                    : fmt::format(" Only {} matter{}.", known, known.find(" and ") == std::string::npos ? "s" : "");
  if (kinetic_energy_of_masses_alone(s.system)) {
    s.diagnostics.error(
        "E0417", c.span, fmt::format("the masses cannot tell {} apart", names(s, v)),
        fmt::format("Changing {} moves no mass{}: there are more coordinates than the points have ways to move.{}",
                    change, nor_constraint(s, "forbids it"), only),
        fmt::format("Remove `{}`, or give a mass to a point that it moves by itself.", c.name));
    return;
  }
  if (!is_in_time(s)) {
    s.diagnostics.error(
        "E0408", c.span, fmt::format("the integrand is not curved where {} change together", names(s, v)),
        fmt::format(
            "Changing {} leaves ∂L/∂q' as it is: the Euler-Lagrange equations do not determine the second derivatives.",
            change),
        "An integrand of degree 1 in all velocities does not say how fast its path is run through: make one of "
        "the coordinates the independent variable.");
    return;
  }
  s.diagnostics.error(
      "E0408", c.span, fmt::format("the kinetic energy cannot tell {} apart", names(s, v)),
      fmt::format(
          "Changing {} leaves T as it is{}: the mass matrix is singular, and the accelerations are not determined.{}",
          change, nor_constraint(s, "forbids it"), only),
      "Add the missing part of T, or use fewer coordinates.");
}

void report_norm(Subject& s, const Stretched& x) {
  s.diagnostics.error("E0408", x.span, fmt::format("nothing holds the quaternion of `{}` at norm 1", x.name),
                      "No kinetic energy belongs to a change of its norm: the mass matrix is singular, and the "
                      "accelerations are not determined.",
                      "Add the constraint w^2 + x^2 + y^2 + z^2 = 1 for its components, or write `rotation quaternion` "
                      "alone, which brings both.");
}

void report_zero_parameter(Subject& s, const Parameter& p) {
  const bool length = p.dimension.same_as(dimensions::length()), mass = p.dimension.same_as(dimensions::mass());
  s.diagnostics.error("E0409", p.span,
                      fmt::format("the {} `{}` is zero",
                                  length ? "length"
                                  : mass ? "mass"
                                         : "parameter",
                                  p.name),
                      "With it the kinetic energy of a motion vanishes: the mass matrix is singular, and the "
                      "accelerations are not determined.",
                      "Give it a value other than zero.");
}

/// N0428: M is singular, and the constraints make up for it.
void note_of_tied_coordinates(Subject& s, const Row& massless) {
  const auto first = std::find_if(massless.begin(), massless.end(), [](double x) { return x != 0; });
  if (first == massless.end()) return;
  const bool one = std::count_if(first, massless.end(), [](double x) { return x != 0; }) == 1;
  s.diagnostics.note(
      "N0428", s.system.coordinates[static_cast<std::size_t>(first - massless.begin())].span,
      fmt::format("the coordinate{} {} {} no kinetic energy", one ? "" : "s", names(s, massless), one ? "has" : "have"),
      "The mass matrix is singular; the constraints determine the accelerations all the same.", "");
}

/// Coordinates, velocities at rest and the time of the start as it is written.
Bindings written_start(const Subject& s) {
  Bindings point = sample(s, 0);
  for (std::size_t i = 0; i < s.freedoms(); ++i) point[s.system.coordinates[i].q] = point[s.velocities[i]] = 0;
  const Experiment& experiment = s.model.experiment;
  point[s.system.context->time()] = experiment.start_time ? evaluate(experiment.start_time, point) : 0;
  for (const StartValue& v : experiment.start)
    if (v.order == 0) point[s.system.coordinates[v.coordinate].q] = evaluate(v.value, point);
  return point;
}

/// W0439: M is regular, but not at the start. Under constraints, and where a start is searched for, it is not known
/// here.
void warn_of_singular_start(Subject& s, const MassMatrix& matrix) {
  const Experiment& experiment = s.model.experiment;
  const bool runs = experiment.duration || experiment.until;
  const bool is_searched = std::any_of(experiment.start_conditions.begin(), experiment.start_conditions.end(),
                                       [](const StartCondition& c) { return c.is_of_positions(); });
  if (!runs || s.system.constrained() || is_searched || !is_in_time(s)) return;
  const Matrix m = matrix.at(written_start(s));
  const std::vector<Row> null = m.empty() ? std::vector<Row>() : reduce(m, {}).null;
  if (null.empty()) return;
  const Row& v = null.front();
  const bool is_one = std::count_if(v.begin(), v.end(), [](double x) { return x != 0; }) == 1;
  const auto last = v.rend() - std::find_if(v.rbegin(), v.rend(), [](double x) { return x != 0; }) - 1;
  s.diagnostics.warning(
      "W0439", s.system.coordinates[static_cast<std::size_t>(last)].span,
      is_one ? fmt::format("at the start nothing moves with {}", names(s, v))
             : fmt::format("at the start T cannot tell {} apart", names(s, v)),
      fmt::format("Changing {} leaves T as it is there: the mass matrix is singular, and a run ends before it begins.",
                  combination(s, v, v[static_cast<std::size_t>(last)])),
      "Two of the three angles of a rotation do the same where two of its axes coincide (gimbal lock), a polar angle "
      "nothing in the centre. Start beside it, or take other coordinates: `rotation quaternion`; x and y.");
}

}  // namespace

bool mass_matrix_rules(Subject& s, const std::vector<bool>& unused) {
  // What is regular everywhere is regular on the constraints.
  if (s.freedoms() > largest_looked_at_whole && kinetic_form_is_definite(s, sample(s, 0))) return false;
  const MassMatrix matrix(s);
  const Manifold manifold(s);
  const Findings found = examine(s, matrix, manifold, {});
  if (!found.defined) return false;
  if (!found.singular) {
    if (!found.positive && is_in_time(s) && s.system.integral_constraints.empty())
      s.diagnostics.warning("W0410",
                            s.system.lagrangian_given  ? s.system.lagrangian_given->span
                            : s.system.kinetic.empty() ? s.system.coordinates.front().span
                                                       : s.system.kinetic.front().span,
                            "the kinetic energy is not positive",
                            "Some motion has a negative kinetic energy: the mass matrix is indefinite. The equations "
                            "of motion can still be solved.",
                            "Check the signs in T, unless this is meant (as in Bateman's Lagrangian).");
    note_of_tied_coordinates(s, found.massless);
    warn_of_singular_start(s, matrix);
    return false;
  }
  if (std::any_of(unused.begin(), unused.end(), [](bool x) { return x; })) return true;  // told
  if (const Parameter* p = zero_parameter_at_fault(s, matrix, manifold)) {
    report_zero_parameter(s, *p);
    return true;
  }
  if (const std::optional<Stretched> x = stretched_rotation(s)) {
    report_norm(s, *x);
    return true;
  }
  std::set<std::string> told;
  for (const Row& v : found.null) {
    if (const Constraint* norm = quaternion_in(s, v)) {
      if (told.insert(norm->body).second) report_massless_turn(s, *norm);
      continue;
    }
    const auto count = std::count_if(v.begin(), v.end(), [](double x) { return x != 0; });
    const auto first = std::find_if(v.begin(), v.end(), [](double x) { return x != 0; }) - v.begin();
    if (count == 1)
      report_massless(s, static_cast<std::size_t>(first));
    else
      report_combination(s, v);
  }
  return true;
}

}  // namespace maupertuis::lint_rules
