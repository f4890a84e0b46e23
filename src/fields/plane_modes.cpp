#include "fields/plane_modes.hpp"

#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/repeated_evaluation.hpp>

#include "fields/field_elements.hpp"
#include "fields/small_motions.hpp"
#include "linear_algebra/products.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

/// Ritz's method on a rectangle: products of integrated Legendre polynomials along x and along y, of twice integrated
/// ones where the density holds second derivatives (plates), on elements that end where coefficients jump along a side,
/// which converge exponentially where the coefficients are smooth. Degrees grow until the frequencies of two sizes
/// agree.
namespace maupertuis {
namespace {

using Side = BoundaryCondition::Side;

/// Functions along one direction with their values, slopes and curvatures at the points of quadrature.
struct Axis {
  std::vector<double> borders;  // of elements
  ElementSpace space;
  Eigen::VectorXd weight;
  Eigen::MatrixXd of[3];  // [points × functions]

  Axis(std::vector<double> ends, int degree, bool periodic, ElementSpace::Kind kind)
      : borders(std::move(ends)), space({borders, degree, degree + 6, periodic}, kind) {
    const auto q = static_cast<Eigen::Index>(space.points().size());
    weight.resize(q);
    for (Eigen::MatrixXd& m : of) m = Eigen::MatrixXd::Zero(q, size());
    for (Eigen::Index i = 0; i < q; ++i) {
      const ElementSpace::Point& point = space.points()[static_cast<std::size_t>(i)];
      weight(i) = point.weight;
      for (const ElementSpace::Part& part : point.parts)
        for (int k = 0; k < 3; ++k) of[k](i, static_cast<Eigen::Index>(part.dof)) += part.of[k];
    }
  }
  Eigen::Index size() const { return static_cast<Eigen::Index>(space.size()); }
  Eigen::Index points() const { return weight.size(); }
  /// Inside of its element, as coefficients may jump at borders.
  double place(Eigen::Index point) const {
    const std::size_t q = static_cast<std::size_t>(point), cell = q / (space.points().size() / (borders.size() - 1));
    const double near = 1e-13 * (borders[cell + 1] - borders[cell]);
    return std::clamp(space.points()[q].x, borders[cell] + near, borders[cell + 1] - near);
  }
  /// ∫ of two derivatives.
  Eigen::MatrixXd integrals(int one, int other) const {
    Eigen::MatrixXd weighted = of[other];
    for (Eigen::Index i = 0; i < points(); ++i) weighted.row(i) *= weight(i);
    return transposed_product(of[one], weighted);
  }
};

class PlaneModes {
 public:
  /// Of continuous slopes where `smooth`.
  PlaneModes(const FieldEquations& equations, const DensityEntries& entries, bool smooth)
      : equations_(equations),
        s_(equations.system()),
        entries_(entries),
        kind_(smooth ? ElementSpace::Kind::Smooth : ElementSpace::Kind::Continuous) {
    for (const Parameter& p : equations.model->parameters) values_[p.symbol] = p.si_value;
    for (std::size_t i = 0; i < 2; ++i) {
      from_[i] = evaluate(s_.expanded(s_.space[i].from), values_);
      to_[i] = evaluate(s_.expanded(s_.space[i].to), values_);
      borders_[i] = borders_along(i);
    }
    for (const DensityEntry& e : entries.list) gyroscopic_ = gyroscopic_ || e.ta != e.tb;
  }

  bool gyroscopic() const { return gyroscopic_; }
  /// Degrees whose unknowns are about so many, more along the longer side; along both sides more than before, so that
  /// two sizes never agree because they are one.
  void lay_out(double unknowns) {
    constexpr double least = 8;  // of the shortest side: what a half wave needs
    const double per_field = unknowns / static_cast<double>(equations_.varied.size());
    double ratio = (to_[0] - from_[0]) / (to_[1] - from_[1]);
    const bool across = ratio < 1;
    if (across) ratio = 1 / ratio;
    // (least + n)(least + ratio n) = per_field
    const double b = least * (1 + ratio), c = least * least - per_field;
    const double n = std::max(0.0, (-b + std::sqrt(std::max(0.0, b * b - 4 * ratio * c))) / (2 * ratio));
    const int small = static_cast<int>(least + n), large = std::max(small, static_cast<int>(least + ratio * n));
    axes_.clear();
    for (std::size_t i = 0; i < 2; ++i) {
      constexpr int least_of_element = 6;
      const int elements = static_cast<int>(borders_[i].size()) - 1,
                wanted = ((i == 0) == across ? small : std::min(large, most_degree_)) / elements;
      degrees_[i] = std::max({wanted, least_of_element, degrees_[i] + 2});
      axes_.emplace_back(borders_[i], degrees_[i], s_.periodic(i), kind_);
    }
    size_ = axes_[0].size() * axes_[1].size();
  }

