#include "fields/resting_fields.hpp"

#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/repeated_evaluation.hpp>

#include "fields/field_sides.hpp"
#include "fields/given_fields.hpp"
#include "fields/resolution.hpp"
#include "fields/semi_discrete.hpp"
#include "fields/small_motions.hpp"
#include "fields/static_density.hpp"
#include "linear_algebra/products.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

/// δ∫ℒ = 0 for φ = Σ c_i N_i that does not move: F_i = Σ_q w_q Σ_J ∂ℒ/∂φ_J N_i^(J) + ∫ f N_i + forces at sides = 0 for
/// the functions that sides leave free. Newton's steps are shortened until the next one, of the same matrix, is shorter
/// than this one: that test does not depend on units or on how large the functions are (Deuflhard, Newton Methods for
/// Nonlinear Problems, §3.3).
namespace maupertuis {
namespace {

using Side = BoundaryCondition::Side;

/// Where −∫ℒ has a minimum its second variation is positive; elsewhere, and where a displacement costs nothing, least
/// squares.
class StepSolver {
 public:
  explicit StepSolver(const Eigen::MatrixXd& slopes) : positive_(symmetric_part(Eigen::MatrixXd(-slopes))) {
    constexpr double least = 1e-14;
    const Eigen::ArrayXd pivots = positive_.matrixLLT().diagonal().array().square();
    if (positive_.info() != Eigen::Success || !(pivots.minCoeff() > least * pivots.maxCoeff())) any_.emplace(slopes);
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const {
    if (any_) return any_->solve(right);
    return positive_.solve(Eigen::VectorXd(-right));
  }

 private:
  Eigen::LLT<Eigen::MatrixXd> positive_;
  std::optional<Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>> any_;
};

class Equilibrium {
 public:
  Equilibrium(const FieldEquations& equations, const StaticDensity& density, std::shared_ptr<const StaticSpace> space)
      : equations_(equations), s_(equations.system()), density_(density), space_(std::move(space)), at_(density.roots) {
    for (const Parameter& p : equations.model->parameters) values_[p.symbol] = p.si_value;
    for (const StaticDensity::Slot& slot : density.slots) tables_.push_back(space_->table(slot.a, slot.jet.space));
  }

  /// Why there is none; empty: `c` is it.
  std::string find(const RestingFields* before, Eigen::VectorXd& c) {
    c = Eigen::VectorXd::Zero(space_->size());
    for (std::size_t a = 0; a < equations_.varied.size(); ++a) begin(a, before, c);
    if (!c.allFinite()) return "The start has no value somewhere in the domain.";
    if (const std::string trouble = hold(c); !trouble.empty()) return trouble;
    const Eigen::VectorXd start = c;
    const std::string trouble = newton(c);
    if (trouble.empty()) return "";
    c = start;
    return descend(c) ? newton(c) : trouble;
  }
  /// What rounding leaves open of what was found, beside its size.
  double rounding() const { return rounding_; }
  /// −∫ℒ.
  double energy(const Eigen::VectorXd& c) {
    evaluate_at(c, nullptr);
    return -energy_;
  }
  /// The second variation of −∫ℒ in the mean square.
  void judge(const Eigen::VectorXd& c, FieldEquilibrium& out) {
    Eigen::MatrixXd slopes;
    evaluate_at(c, &slopes);
    SmallMotions second;
    second.from_free = Eigen::MatrixXd::Identity(slopes.rows(), slopes.cols());
    second.stiffness = symmetric_part(Eigen::MatrixXd(-slopes));
    second.mass = mean_square();
    std::vector<double> roots;
    std::vector<Eigen::VectorXd> shapes;
    out.lowest.reset(), out.falling = 0;
    if (!solve_conservative(second, static_cast<std::size_t>(slopes.rows()), roots, shapes) || roots.empty()) return;
    out.lowest = roots.front() < 0 ? -roots.front() * roots.front() : roots.front() * roots.front();
    out.falling = static_cast<std::size_t>(std::count_if(roots.begin(), roots.end(), [](double r) { return r < 0; }));
  }

