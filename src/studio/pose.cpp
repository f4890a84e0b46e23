#include "linear_algebra/dense.hpp"
#include "studio/gaps.hpp"
#include "studio/requests.hpp"

#include <maupertuis/constraint_manifold.hpp>

#include <algorithm>
#include <cmath>
#include <map>

/// The mechanism at its start, and dragged by one of the points that are drawn.
///
/// A drawn point p(q) is pulled to where the pointer is: δq minimizes |p(q) + J δq − target|² + μ δqᵀ M δq, then the
/// constraints are met again in the metric of M (docs/design/studio.md). J comes from drawings at neighbouring
/// positions, so that whatever is drawn can be dragged. Contacts that a step would violate hold in it as equations.
namespace maupertuis::studio {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int most_pulls = 30;
constexpr double small = 1e-6;  // a step for J, as a part of the size of a coordinate

struct Drag {
  std::size_t element = 0, point = 0;
  std::vector<double> to;
  std::map<std::string, double> velocities;  // x', SI: what the velocities were before the drag began
};

Trajectory rows_at(const MechanicalSystem& system, const std::vector<MotionState>& states) {
  Trajectory rows;
  for (const Coordinate& c : system.coordinates) rows.columns.push_back({c.name, ""});
  for (const Coordinate& c : system.coordinates) rows.columns.push_back({c.name + "'", ""});
  double time = 0;
  for (const MotionState& state : states) {
    rows.times.push_back(time++);
    rows.values.insert(rows.values.end(), state.q.begin(), state.q.end());
    rows.values.insert(rows.values.end(), state.v.begin(), state.v.end());
  }
  return rows;
}

/// Pulls one drawn point towards a place, on the constraints.
class Pull {
 public:
  Pull(const Model& model, const EquationsOfMotion& equations, const Drag& drag)
      : model_(model), manifold_(equations), gaps_(model.system), drag_(drag) {}

  /// Moves the state as far as it goes; false where the point cannot be dragged.
  bool carry_out(MotionState& state) const {
    double distance = 0;
    for (int k = 0; k < most_pulls; ++k) {
      const auto place = place_of(state);
      if (!place) return k > 0;
      const VectorXd gap = target() - *place;
      if (k > 0 && gap.norm() >= distance * (1 - 1e-7)) break;  // as near as it gets
      distance = gap.norm();
      if (distance < 1e-9 * size_of(*place)) break;
      if (!pull(state, *place, gap)) break;
    }
    // The velocities of the beginning, whatever way the drag took.
    for (std::size_t i = 0; i < state.v.size(); ++i)
      if (const auto given = drag_.velocities.find(model_.system.coordinates[i].name + "'");
          given != drag_.velocities.end())
        state.v[i] = given->second;
    const std::vector<bool> free(state.q.size(), false);
    return manifold_.constraints() == 0 || manifold_.move_velocities(state, free);
  }

 private:
  VectorXd target() const {
    return Eigen::Map<const VectorXd>(drag_.to.data(), static_cast<Eigen::Index>(drag_.to.size()));
  }

  /// Of what is dragged: how far it is from the origin, and from where it is to go.
  double size_of(const VectorXd& place) const { return std::max(place.norm(), (target() - place).norm()); }

  /// Of a coordinate: the largest of its kind, a turn's radian for angles and numbers, the length of the drag for
  /// lengths (and for numbers that stand for lengths, in models without units).
  double size_of(const MotionState& state, std::size_t i, double length) const {
    const Coordinate& c = model_.system.coordinates[i];
    double out = c.dimension.same_as(dimensions::length()) ? length
                 : model_.system.dimensionless             ? std::min(1.0, length)
                                                           : 1;
    for (std::size_t k = 0; k < state.q.size(); ++k)
      if (model_.system.coordinates[k].dimension.same_as(c.dimension)) out = std::max(out, std::abs(state.q[k]));
    return out;
  }

  std::optional<VectorXd> place_of(const MotionState& state) const {
    const auto drawing = evaluate_drawing(model_, rows_at(model_.system, {state}));
    return drawing ? point_in(*drawing, 0) : std::nullopt;
  }

  std::optional<VectorXd> point_in(const Drawing& drawing, std::size_t frame) const {
    const auto d = static_cast<std::size_t>(drawing.dimension);
    if (drag_.element >= drawing.elements.size() || drag_.to.size() != d) return std::nullopt;
    const Drawing::Element& e = drawing.elements[drag_.element];
    if (drag_.point >= e.points || e.still) return std::nullopt;
    const std::size_t at = (frame * e.points + drag_.point) * d;
    const VectorXd out = Eigen::Map<const VectorXd>(e.positions.data() + at, static_cast<Eigen::Index>(d));
    return out.allFinite() ? std::optional(out) : std::nullopt;
  }

