#include "analysis/linearization/steady_state.hpp"

#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/size_of_terms.hpp>
#include <maupertuis/transform.hpp>

#include "analysis/linearization/dense.hpp"
#include "linear_algebra/products.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis {
namespace {

constexpr double arrived = 1e-9;  // of what is left, by the sizes of coordinates
constexpr double rank_of_balance = 1e-11;
constexpr double rounding_of_work = 1e-14;
constexpr double next_to = 0.03;  // of sizes: a root of order 12 is known that well in double

}  // namespace

SteadyState::SteadyState(PointEquations::Impl& equations, const std::vector<Translation>& translations, Held held,
                         std::vector<double> momenta, std::vector<double> sizes)
    : e_(equations), translations_(translations), momenta_(std::move(momenta)), sizes_(std::move(sizes)) {
  for (std::size_t i = 0; i < e_.n; ++i)
    if (!held.q[i]) free_q_.push_back(i);
  for (std::size_t k = 0; k < translations.size(); ++k)
    if (!held.rates[k]) free_rates_.push_back(k);
  for (const std::size_t k : free_rates_)
    if (!std::isnan(momenta_[k])) kept_momenta_.push_back(k);
  by_rates_ = Matrix::Zero(static_cast<Index>(e_.n), static_cast<Index>(free_rates_.size()));
  for (std::size_t k = 0; k < free_rates_.size(); ++k)
    by_rates_.col(static_cast<Index>(k)) = to_eigen(translations[free_rates_[k]].direction);
}

/// Derivatives by rates matter where rates are sought.
PointEquations::Impl::Rows& SteadyState::balance_of(const OperatingPoint& point) const {
  const auto none = [](const std::vector<double>& x) {
    return std::all_of(x.begin(), x.end(), [](double value) { return value == 0; });
  };
  return free_rates_.empty() && none(point.v) && none(point.a) ? e_.resting : e_.balance;
}

/// The rows alone, for a fraction of the price of their derivatives.
Vector SteadyState::rows_at(const OperatingPoint& point) const {
  const Vector parts[] = {e_.value(balance_of(point), point), e_.value(e_.positions, point),
                          e_.value(e_.velocities, point), e_.value(e_.relations, point)};
  const Vector momenta = kept_momenta_.empty() ? Vector() : e_.value(e_.momenta, point);
  Index rows = static_cast<Index>(kept_momenta_.size()), row = 0;
  for (const Vector& part : parts) rows += part.size();
  Vector out(rows);
  for (const Vector& part : parts) {
    out.segment(row, part.size()) = part;
    row += part.size();
  }
  for (const std::size_t k : kept_momenta_)
    out[row++] = to_eigen(translations_[k].direction).dot(momenta) - momenta_[k];
  return out;
}

SteadyState::System SteadyState::system_at(const OperatingPoint& point) const {
  const auto q = static_cast<Index>(free_q_.size()), c = static_cast<Index>(free_rates_.size()),
             m = static_cast<Index>(e_.m);
  const RowsAtPoint balance = e_.at(balance_of(point), point), positions = e_.at(e_.positions, point),
                    velocities = e_.at(e_.velocities, point), relations = e_.at(e_.relations, point);
  const RowsAtPoint momenta = kept_momenta_.empty() ? RowsAtPoint{} : e_.at(e_.momenta, point);
  const auto kept = static_cast<Index>(kept_momenta_.size());
  const Index rows =
      balance.value.size() + positions.value.size() + velocities.value.size() + relations.value.size() + kept;
  System out{Vector::Zero(rows), Matrix::Zero(rows, q + c + m)};
  Index row = 0;
  for (const RowsAtPoint* part : {&balance, &positions, &velocities, &relations}) {
    const Index count = part->value.size();
    out.f.segment(row, count) = part->value;
    for (Index j = 0; j < q; ++j)
      out.j.block(row, j, count, 1) = part->by_q.col(static_cast<Index>(free_q_[static_cast<std::size_t>(j)]));
    out.j.block(row, q, count, c) = part->by_v * by_rates_;
    out.j.block(row, q + c, count, m) = part->by_multipliers;
    row += count;
  }
  for (const std::size_t k : kept_momenta_) {
    const Vector d = to_eigen(translations_[k].direction);
    out.f[row] = d.dot(momenta.value) - momenta_[k];
    for (Index j = 0; j < q; ++j)
      out.j(row, j) = d.dot(momenta.by_q.col(static_cast<Index>(free_q_[static_cast<std::size_t>(j)])));
    out.j.block(row, q, 1, c) = d.transpose() * momenta.by_v * by_rates_;
    ++row;
  }
  return out;
}

