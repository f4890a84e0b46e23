#include "drawing/contact_places.hpp"
#include "drawing/outlines.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/degenerate.hpp>

#include <algorithm>
#include <cmath>

/// The drawing at the frames of an animation. The state between two rows of the run comes from the cubic through its
/// coordinates and velocities at both; positions are then those of the state, so that a rod keeps its length.
namespace maupertuis {
namespace {

using drawing::Outline;

constexpr std::size_t fewest_frames = 600;
constexpr double just_followed = 0.1;  // of the range of a coordinate: a sine has five rows in a period

// States of the run at any time between two of its rows.
class Motion {
 public:
  Motion(const MechanicalSystem& system, const Trajectory& run, const Bindings& parameters)
      : system_(system), run_(run), bindings_(parameters) {
    for (const Coordinate& c : system.coordinates) columns_.push_back({run.column(c.name), run.column(c.name + "'")});
  }

  bool complete() const {
    return std::all_of(columns_.begin(), columns_.end(), [](const auto& c) { return c.first && c.second; });
  }

  // The state at the part `u` in [0, 1) of the way from `row` to the next.
  const Bindings& state(std::size_t row, double u) {
    const std::size_t next = std::min(row + 1, run_.rows() - 1);
    const double h = run_.times[next] - run_.times[row];
    bindings_[system_.context->time()] = time(row, u);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const auto [q, v] = columns_[i];
      const double q0 = run_.at(row, *q), q1 = run_.at(next, *q), v0 = run_.at(row, *v), v1 = run_.at(next, *v);
      bindings_[system_.coordinates[i].q] = u == 0 ? q0 : hermite(q0, q1, h * v0, h * v1, u);
      bindings_[system_.coordinates[i].velocity] = v0 + u * (v1 - v0);
    }
    return bindings_;
  }

  // Whether cubics through those rows follow the motion: the way of a coordinate between two rows is that of its
  // velocities there, but for a part of its range: a tenth where a sine has five rows in a period, 0.005 where it has
  // thirteen.
  bool is_followed_by(const std::vector<std::size_t>& rows, double part) const {
    return std::all_of(columns_.begin(), columns_.end(), [&](const auto& c) {
      double low = INFINITY, high = -INFINITY;
      for (const std::size_t row : rows) {
        low = std::fmin(low, run_.at(row, *c.first));
        high = std::fmax(high, run_.at(row, *c.first));
      }
      std::size_t lost = 0;
      for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
        const double h = run_.times[rows[i + 1]] - run_.times[rows[i]];
        const double way = run_.at(rows[i + 1], *c.first) - run_.at(rows[i], *c.first);
        const double by_velocities = h * (run_.at(rows[i], *c.second) + run_.at(rows[i + 1], *c.second)) / 2;
        lost += std::abs(way - by_velocities) > part * (high - low);
      }
      return lost <= rows.size() / 50;  // more than what impacts and sudden forces leave
    });
  }

  double column(std::size_t index, std::size_t row, double u) const {
    const std::size_t next = std::min(row + 1, run_.rows() - 1);
    return (1 - u) * run_.at(row, index) + u * run_.at(next, index);
  }

  double time(std::size_t row, double u) const {
    const std::size_t next = std::min(row + 1, run_.rows() - 1);
    return run_.times[row] + u * (run_.times[next] - run_.times[row]);
  }

 private:
  static double hermite(double p0, double p1, double m0, double m1, double u) {
    const double w = 1 - u;
    return p0 * (1 + 2 * u) * w * w + p1 * (3 - 2 * u) * u * u + m0 * u * w * w - m1 * u * u * w;
  }

  const MechanicalSystem& system_;
  const Trajectory& run_;
  Bindings bindings_;
  std::vector<std::pair<std::optional<std::size_t>, std::optional<std::size_t>>> columns_;
};

/// Rows that are frames: about 1500, and more of them, up to `most`, where the motion swings faster than cubics through
/// fewer follow. The last one is among them whatever the stride: a motion is shown to its end.
std::vector<std::size_t> rows_shown(const Motion& motion, std::size_t rows, std::size_t most) {
  constexpr std::size_t enough = 1500;
  const auto every = [&](std::size_t stride) {
    std::vector<std::size_t> out;
    for (std::size_t row = 0; row + 1 < rows; row += stride) out.push_back(row);
    out.push_back(rows - 1);
    return out;
  };
  const std::size_t least_stride = (rows + most - 1) / most;
  for (std::size_t stride = std::max(least_stride, rows / enough); stride > least_stride; stride /= 2)
    if (auto out = every(stride); motion.is_followed_by(out, 0.005)) return out;
  return every(least_stride);
}

