#include <maupertuis/contact_mode.hpp>
#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/field_run.hpp>
#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/repeated_evaluation.hpp>
#include <maupertuis/switches.hpp>

#include "fields/field_elements.hpp"
#include "fields/field_sides.hpp"
#include "fields/plane_modes.hpp"
#include "fields/resting_fields.hpp"
#include "fields/semi_discrete.hpp"
#include "fields/small_motions.hpp"
#include "linear_algebra/dense.hpp"
#include "linear_algebra/products.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// Small motions about rest by Ritz's method with polynomials of high degree between the places where bodies sit, which
/// converge exponentially where the coefficients are smooth. K and M are sums over Gauss-Lobatto points of second
/// derivatives of ℒ at rest, and of the linearized equations of the bodies.
namespace maupertuis {
namespace {

using Side = BoundaryCondition::Side;
using SpaceKind = ElementSpace::Kind;

class ModeProblem {
 public:
  struct Size {
    int cells;     // borders of elements lie at most so many-th of the domain apart
    int unknowns;  // together, about
    int degree;    // of an element, at most
  };
  /// Of a degree above `before`, so that two sizes never agree because they are one.
  ModeProblem(const FieldEquations& equations, const DensityEntries& entries, const Size& size, int before,
              Diagnostics& diagnostics)
      : equations_(equations), s_(equations.system()), entries_(entries), diagnostics_(diagnostics) {
    for (const Parameter& p : equations.model->parameters) values_[p.symbol] = p.si_value;
    if (equations.bodies)
      for (const Parameter& p : equations.bodies->system->parameters) values_[p.symbol] = p.si_value;
    lay_out_unknowns(size, before);
  }

  std::optional<SmallMotions> assemble() {
    mass_ = gyroscopic_ = stiffness_ = Eigen::MatrixXd::Zero(size_, size_);
    add_density();
    if (equations_.bodies && !add_bodies()) return std::nullopt;
    if (!hold()) return std::nullopt;
    SmallMotions out;
    out.from_free = free_;
    out.mass = symmetric_part(quadratic_form(free_, mass_));
    out.stiffness = symmetric_part(quadratic_form(free_, stiffness_));
    out.gyroscopic = quadratic_form(free_, gyroscopic_);
    return out;
  }

  /// How much of a coefficient lies between the points of quadrature, beside its mean, at most.
  double unseen() const {
    const double left = mesh_.borders.front(), length = mesh_.borders.back() - left;
    std::vector<std::pair<double, double>> points;
    for (std::size_t q = 0; q < spaces_.front().points().size(); ++q)
      points.emplace_back(place_of(q), spaces_.front().points()[q].weight);
    double out = 0;
    for (const DensityEntry& e : entries_.list) {
      const RepeatedEvaluation value({&e.value, 1});
      const auto at = [&](double x) { return value([&](Expr symbol) { return value_of(symbol, x); }).front(); };
      out = std::max(out, unseen_along(at, left, length, points));
    }
    return out;
  }

  /// What turns steadily meanwhile: "ψ' = 100 (SI units)".
  const std::string& turning() const { return turning_text_; }
  /// A number of elements, and their degree.
  std::size_t elements() const { return mesh_.borders.size() - 1; }
  int degree() const { return mesh_.degree; }
  const std::vector<double>& borders() const { return mesh_.borders; }
  int points() const { return mesh_.points; }  // of quadrature, in an element

  std::vector<double> places() const {
    constexpr int shown = 20;
    std::vector<double> out;
    const std::vector<double>& b = mesh_.borders;
    for (int k = 0; k <= shown; ++k) out.push_back(b.front() + (b.back() - b.front()) * k / shown);
    return out;
  }
  FieldModes::Shape shape(Eigen::VectorXd c) const {
    FieldModes::Shape out;
    double largest = 0;
    for (const std::vector<double>& field : values_of(c))
      for (const double v : field)
        if (std::abs(v) > std::abs(largest)) largest = v;
    // Where the field is rounding beside the coordinates, the largest of these is 1.
    constexpr double rounding = 1e-9;
    for (const Eigen::Index i : body_unknowns_)
      if (std::abs(largest) < rounding * std::abs(c(i))) largest = c(i);
    if (largest == 0) largest = c.cwiseAbs().maxCoeff();
    if (largest != 0) c /= largest;
    out.fields = values_of(c);
    for (const Eigen::Index i : body_unknowns_) out.coordinates.push_back(c(i));
    return out;
  }