Vector SteadyState::unknowns(const OperatingPoint& point) const {
  Vector z(static_cast<Index>(free_q_.size() + free_rates_.size() + e_.m));
  Index at = 0;
  for (const std::size_t i : free_q_) z[at++] = point.q[i];
  for (const std::size_t k : free_rates_) z[at++] = point.v[translations_[k].pivot];
  for (const double l : point.multipliers) z[at++] = l;
  return z;
}

void SteadyState::place(const Vector& z, OperatingPoint& point) const {
  Index at = 0;
  for (const std::size_t i : free_q_) point.q[i] = z[at++];
  std::vector<double> rates;
  for (const Translation& t : translations_) rates.push_back(point.v[t.pivot]);
  for (const std::size_t k : free_rates_) rates[k] = z[at++];
  Vector v = Vector::Zero(static_cast<Index>(e_.n));
  for (std::size_t k = 0; k < rates.size(); ++k) v += rates[k] * to_eigen(translations_[k].direction);
  point.v = to_list(v);
  for (double& l : point.multipliers) l = z[at++];
}

void SteadyState::fit_multipliers(OperatingPoint& point) const {
  if (e_.m == 0) return;
  std::fill(point.multipliers.begin(), point.multipliers.end(), 0);
  const RowsAtPoint balance = e_.at(balance_of(point), point);
  if (!balance.value.allFinite() || !balance.by_multipliers.allFinite()) return;
  const Vector fit = least_squares(balance.by_multipliers, -balance.value, rank_of_balance).x;
  if (fit.allFinite()) point.multipliers = to_list(fit);
}

/// What the unknowns of typical size do to a row.
double SteadyState::scale_of(const System& s, const Vector& z, Index row) const {
  double scale = 0;
  for (Index j = 0; j < s.j.cols(); ++j) {
    const double typical =
        static_cast<std::size_t>(j) < free_q_.size() ? sizes_[free_q_[static_cast<std::size_t>(j)]] : 0.0;
    scale = std::max(scale, std::abs(s.j(row, j)) * std::max(std::abs(z[j]), typical));
  }
  return scale;
}

/// The largest row, divided by its scale: a relative error of positions. The first n rows are forces, and forces times
/// typical sizes are works, which compare: a force that no unknown changes (one sideways on a bicycle that runs
/// upright) is rounding of the others. Of the largest force over a typical size: work below rounding of it is none.
double SteadyState::largest_work(const System& s, const Vector& z) const {
  double work = 0;
  for (Index i = 0; i < static_cast<Index>(e_.n); ++i)
    work = std::max(work, scale_of(s, z, i) * sizes_[static_cast<std::size_t>(i)]);
  return work;
}

double SteadyState::scaled(const System& s, const Vector& z) const {
  if (!s.f.allFinite() || !s.j.allFinite()) return HUGE_VAL;
  const auto forces = static_cast<Index>(e_.n);
  const double work = largest_work(s, z);
  double largest = 0;
  for (Index i = 0; i < s.f.size(); ++i) {
    if (s.f[i] == 0 ||
        (i < forces && std::abs(s.f[i]) * sizes_[static_cast<std::size_t>(i)] <= rounding_of_work * work))
      continue;
    const double scale = scale_of(s, z, i);
    largest = std::max(largest, scale > 0 ? std::abs(s.f[i]) / scale : HUGE_VAL);
  }
  return largest;
}