/// What stands still has one frame, of the first moment. The force of an arrow is in newtons; metres come at the end.
void add_frame(Drawing& drawing, std::vector<Outline>& outlines, const std::vector<double>& values,
               const Motion& motion, std::size_t row, double u) {
  const bool first = drawing.times.empty();
  drawing.times.push_back(motion.time(row, u));
  std::size_t at = 0;
  for (Outline& outline : outlines) {
    std::vector<double>& out = outline.element.positions;
    const std::size_t count = outline.values.size();
    const double factor = outline.reaction ? motion.column(*outline.reaction, row, u) : 1;
    for (std::size_t i = 0; i < count; ++i)
      if (first || !outline.element.still)
        out.push_back(values[at + i] * (outline.placement == Outline::Placement::Force && 2 * i >= count ? factor : 1));
    at += count;
  }
  for (; at < values.size(); ++at) drawing.follow.push_back(values[at]);
}

/// Where functions of time are free: what they move has no place, and is not drawn.
void leave_out_undetermined(drawing::Plan& plan, const EquationsOfMotion& equations) {
  const DegenerateAnalysis& analysis = *equations.degenerate;
  const auto depends = [&](const std::vector<Expr>& places) {
    const std::vector<Expr> of_motion = in_terms_of_motion(*equations.system, places);
    return !std::all_of(of_motion.begin(), of_motion.end(), [&](Expr e) { return analysis.is_determined(e); });
  };
  auto& outlines = plan.outlines;
  outlines.erase(std::remove_if(outlines.begin(), outlines.end(), [&](const Outline& o) { return depends(o.values); }),
                 outlines.end());
  if (depends(plan.follow)) plan.follow.clear();
}

std::vector<double> gravity_of(const MechanicalSystem& system, const Bindings& parameters) {
  if (system.gravity.empty()) return {};
  Bindings start = parameters;
  for (const Coordinate& c : system.coordinates) start.insert({{c.q, 0.0}, {c.velocity, 0.0}});
  start.insert({system.context->time(), 0.0});
  return evaluate(in_terms_of_motion(system, system.gravity), start);
}

}  // namespace

std::optional<Drawing> evaluate_drawing(const Model& model, const Trajectory& shown_rows, std::size_t frames,
                                        const EquationsOfMotion* equations, const std::vector<ContactImpulse>& impulses,
                                        ForcesShown forces) {
  const MechanicalSystem& system = model.system;
  const Bindings parameters = parameter_bindings(system);
  const Trajectory& run = shown_rows.of_one_choice ? *shown_rows.of_one_choice : shown_rows;
  Motion motion(system, run, parameters);
  if (run.rows() == 0 || frames == 0 || !motion.complete()) return std::nullopt;
  drawing::Plan plan = drawing::plan_of(model, parameters, equations, run, forces);
  if (equations && has_free_functions(*equations)) leave_out_undetermined(plan, *equations);
  if (plan.outlines.empty()) return std::nullopt;

  std::vector<Expr> wanted;
  for (const Outline& outline : plan.outlines)
    wanted.insert(wanted.end(), outline.values.begin(), outline.values.end());
  wanted.insert(wanted.end(), plan.follow.begin(), plan.follow.end());
  wanted = in_terms_of_motion(system, wanted);
  drawing::ContactTracks contacts(model, parameters, run, equations);

  Drawing drawing;
  drawing.dimension = system.space_dimension;
  drawing.dimensionless = system.dimensionless;
  drawing.gravity = gravity_of(system, parameters);
  drawing.unplaced_forces = plan.unplaced;
  const std::size_t rows = run.rows();
  const std::size_t parts = rows > 1 ? std::max<std::size_t>(1, (fewest_frames + rows - 2) / (rows - 1)) : 1;
  const std::vector<std::size_t> shown = rows_shown(motion, rows, frames);
  drawing.moments_only = !motion.is_followed_by(shown, just_followed);
  const std::size_t between = shown.size() == rows && !drawing.moments_only ? parts : 1;
  for (const std::size_t row : shown)
    for (std::size_t k = 0; k < (row + 1 == rows ? 1 : between); ++k) {
      const double u = static_cast<double>(k) / static_cast<double>(parts);
      const Bindings& state = motion.state(row, u);
      add_frame(drawing, plan.outlines, evaluate(wanted, state), motion, row, u);
      contacts.add_frame(state, [&](std::size_t column) { return motion.column(column, row, u); });
    }
  drawing::settle(drawing, plan.outlines, plan, system, parameters, contacts, impulses);
  return drawing;
}

bool frames_follow(const Model& model, const Trajectory& shown_rows, const std::vector<double>& elapsed) {
  const Trajectory& run = shown_rows.of_one_choice ? *shown_rows.of_one_choice : shown_rows;
  const Motion motion(model.system, run, parameter_bindings(model.system));
  if (run.rows() == 0 || !motion.complete()) return true;
  const auto since_start = [&](std::size_t row) { return std::abs(run.times[row] - run.times.front()); };
  std::vector<std::size_t> rows;
  std::size_t row = 0;
  for (const double moment : elapsed) {
    while (row + 1 < run.rows() && std::abs(since_start(row + 1) - moment) <= std::abs(since_start(row) - moment))
      ++row;
    rows.push_back(row);
  }
  return motion.is_followed_by(rows, just_followed);
}

}  // namespace maupertuis