  SmallMotions assemble() const {
    const auto n = static_cast<Eigen::Index>(equations_.varied.size()) * size_;
    Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n, n), sideways = mass, stiffness = mass;
    for (const DensityEntry& e : entries_.list) {
      const Eigen::MatrixXd part = integrals(e);
      const Eigen::Index row = static_cast<Eigen::Index>(e.a) * size_, column = static_cast<Eigen::Index>(e.b) * size_;
      if (e.ta == 1 && e.tb == 1) mass.block(row, column, size_, size_) += part;
      if (e.ta == 0 && e.tb == 0) stiffness.block(row, column, size_, size_) -= part;
      if (e.ta == 1 && e.tb == 0) sideways.block(row, column, size_, size_) += part;
      if (e.ta == 0 && e.tb == 1) sideways.block(row, column, size_, size_) -= part;
    }
    SmallMotions out;
    out.from_free = free_functions();
    out.mass = symmetric_part(quadratic_form(out.from_free, mass));
    out.stiffness = symmetric_part(quadratic_form(out.from_free, stiffness));
    if (gyroscopic_) out.gyroscopic = quadratic_form(out.from_free, sideways);
    return out;
  }

  /// At most, of the coefficients: along each side for some places of the other, and over the plane.
  UnseenParts unseen() const {
    UnseenParts out;
    for (const DensityEntry& e : entries_.list) {
      if (changes_along(e.value, 0) && changes_along(e.value, 1)) out.between = std::max(out.between, unseen(e.value));
      for (std::size_t along = 0; along < 2; ++along) {
        if (!changes_along(e.value, along)) continue;
        const Axis& other = axes_[1 - along];
        for (Eigen::Index i = 0; i < other.points(); i += std::max<Eigen::Index>(1, other.points() / 5))
          add_unseen_along(e, along, other.place(i), out);
      }
    }
    return out;
  }

  Borders borders() const { return {borders_[0], borders_[1]}; }
  /// Of quadrature, in an element along each side.
  std::vector<int> points() const {
    std::vector<int> out;
    for (std::size_t i = 0; i < 2; ++i)
      out.push_back(static_cast<int>(axes_[i].points()) / static_cast<int>(borders_[i].size() - 1));
    return out;
  }

  /// Modes of one frequency are told apart by how much they change along x: on a square sin 2πx sin πy from sin πx
  /// sin 2πy.
  void part_equals(const std::vector<double>& frequencies, std::vector<Eigen::VectorXd>& shapes) const {
    constexpr double equal = 1e-7;
    for (std::size_t first = 0, last; first < shapes.size(); first = last) {
      last = first + 1;
      while (last < shapes.size() &&
             std::abs(frequencies[last] - frequencies[first]) <= equal * std::abs(frequencies[first]))
        ++last;
      if (last - first > 1) turn(shapes, first, last);
    }
  }

  FieldModes::Shape shape(const Eigen::VectorXd& c, const std::vector<double>& x, const std::vector<double>& y) const {
    FieldModes::Shape out;
    double largest = 0;
    for (std::size_t a = 0; a < equations_.varied.size(); ++a) {
      out.fields.emplace_back();
      for (const double at_y : y)
        for (const double at_x : x) {
          double sum = 0;
          for (const ElementSpace::Part& j : axes_[1].space.at(at_y))
            for (const ElementSpace::Part& i : axes_[0].space.at(at_x))
              sum += i.of[0] * j.of[0] * c(static_cast<Eigen::Index>(a) * size_ + index(i.dof, j.dof));
          out.fields.back().push_back(sum);
          if (std::abs(sum) > (1 + 1e-9) * std::abs(largest)) largest = sum;
        }
    }
    for (std::vector<double>& field : out.fields)
      for (double& v : field) v = largest != 0 ? v / largest : 0;
    return out;
  }
  std::vector<double> places(std::size_t direction) const {
    constexpr int shown = 40;
    std::vector<double> out;
    for (int k = 0; k <= shown; ++k) out.push_back(from_[direction] + (to_[direction] - from_[direction]) * k / shown);
    return out;
  }

