#include "equations/degenerate/lagrange_problem.hpp"
#include "linear_algebra/dense.hpp"

#include <maupertuis/degenerate.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace maupertuis {
namespace {

constexpr int most_turns = 80, searches = 24;
constexpr double reached = 1e-13, good_enough = 1e-10;
constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();  // of a step in all unknowns together

void add_terms(Expr e, ExprVector& out) {
  if (!e.is(Kind::Sum)) return out.push_back(e);
  for (std::size_t i = 0; i < e.size(); ++i) add_terms(e[i], out);
}

}  // namespace

struct StateRelations::Impl {
  ReadingOrder order;
  ExprVector states, relations;
  std::vector<ExprVector> terms;  // of each relation
  ExprVector slopes;              // [relations × states]
  Bindings parameters;
  Expr time;

  Bindings at(const MotionState& s) const {
    Bindings out = parameters;
    out[time] = s.t;
    const std::size_t n = s.q.size();
    for (std::size_t i = 0; i < n; ++i) out[states[i]] = s.q[i], out[states[n + i]] = s.v[i];
    return out;
  }

  /// Values, and each divided by the sizes of its terms and of what the state's own size changes in it.
  struct Sizes {
    Eigen::VectorXd value, relative;
    Eigen::MatrixXd slope;
  };
  static double size_of(const MotionState& s) {
    double square = 0;
    for (std::size_t i = 0; i < s.q.size(); ++i) square += s.q[i] * s.q[i] + s.v[i] * s.v[i];
    return std::sqrt(square);
  }
  /// Of a relation such as x' = 0 the terms are no measure: what the others' sizes leave of x' is rounding, and what is
  /// left of the x' that it began with. `size`: of the state, or of the one that it was moved from.
  static bool fulfilled(const Sizes& here, double size, double within) {
    for (Eigen::Index i = 0; i < here.value.size(); ++i)
      if (!(here.relative[i] <= within) && !(std::abs(here.value[i]) <= rounding * here.slope.row(i).norm() * size))
        return false;
    return true;
  }
  Sizes sizes(const MotionState& s) const {
    const Bindings point = at(s);
    const auto rows = static_cast<Eigen::Index>(relations.size()), columns = static_cast<Eigen::Index>(states.size());
    Sizes out{Eigen::VectorXd::Zero(rows), Eigen::VectorXd::Zero(rows), Eigen::MatrixXd(rows, columns)};
    const std::vector<double> flat = evaluate(slopes, point);
    for (Eigen::Index i = 0; i < rows; ++i) {
      double size = 0;
      for (const double term : evaluate(terms[static_cast<std::size_t>(i)], point))
        out.value[i] += term, size += std::abs(term);
      for (Eigen::Index j = 0; j < columns; ++j) {
        out.slope(i, j) = flat[static_cast<std::size_t>(i * columns + j)];
        size += std::abs(out.slope(i, j) * point.at(states[static_cast<std::size_t>(j)]));
      }
      out.relative[i] = out.value[i] == 0 ? 0 : std::abs(out.value[i]) / size;
    }
    return out;
  }

  static void move(MotionState& s, const Eigen::VectorXd& step, double by) {
    const std::size_t n = s.q.size();
    for (std::size_t i = 0; i < n; ++i) {
      s.q[i] -= by * step[static_cast<Eigen::Index>(i)];
      s.v[i] -= by * step[static_cast<Eigen::Index>(n + i)];
    }
  }

  /// Least steps of what may move, halved while they do not come closer.
  bool newton(MotionState& s, const Eigen::VectorXd& may_move) const {
    const MotionState before = s;
    const double size = size_of(s);
    Sizes here = sizes(s);
    for (int turn = 0; turn < most_turns && !fulfilled(here, size, reached); ++turn) {
      if (!here.slope.allFinite() || !here.value.allFinite()) return false;
      const Eigen::MatrixXd slope = here.slope * may_move.asDiagonal();
      Eigen::VectorXd weight = slope.rowwise().norm();
      for (double& w : weight) w = w > 0 ? 1 / w : 1;
      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(weight.asDiagonal() * slope);
      solver.setThreshold(1e-11);
      const Eigen::VectorXd step = solver.solve(Eigen::VectorXd(weight.cwiseProduct(here.value)));
      const double merit = weight.cwiseProduct(here.value).norm();
      bool closer = false;
      for (double by = 1; !closer && by > 1e-6; by /= 2) {
        MotionState trial = s;
        move(trial, step, by);
        Sizes there = sizes(trial);
        closer = there.value.allFinite() && weight.cwiseProduct(there.value).norm() < merit;
        if (closer) s = std::move(trial), here = std::move(there);
      }
      if (!closer) break;
    }
    if (!fulfilled(here, std::max(size, size_of(s)), good_enough)) return false;
    clear_rounding(s, before);
    return true;
  }

