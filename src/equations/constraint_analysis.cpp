#include <maupertuis/constraint_analysis.hpp>
#include <maupertuis/jacobian.hpp>

#include "equations/antiderivative.hpp"
#include "equations/integrable_part.hpp"
#include "equations/manifold_samples.hpp"
#include "equations/row_reduction.hpp"
#include "equations/simplified.hpp"
#include "equations/sparse_rows.hpp"

#include <algorithm>
#include <cmath>

/// In this order: ranks of A at consistent points, dependent rows, one-forms and their integrable part, freedoms.
namespace maupertuis {
namespace {

using Matrix = Eigen::MatrixXd;
using Index = Eigen::Index;

constexpr double vanishing = 1e-4;  // a row on the manifold against beside it
constexpr double rounding = 1e-14;  // a row at the start against its length elsewhere
/// Beyond this number of entries ranks are taken by elimination, not by singular values.
constexpr std::size_t largest_dense = 64 * 128;

class Analysis {
 public:
  Analysis(const EquationsOfMotion& equations, const MotionState* start)
      : equations_(equations),
        system_(*equations.system),
        n_(system_.coordinates.size()),
        m_(system_.constraints.size()),
        manifold_(equations),
        start_(start) {
    for (const Coordinate& c : system_.coordinates) variables_.push_back(c.q), velocities_.push_back(c.velocity);
    variables_.push_back(system_.context->time());
  }

  ConstraintAnalysis carry_out() {
    out_.constraints.resize(m_);
    out_.configuration_freedoms = out_.instantaneous_freedoms = n_;
    if (m_ == 0) return out_;
    make_forms();
    take_samples();
    if (points_.empty()) return out_;
    take_ranks();
    find_dependent_rows();
    if (has_velocity_forms()) classify();
    out_.configuration_freedoms = n_ - out_.holonomic_rank - out_.integrable_rank;
    out_.instantaneous_freedoms = n_ - out_.rank;
    return out_;
  }

 private:
  // ------------------------------------------------------------------------------------------------- one-forms

  /// dφ or a·dq + a₀ dt; constraints that are not affine in the velocities have none.
  void make_forms() {
    forms_.resize(m_);
    const MotionTerms in_terms(system_);
    const SparseGradient by_variables(variables_), by_velocities(velocities_);
    ExprMap at_rest;
    for (const Expr& v : velocities_) at_rest.emplace(v, number(0));
    // Only velocity constraints are classified by their forms; the others enter beside them.
    const bool needed = std::any_of(system_.constraints.begin(), system_.constraints.end(),
                                    [](const Constraint& c) { return c.level == Constraint::Level::Velocity; });
    for (std::size_t i = 0; i < m_; ++i) {
      const Expr value = in_terms(system_.constraints[i].value);
      ConstraintReport& report = out_.constraints[i];
      if (is_holonomic(i)) {
        const std::vector<SparseGradient::Entry> entries = by_variables(value);
        if (needed) forms_[i].components = in_full(entries, n_ + 1);
        report.scleronomic =
            entries.empty() || entries.back().column != n_ || vanishes_identically(entries.back().value);
        continue;
      }
      if (affine_form(value, by_velocities, at_rest, forms_[i])) {
        report.constraint_class = ConstraintClass::Nonholonomic;
        report.scleronomic = vanishes_identically(forms_[i].components[n_]) && free_of_time(forms_[i].components);
      } else {
        forms_[i].components.clear();
        report.constraint_class = ConstraintClass::Nonlinear;
        report.scleronomic = vanishes_identically(differentiate(value, variables_[n_]));
      }
    }
  }

  bool is_holonomic(std::size_t i) const { return system_.constraints[i].level == Constraint::Level::Position; }
  Expr number(int value) const { return system_.context->number(Rational(value)); }

  ExprVector in_full(const std::vector<SparseGradient::Entry>& entries, std::size_t count) const {
    ExprVector out(count, number(0));
    for (const auto& [column, value] : entries) out[column] = value;
    return out;
  }

  bool affine_form(Expr value, const SparseGradient& by_velocities, const ExprMap& at_rest, OneForm& form) const {
    const std::vector<SparseGradient::Entry> entries = by_velocities(value);
    for (const SparseGradient::Entry& a : entries)
      for (const SparseGradient::Entry& second : by_velocities(a.value))
        if (!vanishes_identically(second.value)) return false;
    form.components = substitute(in_full(entries, n_), at_rest);
    form.components.push_back(substitute(value, at_rest));
    return true;
  }

  bool free_of_time(const ExprVector& form) const {
    return std::all_of(form.begin(), form.end(),
                       [&](Expr a) { return a.is_number() || vanishes_identically(differentiate(a, variables_[n_])); });
  }

  bool has_velocity_forms() const {
    for (std::size_t i = 0; i < m_; ++i)
      if (!is_holonomic(i) && !forms_[i].components.empty()) return true;
    return false;
  }

  // ------------------------------------------------------------------------------------------ points and ranks