 private:
  /// Whether a coefficient changes along a direction: by its place, or with the rest that was computed.
  bool changes_along(Expr value, std::size_t direction) const {
    const std::vector<Expr> below = symbols_of({&value, 1});
    return std::any_of(below.begin(), below.end(), [&](Expr symbol) {
      return symbol == s_.space[direction].symbol || s_.jet_of(symbol).has_value();
    });
  }
  /// Of a symbol in a coefficient.
  double value_of(Expr symbol, double x, double y) const {
    if (symbol == s_.space[0].symbol) return x;
    if (symbol == s_.space[1].symbol) return y;
    const auto jet = entries_.rest.value(s_, symbol, x, y);
    return jet ? *jet : values_.at(symbol);
  }
  /// A coefficient at a place.
  double value_at(const RepeatedEvaluation& value, double x, double y) const {
    return value([&](Expr symbol) { return value_of(symbol, x, y); }).front();
  }
  void add_unseen_along(const DensityEntry& e, std::size_t along, double across, UnseenParts& out) const {
    const RepeatedEvaluation evaluation({&e.value, 1});
    const auto at = [&](double x) {
      return along == 0 ? value_at(evaluation, x, across) : value_at(evaluation, across, x);
    };
    std::vector<std::pair<double, double>> points;
    for (Eigen::Index q = 0; q < axes_[along].points(); ++q)
      points.emplace_back(axes_[along].place(q), axes_[along].weight(q));
    out.between = std::max(out.between, unseen_along(at, from_[along], to_[along] - from_[along], points));
    // A stiffness or a mass: what it is off by counts beside its own value.
    const bool square = e.a == e.b && e.da == e.db && e.ya == e.yb && e.ta == e.tb && e.da + e.ya + e.ta > 0;
    out.unfollowed = std::max(out.unfollowed, unfollowed_along(at, borders_[along], degrees_[along], square));
  }

  /// Over the plane: what is narrow in both directions lies between the lines too.
  double unseen(Expr value) const {
    // Along each side; a rest that was computed is a polynomial, which takes its time.
    const int places = entries_.rest.computed ? 60 : 1000;
    const Expr root[] = {value};
    const RepeatedEvaluation evaluation(root);
    const double length = to_[0] - from_[0], height = to_[1] - from_[1];
    double by_quadrature = 0, by_places = 0, size = 0;
    for (Eigen::Index j = 0; j < axes_[1].points(); ++j)
      for (Eigen::Index i = 0; i < axes_[0].points(); ++i)
        by_quadrature += axes_[0].weight(i) * axes_[1].weight(j) / (length * height) *
                         value_at(evaluation, axes_[0].place(i), axes_[1].place(j));
    for (int j = 0; j < places; ++j) {
      interrupt_of(*s_.context).throw_if_asked();
      for (int i = 0; i < places; ++i) {
        const double v =
            value_at(evaluation, from_[0] + length * (i + 0.5) / places, from_[1] + height * (j + 0.5) / places);
        by_places += v, size += std::abs(v);
      }
    }
    const double all = static_cast<double>(places) * places;
    return size > 0 ? std::abs(by_quadrature - by_places / all) / (size / all) : 0;
  }

  /// Elements end where a coefficient jumps or has a kink across the whole of a line, if there are few of these.
  std::vector<double> borders_along(std::size_t along) const {
    constexpr std::size_t most = 3;
    std::vector<double> out{from_[along]};
    const double near = 1e-9 * (to_[along] - from_[along]);
    for (const DensityBorder& b : density_borders_along(equations_, along))
      if (b.at > out.back() + near && b.at < to_[along] - near) out.push_back(b.at);
    if (out.size() - 1 > most) out.resize(1);
    out.push_back(to_[along]);
    return out;
  }

  Eigen::Index index(std::size_t i, std::size_t j) const {
    return static_cast<Eigen::Index>(j) * axes_[0].size() + static_cast<Eigen::Index>(i);
  }