 private:
  double number(Expr e, Side side, double along) {
    Bindings at = values_;
    if (s_.space.size() > 1) at[s_.space[side == Side::Left || side == Side::Right ? 1 : 0].symbol] = along;
    return evaluate(on_side(s_, e, side), at);
  }
  double at_place(const RepeatedEvaluation& e, double x, double y) const {
    return e([&](Expr symbol) {
             return symbol == s_.space[0].symbol                          ? x
                    : s_.space.size() > 1 && symbol == s_.space[1].symbol ? y
                                                                          : values_.at(symbol);
           })
        .front();
  }

  void begin(std::size_t a, const RestingFields* before, Eigen::VectorXd& c) const {
    if (before) {
      FieldJet jet;
      jet.field = equations_.varied[a], jet.space.assign(s_.space.size(), 0);
      return space_->fit(
          a, [&](double x, double y) { return before->value(jet, x, y); }, c);
    }
    for (const FieldStart& start : equations_.model->start) {
      if (start.field != equations_.varied[a] || start.order != 0) continue;
      const Expr value = s_.expanded(start.value);
      const RepeatedEvaluation e({&value, 1});
      space_->fit(
          a, [&](double x, double y) { return at_place(e, x, y); }, c);
    }
  }

  /// What sides hold, and forces there.
  std::string hold(Eigen::VectorXd& c) {
    std::vector<bool> held(static_cast<std::size_t>(c.size()), false);
    load_ = Eigen::VectorXd::Zero(c.size());
    for (const EndForce& f : s_.end_forces)
      if (const std::string trouble = add_load(f.jet, f.side, f.value); !trouble.empty()) return trouble;
    for (const BoundaryCondition& b : s_.boundary) {
      const std::size_t a = equations_.varied_index(b.jet.field);
      if (s_.context->depends_on_time(s_.expanded(b.value).id())) return "Its ends are moved in time.";
      if (b.jet.order() > 0 && !density_.smooth[a]) {
        if (const std::string trouble = add_given_slope(b); !trouble.empty()) return trouble;
        continue;
      }
      Expr slope = s_.context->number(0);
      if (s_.space.size() > 1)
        slope =
            differentiate(s_.expanded(b.value), s_.space[b.side == Side::Left || b.side == Side::Right ? 1 : 0].symbol);
      for (const StaticSpace::Held& one : space_->held(
               a, b.side, b.jet.order() > 0, [&](double u) { return number(b.value, b.side, u); },
               [&](double u) { return number(slope, b.side, u); }))
        c(one.function) = one.value, held[static_cast<std::size_t>(one.function)] = true;
    }
    free_.clear();
    for (std::size_t i = 0; i < held.size(); ++i)
      if (!held[i]) free_.push_back(static_cast<Eigen::Index>(i));
    return "";
  }
  std::string add_load(const FieldJet& jet, Side side, Expr value) {
    const std::size_t a = equations_.varied_index(jet.field);
    if (s_.context->depends_on_time(s_.expanded(value).id())) return "A force at its end changes in time.";
    if (jet.order() > 0 && !density_.smooth[a]) return "A moment acts on an end that does not bend.";
    for (const StaticSpace::Held& one :
         space_->loads(a, side, jet.order() > 0, [&](double u) { return number(value, side, u); }))
      load_(one.function) += one.value;
    return "";
  }
  /// u_x = a says what ∂ℒ/∂u_x is there: p + F = 0 on the far side, −p + F = 0 on the near one.
  std::string add_given_slope(const BoundaryCondition& b) {
    const bool far = b.side == Side::Right || b.side == Side::Top;
    const Expr slope = s_.jet_symbol(b.jet);
    const Expr p = substitute(differentiate(density_.roots.front(), slope), {{slope, s_.expanded(b.value)}});
    if (!s_.jets_in(p).empty()) return "A given slope at a side does not say what ∂ℒ/∂u_x is there.";
    FieldJet plain = b.jet;
    std::fill(plain.space.begin(), plain.space.end(), 0);
    return add_load(plain, b.side, far ? -p : p);
  }