  void take_samples() {
    ManifoldSamples samples = sample_manifold(manifold_, system_, start_);
    out_.clashing = samples.clashing;
    points_ = std::move(samples.states);
    beside_ = std::move(samples.beside);
    // A start that is consistent proves that constraints without t do not clash: then it stands for the manifold alone.
    const bool by_time = std::any_of(out_.clashing.begin(), out_.clashing.end(),
                                     [&](std::size_t i) { return !out_.constraints[i].scleronomic; });
    if (points_.empty() && start_ && !by_time) {
      out_.clashing.clear();
      points_.push_back(*start_);
    }
  }

  /// A with its columns in the scale of the masses.
  SparseRows rows_at(const MotionState& state) const {
    const std::vector<double> mass = manifold_.mass_diagonal(state);
    SparseRows out{n_, std::vector<SparseRows::Row>(m_)};
    for (const MatrixEntry& e : manifold_.matrix_entries(state)) {
      const double diagonal = mass[e.column];
      const double scale = std::isfinite(diagonal) && diagonal > 0 ? std::sqrt(diagonal) : 1;
      out.rows[e.row].emplace_back(e.column, e.value / scale);
    }
    return out;
  }

  bool is_large() const { return m_ * n_ > largest_dense; }

  static Matrix dense(const SparseRows& a) {
    Matrix out = Matrix::Zero(static_cast<Index>(a.rows.size()), static_cast<Index>(a.columns));
    for (std::size_t i = 0; i < a.rows.size(); ++i)
      for (const auto& [column, value] : a.rows[i]) out(static_cast<Index>(i), static_cast<Index>(column)) = value;
    return out;
  }

  std::size_t rank_of(const SparseRows& a) const { return is_large() ? sparse_rank(a) : numerical_rank(dense(a)); }

  static void scale_row(SparseRows::Row& row, double factor) {
    for (auto& entry : row) entry.second *= factor;
    if (factor == 0) row.clear();
  }

  void take_ranks() {
    for (const MotionState& point : points_) rows_.push_back(rows_at(point));
    SparseRows at_start = start_ ? rows_at(*start_) : rows_[0];
    std::vector<double> lengths(m_, 0), beside(m_, 0);
    const auto measure = [&](const SparseRows& a, std::vector<double>& longest) {
      for (std::size_t i = 0; i < m_; ++i) longest[i] = std::max(longest[i], norm(a.rows[i]));
    };
    for (const SparseRows& a : rows_) measure(a, lengths);
    for (const MotionState& point : beside_) measure(rows_at(point), beside);
    for (std::size_t i = 0; i < m_; ++i) {
      // φ = 0 where its gradient vanishes is met to half of the digits only.
      const double scale = lengths[i] > vanishing * beside[i] ? 1 / lengths[i] : 0;
      for (SparseRows& a : rows_) scale_row(a.rows[i], scale);
      scale_row(at_start.rows[i], scale);
      // cos 90° is 6e-17: a gradient that is rounding of its length elsewhere is none.
      if (norm(at_start.rows[i]) < rounding) at_start.rows[i].clear();
    }
    std::vector<std::size_t> ranks;
    for (const SparseRows& a : rows_) {
      ranks.push_back(rank_of(a));
      out_.holonomic_rank = std::max(out_.holonomic_rank, only_holonomic() ? ranks.back() : rank_of(holonomic(a)));
    }
    best_ = static_cast<std::size_t>(std::max_element(ranks.begin(), ranks.end()) - ranks.begin());
    out_.rank = ranks[best_];
    out_.rank_varies = *std::min_element(ranks.begin(), ranks.end()) < out_.rank;
    out_.start_rank = start_ ? std::min(rank_of(at_start), out_.rank) : out_.rank;
  }

  bool only_holonomic() const {
    for (std::size_t i = 0; i < m_; ++i)
      if (!is_holonomic(i)) return false;
    return true;
  }

  SparseRows holonomic(const SparseRows& a) const {
    SparseRows out = a;
    for (std::size_t i = 0; i < m_; ++i)
      if (!is_holonomic(i)) out.rows[i].clear();
    return out;
  }

  /// Each row that adds nothing to the earlier ones, as their combination. What takes part in one has no definite λ.
  void find_dependent_rows() {
    std::vector<bool> undetermined(m_, false);
    for (const auto& [row, depends_on] :
         is_large() ? dependent_rows(rows_[best_]) : dependent_rows(dense(rows_[best_]))) {
      out_.constraints[row].redundant = undetermined[row] = true;
      out_.constraints[row].depends_on = depends_on;
      for (const std::size_t k : depends_on) undetermined[k] = true;
    }
    for (std::size_t i = 0; i < m_; ++i)
      if (undetermined[i]) out_.undetermined.push_back(i);
  }

  using Dependent = std::vector<std::pair<std::size_t, std::vector<std::size_t>>>;

