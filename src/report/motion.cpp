#include "report/motion_parts.hpp"
#include "report/notation.hpp"

#include <maupertuis/motion_pictures.hpp>
#include <maupertuis/uncertainty.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr std::size_t most_phase_portraits = 4;
constexpr std::size_t most_numbers = 150'000;  // of a drawing: about a megabyte of page
constexpr double plot_width = 440;

/// The state at the end with its certain digits, of small systems; and from when on there are none.
void add_certainty(ReportContent& content, const SimulationResult& run, const MechanicalSystem& system) {
  constexpr std::size_t most_coordinates = 6;
  const auto add = [&](std::string name, std::string value) {
    content.statistics.emplace_back(std::move(name), std::move(value));
  };
  const auto& errors = run.final.errors;
  for (std::size_t i = 0;
       errors && i < std::min(run.final.q.size(), run.final.q.size() > most_coordinates ? 0 : most_coordinates); ++i) {
    const auto place = run.trajectory.column(system.coordinates[i].name);
    if (!place) continue;  // it depends on functions that are free
    const Trajectory::Column& column = run.trajectory.columns[*place];
    add(column.name + " at the end", std::isinf(errors->q[i]) ? "no digit is certain"
                                                              : with_uncertainty(run.final.q[i], errors->q[i]) +
                                                                    (column.unit.empty() ? "" : " " + column.unit));
  }
  if (run.uncertain.columns.empty()) return;
  std::string names;
  for (const std::size_t column : run.uncertain.columns)
    names += (names.empty() ? "" : ", ") + run.trajectory.columns[column].name;
  add(run.uncertain.everything ? "nothing is certain" : "no digit is certain of " + names,
      "from " + system.moment(short_number(run.uncertain.from, 4)) + " on");
}

void add_statistics(ReportContent& content, const SimulationResult& run, const MechanicalSystem& system) {
  const SimulationStatistics& s = run.statistics;
  const std::string second = system.dimensionless ? "" : system.independent_unit();
  const auto add = [&](const char* name, std::string value) {
    content.statistics.emplace_back(name, std::move(value));
  };
  add("from", quantity(run.start.t, second) + " to " + quantity(run.final.t, second, 10));
  const std::string method = s.method == "variational" ? "variational steps" : "Taylor series";
  if (s.method == "stiff")
    add("method", "stiff: Radau's implicit steps");
  else
    add("method", s.order > 0 ? fmt::format("{} of order {}, {}", method, s.order, s.backend) : s.backend);
  add("steps", fmt::format("{}", s.steps));
  if (s.switches > 0) add("switches crossed", fmt::format("{}", s.switches));
  add("energy drift", short_number(s.energy_drift, 2));
  if (s.constraint_residual > 0) add("constraint residual", short_number(s.constraint_residual, 2));
  add("time of computation",
      short_number(s.seconds, 2) + " s, and " + short_number(s.compile_seconds, 2) + " s for the kernel");
  add_certainty(content, run, system);
  if (run.ending != Ending::Finished && !run.reason.empty()) {
    content.ending = run.reason;
    content.ending[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(content.ending[0])));
    if (!content.ending.ends_with('.')) content.ending += '.';
  }
}

// The column `energy drift`, energy − energy at the start: what is left of a constant is worth a look.
void add_drift_column(Trajectory& run) {
  const auto energy = run.column("energy");
  if (!energy || run.rows() == 0) return;
  const std::size_t width = run.columns.size();
  std::vector<double> values, errors;
  values.reserve(run.rows() * (width + 1));
  for (std::size_t row = 0; row < run.rows(); ++row) {
    for (std::size_t column = 0; !run.errors.empty() && column <= width; ++column)
      errors.push_back(run.error(row, column < width ? column : *energy));
    values.insert(values.end(), run.values.begin() + static_cast<std::ptrdiff_t>(row * width),
                  run.values.begin() + static_cast<std::ptrdiff_t>((row + 1) * width));
    values.push_back(run.at(row, *energy) - run.at(0, *energy));
  }
  run.columns.push_back({"energy drift", run.columns[*energy].unit});
  run.values = std::move(values);
  run.errors = std::move(errors);
}

void add_picture(ReportContent& content, std::string caption, std::vector<std::string> columns,
                 std::string against = {}) {
  ReportContent::Picture picture{std::move(caption), {}};
  picture.options.columns = std::move(columns);
  picture.options.against = std::move(against);
  picture.options.width = plot_width;
  if (!picture.options.columns.empty() && plot_problem(content.trajectory, picture.options).empty())
    content.pictures.push_back(std::move(picture));
}

void add_pictures(ReportContent& content, const MechanicalSystem& system,
                  const std::vector<Trajectory::Column>& reactions, bool energy_conserved) {
  std::vector<std::string> coordinates, velocities;
  for (const Coordinate& c : system.coordinates) {
    coordinates.push_back(c.name);
    velocities.push_back(c.name + "'");
  }
  add_picture(content, "The coordinates.", coordinates);
  add_picture(content, "Their velocities.", velocities);
  if (energy_conserved)
    add_picture(content, "What the computation adds to the energy, which is conserved.", {"energy drift"});
  else
    add_picture(content, "The energy function.", {"energy"});
  std::vector<std::string> forces;
  for (const auto& reaction : reactions) forces.push_back(reaction.name);
  if (!forces.empty()) add_picture(content, "The forces of the constraints.", forces);
  for (std::size_t i = 0; i < std::min(coordinates.size(), most_phase_portraits); ++i)
    add_picture(content, fmt::format("Phase portrait of {}; the dot is the start.", coordinates[i]), {velocities[i]},
                coordinates[i]);
}

std::size_t frames_within_budget(const Model& model) {
  std::size_t numbers = 0;
  const auto dimension = static_cast<std::size_t>(model.system.space_dimension);
  for (const DrawElement& element : model.experiment.drawing)
    numbers += (element.sizes.empty() ? element.path.size() : dimension + 1) * dimension;
  numbers += model.system.links.size() * (dimension + 1) * dimension;
  return std::clamp<std::size_t>(most_numbers / std::max<std::size_t>(numbers, 4), 1500, 12'000);
}

}  // namespace

void add_motion(ReportContent& content, const Model& model, const EquationsOfMotion& equations, bool energy_conserved,
                const SimulationResult& run) {
  add_statistics(content, run, model.system);
  content.trajectory = run.trajectory;
  content.drawing =
      evaluate_drawing(model, run.trajectory, frames_within_budget(model), &equations, impulses_of(run, model.system));
  const bool is_constant = energy_conserved && !model.system.has_modes();  // impacts and friction take of it
  if (is_constant) add_drift_column(content.trajectory);
  add_pictures(content, model.system, run.reactions, is_constant);
  for (ReportContent::Picture& picture : content.pictures)
    if (picture.options.against.empty()) show_happenings(picture.options, run, model.system);
}

}  // namespace maupertuis
