#include "studio/requests.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/diagram.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/field_report.hpp>
#include <maupertuis/modes.hpp>
#include <maupertuis/motion_pictures.hpp>
#include <maupertuis/orbits.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis::studio {
namespace {

/// So many rows at most, the first and the last among them.
std::vector<std::size_t> shown_rows(std::size_t rows, std::size_t most) {
  std::vector<std::size_t> out;
  const std::size_t stride = rows > most ? (rows + most - 2) / std::max<std::size_t>(most - 1, 1) : 1;
  for (std::size_t row = 0; row + 1 < rows; row += stride) out.push_back(row);
  if (rows > 0) out.push_back(rows - 1);
  return out;
}

/// Columns one after the other: what plots take.
void add_trajectory(Json& out, const Trajectory& t, std::size_t most_rows) {
  const std::vector<std::size_t> rows = shown_rows(t.rows(), most_rows);
  out["independent"] = {{"name", t.independent.name}, {"unit", t.independent.unit}};
  Json columns = Json::array(), times = Json::array(), values = Json::array();
  for (const std::size_t row : rows) times.push_back(number_or_null(t.times[row]));
  for (std::size_t c = 0; c < t.columns.size(); ++c) {
    columns.push_back({{"name", t.columns[c].name}, {"unit", t.columns[c].unit}});
    Json column = Json::array();
    for (const std::size_t row : rows) column.push_back(number_or_null(t.at(row, c)));
    values.push_back(std::move(column));
  }
  out["columns"] = std::move(columns);
  out["times"] = std::move(times);
  out["values"] = std::move(values);
}

Json happenings_json(const SimulationResult& run) {
  Json list = Json::array();
  for (const Happening& h : run.happenings)
    list.push_back({{"t", h.t},
                    {"what", word_of(h.kind)},
                    {"name", h.name},
                    {"mode", h.mode},
                    {"impulse", number_or_null(h.impulse)},
                    {"speed", number_or_null(h.speed)},
                    {"remark", h.remark},
                    {"error", number_or_null(h.error)}});
  return list;
}

Json state_json(const State& state, const MechanicalSystem& system) {
  Json out = Json::object();
  for (std::size_t i = 0; i < state.q.size(); ++i) {
    out[system.coordinates[i].name] = number_or_null(state.q[i]);
    out[system.coordinates[i].name + "'"] = number_or_null(state.v[i]);
  }
  return out;
}

Json pictures_json(const ReportContent& content) {
  Json list = Json::array();
  for (const auto& picture : content.pictures)
    list.push_back({{"caption", picture.caption},
                    {"columns", picture.options.columns},
                    {"phase", !picture.options.against.empty()},
                    {"against", picture.options.against}});
  return list;
}

Json figures_json(const ReportContent& content) {
  Json list = Json::array();
  for (const auto& [caption, svg] : content.figures) list.push_back({{"caption", caption}, {"svg", svg}});
  return list;
}

std::size_t count_of(const Json& request, const char* key, double otherwise, double least, double most) {
  return static_cast<std::size_t>(std::clamp(number_of(request, key, otherwise), least, most));
}

/// The run with what a page shows of it: drawing, statistics, values and drifts of what is conserved.
Json run_json(const Study& study, const Model& model, const EquationsOfMotion& equations,
              const SimulationResult& result, std::size_t frames, ForcesShown forces, bool formulas) {
  ReportParts parts;
  parts.simulation = &result;
  const Derivation derivation;  // what is certified is told with the equations
  const Certificate certificate;
  const ReportContent content = compose_report(model, study.source(), equations, derivation, certificate, parts,
                                               [](std::string_view section, const std::function<void()>& part) {
                                                 const bool shown = section == "motion" || section == "conserved";
                                                 if (shown) part();
                                                 return shown;
                                               });
  const auto drawing =
      evaluate_drawing(model, result.trajectory, frames, &equations, impulses_of(result, model.system), forces);
  Json out = {{"drawing", drawing_of(drawing)}};
  add_trajectory(out, content.trajectory, std::max<std::size_t>(frames, 2));
  out["statistics"] = pairs_json(content.statistics);
  out["happenings"] = happenings_json(result);
  out["first_mode"] = result.first_mode;
  out["ending"] = {{"ok", result.ok()},
                   {"kind", word_of(result.ending)},
                   {"reason", result.reason},
                   {"t", number_or_null(result.final.t)}};
  out["conserved"] = conserved_json(content.conserved, formulas);
  out["pictures"] = pictures_json(content);
  out["figures"] = figures_json(content);
  out["start"] = state_json(result.start, model.system);
  out["uncertain"] = nullptr;
  if (!result.uncertain.columns.empty()) {
    Json names = Json::array();
    for (const std::size_t column : result.uncertain.columns) names.push_back(result.trajectory.columns[column].name);
    out["uncertain"] = {
        {"from", result.uncertain.from}, {"everything", result.uncertain.everything}, {"columns", std::move(names)}};
  }
  return out;
}

Json run_of_fields(Desk& desk, Study& study, const SimulationOptions& options, std::size_t frames) {
  const InterruptScope scope = study.interruptible();
  const FieldEquations& equations = *study.field_equations();
  const FieldCurrents currents = field_currents(equations);
  const auto result = study.field_motion(options, {true, true, {}, &currents});
  if (!result) desk.refuse(study);
  FieldReportParts parts;
  parts.run = &*result;
  parts.currents = &currents;
  parts.with_derivation = parts.with_equations = false;
  const ReportContent content =
      compose_field_report(*study.model(), study.source(), equations, *study.field_certificate(), parts);
  Json out = {{"drawing", nullptr}};
  add_trajectory(out, result->trajectory, std::max<std::size_t>(frames, 2));
  out["places"] = result->places;
  out["upwards"] = result->upwards;
  Json ranges = Json::array();
  for (const auto& range : result->at_end) ranges.push_back({{"name", range.name}, {"unit", range.unit}});
  out["fields"] = std::move(ranges);
  out["statistics"] = pairs_json(content.statistics);
  out["happenings"] = Json::array();
  for (const auto& h : result->happenings)
    out["happenings"].push_back(
        {{"t", h.t}, {"what", word_of(h.kind)}, {"name", h.name}, {"mode", h.mode}, {"remark", h.remark}});
  out["first_mode"] = result->first_mode;
  out["ending"] = {{"ok", result->trouble.empty()},
                   {"kind", result->trouble.empty() ? "finished" : "ended early"},
                   {"reason", result->trouble},
                   {"t", number_or_null(result->end)}};
  out["conserved"] = conserved_json(content.conserved);
  out["pictures"] = Json::array();
  out["figures"] = figures_json(content);
  out["start"] = Json::object();
  out["uncertain"] = nullptr;
  return out;
}

/// As fine as an animation wants it, 50 rows a second and 1000 to 10,000 in all, where the model does not say how
/// often: while a slider moves, rows of every step would cost more than the steps.
SimulationOptions with_even_rows(const Model& model, SimulationOptions options) {
  if (options.output_every || model.experiment.output_every) return options;
  Expr length = model.experiment.until ? model.experiment.within : model.experiment.duration;
  double duration = options.duration.value_or(0);
  if (!options.duration && length)
    duration = evaluate(in_terms_of_motion(model.system, {&length, 1}).front(), parameter_bindings(model.system));
  if (std::isfinite(duration) && duration != 0)
    options.output_every = std::abs(duration) / std::clamp(std::round(50 * std::abs(duration)), 1000.0, 10'000.0);
  return options;
}

}  // namespace

ForcesShown forces_in(const Json& request) {
  return is_true(request, "forces") ? ForcesShown::All : ForcesShown::Asked;
}

Json run(Desk& desk, const Work& work) {
  Study& study = desk.moved(work.request);
  const std::size_t frames = count_of(work.request, "frames", 600, 1, 12'000);
  SimulationOptions options;
  options.interrupt = work.interrupt;
  options.errors = is_true(work.request, "errors") ? ErrorEstimates::States : ErrorEstimates::None;
  options.progress = [&work](double fraction) { work.send({{"progress", fraction}}); };
  Json out;
  Diagnostics found;
  if (study.has_fields()) {
    out = run_of_fields(desk, study, options, frames);
  } else {
    const Model& model = *study.model();
    if (study.refuse_held_integrals()) desk.refuse(study);
    const auto result = simulate(model, *study.equations(), with_even_rows(model, options), found);
    if (!result) desk.refuse(study, found);
    if (result->ending == Ending::Interrupted && result->trajectory.rows() < 2) throw Interrupted();
    out = run_json(study, model, *study.equations(), *result, frames, forces_in(work.request),
                   !is_true(work.request, "brief"));
  }
  out["diagnostics"] = desk.diagnostics(study, found);
  return out;
}

namespace {

Json mode_point_json(const ReportContent::ModePoint& point) {
  Json rows = Json::array(), shapes = Json::array();
  for (const auto& row : point.rows)
    rows.push_back({{"kind", row.kind},
                    {"frequency", row.frequency},
                    {"hertz", row.hertz},
                    {"period", row.period},
                    {"damping", row.damping}});
  for (const auto& shape : point.shapes) {
    Json one = {{"caption", shape.caption},
                {"drawing", drawing_of(shape.drawing ? shape.drawing : shape.beads)},
                {"svg", shape.svg}};
    if (shape.diagram) {
      Diagram diagram = *shape.diagram;
      diagram.theme = PlotTheme::Page;
      one["svg"] = diagram_svg(diagram);
    }
    shapes.push_back(std::move(one));
  }
  return {{"name", point.name},      {"stability", point.stability},
          {"stable", point.stable},  {"formulas", lines_json(point.formulas)},
          {"rows", std::move(rows)}, {"shapes", std::move(shapes)}};
}

Json modes_of_fields(Study& study) {
  const InterruptScope scope = study.interruptible();
  const FieldEquations& equations = *study.field_equations();
  Diagnostics unheard;  // a field without such modes has none to show
  const FieldModes modes = field_modes(equations, 6, unheard);
  FieldReportParts parts;
  if (!modes.frequencies.empty()) parts.modes = &modes;
  parts.with_derivation = parts.with_equations = false;
  const ReportContent content =
      compose_field_report(*study.model(), study.source(), equations, *study.field_certificate(), parts);
  Json points = Json::array();
  for (const auto& point : content.mode_points) points.push_back(mode_point_json(point));
  return {{"points", std::move(points)}, {"search", ""}};
}

}  // namespace

Json modes(Desk& desk, const Work& work) {
  Study& study = desk.certified(work.request);
  if (study.has_fields()) return modes_of_fields(study);
  if (study.refuse_modes() || study.refuse_without_time()) desk.refuse(study);
  const Model& model = *study.model();
  const EquationsOfMotion& equations = *study.equations();
  const InterruptScope scope = study.interruptible();
  Diagnostics said;
  const auto start = consistent_start(model, equations, said);
  if (!start || refuse_free_functions(equations, "modes", said)) desk.refuse(study, said);
  PointEquations at_points(solvable_equations(equations));
  auto found = modal_study(at_points, start->state, said);
  if (!found) desk.refuse(study, said);
  settle_driven(*found, at_points, model, equations, work.interrupt);
  work.interrupt.throw_if_asked();
  ReportParts parts;
  parts.modes = &*found;
  const ReportContent content =
      compose_report(model, study.source(), equations, *study.derivation(true), *study.certificate(), parts,
                     [](std::string_view section, const std::function<void()>& part) {
                       if (section == "modes") part();
                       return section == "modes";
                     });
  Json points = Json::array();
  for (const auto& point : content.mode_points) points.push_back(mode_point_json(point));
  return {
      {"points", std::move(points)}, {"search", content.mode_search}, {"diagnostics", desk.diagnostics(study, said)}};
}

namespace {

Json section_json(const SectionResult& result, const std::string& what, const MechanicalSystem& system) {
  const Trajectory rows = section_rows(result, system);
  Json out = Json::object();
  add_trajectory(out, rows, rows.rows());
  PlotOptions picture = section_picture(result, what, system);
  picture.theme = PlotTheme::Page;
  out["svg"] = plot_svg(rows, picture);
  out["across"] = system.coordinates[result.across].name;
  out["crossings"] = result.crossings.size();
  out["ended"] = result.orbits.empty() ? std::string() : result.orbits.front().ended;
  out["energy_conserved"] = result.energy_conserved;
  return out;
}

}  // namespace

Json section(Desk& desk, const Work& work) {
  Json request = work.request;
  const std::string what = text_of(request, "at");
  std::string equation = what;
  SectionDirection direction = SectionDirection::Both;
  for (const auto& [word, way] : {std::pair(std::string(" rising"), SectionDirection::Rising),
                                  std::pair(std::string(" falling"), SectionDirection::Falling)})
    if (what.ends_with(word)) equation = what.substr(0, what.size() - word.size()), direction = way;
  request["section"] = equation;
  Study& study = desk.certified(request);
  if (study.refuse_modes() || study.refuse_without_time() || !study.equations()) desk.refuse(study);
  if (!study.model()->experiment.section)
    throw Trouble{"refused", "No section was named.", "", "Write where the motion passes, such as θ1 = 0.", "",
                  nullptr};
  const InterruptScope scope = study.interruptible();
  SectionOptions options;
  options.section = study.model()->experiment.section;
  options.direction = direction;
  options.interrupt = work.interrupt;
  const std::size_t wanted = count_of(request, "crossings", 200, 1, 20'000);
  const MechanicalSystem& system = study.model()->system;
  // It grows: a few crossings first, then four times as many, until there are enough. The motion is the same each time.
  Json out;
  Diagnostics said;
  for (std::size_t crossings = std::min<std::size_t>(wanted, 50);; crossings = std::min(wanted, 4 * crossings)) {
    options.crossings = crossings;
    const auto found = poincare_section(*study.model(), *study.equations(), options, said);
    if (!found) desk.refuse(study, said);
    if (work.interrupt.asked()) {
      if (out.is_null()) throw Interrupted();
      out["ended"] = "The time of this question was over.";
      break;
    }
    out = section_json(*found, what, system);
    if (crossings == wanted || !out["ended"].get<std::string>().empty()) break;
    work.send({{"section", out}});
  }
  out["diagnostics"] = desk.diagnostics(study, said);
  return out;
}

}  // namespace maupertuis::studio