 private:
  void lay_out_unknowns(const Size& size, int before) {
    std::vector<bool> smooth(equations_.varied.size(), false);
    for (const DensityEntry& e : entries_.list) smooth[e.a] = smooth[e.a] || e.da == 2;
    mesh_.borders = element_borders(equations_, size.cells);
    const int elements = static_cast<int>((mesh_.borders.size() - 1) * equations_.varied.size());
    constexpr int least = 8, step = 2;
    mesh_.degree = std::max(std::clamp(size.unknowns / elements, least, size.degree), before + step);
    mesh_.points = 2 * mesh_.degree;
    mesh_.periodic = s_.periodic(0);
    for (std::size_t a = 0; a < equations_.varied.size(); ++a) {
      spaces_.emplace_back(mesh_, smooth[a] ? SpaceKind::Smooth : SpaceKind::Continuous);
      first_.push_back(size_);
      size_ += static_cast<Eigen::Index>(spaces_.back().size());
    }
    if (!equations_.bodies) return;
    for (std::size_t i = 0; i < equations_.bodies->system->coordinates.size(); ++i) {
      const Eigen::Index at = unknown_of_place(i);
      body_unknowns_.push_back(at >= 0 ? at : size_++);
    }
  }
  Eigen::Index unknown_of_place(std::size_t coordinate) const {
    for (const PlaceCoordinate& p : equations_.model->attached) {
      if (p.coordinate != coordinate) continue;
      const std::size_t a = varied_index(p.jet.field), border = border_at(number(p.place));
      return first_[a] + static_cast<Eigen::Index>(p.jet.space[0] == 0 ? spaces_[a].value_at_border(border)
                                                                       : spaces_[a].slope_at_border(border));
    }
    return -1;
  }
  std::size_t varied_index(std::size_t field) const {
    std::size_t a = 0;
    while (equations_.varied[a] != field) ++a;
    return a;
  }
  std::size_t border_at(double x) const {
    std::size_t best = 0;
    for (std::size_t b = 0; b < mesh_.borders.size(); ++b)
      if (std::abs(mesh_.borders[b] - x) < std::abs(mesh_.borders[best] - x)) best = b;
    return best;
  }
  double number(Expr e) const { return evaluate(s_.expanded(e), values_); }
  /// Of a symbol in a coefficient.
  double value_of(Expr symbol, double x) const {
    if (symbol == s_.space.front().symbol) return x;
    const auto jet = entries_.rest.value(s_, symbol, x, 0);
    return jet ? *jet : values_.at(symbol);
  }
  /// Of a point of quadrature, inside of its element: coefficients may jump at borders.
  double place_of(std::size_t q) const {
    const std::vector<ElementSpace::Point>& points = spaces_.front().points();
    const std::size_t element = q / (points.size() / (mesh_.borders.size() - 1));
    const double a = mesh_.borders[element], b = mesh_.borders[element + 1];
    return std::clamp(points[q].x, a + 1e-13 * (b - a), b - 1e-13 * (b - a));
  }