  /// ∫∫ of an entry with all pairs of functions.
  Eigen::MatrixXd integrals(const DensityEntry& e) const {
    if (!changes_along(e.value, 0) && !changes_along(e.value, 1)) {
      const double value = evaluate(e.value, values_);
      const Eigen::MatrixXd x = axes_[0].integrals(e.da, e.db), y = axes_[1].integrals(e.ya, e.yb);
      Eigen::MatrixXd out(size_, size_);
      for (Eigen::Index j = 0; j < y.rows(); ++j)
        for (Eigen::Index l = 0; l < y.cols(); ++l)
          out.block(j * x.rows(), l * x.cols(), x.rows(), x.cols()) = value * y(j, l) * x;
      return out;
    }
    return transposed_product(at_points(e.da, e.ya), weighted(e));
  }
  /// Derivatives of all functions at all points, [points × functions].
  Eigen::MatrixXd at_points(int by_x, int by_y) const {
    const Eigen::MatrixXd &x = axes_[0].of[by_x], &y = axes_[1].of[by_y];
    Eigen::MatrixXd out(x.rows() * y.rows(), size_);
    for (Eigen::Index r = 0; r < y.rows(); ++r)
      for (Eigen::Index j = 0; j < y.cols(); ++j)
        out.block(r * x.rows(), j * x.cols(), x.rows(), x.cols()) = y(r, j) * x;
    return out;
  }
  Eigen::MatrixXd weighted(const DensityEntry& e) const {
    Eigen::MatrixXd out = at_points(e.db, e.yb);
    const Expr root[] = {e.value};
    const RepeatedEvaluation at(root);
    for (Eigen::Index r = 0; r < axes_[1].points(); ++r)
      for (Eigen::Index q = 0; q < axes_[0].points(); ++q) {
        const double value =
            at([&](Expr symbol) { return value_of(symbol, axes_[0].place(q), axes_[1].place(r)); }).front();
        out.row(r * axes_[0].points() + q) *= value * axes_[0].weight(q) * axes_[1].weight(r);
      }
    return out;
  }

  /// The functions that sides leave free: those that do not vanish there are held with the field.
  Eigen::MatrixXd free_functions() const {
    std::vector<bool> held(equations_.varied.size() * static_cast<std::size_t>(size_), false);
    for (const BoundaryCondition& b : s_.boundary) {
      const bool slope = b.jet.order() != 0;
      if (slope && kind_ != ElementSpace::Kind::Smooth) continue;  // it is the force that it stands for
      std::size_t a = 0;
      while (equations_.varied[a] != b.jet.field) ++a;
      const std::size_t along = b.side == Side::Left || b.side == Side::Right ? 0 : 1;
      const std::size_t border = b.side == Side::Right || b.side == Side::Top ? borders_[along].size() - 1 : 0;
      const ElementSpace& space = axes_[along].space;
      const std::size_t function = slope ? space.slope_at_border(border) : space.value_at_border(border);
      for (std::size_t other = 0; other < axes_[1 - along].space.size(); ++other)
        held[a * static_cast<std::size_t>(size_) +
             static_cast<std::size_t>(along == 0 ? index(function, other) : index(other, function))] = true;
    }
    std::vector<Eigen::Index> kept;
    for (std::size_t i = 0; i < held.size(); ++i)
      if (!held[i]) kept.push_back(static_cast<Eigen::Index>(i));
    Eigen::MatrixXd out =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(held.size()), static_cast<Eigen::Index>(kept.size()));
    for (std::size_t j = 0; j < kept.size(); ++j) out(kept[j], static_cast<Eigen::Index>(j)) = 1;
    return out;
  }

  void turn(std::vector<Eigen::VectorXd>& shapes, std::size_t first, std::size_t last) const {
    const auto count = static_cast<Eigen::Index>(last - first);
    Eigen::MatrixXd group(shapes[first].size(), count);
    for (Eigen::Index i = 0; i < count; ++i) group.col(i) = shapes[first + static_cast<std::size_t>(i)];
    const Eigen::MatrixXd x = axes_[0].integrals(1, 1), y = axes_[1].integrals(0, 0);
    Eigen::MatrixXd changes = Eigen::MatrixXd::Zero(group.rows(), count);
    for (Eigen::Index at = 0; at < group.rows(); at += size_)
      for (Eigen::Index k = 0; k < count; ++k) {
        Eigen::MatrixXd c(x.rows(), y.rows());
        for (Eigen::Index i = 0; i < size_; ++i) c(i % x.rows(), i / x.rows()) = group(at + i, k);
        const Eigen::MatrixXd d = product(product(x, c), y);
        for (Eigen::Index i = 0; i < size_; ++i) changes(at + i, k) = d(i % x.rows(), i / x.rows());
      }
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.compute(symmetric_part(transposed_product(group, changes)), Eigen::ComputeEigenvectors);
    const Eigen::MatrixXd turned = product(group, solver.eigenvectors());
    for (Eigen::Index i = 0; i < count; ++i) shapes[first + static_cast<std::size_t>(i)] = turned.col(i);
  }