double SteadyState::residual_at(OperatingPoint& point) const {
  fit_multipliers(point);
  return scaled(system_at(point), unknowns(point));
}

/// How long a move of the unknowns is, in typical sizes; multipliers do not count.
double SteadyState::length(const Vector& move, const Vector& z) const {
  double out = 0;
  for (std::size_t i = 0; i < free_q_.size(); ++i)
    out = std::max(out, std::abs(move[static_cast<Index>(i)]) / sizes_[free_q_[i]]);
  for (std::size_t i = 0; i < free_rates_.size(); ++i) {
    const auto at = static_cast<Index>(free_q_.size() + i);
    out = std::max(out, std::abs(move[at]) / std::max(1.0, std::abs(z[at])));
  }
  return out;
}

/// Multipliers that vanish up to rounding leave derivatives by the coordinates that are rounding as well. Equilibration
/// would make entries like any other of them.
Matrix SteadyState::without_rounding(const System& s, const Vector& z) const {
  Matrix out = s.j;
  const double none = rounding_of_work * largest_work(s, z);
  for (std::size_t i = 0; i < e_.n; ++i)
    for (std::size_t j = 0; j < free_q_.size(); ++j) {
      double& entry = out(static_cast<Index>(i), static_cast<Index>(j));
      if (std::abs(entry) * sizes_[i] * sizes_[free_q_[j]] <= none) entry = 0;
    }
  return out;
}

/// Orthonormal moves of positions and rates [rows × ways] along which the derivatives vanish, with the multipliers that
/// go with them: each as unknowns in the units of `by`.
Matrix SteadyState::soft_ways(const Matrix& derivatives, const Equilibration& by) const {
  constexpr double soft = 1e-7,
                   moves = 1e-4;  // of the equilibrated derivatives; squared, against changes of multipliers alone
  const Matrix j = by.of(derivatives);
  const KernelFirst split = kernel_first(j, soft * std::max(1.0, j.norm()));
  const Matrix kernel = split.basis.leftCols(split.kernel);
  const Matrix moving = kernel.topRows(static_cast<Index>(free_q_.size() + free_rates_.size()));
  Matrix out(kernel.rows(), 0);
  if (split.kernel == 0) return out;
  const SymmetricEigen parts = symmetric_eigen(transposed_product(moving, moving));
  for (Index k = 0; k < parts.values.size(); ++k) {
    if (!(parts.values[k] > moves)) continue;
    out.conservativeResize(Eigen::NoChange, out.cols() + 1);
    out.col(out.cols() - 1) = kernel * parts.vectors.col(k) / std::sqrt(parts.values[k]);
  }
  return out;
}

std::optional<OperatingPoint> SteadyState::step_towards(const OperatingPoint& solution, const OperatingPoint& target,
                                                        double step) const {
  const Vector z = unknowns(solution);
  const Matrix derivatives = without_rounding(system_at(solution), z);
  if (!derivatives.allFinite()) return std::nullopt;
  const Equilibration by(derivatives);
  const Matrix ways = soft_ways(derivatives, by);
  const auto moving = static_cast<Index>(free_q_.size() + free_rates_.size());
  if (ways.cols() == 0) return std::nullopt;
  // As near to the target as the directions lead in typical sizes: those of the equilibrated derivatives can be of any
  // ratio, on a ring next to an axis, and a way that is near in them leads back.
  Vector sizes = Vector::Ones(moving);
  for (std::size_t i = 0; i < free_q_.size(); ++i) sizes[static_cast<Index>(i)] = sizes_[free_q_[i]];
  const Matrix moves = by.columns.asDiagonal() * ways;
  const Matrix sized = sizes.cwiseInverse().asDiagonal() * moves.topRows(moving);
  const Matrix there = (unknowns(target) - z).head(moving).cwiseQuotient(sizes);
  const Vector way = moves * least_squares(sized, there, rank_of_balance).x.col(0);
  const double far = length(way, z);
  if (!(far > 0) || !std::isfinite(far)) return std::nullopt;
  OperatingPoint out = solution;
  place(z + std::min(1.0, step / far) * way, out);
  return out;
}