  void add_density() {
    std::vector<Expr> roots;
    for (const DensityEntry& e : entries_.list) roots.push_back(e.value);
    const RepeatedEvaluation at(roots);
    const std::vector<ElementSpace::Point>& points = spaces_.front().points();
    for (std::size_t q = 0; q < points.size(); ++q) {
      const double x = place_of(q);
      const std::vector<double> c = at([&](Expr symbol) { return value_of(symbol, x); });
      for (std::size_t i = 0; i < entries_.list.size(); ++i) add_entry(entries_.list[i], points[q].weight * c[i], q);
    }
  }
  /// d/dt ∂ℒ/∂v − ∂ℒ/∂u: mass from v v, stiffness from u u, and from v u a force sideways.
  void add_entry(const DensityEntry& e, double weight, std::size_t q) {
    for (const ElementSpace::Part& r : spaces_[e.a].points()[q].parts)
      for (const ElementSpace::Part& j : spaces_[e.b].points()[q].parts) {
        const Eigen::Index row = first_[e.a] + static_cast<Eigen::Index>(r.dof),
                           column = first_[e.b] + static_cast<Eigen::Index>(j.dof);
        const double v = weight * r.of[e.da] * j.of[e.db];
        if (e.ta == 1 && e.tb == 1) mass_(row, column) += v;
        if (e.ta == 0 && e.tb == 0) stiffness_(row, column) -= v;
        if (e.ta == 1 && e.tb == 0) gyroscopic_(row, column) += v;
        if (e.ta == 0 && e.tb == 1) gyroscopic_(row, column) -= v;
      }
  }

  // -------------------------------------------------------------------------------------------------------- bodies

