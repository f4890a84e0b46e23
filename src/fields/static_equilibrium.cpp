#include "fields/static_equilibrium.hpp"

#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/interrupt_scope.hpp>

#include "fields/field_sides.hpp"
#include "fields/given_fields.hpp"
#include "fields/small_motions.hpp"
#include "linear_algebra/products.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace maupertuis {
namespace {

using Side = BoundaryCondition::Side;

/// Where −∫ℒ has a minimum its second variation is positive; elsewhere, and where a displacement costs nothing, least
/// squares.
class StepSolver {
 public:
  /// `balanced`: rows and columns are brought to one size first, as forces on fields, turning moments and multipliers
  /// have units of their own.
  StepSolver(const Eigen::MatrixXd& slopes, bool balanced)
      : size_(balanced ? sizes_of(slopes) : Eigen::VectorXd::Ones(slopes.rows())),
        positive_(symmetric_part(scaled(-slopes))) {
    constexpr double least = 1e-14;
    const Eigen::ArrayXd pivots = positive_.matrixLLT().diagonal().array().square();
    if (positive_.info() != Eigen::Success || !(pivots.minCoeff() > least * pivots.maxCoeff()))
      any_.emplace(scaled(slopes));
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const {
    const Eigen::VectorXd beside = right.cwiseProduct(size_);
    if (any_) return Eigen::VectorXd(any_->solve(beside)).cwiseProduct(size_);
    return Eigen::VectorXd(positive_.solve(Eigen::VectorXd(-beside))).cwiseProduct(size_);
  }
  /// Of a step, in the measure in which the matrix has one size everywhere.
  double norm(const Eigen::VectorXd& step) const { return step.cwiseQuotient(size_).norm(); }

 private:
  static Eigen::VectorXd sizes_of(const Eigen::MatrixXd& slopes) {
    Eigen::VectorXd out = Eigen::VectorXd::Ones(slopes.rows());
    for (Eigen::Index i = 0; i < out.size(); ++i) {
      const double diagonal = std::abs(slopes(i, i)), largest = slopes.row(i).cwiseAbs().maxCoeff();
      if (largest > 0) out(i) = 1 / std::sqrt(diagonal > 0 ? diagonal : largest);
    }
    return out;
  }
  Eigen::MatrixXd scaled(const Eigen::MatrixXd& m) const { return size_.asDiagonal() * m * size_.asDiagonal(); }

  Eigen::VectorXd size_;
  Eigen::LLT<Eigen::MatrixXd> positive_;
  std::optional<Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>> any_;
};

}  // namespace

StaticEquilibrium::StaticEquilibrium(const FieldEquations& equations, const StaticDensity& density,
                                     const StaticBodies& bodies, std::shared_ptr<const StaticSpace> space)
    : equations_(equations),
      s_(equations.system()),
      density_(density),
      bodies_(bodies),
      space_(std::move(space)),
      at_(density.roots) {
  for (const Parameter& p : equations.model->parameters) values_[p.symbol] = p.si_value;
  if (equations.bodies)
    for (const Parameter& p : equations.bodies->system->parameters) values_[p.symbol] = p.si_value;
  for (const StaticDensity::Slot& slot : density.slots) tables_.push_back(space_->table(slot.a, slot.jet.space));
  of_body_.assign(static_cast<std::size_t>(bodies.size()), -1);
  for (const PlaceCoordinate& p : equations.model->attached)
    if (p.coordinate < of_body_.size())
      of_body_[p.coordinate] =
          space_->function_at(equations.varied_index(p.jet.field), number(p.place, Side::Left, 0), p.jet.order() > 0);
  for (Eigen::Index& unknown : of_body_)
    if (unknown < 0) unknown = space_->size() + own_bodies_++;
}

std::string StaticEquilibrium::find(const RestingFields* before, const std::vector<Expr>& formulas,
                                    Eigen::VectorXd& c) {
  c = Eigen::VectorXd::Zero(unknowns());
  for (std::size_t a = 0; a < equations_.varied.size(); ++a) begin(a, before, formulas[a], c);
  begin_bodies(before, c);
  if (!c.allFinite()) return "The start has no value somewhere in the domain.";
  if (const std::string trouble = hold(c); !trouble.empty()) return trouble;
  const Eigen::VectorXd start = c;
  const std::string trouble = newton(c);
  if (trouble.empty()) return "";
  c = start;
  return descend(c) ? newton(c) : trouble;
}

double StaticEquilibrium::energy(const Eigen::VectorXd& c) {
  evaluate_at(c, nullptr);
  return -energy_;
}

Eigen::VectorXd StaticEquilibrium::of_bodies(const Eigen::VectorXd& c) const {
  Eigen::VectorXd out(bodies_.size());
  for (Eigen::Index i = 0; i < out.size(); ++i) out(i) = c(of_body_[static_cast<std::size_t>(i)]);
  return out;
}

/// An orthonormal basis of the free unknowns, multipliers left out, that constraints leave to second order.
Eigen::MatrixXd StaticEquilibrium::along_constraints(const Eigen::MatrixXd& slopes) const {
  const Eigen::Index m = bodies_.constraints(), n = slopes.rows() - m;  // multipliers are the last unknowns
  if (m == 0) return Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd across = slopes.bottomLeftCorner(m, n).transpose();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(across);
  const Eigen::MatrixXd q = columns_of_q(qr, n);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(slopes.rows(), n - qr.rank());
  out.topRows(n) = q.rightCols(n - qr.rank());
  return out;
}

void StaticEquilibrium::judge(const Eigen::VectorXd& c, FieldEquilibrium& out) {
  Eigen::MatrixXd slopes;
  evaluate_at(c, &slopes);
  out.lowest.reset(), out.falling = 0;
  // Forces without a potential have no energy.
  constexpr double rounding = 1e-10;
  if (Eigen::MatrixXd(slopes - slopes.transpose()).cwiseAbs().maxCoeff() > rounding * slopes.cwiseAbs().maxCoeff())
    return;
  const Eigen::MatrixXd z = along_constraints(slopes);
  SmallMotions second;
  second.from_free = Eigen::MatrixXd::Identity(z.cols(), z.cols());
  second.stiffness = symmetric_part(quadratic_form(z, Eigen::MatrixXd(-slopes)));
  second.mass = symmetric_part(quadratic_form(z, mean_square()));
  std::vector<double> roots;
  std::vector<Eigen::VectorXd> shapes;
  if (!solve_conservative(second, static_cast<std::size_t>(z.cols()), roots, shapes) || roots.empty()) return;
  out.lowest = roots.front() < 0 ? -roots.front() * roots.front() : roots.front() * roots.front();
  out.falling = static_cast<std::size_t>(std::count_if(roots.begin(), roots.end(), [](double r) { return r < 0; }));
}

double StaticEquilibrium::number(Expr e, Side side, double along) {
  Bindings at = values_;
  if (s_.space.size() > 1) at[s_.space[side == Side::Left || side == Side::Right ? 1 : 0].symbol] = along;
  return evaluate(on_side(s_, e, side), at);
}

void StaticEquilibrium::begin(std::size_t a, const RestingFields* before, Expr formula, Eigen::VectorXd& c) const {
  if (before) {
    FieldJet jet;
    jet.field = equations_.varied[a], jet.space.assign(s_.space.size(), 0);
    return space_->fit(
        a, [&](double x, double y) { return before->value(jet, x, y); }, c);
  }
  if (formula.is_zero()) return;
  const RepeatedEvaluation e({&formula, 1});
  space_->fit(
      a,
      [&](double x, double y) {
        return e([&](Expr symbol) {
                 return symbol == s_.space[0].symbol                          ? x
                        : s_.space.size() > 1 && symbol == s_.space[1].symbol ? y
                                                                              : values_.at(symbol);
               })
            .front();
      },
      c);
}

/// Values of fields at places are those of the fields.
void StaticEquilibrium::begin_bodies(const RestingFields* before, Eigen::VectorXd& c) const {
  for (Eigen::Index i = 0; i < bodies_.size(); ++i) {
    const Eigen::Index unknown = of_body_[static_cast<std::size_t>(i)];
    if (unknown < space_->size()) continue;
    c(unknown) = before ? before->bodies()(i) : i < bodies_.coordinates() ? bodies_.start()(i) : 0;
  }
}

/// What sides hold, and forces there.
std::string StaticEquilibrium::hold(Eigen::VectorXd& c) {
  std::vector<bool> held(static_cast<std::size_t>(c.size()), false);
  load_ = Eigen::VectorXd::Zero(space_->size());
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
std::string StaticEquilibrium::add_load(const FieldJet& jet, Side side, Expr value) {
  const std::size_t a = equations_.varied_index(jet.field);
  if (s_.context->depends_on_time(s_.expanded(value).id())) return "A force at its end changes in time.";
  if (jet.order() > 0 && !density_.smooth[a]) return "A moment acts on an end that does not bend.";
  for (const StaticSpace::Held& one :
       space_->loads(a, side, jet.order() > 0, [&](double u) { return number(value, side, u); }))
    load_(one.function) += one.value;
  return "";
}
/// u_x = a says what ∂ℒ/∂u_x is there: p + F = 0 on the far side, −p + F = 0 on the near one.
std::string StaticEquilibrium::add_given_slope(const BoundaryCondition& b) {
  const bool far = b.side == Side::Right || b.side == Side::Top;
  const Expr slope = s_.jet_symbol(b.jet);
  const Expr p = substitute(differentiate(density_.roots.front(), slope), {{slope, s_.expanded(b.value)}});
  if (!s_.jets_in(p).empty()) return "A given slope at a side does not say what ∂ℒ/∂u_x is there.";
  FieldJet plain = b.jet;
  std::fill(plain.space.begin(), plain.space.end(), 0);
  return add_load(plain, b.side, far ? -p : p);
}

/// F, and ∂F/∂c of the free functions.
Eigen::VectorXd StaticEquilibrium::evaluate_at(const Eigen::VectorXd& c, Eigen::MatrixXd* slopes) {
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
  Eigen::VectorXd force = Eigen::VectorXd::Zero(unknowns());
  force.head(load_.size()) = load_;
  Eigen::VectorXd size = force.cwiseAbs();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Index at = space_->first(density_.slots[i].a), rows = tables_[i].cols();
    const Eigen::VectorXd f = found.col(static_cast<Eigen::Index>(i + 1));
    force.segment(at, rows) += transposed_product(tables_[i], f);
    size.segment(at, rows) += transposed_product(Eigen::MatrixXd(tables_[i].cwiseAbs()), Eigen::VectorXd(f.cwiseAbs()));
  }
  Eigen::MatrixXd all;
  if (slopes) all = slopes_of(found);
  if (bodies_.size() > 0) {
    const StaticBodies::Values v = bodies_.at(of_bodies(c));
    energy_ -= v.energy;
    for (Eigen::Index i = 0; i < bodies_.size(); ++i) {
      const Eigen::Index row = of_body_[static_cast<std::size_t>(i)];
      force(row) += v.force(i), size(row) += std::abs(v.force(i));
      for (Eigen::Index j = 0; slopes && j < bodies_.size(); ++j)
        all(row, of_body_[static_cast<std::size_t>(j)]) += v.slopes(i, j);
    }
  }
  size_of_forces_ = restricted(size).maxCoeff();
  if (slopes) *slopes = restricted(all);
  return restricted(force);
}
Eigen::MatrixXd StaticEquilibrium::slopes_of(const Eigen::MatrixXd& found) const {
  const std::size_t n = density_.slots.size();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(unknowns(), unknowns());
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      if (density_.roots[1 + n + i * n + j].is_zero()) continue;
      Eigen::MatrixXd weighted = tables_[j];
      for (Eigen::Index q = 0; q < weighted.rows(); ++q)
        weighted.row(q) *= found(q, static_cast<Eigen::Index>(1 + n + i * n + j));
      all.block(space_->first(density_.slots[i].a), space_->first(density_.slots[j].a), tables_[i].cols(),
                weighted.cols()) += transposed_product(tables_[i], weighted);
    }
  return all;
}
Eigen::MatrixXd StaticEquilibrium::mean_square() const {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(unknowns(), unknowns());
  for (Eigen::Index i = 0; i < bodies_.coordinates(); ++i)
    if (const Eigen::Index at = of_body_[static_cast<std::size_t>(i)]; at >= space_->size()) all(at, at) = 1;
  for (std::size_t i = 0; i < density_.slots.size(); ++i) {
    if (density_.slots[i].jet.order() > 0) continue;
    Eigen::MatrixXd weighted = tables_[i];
    for (Eigen::Index q = 0; q < weighted.rows(); ++q) weighted.row(q) *= space_->weights()(q);
    const Eigen::Index at = space_->first(density_.slots[i].a), rows = weighted.cols();
    all.block(at, at, rows, rows) = transposed_product(tables_[i], weighted);
  }
  return restricted(all);
}
Eigen::VectorXd StaticEquilibrium::restricted(const Eigen::VectorXd& all) const {
  Eigen::VectorXd out(static_cast<Eigen::Index>(free_.size()));
  for (std::size_t i = 0; i < free_.size(); ++i) out(static_cast<Eigen::Index>(i)) = all(free_[i]);
  return out;
}
Eigen::MatrixXd StaticEquilibrium::restricted(const Eigen::MatrixXd& all) const {
  const auto n = static_cast<Eigen::Index>(free_.size());
  Eigen::MatrixXd out(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      out(i, j) = all(free_[static_cast<std::size_t>(i)], free_[static_cast<std::size_t>(j)]);
  return out;
}
Eigen::VectorXd StaticEquilibrium::moved(const Eigen::VectorXd& c, const Eigen::VectorXd& step, double part) const {
  Eigen::VectorXd out = c;
  for (std::size_t i = 0; i < free_.size(); ++i) out(free_[i]) += part * step(static_cast<Eigen::Index>(i));
  return out;
}
/// Each field beside its own largest coefficient.
double StaticEquilibrium::length(const Eigen::VectorXd& step, const Eigen::VectorXd& c) const {
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
  for (Eigen::Index i = 0; i < bodies_.coordinates(); ++i)
    for (std::size_t k = 0; k < free_.size(); ++k)
      if (const Eigen::Index at = of_body_[static_cast<std::size_t>(i)]; free_[k] == at && at >= space_->size()) {
        const double moved = std::abs(step(static_cast<Eigen::Index>(k)));
        out = std::max(out, moved > 0 ? moved / std::max(bodies_.scale(i, c(at)), 1e-12 * moved) : 0);
      }
  return out;
}

std::string StaticEquilibrium::newton(Eigen::VectorXd& c) {
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
    const StepSolver solver(slopes, bodies_.size() > 0);
    const Eigen::VectorXd step = solver.solve(Eigen::VectorXd(-force));
    if (!step.allFinite()) return none;
    const double size = length(step, moved(c, step, 1));
    // Along what costs all but nothing, as the place of a kink, rounding of the forces moves far.
    const bool rounded = size <= soft && force.cwiseAbs().maxCoeff() <= unit * size_of_forces_;
    rounding_ = size;
    if (size <= exact || rounded || (size <= close && size >= before / 2)) return settled(force, slopes, c) ? "" : none;
    before = size;
    double part = 1;
    for (; part >= least_part; part /= 2) {
      const Eigen::VectorXd trial = moved(c, step, part);
      const Eigen::VectorXd there = evaluate_at(trial, nullptr);
      if (!there.allFinite()) continue;
      const Eigen::VectorXd next = solver.solve(Eigen::VectorXd(-there));
      if (size > close && solver.norm(next) > (1 - part / 4) * solver.norm(step)) continue;
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
bool StaticEquilibrium::descend(Eigen::VectorXd& c) {
  if (bodies_.constraints() > 0) return false;  // a rest on constraints is no minimum of −∫ℒ alone
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

/// Where a displacement costs nothing, a force along it is left over by the least squares of a step. At a rest where no
/// force acts anywhere, as u = 1 in a well, the forces are measured by those of a displacement of the size of the
/// field.
bool StaticEquilibrium::settled(const Eigen::VectorXd& force, const Eigen::MatrixXd& slopes,
                                const Eigen::VectorXd& c) const {
  constexpr double beside_forces = 1e-9, beside_field = 1e-13;
  const double left = force.cwiseAbs().maxCoeff();
  if (left <= beside_forces * size_of_forces_) return true;
  const Eigen::VectorXd of_field = slopes.cwiseAbs() * restricted(c).cwiseAbs();
  return left <= beside_field * of_field.maxCoeff();
}

}  // namespace maupertuis