/// Of unknowns with so many the derivatives as formulas are long, and no family is told.
constexpr std::size_t most_precise = 40;

/// Rows in the unknowns, with the parameters' exact values.
const PreciseRoots& SteadyState::precise() const {
  if (precise_) return *precise_;
  ExprMap values = exact_parameters(e_);
  ExprVector rows = e_.balance_rows, of;
  rows.insert(rows.end(), e_.kept_rows.begin(), e_.kept_rows.end());
  Context& context = *e_.system->context;
  const auto number = [&](double x) { return context.number(Rational::from_double(x)); };
  ExprVector velocities(e_.n, context.number(0));
  for (const Translation& t : translations_)
    for (std::size_t i = 0; i < e_.n; ++i)
      velocities[i] = velocities[i] + number(t.direction[i]) * e_.system->coordinates[t.pivot].velocity;
  for (std::size_t i = 0; i < e_.n; ++i) {
    values.emplace(e_.system->coordinates[i].velocity, velocities[i]);
    values.emplace(e_.system->coordinates[i].acceleration, context.number(0));
  }
  for (const std::size_t k : kept_momenta_) {
    Expr row = -number(momenta_[k]);
    for (std::size_t i = 0; i < e_.n; ++i) row = row + number(translations_[k].direction[i]) * e_.momentum_rows[i];
    rows.push_back(row);
  }
  for (const std::size_t i : free_q_) of.push_back(e_.system->coordinates[i].q);
  for (const std::size_t k : free_rates_) of.push_back(e_.system->coordinates[translations_[k].pivot].velocity);
  for (const Constraint& c : e_.system->constraints) of.push_back(c.multiplier);
  precise_ = std::make_unique<PreciseRoots>(substitute(rows, values), of);
  return *precise_;
}

/// The same to 100 digits, rounded; nothing where there is no root within so many sizes.
std::optional<SteadyState::Solution> SteadyState::proved(const Solution& solution, double farthest) const {
  std::vector<double> sizes;
  for (const std::size_t i : free_q_) sizes.push_back(sizes_[i]);
  for (const std::size_t k : free_rates_)
    sizes.push_back(std::max(sizes_[translations_[k].pivot], std::abs(solution.point.v[translations_[k].pivot])));
  sizes.resize(sizes.size() + e_.m, 0);
  const auto root = precise().near(values_at(e_, solution.point), sizes, farthest);
  if (!root) return std::nullopt;
  Solution out = solution;
  place(to_eigen(*root), out.point);
  out.residual = 0;
  out.proved = true;
  return out;
}

std::optional<SteadyState::Solution> SteadyState::precise_root(const OperatingPoint& from, double farthest) const {
  interrupt_of(*e_.system->context).throw_if_asked();
  if (static_cast<std::size_t>(unknowns(from).size()) > most_precise) return std::nullopt;
  Solution guess;
  guess.point = from;
  fit_multipliers(guess.point);
  return proved(guess, farthest);
}

/// The sizes of the terms of R [n] and of what the constraints keep; infinite where one has no value.
Vector SteadyState::sizes_of_terms(const OperatingPoint& point) const {
  if (!terms_) {
    ExprVector sizes;
    for (const ExprVector* rows : {&e_.balance_rows, &e_.kept_rows})
      for (const Expr& row : *rows) sizes.push_back(size_of_terms(row));
    terms_ = std::make_unique<RepeatedEvaluation>(sizes);
  }
  const Bindings at = values_at(e_, point);
  return to_eigen((*terms_)([&](Expr symbol) {
    const auto value = at.find(symbol);
    return value == at.end() ? 0 : value->second;
  }));
}