  /// Rows of the bodies without friction, in q, q', q'', with inputs by their formulas.
  std::vector<Expr> body_rows() const {
    const EquationsOfMotion& bodies = *equations_.bodies;
    ExprMap given;
    for (const Input& input : bodies.system->inputs)
      if (input.formula) given[input.symbol] = input.formula;
    std::vector<Expr> out;
    for (std::size_t i = 0; i < bodies.residual.size(); ++i)
      out.push_back(substitute(expand_time_derivatives(bodies.residual[i] - bodies.dissipative_terms[i]), given));
    return out;
  }
  bool add_bodies() {
    const MechanicalSystem& system = *equations_.bodies->system;
    const std::vector<Expr> rows = body_rows();
    const std::size_t n = rows.size();
    Bindings at = values_;
    at[s_.context->time()] = 0;
    for (const Coordinate& c : system.coordinates) at[c.q] = at[c.velocity] = at[c.acceleration] = 0;
    for (const StartValue& v : equations_.body_start)
      if (v.order == 0 && v.coordinate < n) at[system.coordinates[v.coordinate].q] = number(v.value);
    turn_steadily(rows, at);
    std::vector<Expr> switches;
    for (const Expr& g : switches_of(rows))
      if (holds_coordinates(g)) switches.push_back(g);
    std::vector<Expr> slopes[3];
    bool linear = switches.empty();
    for (const Expr& row : rows)
      for (int order = 0; order < 3; ++order)
        for (const Coordinate& c : system.coordinates) {
          const Expr slope = differentiate(row, order == 0 ? c.q : order == 1 ? c.velocity : c.acceleration);
          if (s_.context->depends_on_time(replaced_by_rest(slope).id()))
            return refuse_modes_of(equations_, diagnostics_, "The coefficients of its bodies change in time.");
          linear = linear && !holds_coordinates(slope);
          slopes[order].push_back(slope);
        }
    if (!linear) {
      for (const Expr& row : rows)
        if (s_.context->depends_on_time(replaced_by_rest(row).id()))
          return refuse_modes_of(equations_, diagnostics_, "Its bodies are driven, so that they have no rest.");
      if (entries_.rest.computed)
        for (std::size_t i = 0; i < n; ++i)
          at[system.coordinates[i].q] = entries_.rest.computed->bodies()(static_cast<Eigen::Index>(i));
      else if (!find_rest(rows, slopes[0], at))
        return false;
      if (!is_beside_switches(switches, at)) return false;
    }
    return add_linearized(slopes, at);
  }
  /// Coordinates on which nothing depends keep the velocity of the start: a shaft that turns.
  void turn_steadily(const std::vector<Expr>& rows, Bindings& at) {
    const MechanicalSystem& system = *equations_.bodies->system;
    turning_.clear();
    for (const StartValue& v : equations_.body_start) {
      if (v.order != 1 || v.coordinate >= rows.size() || unknown_of_place(v.coordinate) >= 0) continue;
      const double rate = number(v.value);
      const Coordinate& c = system.coordinates[v.coordinate];
      if (rate == 0 || std::any_of(rows.begin(), rows.end(), [&](const Expr& row) {
            return zero_test(differentiate(row, c.q)).verdict != Verdict::Zero;
          }))
        continue;
      at[c.velocity] = rate;
      turning_.push_back(v.coordinate);
      turning_text_ += fmt::format("{}{}' = {:.6g}{}", turning_text_.empty() ? "" : ", ", c.name, rate,
                                   system.dimensionless ? "" : " (SI units)");
    }
  }
  /// What turns is left out of the small motions; E0644 where these change its rate.
  bool leave_turning_out(const std::vector<double>& k, const std::vector<double>& c, const std::vector<double>& m) {
    const std::size_t n = body_unknowns_.size();
    for (const std::size_t i : turning_) {
      for (const auto* part : {&k, &c, &m}) {
        double size = 0, coupling = 0;
        for (const double x : *part) size = std::max(size, std::abs(x));
        for (std::size_t j = 0; j < n; ++j)
          if (j != i) coupling = std::max({coupling, std::abs((*part)[i * n + j]), std::abs((*part)[j * n + i])});
        if (coupling > 1e-12 * size)
          return refuse_modes_of(equations_, diagnostics_,
                                 "A body turns steadily, and small motions change the rate at which it does.");
      }
      held_turning_.push_back(body_unknowns_[i]);
    }
    return true;
  }
  /// With numbers for coordinates, so that time alone is left of what changes.
  Expr replaced_by_rest(Expr e) const {
    ExprMap rest;
    const Expr number = s_.context->number(Rational(618034, 1000000));
    for (const Coordinate& c : equations_.bodies->system->coordinates)
      rest[c.q] = rest[c.velocity] = rest[c.acceleration] = number;
    return substitute(e, rest);
  }
  /// One formula holds around the rest; E0644 where it goes over into another there.
  bool is_beside_switches(const std::vector<Expr>& switches, const Bindings& at) const {
    constexpr double near = 1e-9;
    for (const Expr& g : switches) {
      double size = 0;
      for (const Expr& symbol : symbols_of({&g, 1}))
        if (symbol.role() == Role::Coordinate)
          size += std::abs(evaluate(differentiate(g, symbol), at)) * std::max(std::abs(at.at(symbol)), near);
      if (std::abs(evaluate(g, at)) <= near * size)
        return refuse_modes_of(equations_, diagnostics_,
                               "Its bodies rest where one formula of their energy goes over into another.");
    }
    return true;
  }
  bool holds_coordinates(Expr e) const {
    const Expr roots[] = {e};
    for (const Expr& symbol : symbols_of(roots))
      if (symbol.role() == Role::Coordinate) return true;
    return false;
  }
  bool add_linearized(const std::vector<Expr> (&slopes)[3], const Bindings& at) {
    const std::size_t n = body_unknowns_.size();
    double sideways = 0, size = 0, skew = 0, size_of_k = 0;
    std::vector<double> k(n * n), c(n * n), m(n * n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        const Eigen::Index row = body_unknowns_[i], column = body_unknowns_[j];
        k[i * n + j] = evaluate(slopes[0][i * n + j], at), c[i * n + j] = evaluate(slopes[1][i * n + j], at);
        stiffness_(row, column) += k[i * n + j];
        gyroscopic_(row, column) += c[i * n + j];
        m[i * n + j] = evaluate(slopes[2][i * n + j], at);
        mass_(row, column) += m[i * n + j];
      }
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        size = std::max(size, std::abs(c[i * n + j])), size_of_k = std::max(size_of_k, std::abs(k[i * n + j]));
        sideways = std::max(sideways, std::abs(c[i * n + j] + c[j * n + i]));
        skew = std::max(skew, std::abs(k[i * n + j] - k[j * n + i]));
      }
    if (sideways > 1e-12 * size)
      return refuse_modes_of(equations_, diagnostics_,
                             "A force on its bodies grows with their velocity: motions are damped or driven.");
    if (skew > 1e-12 * size_of_k)
      return refuse_modes_of(equations_, diagnostics_, "The forces on its bodies have no potential.");
    return leave_turning_out(k, c, m);
  }