  /// F, and ∂F/∂c of the free functions.
  Eigen::VectorXd evaluate_at(const Eigen::VectorXd& c, Eigen::MatrixXd* slopes) {
    const std::size_t n = density_.slots.size();
    std::vector<Eigen::VectorXd> jets;
    for (std::size_t i = 0; i < n; ++i)
      jets.push_back(
          product(tables_[i], c.segment(space_->first(density_.slots[i].a), space_->size_of(density_.slots[i].a))));
    Eigen::MatrixXd found(space_->points(), static_cast<Eigen::Index>(density_.roots.size()));
    energy_ = 0;
    for (Eigen::Index q = 0; q < space_->points(); ++q) {
      values_[s_.space[0].symbol] = space_->place(0, q);
      if (s_.space.size() > 1) values_[s_.space[1].symbol] = space_->place(1, q);
      for (std::size_t i = 0; i < n; ++i) values_[density_.slots[i].symbol] = jets[i](q);
      const std::vector<double> v = at_([&](Expr symbol) { return values_.at(symbol); });
      for (std::size_t i = 0; i < v.size(); ++i) found(q, static_cast<Eigen::Index>(i)) = space_->weights()(q) * v[i];
      energy_ += found(q, 0);
    }
    Eigen::VectorXd force = load_, size = load_.cwiseAbs();
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Index at = space_->first(density_.slots[i].a), rows = tables_[i].cols();
      const Eigen::VectorXd f = found.col(static_cast<Eigen::Index>(i + 1));
      force.segment(at, rows) += transposed_product(tables_[i], f);
      size.segment(at, rows) +=
          transposed_product(Eigen::MatrixXd(tables_[i].cwiseAbs()), Eigen::VectorXd(f.cwiseAbs()));
    }
    size_of_forces_ = restricted(size).maxCoeff();
    if (slopes) *slopes = slopes_of(found);
    return restricted(force);
  }
  Eigen::MatrixXd slopes_of(const Eigen::MatrixXd& found) const {
    const std::size_t n = density_.slots.size();
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(space_->size(), space_->size());
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        if (density_.roots[1 + n + i * n + j].is_zero()) continue;
        Eigen::MatrixXd weighted = tables_[j];
        for (Eigen::Index q = 0; q < weighted.rows(); ++q)
          weighted.row(q) *= found(q, static_cast<Eigen::Index>(1 + n + i * n + j));
        all.block(space_->first(density_.slots[i].a), space_->first(density_.slots[j].a), tables_[i].cols(),
                  weighted.cols()) += transposed_product(tables_[i], weighted);
      }
    return restricted(all);
  }
  Eigen::MatrixXd mean_square() const {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(space_->size(), space_->size());
    for (std::size_t i = 0; i < density_.slots.size(); ++i) {
      if (density_.slots[i].jet.order() > 0) continue;
      Eigen::MatrixXd weighted = tables_[i];
      for (Eigen::Index q = 0; q < weighted.rows(); ++q) weighted.row(q) *= space_->weights()(q);
      const Eigen::Index at = space_->first(density_.slots[i].a), rows = weighted.cols();
      all.block(at, at, rows, rows) = transposed_product(tables_[i], weighted);
    }
    return restricted(all);
  }
  Eigen::VectorXd restricted(const Eigen::VectorXd& all) const {
    Eigen::VectorXd out(static_cast<Eigen::Index>(free_.size()));
    for (std::size_t i = 0; i < free_.size(); ++i) out(static_cast<Eigen::Index>(i)) = all(free_[i]);
    return out;
  }
  Eigen::MatrixXd restricted(const Eigen::MatrixXd& all) const {
    const auto n = static_cast<Eigen::Index>(free_.size());
    Eigen::MatrixXd out(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        out(i, j) = all(free_[static_cast<std::size_t>(i)], free_[static_cast<std::size_t>(j)]);
    return out;
  }
  Eigen::VectorXd moved(const Eigen::VectorXd& c, const Eigen::VectorXd& step, double part) const {
    Eigen::VectorXd out = c;
    for (std::size_t i = 0; i < free_.size(); ++i) out(free_[i]) += part * step(static_cast<Eigen::Index>(i));
    return out;
  }
  /// Each field beside its own largest coefficient.
  double length(const Eigen::VectorXd& step, const Eigen::VectorXd& c) const {
    double out = 0;
    for (std::size_t a = 0; a < equations_.varied.size(); ++a) {
      const Eigen::Index from = space_->first(a), count = space_->size_of(a);
      double sum = 0;
      for (std::size_t i = 0; i < free_.size(); ++i)
        if (free_[i] >= from && free_[i] < from + count)
          sum = std::max(sum, std::abs(step(static_cast<Eigen::Index>(i))));
      const double size = c.segment(from, count).cwiseAbs().maxCoeff();
      out = std::max(out, sum > 0 ? sum / std::max(size, 1e-12 * sum) : 0);
    }
    return out;
  }

  std::string newton(Eigen::VectorXd& c) {
    if (free_.empty()) return "Its sides hold all of it.";
    constexpr int most_rounds = 60;
    constexpr double least_part = 1e-5, exact = 1e-14, close = 1e-9, soft = 0.02, unit = 1e-14;
    const std::string none = "Newton's method finds no equilibrium next to its start.";
    Eigen::MatrixXd slopes;
    Eigen::VectorXd force = evaluate_at(c, &slopes);
    if (!force.allFinite() || !slopes.allFinite()) return "Its density has no value at the start.";
    double before = std::numeric_limits<double>::infinity();
    for (int round = 0; round < most_rounds; ++round) {
      interrupt_of(*s_.context).throw_if_asked();
      const StepSolver solver(slopes);
      const Eigen::VectorXd step = solver.solve(Eigen::VectorXd(-force));
      if (!step.allFinite()) return none;
      const double size = length(step, moved(c, step, 1));
      // Along what costs all but nothing, as the place of a kink, rounding of the forces moves far.
      const bool rounded = size <= soft && force.cwiseAbs().maxCoeff() <= unit * size_of_forces_;
      rounding_ = size;
      if (size <= exact || rounded || (size <= close && size >= before / 2)) return settled(force) ? "" : none;
      before = size;
      double part = 1;
      for (; part >= least_part; part /= 2) {
        const Eigen::VectorXd trial = moved(c, step, part);
        const Eigen::VectorXd there = evaluate_at(trial, nullptr);
        if (!there.allFinite()) continue;
        const Eigen::VectorXd next = solver.solve(Eigen::VectorXd(-there));
        if (size > close && next.norm() > (1 - part / 4) * step.norm()) continue;
        c = trial;
        break;
      }
      if (part < least_part) return none;
      force = evaluate_at(c, &slopes);
      if (!slopes.allFinite()) return none;
    }
    return none;
  }
  /// Where Newton's method alone does not come to a rest: down the energy −∫ℒ, by the same steps with σ times the mean
  /// square added to its second variation, σ as large as makes it positive and the step one that goes down. False where
  /// no σ does.
  bool descend(Eigen::VectorXd& c) {
    constexpr int most_rounds = 200, most_tries = 40;
    constexpr double first = 1e-6, close = 1e-6;
    const Eigen::MatrixXd mass = mean_square();
    Eigen::MatrixXd slopes;
    double shift = 0;
    for (int round = 0; round < most_rounds; ++round) {
      interrupt_of(*s_.context).throw_if_asked();
      const Eigen::VectorXd force = evaluate_at(c, &slopes);
      const double height = height_of(c);
      const double least = first * std::abs(slopes.trace()) / mass.trace();
      if (!force.allFinite() || !slopes.allFinite() || !(least > 0)) return false;
      int tries = 0;
      for (; tries < most_tries; ++tries, shift = std::max(4 * shift, least)) {
        const Eigen::LLT<Eigen::MatrixXd> factor(symmetric_part(Eigen::MatrixXd(shift * mass - slopes)));
        if (factor.info() != Eigen::Success) continue;
        const Eigen::VectorXd step = factor.solve(force), there = moved(c, step, 1);
        evaluate_at(there, nullptr);
        if (!(height_of(there) <= height + 1e-13 * std::abs(height))) continue;
        c = there;
        if (length(step, c) <= close && shift <= least) return true;
        break;
      }
      if (tries == most_tries) return length(force, c) <= close;
      shift = shift > least ? shift / 4 : 0;
    }
    return false;
  }
  /// −∫ℒ less the work of forces at sides, of what was evaluated last.
  double height_of(const Eigen::VectorXd& c) const { return -energy_ - load_.dot(c); }

  /// Where a displacement costs nothing, a force along it is left over by the least squares of a step.
  bool settled(const Eigen::VectorXd& force) const { return force.cwiseAbs().maxCoeff() <= 1e-9 * size_of_forces_; }

  const FieldEquations& equations_;
  const FieldSystem& s_;
  const StaticDensity& density_;
  std::shared_ptr<const StaticSpace> space_;
  RepeatedEvaluation at_;
  Bindings values_;
  std::vector<Eigen::MatrixXd> tables_;  // [slots]
  std::vector<Eigen::Index> free_;
  Eigen::VectorXd load_;
  double energy_ = 0, size_of_forces_ = 0, rounding_ = 0;
};

// ----------------------------------------------------------------------------------------------------------- sizes

double value_in_numbers(const FieldEquations& equations, Expr e) {
  Bindings values;
  for (const Parameter& p : equations.model->parameters) values[p.symbol] = p.si_value;
  return evaluate(equations.system().expanded(e), values);
}

/// Elements end where a coefficient jumps or has a kink across the whole of a line, if there are few of these.
std::vector<double> borders_in_plane(const FieldEquations& equations, std::size_t direction) {
  constexpr std::size_t most = 3;
  const SpaceVariable& x = equations.system().space[direction];
  const double from = value_in_numbers(equations, x.from), to = value_in_numbers(equations, x.to),
               near = 1e-9 * (to - from);
  std::vector<double> out{from};
  for (const DensityBorder& b : density_borders_along(equations, direction))
    if (b.at > out.back() + near && b.at < to - near) out.push_back(b.at);
  if (out.size() - 1 > most) out.resize(1);
  out.push_back(to);
  return out;
}

/// Of each size; empty: no more.
std::vector<StaticSpace::Along> layout(const FieldEquations& equations, std::size_t size) {
  struct Size {
    int cells, degree;
  };
  constexpr Size lines[] = {{1, 20}, {1, 36}, {4, 20}, {8, 20}, {12, 24}, {20, 24}};
  constexpr int planes[] = {8, 12, 17, 23, 29};
  const std::size_t fields = equations.varied.size();
  if (equations.system().space.size() == 1) {
    if (size >= std::size(lines)) return {};
    return {{element_borders(equations, lines[size].cells), lines[size].degree}};
  }
  if (size >= std::size(planes)) return {};
  std::vector<StaticSpace::Along> out;
  std::size_t unknowns = fields;
  for (std::size_t i = 0; i < 2; ++i) {
    std::vector<double> borders = borders_in_plane(equations, i);
    constexpr int least = 5;
    const int elements = static_cast<int>(borders.size()) - 1, degree = std::max(planes[size] / elements, least);
    unknowns *= static_cast<std::size_t>(degree * elements);
    out.push_back({std::move(borders), degree + static_cast<int>(size)});
  }
  constexpr std::size_t most = 1200;
  return size > 1 && unknowns > most ? std::vector<StaticSpace::Along>{} : out;
}

std::vector<double> shown_places(const FieldEquations& equations, std::size_t direction) {
  constexpr int shown = 20;
  const SpaceVariable& x = equations.system().space[direction];
  const double from = value_in_numbers(equations, x.from), to = value_in_numbers(equations, x.to);
  std::vector<double> out;
  for (int k = 0; k <= shown; ++k) out.push_back(k == shown ? to : from + (to - from) * k / shown);
  return out;
}

void read_values(const FieldEquations& equations, const RestingFields& rest, FieldEquilibrium& out) {
  const std::size_t dimensions = equations.system().space.size();
  out.places = shown_places(equations, 0);
  if (dimensions > 1) out.upwards = shown_places(equations, 1);
  out.fields.clear();
  for (const std::size_t field : equations.varied) {
    FieldJet jet;
    jet.field = field, jet.space.assign(dimensions, 0);
    out.fields.emplace_back();
    for (const double y : dimensions > 1 ? out.upwards : std::vector<double>{0})
      for (const double x : out.places) out.fields.back().push_back(rest.value(jet, x, y));
  }
}

/// The largest change beside the largest value; errors by it and by `rounding`, a part of that value.
double change(const FieldEquilibrium& before, FieldEquilibrium& now, double rounding) {
  double out = 0;
  now.errors.clear();
  for (std::size_t a = 0; a < now.fields.size(); ++a) {
    double off = 0, size = 0;
    for (std::size_t i = 0; i < now.fields[a].size(); ++i) {
      off = std::max(off, std::abs(now.fields[a][i] - before.fields[a][i]));
      size = std::max(size, std::abs(now.fields[a][i]));
    }
    constexpr double least = 4e-15;
    now.errors.push_back(off + std::max(rounding, least) * size);
    if (size > 0) out = std::max(out, off / size);
  }
  now.energy_error = std::abs(now.energy - before.energy) + 4e-15 * std::abs(now.energy);
  return out;
}

/// Two sizes of functions agree as well where both pass a load by that lies between their points.
std::string what_is_passed_by(const FieldEquations& equations, const std::vector<StaticSpace::Along>& along) {
  constexpr int highest = 20;  // of polynomials through the points of an element
  Borders borders;
  int order = highest;
  for (const StaticSpace::Along& one : along) borders.push_back(one.borders), order = std::min(order, one.degree);
  const auto passed = passed_by(equations, borders, order);
  return passed ? fmt::format("The polynomials of the equilibrium pass by what {}: it is too narrow for them.", *passed)
                : "";
}

}  // namespace

std::optional<ComputedRest> computed_rest(const FieldEquations& equations, std::string& why) {
  const FieldSystem& s = equations.system();
  if (equations.bodies || s.space.size() > 2 ||
      std::any_of(s.space.begin(), s.space.end(), [](const auto& x) { return !x.from; })) {
    why = "Equilibria are those of fields without bodies, with a domain.";
    return std::nullopt;
  }
  StaticDensity density;
  if (why = density.read(equations); !why.empty()) return std::nullopt;
  constexpr double close = 1e-11, much = 0.03;
  ComputedRest out;
  double off = std::numeric_limits<double>::infinity(), off_before = off;
  int failed = 0;
  double rounding = 0;
  std::vector<StaticSpace::Along> finest;
  for (std::size_t size = 0; off > std::max(close, 2 * rounding); ++size) {
    const std::vector<StaticSpace::Along> along = layout(equations, size);
    if (along.empty()) break;
    const auto space = std::make_shared<const StaticSpace>(equations, along, density.smooth);
    Equilibrium problem(equations, density, space);
    Eigen::VectorXd c;
    // A coarse one may be another than that next to the start.
    constexpr double trusted = 1e-3;
    why = problem.find(off <= trusted ? out.finest.get() : nullptr, c);
    if (!why.empty()) {
      if (off <= trusted) break;
      if (++failed == 2) return std::nullopt;
      out = {}, off = off_before = std::numeric_limits<double>::infinity();
      continue;
    }
    finest = along;
    out.before = out.finest;
    out.finest = std::make_shared<const RestingFields>(space, c);
    const FieldEquilibrium before = out.values;
    read_values(equations, *out.finest, out.values);
    out.values.energy = problem.energy(c);
    rounding = problem.rounding();
    if (out.before) off_before = off, off = change(before, out.values, rounding);
    constexpr Eigen::Index enough = 400;  // for the lowest eigenvalues
    if (c.size() <= enough || size == 0) problem.judge(c, out.values);
  }
  if (!(off <= much)) {
    if (why.empty())
      why = "The equilibria of two sizes of functions are far from each other, so that neither is known.";
    return std::nullopt;
  }
  if (why = what_is_passed_by(equations, finest); !why.empty()) return std::nullopt;
  // Where changes fall slowly, the last is less than what is left: that of a geometric series beyond it.
  const double ratio = std::isfinite(off_before) && off_before > 0 ? std::min(0.8, off / off_before) : 0;
  const double missing = std::max(1.0, 2 * ratio / (1 - ratio));
  for (double& e : out.values.errors) e *= missing;
  out.values.energy_error *= missing;
  why.clear();
  return out;
}

}  // namespace maupertuis
