#include <maupertuis/evaluate.hpp>
#include <maupertuis/reactions.hpp>
#include <maupertuis/report.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

/// The drawing at the frames of an animation. The state between two rows of the run comes from the cubic through its
/// coordinates and velocities at both; positions are then those of the state, so that a rod keeps its length.
namespace maupertuis {
namespace {

constexpr std::size_t fewest_frames = 600;

// Which expressions make up one element, in the order of its positions, sizes and rotation.
struct Outline {
  Drawing::Element element;
  std::vector<Expr> positions, sizes, rotation;
  std::optional<std::size_t> reaction = std::nullopt;  // Reaction: the column of the run with its value
  std::vector<Expr> force = {};                        // … and the force for each newton of it [dimension]
};

double mass_of(const MechanicalSystem& system, const std::string& name, const Bindings& parameters) {
  Expr mass;
  if (const Point* point = system.find_point(name)) mass = point->mass;
  else if (const Body* body = system.find_body(name)) mass = body->mass;
  return mass ? evaluate(in_terms_of_motion(system, {&mass, 1}).front(), parameters) : 0;
}

Drawing::Kind kind_of(syntax::DrawItem::Kind kind) {
  switch (kind) {
    case syntax::DrawItem::Kind::Line: return Drawing::Kind::Line;
    case syntax::DrawItem::Kind::Trail: return Drawing::Kind::Trail;
    case syntax::DrawItem::Kind::Box: return Drawing::Kind::Box;
    case syntax::DrawItem::Kind::Circle: return Drawing::Kind::Circle;
    case syntax::DrawItem::Kind::Spring: return Drawing::Kind::Spring;
    case syntax::DrawItem::Kind::Reaction: return Drawing::Kind::Reaction;
  }
  return Drawing::Kind::Line;
}

Outline outline_of(const MechanicalSystem& system, Drawing::Kind kind, const std::vector<ExprVector>& path,
                   const std::vector<std::string>& names, const std::vector<Expr>& sizes, const Bindings& parameters) {
  Outline outline;
  outline.element.kind = kind;
  outline.element.points = path.size();
  outline.element.names = names;
  for (const auto& position : path) outline.positions.insert(outline.positions.end(), position.begin(), position.end());
  for (const auto& name : names) outline.element.masses.push_back(mass_of(system, name, parameters));
  outline.sizes = sizes;
  const Body* body = names.size() == 1 ? system.find_body(names[0]) : nullptr;
  if (kind == Drawing::Kind::Box && body && body->rotation.rows == 2)
    outline.rotation = {body->rotation.at(0, 0), body->rotation.at(1, 0)};
  return outline;
}

/// The arrows of one reaction. Its value and its force are proportional to one multiplier, so that their ratio depends on
/// the configuration alone: the run knows the value.
void add_arrows(std::vector<Outline>& outlines, const std::string& name, const EquationsOfMotion& equations, const Trajectory& run) {
  const MechanicalSystem& system = *equations.system;
  ExprMap once;  // λ = 1 at rest
  for (const Expr& multiplier : equations.multipliers) once.emplace(multiplier, system.context->number(1));
  for (const Coordinate& c : system.coordinates) once.emplace(c.acceleration, system.context->number(0));
  const auto column = run.column("reaction(" + name + ")");
  if (!column) return;
  for (const Reaction& r : reactions(equations)) {
    if (r.name != name || !r.value) continue;
    for (const ForceArrow& arrow : r.arrows) {
      Outline outline;
      outline.element.kind = Drawing::Kind::Reaction;
      outline.element.points = 2;
      outline.element.names = {name, ""};
      outline.element.masses = {0, 0};
      outline.positions = arrow.position;
      outline.reaction = column;
      for (const Expr& f : arrow.force) outline.force.push_back(substitute(f / r.value, once));
      outlines.push_back(std::move(outline));
    }
  }
}

// What the model asks for; without a `draw`, what has mass.
std::vector<Outline> outlines_of(const Model& model, const Bindings& parameters, const EquationsOfMotion* equations,
                                 const Trajectory& run) {
  const MechanicalSystem& system = model.system;
  std::vector<Outline> outlines;
  for (const DrawElement& element : model.experiment.drawing) {
    if (element.kind == syntax::DrawItem::Kind::Reaction) {
      if (equations && !element.names.empty()) add_arrows(outlines, element.names[0], *equations, run);
      continue;
    }
    outlines.push_back(outline_of(system, kind_of(element.kind), element.path, element.names, element.sizes, parameters));
  }
  if (!outlines.empty()) return outlines;
  const auto mark = [&](const std::string& name, const ExprVector& position) {
    outlines.push_back(outline_of(system, Drawing::Kind::Trail, {position}, {name}, {}, parameters));
    outlines.push_back(outline_of(system, Drawing::Kind::Line, {position}, {name}, {}, parameters));
  };
  for (const Point& point : system.points)
    if (point.mass) mark(point.name, point.position);
  for (const Body& body : system.bodies)
    if (body.mass) mark(body.name, body.position);
  return outlines;
}

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

void add_frame(std::vector<Outline>& outlines, const std::vector<double>& values, const Motion& motion, std::size_t row, double u) {
  std::size_t at = 0;
  for (Outline& outline : outlines) {
    for (std::size_t i = 0; i < outline.positions.size(); ++i) outline.element.positions.push_back(values[at++]);
    for (std::size_t i = 0; i < outline.force.size(); ++i)  // the tip in newtons; metres come at the end
      outline.element.positions.push_back(values[at++] * motion.column(*outline.reaction, row, u));
    for (std::size_t i = 0; i < outline.sizes.size(); ++i) outline.element.sizes.push_back(values[at++]);
    if (outline.rotation.empty()) continue;
    outline.element.rotation.push_back(std::atan2(values[at + 1], values[at]));
    at += 2;
  }
}

// An angle from atan2 jumps by 2π; between frames it must not.
void unwind(std::vector<double>& angles) {
  constexpr double turn = 6.283185307179586;
  for (std::size_t i = 1; i < angles.size(); ++i) angles[i] -= turn * std::round((angles[i] - angles[i - 1]) / turn);
}

/// Turns the newtons of arrows into metres from their feet: the longest arrow is a third of the size of the scene.
void scale_arrows(std::vector<Outline>& outlines, std::size_t dimension) {
  double longest = 0;
  std::vector<double> low(dimension, HUGE_VAL), high(dimension, -HUGE_VAL);
  const auto each_arrow = [&](auto&& visit) {
    for (Outline& o : outlines)
      for (std::size_t i = 0; o.reaction && i + 2 * dimension <= o.element.positions.size(); i += 2 * dimension)
        visit(&o.element.positions[i], &o.element.positions[i + dimension]);
  };
  each_arrow([&](const double*, const double* force) {
    double square = 0;
    for (std::size_t k = 0; k < dimension; ++k) square += force[k] * force[k];
    if (std::isfinite(square)) longest = std::max(longest, std::sqrt(square));
  });
  for (const Outline& o : outlines)
    for (std::size_t i = 0; !o.reaction && i < o.element.positions.size(); ++i) {
      low[i % dimension] = std::min(low[i % dimension], o.element.positions[i]);
      high[i % dimension] = std::max(high[i % dimension], o.element.positions[i]);
    }
  double extent = 0;
  for (std::size_t k = 0; k < dimension; ++k) extent = std::max(extent, high[k] - low[k]);
  const double metres = longest > 0 && extent > 0 ? extent / 3 / longest : 0;
  each_arrow([&](const double* foot, double* tip) {
    for (std::size_t k = 0; k < dimension; ++k) tip[k] = foot[k] + metres * tip[k];
  });
}

std::vector<double> gravity_of(const MechanicalSystem& system, const Bindings& parameters) {
  if (system.gravity.empty()) return {};
  Bindings start = parameters;
  for (const Coordinate& c : system.coordinates) start.insert({{c.q, 0.0}, {c.velocity, 0.0}});
  return evaluate(in_terms_of_motion(system, system.gravity), start);
}

}  // namespace

std::optional<Drawing> evaluate_drawing(const Model& model, const Trajectory& run, std::size_t frames,
                                        const EquationsOfMotion* equations) {
  const MechanicalSystem& system = model.system;
  const Bindings parameters = parameter_bindings(system);
  auto outlines = outlines_of(model, parameters, equations, run);
  Motion motion(system, run, parameters);
  if (outlines.empty() || run.rows() == 0 || frames == 0 || !motion.complete()) return std::nullopt;

  std::vector<Expr> wanted;
  for (const Outline& outline : outlines)
    for (const auto* part : {&outline.positions, &outline.force, &outline.sizes, &outline.rotation})
      wanted.insert(wanted.end(), part->begin(), part->end());
  wanted = in_terms_of_motion(system, wanted);

  Drawing drawing;
  drawing.dimension = system.space_dimension;
  drawing.dimensionless = system.dimensionless;
  drawing.gravity = gravity_of(system, parameters);
  const std::size_t rows = run.rows(), stride = (rows + frames - 1) / frames;
  const std::size_t parts = rows > 1 ? std::max<std::size_t>(1, (fewest_frames + rows - 2) / (rows - 1)) : 1;
  for (std::size_t row = 0; row < rows; row += stride)
    for (std::size_t k = 0; k < (row + 1 == rows ? 1 : stride == 1 ? parts : 1); ++k) {
      const double u = static_cast<double>(k) / static_cast<double>(parts);
      drawing.times.push_back(motion.time(row, u));
      add_frame(outlines, evaluate(wanted, motion.state(row, u)), motion, row, u);
    }
  scale_arrows(outlines, static_cast<std::size_t>(system.space_dimension));
  for (Outline& outline : outlines) {
    unwind(outline.element.rotation);
    drawing.elements.push_back(std::move(outline.element));
  }
  return drawing;
}

SimulationOptions report_run(const Model& model, SimulationOptions options) {
  if (options.output_every || model.experiment.output_every) return options;
  Expr length = model.experiment.until ? model.experiment.within : model.experiment.duration;
  double duration = options.duration.value_or(0);
  if (!options.duration && length)
    duration = evaluate(in_terms_of_motion(model.system, {&length, 1}).front(), parameter_bindings(model.system));
  if (std::isfinite(duration) && duration != 0)
    options.output_every = std::abs(duration) / std::clamp(std::round(50 * std::abs(duration)), 1000.0, 10'000.0);
  return options;
}

}  // namespace maupertuis