  /// Newton's method from the start of the model for the rest that the bodies and the field have together.
  bool find_rest(const std::vector<Expr>& rows, const std::vector<Expr>& slopes, Bindings& at) {
    const MechanicalSystem& system = *equations_.bodies->system;
    const std::size_t n = rows.size();
    const Eigen::MatrixXd field = stiffness_;
    const Eigen::VectorXd load = static_load();
    Eigen::VectorXd z = Eigen::VectorXd::Zero(size_);
    for (std::size_t i = 0; i < n; ++i) z(body_unknowns_[i]) = at.at(system.coordinates[i].q);
    if (!hold()) return false;
    constexpr int most_rounds = 60;
    for (int round = 0; round < most_rounds; ++round) {
      Eigen::VectorXd force = -load;
      Eigen::MatrixXd k = field;
      for (Eigen::Index i = 0; i < size_; ++i)
        for (Eigen::Index j = 0; j < size_; ++j) force(i) += field(i, j) * z(j);
      for (std::size_t i = 0; i < n; ++i) {
        force(body_unknowns_[i]) += evaluate(rows[i], at);
        for (std::size_t j = 0; j < n; ++j) k(body_unknowns_[i], body_unknowns_[j]) += evaluate(slopes[i * n + j], at);
      }
      const Eigen::MatrixXd kk = quadratic_form(free_, k);
      const Eigen::VectorXd right = transposed_product(free_, -force);
      const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(kk);
      const Eigen::VectorXd step = product(free_, Eigen::VectorXd(solver.solve(right)));
      z += step;
      for (std::size_t i = 0; i < n; ++i) at[system.coordinates[i].q] = z(body_unknowns_[i]);
      if (!z.allFinite()) break;
      if (step.cwiseAbs().maxCoeff() <= 1e-13 * std::max(z.cwiseAbs().maxCoeff(), 1e-300)) return true;
    }
    return refuse_modes_of(equations_, diagnostics_, "No rest of its bodies was found near the start of the model.");
  }
  /// ∂ℒ at rest and force densities, on each unknown of the fields.
  Eigen::VectorXd static_load() const {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(size_);
    const Expr density = density_of(equations_);
    struct Load {
      std::size_t a;
      int derivative;
      Expr value;
    };
    std::vector<Load> loads;
    std::vector<Expr> roots;
    ExprMap rest;
    for (const Expr& jet : s_.jets_in(density)) rest[jet] = s_.context->number(0);
    const auto add = [&](std::size_t field, int derivative, Expr e) {
      const Expr value = s_.expanded(substitute(e, rest));
      if (value.is_zero() || s_.context->depends_on_time(value.id())) return;
      loads.push_back({varied_index(field), derivative, value});
      roots.push_back(value);
    };
    for (const Expr& one : s_.jets_in(density))
      if (const FieldJet jet = *s_.jet_of(one); jet.time == 0)
        add(jet.field, jet.space[0], differentiate(density, one));
    for (const std::size_t f : equations_.varied)
      if (s_.forces[f] && s_.jets_in(s_.forces[f]).empty()) add(f, 0, s_.forces[f]);
    const RepeatedEvaluation at(roots);
    for (std::size_t q = 0; q < spaces_.front().points().size(); ++q) {
      const double x = place_of(q);
      const auto c = at([&](Expr symbol) { return symbol == s_.space.front().symbol ? x : values_.at(symbol); });
      for (std::size_t i = 0; i < loads.size(); ++i)
        for (const ElementSpace::Part& part : spaces_[loads[i].a].points()[q].parts)
          out(first_[loads[i].a] + static_cast<Eigen::Index>(part.dof)) +=
              spaces_.front().points()[q].weight * c[i] * part.of[loads[i].derivative];
    }
    return out;
  }

  // ---------------------------------------------------------------------------------------------------------- ends