  /// J δq = gap in the metric of M with a little damping, then back onto the constraints. Shorter steps where the
  /// constraints are not met again.
  bool pull(MotionState& state, const VectorXd& place, const VectorXd& gap) const {
    const auto n = static_cast<Eigen::Index>(state.q.size());
    MatrixXd j(gap.size(), n);
    for (Eigen::Index i = 0; i < n; ++i) {
      MotionState near = state;
      const double step = small * size_of(state, static_cast<std::size_t>(i), size_of(place));
      near.q[static_cast<std::size_t>(i)] += step;
      const auto moved = place_of(near);
      if (!moved) return false;
      j.col(i) = (*moved - place) / step;
    }
    const MatrixXd m = metric(state);
    const double size = j.squaredNorm();
    if (!(size > 0)) return false;
    // The motion along the constraints alone counts: A δq = 0.
    const MatrixXd k =
        j.transpose() * j + 1e-4 * size / static_cast<double>(n) * m + 1e-9 * size * MatrixXd::Identity(n, n);
    const VectorXd force = j.transpose() * gap;
    std::vector<bool> closed(model_.system.contacts.size(), false);
    VectorXd delta = on_constraints(state, k, force, closed);
    for (std::size_t tries = 0; tries < closed.size() && close_crossed(state, delta, closed); ++tries)
      delta = on_constraints(state, k, force, closed);
    // A place out of reach is overshot by the whole step: it is halved as long as that comes nearer.
    std::optional<MotionState> best;
    double nearest = gap.norm();
    for (double part = 1; part > 1e-4; part /= 2) {
      const auto [next, distance] = moved_by(state, delta, part);
      if (next && distance < nearest)
        best = next, nearest = distance;
      else if (best)
        break;
    }
    if (best) state = *std::move(best);
    return best.has_value();
  }

  /// Contacts that this step goes through are closed in the next; whether there are new ones.
  bool close_crossed(const MotionState& state, const VectorXd& delta, std::vector<bool>& closed) const {
    MotionState next = state;
    for (std::size_t i = 0; i < next.q.size(); ++i) next.q[i] += delta(static_cast<Eigen::Index>(i));
    const std::vector<Gaps::Gap> gaps = gaps_.at(next);
    bool more = false;
    for (std::size_t c = 0; c < gaps.size(); ++c)
      if (!closed[c] && !gaps[c].kept()) closed[c] = more = true;
    return more;
  }

  /// Back from behind contacts by the least change; false where that does not succeed.
  bool out_of_contacts(MotionState& state) const {
    constexpr int most_steps = 12;
    for (int k = 0; k < most_steps; ++k) {
      const std::vector<Gaps::Gap> gaps = gaps_.at(state);
      std::vector<bool> violated;
      for (const Gaps::Gap& g : gaps) violated.push_back(!g.kept());
      if (std::none_of(violated.begin(), violated.end(), [](bool v) { return v; })) return true;
      const auto n = static_cast<Eigen::Index>(state.q.size());
      const VectorXd delta = on_constraints(state, metric(state), VectorXd::Zero(n), violated);
      if (!delta.allFinite()) return false;
      for (std::size_t i = 0; i < state.q.size(); ++i) state.q[i] += delta(static_cast<Eigen::Index>(i));
      if (!on_manifold(state)) return false;
    }
    return false;
  }

  bool on_manifold(MotionState& state) const {
    return manifold_.constraints() == 0 || manifold_.move_positions(state, std::vector<bool>(state.q.size(), false));
  }

  /// M in parts of its largest entry; the identity where M says nothing.
  MatrixXd metric(const MotionState& state) const {
    const auto n = static_cast<Eigen::Index>(state.q.size());
    const std::vector<double> rows = manifold_.mass(state);
    MatrixXd m = Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(rows.data(), n, n);
    const double scale = m.diagonal().cwiseAbs().maxCoeff();
    if (!(scale > 0) || !m.allFinite()) return MatrixXd::Identity(n, n);
    return m / scale;
  }