  /// What is left of a value that came to 0 is 0, where the relations hold with it.
  void clear_rounding(MotionState& s, const MotionState& before) const {
    MotionState cleared = s;
    for (std::size_t i = 0; i < s.q.size(); ++i) {
      if (std::abs(s.q[i]) <= rounding * std::abs(before.q[i])) cleared.q[i] = 0;
      if (std::abs(s.v[i]) <= rounding * std::abs(before.v[i])) cleared.v[i] = 0;
    }
    if (fulfilled(sizes(cleared), size_of(cleared), good_enough)) s = std::move(cleared);
  }

  /// Least steps move what need not be moved: positions for which others fulfil the relations are again what they were.
  void put_back_positions(MotionState& s, const MotionState& before, Eigen::VectorXd may_move) const {
    for (std::size_t i = 0; i < s.q.size(); ++i) {
      if (s.q[i] == before.q[i]) continue;
      double& moves = may_move[static_cast<Eigen::Index>(i)];
      moves = 0;
      MotionState trial = s;
      trial.q[i] = before.q[i];
      if (newton(trial, may_move))
        s = std::move(trial);
      else
        moves = 1;
    }
  }
};

StateRelations::StateRelations(const EquationsOfMotion& equations, const DegenerateAnalysis& analysis)
    : impl_(std::make_unique<Impl>()) {
  const ConstraintProblem problem = lagrange_problem(equations, analysis.gauges > 0);
  Impl& x = *impl_;
  x.order = equations.order;
  x.states = problem.states;
  x.relations = problem.relations;
  for (const FoundConstraint& c : analysis.chain.constraints) x.relations.push_back(c.value);
  for (const Expr& relation : x.relations) {
    add_terms(relation, x.terms.emplace_back());
    for (const Expr& slope : gradient(relation, x.states)) x.slopes.push_back(slope);
  }
  x.parameters = parameter_bindings(*equations.system);
  x.time = equations.system->context->time();
}
StateRelations::~StateRelations() = default;

const ExprVector& StateRelations::values() const { return impl_->relations; }

Settled StateRelations::settle(MotionState& state, const std::vector<bool>& fixed_q,
                               const std::vector<bool>& fixed_v) const {
  const std::size_t n = state.q.size();
  Eigen::VectorXd may_move = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(2 * n));
  for (std::size_t i = 0; i < n; ++i) {
    if (fixed_q[i]) may_move[static_cast<Eigen::Index>(i)] = 0;
    if (fixed_v[i]) may_move[static_cast<Eigen::Index>(n + i)] = 0;
  }
  // Positions stay as they are where velocities alone can bring it about.
  MotionState same_place = state;
  Eigen::VectorXd velocities = may_move;
  velocities.head(static_cast<Eigen::Index>(n)).setZero();
  if (impl_->newton(same_place, velocities)) {
    state = std::move(same_place);
    return Settled::Near;
  }
  std::mt19937_64 random(1744);  // the same states in every run
  for (int attempt = 0; attempt <= searches; ++attempt) {
    MotionState trial = state;
    if (attempt > 0) {
      Eigen::VectorXd scatter = may_move * (attempt < searches / 2 ? -0.5 : -3.0);
      for (double& x : scatter) x *= std::generate_canonical<double, 53>(random) * 2 - 1 + (attempt == 1 ? 1 : 0);
      Impl::move(trial, scatter, 1);
    }
    if (!impl_->newton(trial, may_move)) continue;
    impl_->put_back_positions(trial, state, may_move);
    state = std::move(trial);
    return attempt == 0 ? Settled::Near : Settled::Elsewhere;
  }
  return Settled::Nowhere;
}

bool StateRelations::hold(const MotionState& state) const {
  return Impl::fulfilled(impl_->sizes(state), Impl::size_of(state), good_enough);
}

std::string StateRelations::worst_at(const MotionState& state) const {
  const Impl::Sizes here = impl_->sizes(state);
  Eigen::Index worst = 0;
  if (here.relative.size() == 0) return "a condition";
  here.relative.maxCoeff(&worst);
  const std::string text = to_plain(impl_->relations[static_cast<std::size_t>(worst)], impl_->order);
  return text.size() <= 100 ? text + " = 0" : std::string("one of its constraints");
}

}  // namespace maupertuis