  /// What ends hold and constraints tie: an orthonormal basis of what is left free.
  bool hold() {
    std::vector<bool> held(static_cast<std::size_t>(size_), false);
    for (const BoundaryCondition& b : s_.boundary) {
      const std::size_t a = varied_index(b.jet.field);
      const bool smooth = spaces_[a].kind() == SpaceKind::Smooth;
      if (b.jet.order() == 1 && !smooth) continue;
      const std::size_t border = b.side == Side::Right ? mesh_.borders.size() - 1 : 0;
      const std::size_t dof =
          b.jet.order() == 0 ? spaces_[a].value_at_border(border) : spaces_[a].slope_at_border(border);
      held[static_cast<std::size_t>(first_[a]) + dof] = true;
    }
    for (const Eigen::Index i : held_turning_) held[static_cast<std::size_t>(i)] = true;
    std::vector<Eigen::Index> kept;
    for (std::size_t i = 0; i < held.size(); ++i)
      if (!held[i]) kept.push_back(static_cast<Eigen::Index>(i));
    free_ = Eigen::MatrixXd::Zero(size_, static_cast<Eigen::Index>(kept.size()));
    for (std::size_t j = 0; j < kept.size(); ++j) free_(kept[j], static_cast<Eigen::Index>(j)) = 1;
    return !equations_.bodies || equations_.bodies->system->constraints.empty() || tie();
  }
  /// Constraints that are linear: A z = 0.
  bool tie() {
    const EquationsOfMotion& bodies = *equations_.bodies;
    const ExprMatrix a = constraint_matrix(bodies);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(a.rows), size_);
    for (std::size_t r = 0; r < a.rows; ++r)
      for (std::size_t c = 0; c < a.columns; ++c) {
        const Expr e = expand_time_derivatives(a.at(r, c));
        if (holds_coordinates(e) || s_.context->depends_on_time(e.id()))
          return refuse_modes_of(equations_, diagnostics_, "A constraint of its bodies is not linear.");
        rows(static_cast<Eigen::Index>(r), body_unknowns_[c]) = evaluate(e, values_);
      }
    const Eigen::MatrixXd on_free = product(rows, free_);
    const Eigen::MatrixXd transposed = on_free.transpose();
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(transposed);
    const Eigen::MatrixXd whole = columns_of_q(qr, free_.cols());
    free_ = product(free_, whole.rightCols(free_.cols() - transposed.cols()));
    return true;
  }

  std::vector<std::vector<double>> values_of(const Eigen::VectorXd& c) const {
    std::vector<std::vector<double>> out(spaces_.size());
    for (std::size_t a = 0; a < spaces_.size(); ++a)
      for (const double x : places()) {
        double sum = 0;
        for (const ElementSpace::Part& part : spaces_[a].at(x, x >= mesh_.borders.back()))
          sum += part.of[0] * c(first_[a] + static_cast<Eigen::Index>(part.dof));
        out[a].push_back(sum);
      }
    return out;
  }

  const FieldEquations& equations_;
  const FieldSystem& s_;
  const DensityEntries& entries_;
  Diagnostics& diagnostics_;
  Bindings values_;
  ElementMesh mesh_;
  std::vector<ElementSpace> spaces_;
  std::vector<Eigen::Index> first_, body_unknowns_, held_turning_;
  std::vector<std::size_t> turning_;  // coordinates
  std::string turning_text_;
  Eigen::Index size_ = 0;
  Eigen::MatrixXd mass_, gyroscopic_, stiffness_, free_;
};

}  // namespace