  static Dependent dependent_rows(const SparseRows& a) {
    Dependent out;
    for (const DependentRow& found : dependence_of(a).dependent) {
      out.push_back({found.row, {}});
      for (const auto& [k, weight] : found.combination)
        if (std::abs(weight) * norm(a.rows[k]) > 1e-7 * norm(a.rows[found.row])) out.back().second.push_back(k);
    }
    return out;
  }

  Dependent dependent_rows(const Matrix& a) const {
    Dependent out;
    const std::vector<std::size_t> chosen = independent_rows(a);
    for (std::size_t i = 0; i < m_; ++i) {
      if (std::find(chosen.begin(), chosen.end(), i) != chosen.end()) continue;
      std::vector<std::size_t> earlier;
      for (const std::size_t k : chosen)
        if (k < i) earlier.push_back(k);
      out.push_back({i, part_taking(a, i, earlier)});
    }
    return out;
  }

  static std::vector<std::size_t> part_taking(const Matrix& a, std::size_t row, const std::vector<std::size_t>& of) {
    if (of.empty()) return {};
    Matrix basis(a.cols(), static_cast<Index>(of.size()));
    for (std::size_t k = 0; k < of.size(); ++k)
      basis.col(static_cast<Index>(k)) = a.row(static_cast<Index>(of[k])).transpose();
    const Eigen::VectorXd target = a.row(static_cast<Index>(row)).transpose();
    const Eigen::VectorXd weights = least_squares(basis, target);
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < of.size(); ++k)
      if (std::abs(weights[static_cast<Index>(k)]) * basis.col(static_cast<Index>(k)).norm() > 1e-7 * target.norm())
        out.push_back(of[k]);
    return out;
  }

  // -------------------------------------------------------------------------------------------- classification

  std::vector<Bindings> bindings() const {
    std::vector<Bindings> out;
    for (const MotionState& point : points_) {
      Bindings b = parameter_bindings(system_);
      b[variables_[n_]] = point.t;
      for (std::size_t i = 0; i < n_; ++i) b[variables_[i]] = point.q[i];
      out.push_back(std::move(b));
    }
    return out;
  }

  void classify() {
    std::vector<OneForm> forms;
    std::vector<std::size_t> owner;
    for (std::size_t i = 0; i < m_; ++i)
      if (!forms_[i].components.empty()) forms.push_back(forms_[i]), owner.push_back(i);
    const IntegrablePart part = integrable_part(forms, variables_, bindings());
    out_.integrable_rank = part.integrable_rank > out_.holonomic_rank ? part.integrable_rank - out_.holonomic_rank : 0;
    for (std::size_t k = 0; k < forms.size(); ++k) {
      ConstraintReport& report = out_.constraints[owner[k]];
      if (is_holonomic(owner[k]) || !part.integrable[k]) continue;
      report.constraint_class = ConstraintClass::Integrable;
      report.integral = first_integral(forms[k], variables_, equations_.order);
    }
    for (const IntegrablePart::Combination& found : part.combinations) {
      IntegrableCombination combination;
      for (const std::size_t k : found.forms) combination.constraints.push_back(owner[k]);
      std::sort(combination.constraints.begin(), combination.constraints.end());
      combination.integral = first_integral(found.form, variables_, equations_.order);
      out_.combinations.push_back(std::move(combination));
    }
  }

  const EquationsOfMotion& equations_;
  const MechanicalSystem& system_;
  std::size_t n_, m_;
  ConstraintManifold manifold_;
  const MotionState* start_;
  ExprVector variables_, velocities_;         // q and t [n + 1]; q̇ [n]
  std::vector<OneForm> forms_;                // [m]; without components where ψ is not affine
  std::vector<MotionState> points_, beside_;  // on the constraints, and where they were taken from
  std::vector<SparseRows> rows_;              // A at the points, scaled
  std::size_t best_ = 0;                      // a point of the largest rank
  ConstraintAnalysis out_;
};

}  // namespace

const char* word(ConstraintClass constraint_class) {
  switch (constraint_class) {
    case ConstraintClass::Holonomic:
      return "holonomic";
    case ConstraintClass::Nonholonomic:
      return "nonholonomic";
    case ConstraintClass::Integrable:
      return "integrable";
    case ConstraintClass::Nonlinear:
      return "nonlinear";
  }
  return "";
}

const char* words(ConstraintClass constraint_class) {
  switch (constraint_class) {
    case ConstraintClass::Holonomic:
      return "holonomic";
    case ConstraintClass::Nonholonomic:
      return "non-holonomic";
    case ConstraintClass::Integrable:
      return "holonomic in disguise";
    case ConstraintClass::Nonlinear:
      return "non-linear in the velocities (Chetaev)";
  }
  return "";
}

ConstraintAnalysis analyse_constraints(const EquationsOfMotion& equations, const MotionState* start) {
  if (!equations.system->constrained()) {
    ConstraintAnalysis free;
    free.configuration_freedoms = free.instantaneous_freedoms = equations.system->coordinates.size();
    return free;
  }
  return Analysis(equations, start).carry_out();
}

}  // namespace maupertuis
