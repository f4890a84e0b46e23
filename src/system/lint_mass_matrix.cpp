#include "system/lint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// Whether M = ∂²L/∂q̇∂q̇ can be solved for the accelerations, seen from numbers: M is sampled near the start.
namespace maupertuis::lint_rules {
namespace {

using Row = std::vector<double>;
using Matrix = std::vector<Row>;

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

/// Coordinates have units: each is scaled so that the diagonal of M is 1.
Row scale(Matrix& m) {
  const std::size_t n = m.size();
  Row scales(n, 1);
  for (std::size_t i = 0; i < n; ++i) {
    double size = std::abs(m[i][i]);
    if (size == 0)
      for (std::size_t j = 0; j < n; ++j) size = std::max(size, std::abs(m[i][j]));
    if (size > 0) scales[i] = 1 / std::sqrt(size);
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) m[i][j] *= scales[i] * scales[j];
  return scales;
}

/// Directions of q̇ that M sends to zero, by elimination with full pivoting; empty if M is regular.
std::vector<Row> null_vectors(Matrix m) {
  const std::size_t n = m.size();
  const Row scales = scale(m);
  std::vector<std::size_t> pivot_column, free;
  std::vector<bool> used(n, false);
  for (std::size_t step = 0; step < n; ++step) {
    std::size_t row = step, column = n;
    double best = 1e-9;
    for (std::size_t i = step; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        if (!used[j] && std::abs(m[i][j]) > best) best = std::abs(m[row = i][column = j]);
    if (column == n) break;
    used[column] = true;
    pivot_column.push_back(column);
    std::swap(m[step], m[row]);
    const double pivot = m[step][column];
    for (double& x : m[step]) x /= pivot;
    for (std::size_t i = 0; i < n; ++i) {
      const double factor = m[i][column];
      if (i == step || factor == 0) continue;
      for (std::size_t j = 0; j < n; ++j) m[i][j] -= factor * m[step][j];
    }
  }
  std::vector<Row> out;
  for (std::size_t f = 0; f < n; ++f) {
    if (used[f]) continue;
    Row v(n, 0);
    v[f] = scales[f];
    for (std::size_t k = 0; k < pivot_column.size(); ++k) {
      const double x = -m[k][f];
      if (std::abs(x) > 1e-7) v[pivot_column[k]] = x * scales[pivot_column[k]];
    }
    out.push_back(std::move(v));
  }
  return out;
}

bool is_positive_definite(Matrix m) {
  scale(m);
  const std::size_t n = m.size();
  for (std::size_t j = 0; j < n; ++j) {
    if (!(m[j][j] > 1e-9)) return false;
    for (std::size_t i = j + 1; i < n; ++i) {
      const double f = m[i][j] / m[j][j];
      for (std::size_t k = j; k < n; ++k) m[i][k] -= f * m[j][k];
    }
  }
  return true;
}

/// Null vectors that M has at every sample where it is defined.
struct Findings {
  bool defined = false;
  bool singular = false;
  bool positive = true;
  std::vector<Row> null;
};

Findings examine(const Subject& s, const MassMatrix& matrix, const Bindings& changed) {
  Findings out;
  for (int attempt = 0, good = 0; attempt < 9 && good < 2; ++attempt) {
    Bindings point = sample(s, attempt);
    for (const auto& [symbol, value] : changed) point[symbol] = value;
    const Matrix m = matrix.at(point);
    if (m.empty()) continue;
    ++good;
    out.defined = true;
    out.null = null_vectors(m);
    out.singular = !out.null.empty();
    if (out.singular) continue;
    out.positive = is_positive_definite(m);
    return out;
  }
  return out;
}

/// A parameter whose value 0 alone makes M singular.
const Parameter* zero_parameter_at_fault(const Subject& s, const MassMatrix& matrix) {
  for (const Parameter& p : s.system.parameters) {
    if (p.si_value != 0) continue;
    const Findings found = examine(s, matrix, {{p.symbol, 1.0}});
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

void report_massless(Subject& s, std::size_t coordinate) {
  const Coordinate& c = s.system.coordinates[coordinate];
  const bool from_masses = kinetic_energy_of_masses_alone(s.system);
  s.diagnostics.error(
      "E0407", c.span, fmt::format("the coordinate `{}` has no kinetic energy", c.name),
      from_masses
          ? fmt::format("No mass moves when {0} changes, so that no equation gives its acceleration {0}''.", c.name)
          : fmt::format("{0}' does not enter T, so that no equation gives its acceleration {0}''.", c.name),
      from_masses ? "Give a point that moves with it a mass, or a body its inertia."
                  : fmt::format("Add its part to T, or remove the coordinate.", c.name));
}

void report_combination(Subject& s, const Row& v) {
  std::size_t last = 0;
  for (std::size_t i = 0; i < v.size(); ++i)
    if (v[i] != 0) last = i;
  const Coordinate& c = s.system.coordinates[last];
  const std::string change = combination(s, v, v[last]);
  if (kinetic_energy_of_masses_alone(s.system)) {
    s.diagnostics.error(
        "E0417", c.span, fmt::format("the masses cannot tell {} apart", names(s, v)),
        fmt::format("Changing {} moves no mass: there are more coordinates than the points have ways to move.", change),
        fmt::format("Remove `{}`, or give a mass to a point that it moves by itself.", c.name));
    return;
  }
  s.diagnostics.error(
      "E0408", c.span, fmt::format("the kinetic energy cannot tell {} apart", names(s, v)),
      fmt::format(
          "Changing {} leaves T as it is: the mass matrix is singular, and the accelerations are not determined.",
          change),
      "Add the missing part of T, or use fewer coordinates.");
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

}  // namespace

void mass_matrix_rules(Subject& s, const std::vector<bool>& unused) {
  const MassMatrix matrix(s);
  const Findings found = examine(s, matrix, {});
  if (!found.defined) return;
  if (!found.singular) {
    if (!found.positive)
      s.diagnostics.warning("W0410",
                            s.system.lagrangian_given  ? s.system.lagrangian_given->span
                            : s.system.kinetic.empty() ? s.system.coordinates.front().span
                                                       : s.system.kinetic.front().span,
                            "the kinetic energy is not positive",
                            "Some motion has a negative kinetic energy: the mass matrix is indefinite. The equations "
                            "of motion can still be solved.",
                            "Check the signs in T, unless this is meant (as in Bateman's Lagrangian).");
    return;
  }
  if (std::any_of(unused.begin(), unused.end(), [](bool x) { return x; })) return;  // told
  if (const Parameter* p = zero_parameter_at_fault(s, matrix)) return report_zero_parameter(s, *p);
  for (const Row& v : found.null) {
    const auto count = std::count_if(v.begin(), v.end(), [](double x) { return x != 0; });
    const auto first = std::find_if(v.begin(), v.end(), [](double x) { return x != 0; }) - v.begin();
    if (count == 1)
      report_massless(s, static_cast<std::size_t>(first));
    else
      report_combination(s, v);
  }
}

}  // namespace maupertuis::lint_rules