bool SteadyState::is_unbalanced(const OperatingPoint& point) const {
  constexpr double rounding = 64 * std::numeric_limits<double>::epsilon(), rounded_to = 1e-11;  // of sizes: zeros
  const System s = system_at(point);
  const Vector terms = sizes_of_terms(point);
  Vector z = unknowns(point).cwiseAbs();
  // Forces that constraints leave open are a shortest fit: 0 among them is rounding of the largest.
  const auto m = static_cast<Index>(e_.m);
  const Matrix by_multipliers = s.j.topRightCorner(static_cast<Index>(e_.n), m);
  const bool are_open =
      m > 0 && by_multipliers.allFinite() &&
      least_squares(Equilibration(by_multipliers).of(by_multipliers), s.f.head(by_multipliers.rows()), rank_of_balance)
              .rank < m;
  if (are_open) z.tail(m) = z.tail(m).cwiseMax(z.tail(m).maxCoeff());
  for (Index i = 0; i < static_cast<Index>(e_.n); ++i) {
    double size = terms[i];
    for (Index j = 0; j < z.size(); ++j) {
      const bool is_position = static_cast<std::size_t>(j) < free_q_.size();
      const double least = is_position ? rounded_to * sizes_[free_q_[static_cast<std::size_t>(j)]] : 0;
      size += std::abs(s.j(i, j)) * std::max(z[j], least);
    }
    if (std::isfinite(size) && !(std::abs(s.f[i]) <= rounding * size)) return true;
  }
  return false;
}

/// Next to a singular place of the constraints multipliers without bound balance the forces, at the place none do.
bool SteadyState::has_no_multipliers(OperatingPoint point) const {
  if (e_.m == 0) return false;
  fit_multipliers(point);
  return is_unbalanced(point);
}

/// Where rows pass as rounding of other works, or rounding of their own terms leaves the place open: near a singular
/// place of the constraints, too, where multipliers without bound balance any force.
bool SteadyState::is_doubtful(const Solution& solution) const {
  constexpr double known = 1e-9, operations = 8 * std::numeric_limits<double>::epsilon();
  const Vector z = unknowns(solution.point);
  const System s = system_at(solution.point);
  const auto forces = static_cast<Index>(e_.n);
  for (Index i = 0; i < forces; ++i) {
    const double scale = scale_of(s, z, i);
    if (scale > 0 && std::abs(s.f[i]) > arrived * scale) return true;
  }
  const Vector terms = sizes_of_terms(solution.point);
  const Equilibration by(s.j);
  Matrix rounding = Matrix::Zero(s.j.rows(), terms.size());
  for (Index i = 0; i < terms.size(); ++i)
    if (std::isfinite(terms[i])) rounding(i, i) = by.rows[i] * operations * terms[i];
  const Matrix moves = by.columns.asDiagonal() * least_squares(by.of(s.j), rounding, rank_of_balance).x;
  return length(moves.cwiseAbs().rowwise().sum(), z) > known;
}

/// A kernel alone is no family: where two equilibria meet it has a dimension too, and leads nowhere. So a short way is
/// gone along each of its directions, and Newton's method asked where the next solution is, in 100 digits. It projects
/// on the family, and its projections have as many dimensions as the family.
void SteadyState::find_family(Solution& solution) const {
  constexpr double step = 1e-3, followed = 0.25, felt = 1e-3;  // followed: squared
  const Vector z = unknowns(solution.point);
  const Matrix derivatives = without_rounding(system_at(solution.point), z);
  const Equilibration by(derivatives);
  const Matrix ways = soft_ways(derivatives, by);
  const auto moving = static_cast<Index>(free_q_.size() + free_rates_.size());
  Matrix gone = Matrix::Zero(moving, ways.cols());  // by the length of the way
  for (Index k = 0; k < ways.cols(); ++k) {
    const Vector whole = by.columns.cwiseProduct(ways.col(k));
    const double part = step / length(whole, z);
    if (!std::isfinite(part)) continue;
    Solution moved = solution;
    place(z + part * whole, moved.point);
    const auto near = solve(moved.point, false);
    // Where all forces vanish what is left of them compares with nothing, and only 100 digits arrive.
    const auto there = near ? proved(*near, next_to) : precise_root(moved.point, 2 * step);
    // Multipliers that constraints leave open are fitted anew at each point: they say nothing about the way.
    if (there) gone.col(k) = (unknowns(there->point) - z).head(moving).cwiseQuotient(by.columns.head(moving)) / part;
  }
  if (gone.isZero(0)) return;  // no way at all, or none that was followed
  const SymmetricEigen projections = symmetric_eigen(transposed_product(gone, gone));
  std::vector<bool> moves(e_.n, false);
  for (Index k = 0; k < projections.values.size(); ++k) {
    if (!(projections.values[k] > followed)) continue;
    ++solution.family;
    const Vector way = by.columns.head(moving).cwiseProduct(gone * projections.vectors.col(k));
    for (std::size_t i = 0; i < free_q_.size(); ++i)
      if (std::abs(way[static_cast<Index>(i)]) / sizes_[free_q_[i]] > felt * length(way, z)) moves[free_q_[i]] = true;
  }
  for (std::size_t i = 0; i < e_.n; ++i)
    if (moves[i]) solution.along.push_back(i);
}