namespace {

FieldModes line_modes(const FieldEquations& equations, const DensityEntries& entries, std::size_t count,
                      Diagnostics& diagnostics) {
  FieldModes out;
  constexpr ModeProblem::Size sizes[] = {{1, 100, 30}, {1, 160, 40}, {4, 240, 40}, {8, 400, 40}};
  constexpr std::size_t beyond = 2;
  FrequencyErrors errors;
  int degree = 0;
  std::size_t elements = 0;
  for (const ModeProblem::Size& size : sizes) {
    interrupt_of(*equations.system().context).throw_if_asked();
    const bool more = element_borders(equations, size.cells).size() - 1 > elements;
    ModeProblem problem(equations, entries, size, more ? 0 : degree, diagnostics);
    elements = problem.elements(), degree = problem.degree();
    const auto motions = problem.assemble();
    if (!motions) return {};
    std::vector<Eigen::VectorXd> shapes;
    out = {};
    const bool sideways = motions->gyroscopic.cwiseAbs().maxCoeff() > 0;
    if (sideways ? !solve_gyroscopic(*motions, count + beyond, out.frequencies)
                 : !solve_conservative(*motions, count + beyond, out.frequencies, shapes)) {
      refuse_modes_of(equations, diagnostics, no_small_motions(*motions));
      return {};
    }
    const bool settled = errors.settle(out.frequencies, count, motions->mass.rows());
    if (!settled && &size + 1 != std::end(sizes)) continue;
    out.errors = errors.errors();
    if (!add_unseen(equations, {problem.unseen(), 0}, out, diagnostics) ||
        !sees_what_acts(equations, {problem.borders()}, {problem.points()}, diagnostics))
      return {};
    shapes.resize(std::min(count, shapes.size()));
    out.places = problem.places();
    out.about = problem.turning();
    for (Eigen::VectorXd& c : shapes) out.shapes.push_back(problem.shape(std::move(c)));
    break;
  }
  if (out.about.empty()) out.about = entries.about(equations);
  out.frequencies.resize(std::min(count, out.frequencies.size()));
  out.errors.resize(out.frequencies.size());
  return out;
}

}  // namespace

FieldModes field_modes(const FieldEquations& equations, std::size_t count, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  FieldModes out;
  if (s.dissipation)
    diagnostics.warning(
        "W0653", s.density_span, "these are the modes without the dissipation of the field",
        "Dissipation damps the motions, and shifts frequencies and shapes.",
        "`maup modes --dispersion` has it in the relation of waves, and `maup simulate` shows the decay.");
  if (equations.bodies && equations.bodies->system->has_modes())
    diagnostics.warning("W0658", s.density_span, "these are the modes with open contacts and without dry friction",
                        "A closed contact holds the system on one side alone, and dry friction up to a limit.",
                        fmt::format("--mode \"{}\" has those of one mode; `maup simulate` goes through all.",
                                    some_mode(*equations.bodies->system)));
  if (refuse_too_many_conditions(equations, diagnostics)) return out;
  if (s.space.size() == 2) return plane_modes(equations, count, diagnostics);
  if (s.space.size() != 1 || !s.space.front().from) {
    refuse_modes_of(equations, diagnostics, "It has three space variables, or no domain.");
    return out;
  }
  for (const PlaceCoordinate& p : equations.model->attached)
    if (p.moves) {
      refuse_modes_of(equations, diagnostics, "A place at which bodies or forces take hold of it moves in time.");
      return out;
    }
  DensityEntries entries;
  std::optional<ComputedRest> rest;
  if (!entries_at_rest(equations, entries, rest, diagnostics)) return out;
  if (equations.bodies &&
      std::any_of(equations.bodies->dissipative_terms.begin(), equations.bodies->dissipative_terms.end(),
                  [](const Expr& e) { return !e.is_zero(); }))
    diagnostics.warning("W0653", s.density_span, "these are the modes without the friction of the bodies",
                        "Friction damps the motions, and shifts frequencies and shapes.",
                        "`maup simulate` shows the decay.");
  if (rest && nothing_moves(equations)) {
    out.equilibrium = rest->values;
    return out;
  }
  out = line_modes(equations, entries, count, diagnostics);
  if (!rest || out.frequencies.empty()) return out;
  Diagnostics unheard;
  add_errors_of_rest(equations, *rest, out,
                     [&](const DensityEntries& other) { return line_modes(equations, other, count, unheard); });
  out.equilibrium = rest->values;
  return out;
}

std::vector<double> field_frequencies(const FieldEquations& equations, std::size_t count, Diagnostics& diagnostics) {
  return field_modes(equations, count, diagnostics).frequencies;
}

}  // namespace maupertuis