  static constexpr int most_degree_ = 72;  // of the first size
  const FieldEquations& equations_;
  const FieldSystem& s_;
  const DensityEntries& entries_;
  const ElementSpace::Kind kind_;
  Bindings values_;
  double from_[2] = {0, 0}, to_[2] = {0, 0};
  std::vector<double> borders_[2];  // of elements
  int degrees_[2] = {0, 0};
  std::vector<Axis> axes_;
  Eigen::Index size_ = 0;  // functions of a field
  bool gyroscopic_ = false;
};

/// Whether ∂ℒ by the slope that is given at a side follows from it alone, as in E0292 of runs.
bool says_the_force(const FieldEquations& equations, const BoundaryCondition& b) {
  const FieldSystem& s = equations.system();
  const Expr slope = s.jet_symbol(b.jet);
  return s.jets_in(substitute(differentiate(s.expanded(s.density), slope), {{slope, s.expanded(b.value)}})).empty();
}

/// Why there are no modes; empty: there are.
std::string trouble_of(const FieldEquations& equations, bool smooth) {
  const FieldSystem& s = equations.system();
  if (!s.space[0].from || !s.space[1].from) return "It has no domain.";
  for (const BoundaryCondition& b : s.boundary)
    if (b.jet.order() == 1 && !smooth && !says_the_force(equations, b))
      return "A given slope at a side does not say what ∂ℒ/∂u_x is there, as other derivatives stand in it.";
  return equations.bodies ? "Bodies take hold of it in the plane." : "";
}

bool is_smooth(const DensityEntries& entries) {
  return std::any_of(entries.list.begin(), entries.list.end(),
                     [](const DensityEntry& e) { return e.da + e.ya > 1 || e.db + e.yb > 1; });
}

FieldModes modes_about(const FieldEquations& equations, const DensityEntries& entries, std::size_t count,
                       Diagnostics& diagnostics) {
  PlaneModes problem(equations, entries, is_smooth(entries));
  constexpr std::size_t beyond = 4;  // so that modes of one frequency are seen together
  constexpr double sizes[] = {250, 380, 580, 900}, sizes_sideways[] = {60, 90, 130};
  FieldModes out;
  FrequencyErrors errors;
  std::vector<Eigen::VectorXd> shapes;
  for (std::size_t pass = 0; pass < (problem.gyroscopic() ? std::size(sizes_sideways) : std::size(sizes)); ++pass) {
    interrupt_of(*equations.system().context).throw_if_asked();
    problem.lay_out(problem.gyroscopic() ? sizes_sideways[pass] : sizes[pass]);
    const SmallMotions motions = problem.assemble();
    out.frequencies.clear(), shapes.clear();
    if (problem.gyroscopic() ? !solve_gyroscopic(motions, count + beyond, out.frequencies)
                             : !solve_conservative(motions, count + beyond, out.frequencies, shapes)) {
      refuse_modes_of(equations, diagnostics, no_small_motions(motions));
      return {};
    }
    if (errors.settle(out.frequencies, count, motions.mass.rows())) break;
  }
  out.about = entries.about(equations), out.errors = errors.errors();
  if (!add_unseen(equations, problem.unseen(), out, diagnostics) ||
      !sees_what_acts(equations, problem.borders(), problem.points(), diagnostics))
    return {};
  problem.part_equals(out.frequencies, shapes);
  out.frequencies.resize(std::min(count, out.frequencies.size()));
  out.errors.resize(out.frequencies.size());
  shapes.resize(std::min(count, shapes.size()));
  out.places = problem.places(0), out.upwards = problem.places(1);
  for (const Eigen::VectorXd& c : shapes) out.shapes.push_back(problem.shape(c, out.places, out.upwards));
  return out;
}

}  // namespace

FieldModes plane_modes(const FieldEquations& equations, std::size_t count, Diagnostics& diagnostics) {
  DensityEntries entries;
  if (!entries_of(equations, entries, diagnostics)) return {};
  if (const std::string trouble = trouble_of(equations, is_smooth(entries)); !trouble.empty()) {
    refuse_modes_of(equations, diagnostics, trouble);
    return {};
  }
  std::optional<ComputedRest> rest;
  if (!entries_at_rest(equations, entries, rest, diagnostics)) return {};
  FieldModes out;
  if (!rest || entries.have_inertia()) out = modes_about(equations, entries, count, diagnostics);
  if (!rest || (entries.have_inertia() && out.frequencies.empty())) return out;
  Diagnostics unheard;
  add_errors_of_rest(equations, *rest, out,
                     [&](const DensityEntries& other) { return modes_about(equations, other, count, unheard); });
  out.equilibrium = rest->values;
  return out;
}

}  // namespace maupertuis