  /// The state after a part of a step, on the constraints, and how far its point is from the pointer then.
  std::pair<std::optional<MotionState>, double> moved_by(const MotionState& state, const VectorXd& delta,
                                                         double part) const {
    MotionState next = state;
    for (std::size_t i = 0; i < next.q.size(); ++i) next.q[i] += part * delta(static_cast<Eigen::Index>(i));
    if (!on_manifold(next) || !out_of_contacts(next)) return {};
    const auto moved = place_of(next);
    if (!moved) return {};
    return {std::move(next), (target() - *moved).norm()};
  }

  /// K δ + Aᵀ ν = r, A δ = 0, and closed contacts come to g = 0; the shortest where these rows depend on each other.
  VectorXd on_constraints(const MotionState& state, const MatrixXd& k, const VectorXd& r,
                          const std::vector<bool>& closed) const {
    const auto n = k.rows(), m = static_cast<Eigen::Index>(manifold_.constraints());
    const auto more = static_cast<Eigen::Index>(std::count(closed.begin(), closed.end(), true));
    MatrixXd bordered = MatrixXd::Zero(n + m + more, n + m + more);
    bordered.topLeftCorner(n, n) = k;
    if (m > 0) {
      const std::vector<double> rows = manifold_.matrix(state);
      const MatrixXd a = Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(rows.data(), m, n);
      bordered.block(n, 0, m, n) = a;
      bordered.block(0, n, n, m) = a.transpose();
    }
    VectorXd right = VectorXd::Zero(n + m + more);
    right.head(n) = r;
    const std::vector<Gaps::Gap> gaps = more > 0 ? gaps_.at(state) : std::vector<Gaps::Gap>();
    Eigen::Index row = n + m;
    for (std::size_t c = 0; c < gaps.size(); ++c) {
      if (!closed[c]) continue;
      for (Eigen::Index i = 0; i < n; ++i)
        bordered(row, i) = bordered(i, row) = gaps[c].slope[static_cast<std::size_t>(i)];
      right(row++) = gaps[c].wanted() - gaps[c].value;
    }
    const Eigen::CompleteOrthogonalDecomposition<MatrixXd> factors(bordered);
    return VectorXd(factors.solve(right)).head(n);
  }

  const Model& model_;
  ConstraintManifold manifold_;
  Gaps gaps_;
  const Drag& drag_;
};

std::optional<Drag> drag_of(const Json& request) {
  const auto found = request.find("drag");
  if (found == request.end() || found->is_null()) return std::nullopt;
  Drag drag;
  if (!found->is_object()) throw Trouble{"request", "`drag` is no object.", "", "", "", nullptr};
  drag.element = static_cast<std::size_t>(std::max(0.0, number_of(*found, "element", 0)));
  drag.point = static_cast<std::size_t>(std::max(0.0, number_of(*found, "point", 0)));
  const auto to = found->find("to");
  if (to == found->end() || !to->is_array()) throw Trouble{"request", "`drag.to` is no place.", "", "", "", nullptr};
  for (const Json& x : *to) {
    if (!x.is_number()) throw Trouble{"request", "`drag.to` is no place.", "", "", "", nullptr};
    drag.to.push_back(x.get<double>());
  }
  if (const auto given = found->find("velocities"); given != found->end() && given->is_object())
    for (const auto& [name, value] : given->items())
      if (value.is_number()) drag.velocities[name] = value.get<double>();
  return drag;
}

}  // namespace

Json pose(Desk& desk, const Work& work) {
  Study& study = desk.moved(work.request);
  if (study.has_fields() || !study.equations()) desk.refuse(study);
  const Model& model = *study.model();
  const MechanicalSystem& system = model.system;
  const InterruptScope scope = study.interruptible();
  Diagnostics found;
  const auto start = consistent_start(model, *study.equations(), found);
  if (!start) desk.refuse(study, found);
  MotionState state = start->state;
  if (const auto drag = drag_of(work.request)) {
    MotionState dragged = state;
    if (Pull(model, *study.equations(), *drag).carry_out(dragged)) state = std::move(dragged);
  }
  Json values = Json::object(), adjusted = Json::array();
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    values[system.coordinates[i].name] = number_or_null(state.q[i]);
    values[system.coordinates[i].name + "'"] = number_or_null(state.v[i]);
  }
  for (const StartAdjustment& a : start->adjustments)
    adjusted.push_back(system.coordinates[a.coordinate].name + (a.order ? "'" : ""));
  return {{"start", std::move(values)},
          {"adjusted", std::move(adjusted)},
          {"drawing", drawing_of(evaluate_drawing(model, rows_at(system, {state}), 1, study.equations(), {},
                                                  forces_in(work.request)))},
          {"diagnostics", desk.diagnostics(study, found)}};
}

}  // namespace maupertuis::studio