std::optional<SteadyState::Solution> SteadyState::solve(const OperatingPoint& from, bool with_family, int turns) const {
  OperatingPoint point = from;
  std::fill(point.a.begin(), point.a.end(), 0);
  Vector z = unknowns(point);
  place(z, point);
  fit_multipliers(point);
  z = unknowns(point);
  System s = system_at(point);
  double error = scaled(s, z);
  for (int turn = 0; turn < turns; ++turn) {
    interrupt_of(*e_.system->context).throw_if_asked();
    if (!std::isfinite(error) && !(s.f.allFinite() && s.j.allFinite())) return std::nullopt;
    const Equilibration by(s.j);
    const Vector weighted = by.rows.cwiseProduct(s.f);
    const LeastSquares solved = least_squares(by.of(s.j), -weighted, rank_of_balance);
    const Vector step = by.columns.cwiseProduct(solved.x.col(0));
    if (s.f.isZero(0) || !step.allFinite()) break;
    bool closer = false;
    OperatingPoint trial = point;
    Vector moved = z;
    System there = s;
    for (double damping = 1; !closer && damping > 1e-6; damping /= 2) {
      moved = z + damping * step;
      place(moved, trial);
      const Vector f = rows_at(trial);
      if (!(f.allFinite() && by.rows.cwiseProduct(f).norm() < (1 - 1e-4 * damping) * weighted.norm())) continue;
      there = system_at(trial);
      closer = there.j.allFinite();
    }
    if (!closer) break;
    point = trial;
    z = moved;
    s = there;
    error = scaled(s, z);
  }
  return accepted({point, error, 0, {}, false}, s, z, with_family);
}

/// Where a way is so soft that double takes its derivative for none, Newton's method has not gone along it, and what is
/// left of the forces compares with nothing: then the root of 100 digits decides, wherever it is.
std::optional<SteadyState::Solution> SteadyState::accepted(const Solution& solution, const System& s, const Vector& z,
                                                           bool with_family) const {
  constexpr double anywhere = 1e9;
  const bool has_arrived = solution.residual <= arrived;
  const bool is_open =
      s.j.allFinite() && least_squares(Equilibration(s.j).of(s.j), s.f, rank_of_balance).rank < z.size();
  if (!has_arrived && !is_open) return std::nullopt;
  if (!with_family || static_cast<std::size_t>(z.size()) > most_precise)
    return has_arrived && !(is_open && is_unbalanced(solution.point)) ? std::optional(solution) : std::nullopt;
  const Matrix derivatives = without_rounding(s, z);
  const bool has_ways = soft_ways(derivatives, Equilibration(derivatives)).cols() > 0;
  if (has_arrived && !has_ways && !is_doubtful(solution)) return solution;
  std::optional<Solution> out = has_arrived ? proved(solution, next_to) : std::nullopt;
  if (!out && is_open) out = proved(solution, anywhere);
  if (!out || (is_open && is_unbalanced(out->point)) || has_no_multipliers(out->point)) return std::nullopt;
  if (has_ways) find_family(*out);
  return out;
}

}  // namespace maupertuis
