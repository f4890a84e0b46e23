#include "studio/requests.hpp"

#include <maupertuis/action.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/field_report.hpp>
#include <maupertuis/formula_document.hpp>
#include <maupertuis/motion_pictures.hpp>
#include <maupertuis/orbits.hpp>
#include <maupertuis/page_findings.hpp>
#include <maupertuis/picture.hpp>

#include <algorithm>
#include <cmath>

/// Files to take away: the same that the command line writes.
namespace maupertuis::studio {
namespace {

std::string base64(std::string_view bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) {
      return i + k < bytes.size() ? static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i + k])) : 0u;
    };
    const std::uint32_t three = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : letters[three >> (18 - 6 * k) & 63];
  }
  return out;
}

Json text_file(const std::string& name, const char* ending, const char* type, std::string text) {
  return {{"name", (name.empty() ? "motion" : name) + ending}, {"type", type}, {"text", std::move(text)}};
}

Json png_file(const std::string& name, const char* ending, const std::string& svg) {
  const PictureBytes picture = png_of(svg);
  if (!picture.problem.empty())
    throw Trouble{"refused", "No PNG can be made here.", picture.problem + ".", "Take the SVG.", "", nullptr};
  return {
      {"name", (name.empty() ? "motion" : name) + ending}, {"type", "image/png"}, {"base64", base64(picture.bytes)}};
}

SimulationResult motion_of(Desk& desk, Study& study, const Work& work) {
  SimulationOptions options;
  options.interrupt = work.interrupt;
  options.errors = ErrorEstimates::None;
  options.rows_of_steps = true;
  options.progress = [&work](double fraction) { work.send({{"progress", fraction}}); };
  auto result = study.motion(options);
  if (!result) desk.refuse(study);
  return *std::move(result);
}

/// With the arrows of forces that are asked for: those of the model, all, or none.
Drawing drawing_for(const Model& model, const EquationsOfMotion& equations, const SimulationResult& run,
                    const Json& request) {
  auto drawing =
      evaluate_drawing(model, run.trajectory, 12'000, &equations, impulses_of(run, model.system), forces_in(request));
  if (!drawing)
    throw Trouble{"refused",
                  "This model has nothing to draw.",
                  "A drawing shows points, bodies, springs and what `draw` names.",
                  "Mark a point, `point P at (x, y)`.",
                  "",
                  nullptr};
  if (const auto asked = request.find("forces"); asked != request.end() && *asked == false)
    drawing->elements.erase(std::remove_if(drawing->elements.begin(), drawing->elements.end(),
                                           [](const auto& e) { return e.kind == Drawing::Kind::Arrow; }),
                            drawing->elements.end());
  return *std::move(drawing);
}

/// At the moment t of the run, which may go backwards; beyond its ends the nearer one.
std::string frame_of(const Drawing& drawing, double t) {
  FrameOptions options;
  options.height = fitting_height(drawing, options.width);
  const double first = drawing.times.front(), last = drawing.times.back();
  return frame_svg(drawing, std::abs(std::clamp(t, std::min(first, last), std::max(first, last)) - first), options);
}

std::string plot_of(const SimulationResult& run, const MechanicalSystem& system) {
  PlotOptions options;
  options.title = system.title;
  for (const Coordinate& c : system.coordinates)
    if (run.trajectory.column(c.name)) options.columns.push_back(c.name);
  show_happenings(options, run, system);
  return plot_svg(run.trajectory, options);
}

/// The derivation with its equations, as a document that compiles by itself.
std::string latex_of(Study& study) {
  std::vector<FormulaLine> lines;
  const ReportContent content =
      study.has_fields()
          ? compose_field_report(*study.model(), study.source(), *study.field_equations(), *study.field_certificate())
          : compose_report(*study.model(), study.source(), *study.equations(), *study.derivation(true),
                           *study.certificate(), {}, [](std::string_view section, const std::function<void()>& part) {
                             const bool wanted = section == "equations" || section == "derivation";
                             if (wanted) part();
                             return wanted;
                           });
  const auto add = [&](const ReportContent::Formula& f, const std::string& section, const std::string& note) {
    lines.push_back({f.left, f.right, note, note == f.sentence ? std::string() : f.sentence, section, "", false});
  };
  for (const auto& section : content.derivation)
    for (const auto& line : section.lines) add(line, section.title, line.rule);
  for (const auto& equation : content.equations) add(equation, "Equations of motion", equation.sentence);
  for (const auto& where : content.intermediates) add(where, "Equations of motion", "");
  return document(lines, Notation::Latex);
}

/// A model that says between what ends its paths run, and nothing of a run.
bool is_about_paths_alone(const Model& model) {
  const Experiment& e = model.experiment;
  return e.path && !e.duration && !e.until;
}

std::optional<PathSearch> paths_of(const Model& model, const EquationsOfMotion& equations, const Work& work,
                                   Diagnostics& said) {
  if (!model.experiment.path) return std::nullopt;
  ActionOptions options;
  options.interrupt = work.interrupt;
  return stationary_paths(model, equations, ends_of(model), options, said);
}

/// The page of `maup report`, without what takes long.
std::string report_of(Desk& desk, Study& study, const Work& work) {
  const Model& model = *study.model();
  const EquationsOfMotion& equations = *study.equations();
  Diagnostics said = study.diagnostics();
  Diagnostics unheard;  // what the page cannot say of a system is no mistake of the model
  std::optional<SimulationResult> run;
  if (!is_about_paths_alone(model)) run = motion_of(desk, study, work);
  const std::optional<PathSearch> paths = paths_of(model, equations, work, said);
  ReportParts parts;
  if (run) parts.simulation = &*run;
  if (paths) parts.paths = &*paths;
  SimulationOptions options;
  options.interrupt = work.interrupt;
  const Verification verification = verify(model, equations, study.source(), options, unheard);
  parts.verification = &verification;
  std::optional<Invariants> invariants;
  PageModes found;
  if (model.system.has_modes()) {
    said.note(
        "N0506", std::nullopt, "this page has the equations without contact and without dry friction",
        "Conserved quantities and modes of vibration belong to one mode of contacts and frictions, and are left out.",
        "Choose a mode, and make its page.");
  } else {
    invariants = page_invariants(model, equations);
    if (run && moves_in_time(model.system)) found = page_modes(model, equations, work.interrupt);
  }
  work.interrupt.throw_if_asked();
  if (invariants) parts.invariants = &*invariants;
  if (found.modes) parts.modes = &*found.modes;
  if (found.locus) parts.locus = &*found.locus;
  ReportContent content =
      compose_report(model, study.source(), equations, *study.derivation(true), *study.certificate(), parts);
  add_messages(content, said, study.source());
  return report_html(content);
}

Json fields_file(Desk& desk, Study& study, const Work& work, const std::string& what) {
  const std::string& name = study.model()->system.name;
  if (what == "latex") return text_file(name, ".tex", "application/x-tex", latex_of(study));
  const FieldEquations& equations = *study.field_equations();
  const FieldCurrents currents = field_currents(equations);
  SimulationOptions options;
  options.interrupt = work.interrupt;
  const auto run = study.field_motion(options, {true, true, {}, &currents});
  if (!run) desk.refuse(study);
  if (what == "csv") return text_file(name, ".csv", "text/csv", to_csv(run->trajectory));
  if (what == "json") return text_file(name, ".json", "application/json", to_json(run->trajectory));
  if (what != "report")
    throw Trouble{"refused", "Of fields there is no such file here.",
                  "",        "Take the report, which has its pictures.",
                  "",        nullptr};
  FieldReportParts parts;
  parts.run = &*run;
  parts.currents = &currents;
  ReportContent content =
      compose_field_report(*study.model(), study.source(), equations, *study.field_certificate(), parts);
  add_messages(content, study.diagnostics(), study.source());
  return text_file(name, ".html", "text/html", report_html(content));
}

}  // namespace

Json export_file(Desk& desk, const Work& work) {
  const std::string what = text_of(work.request, "what");
  constexpr const char* known[] = {"csv",         "json",  "plot.svg", "plot.png", "drawing.svg",
                                   "drawing.png", "latex", "report",   "animation"};
  if (std::find(std::begin(known), std::end(known), what) == std::end(known))
    throw Trouble{"request", "`" + what + "` is no file that is made here.", "", "", "", nullptr};
  Study& study = desk.certified(work.request);
  const std::string& name = study.model()->system.name;
  const InterruptScope scope = study.interruptible();
  if (study.has_fields()) return fields_file(desk, study, work, what);
  if (what == "latex") return text_file(name, ".tex", "application/x-tex", latex_of(study));
  if (what == "report") return text_file(name, ".html", "text/html", report_of(desk, study, work));
  const Model& model = *study.model();
  const SimulationResult run = motion_of(desk, study, work);
  if (run.ending == Ending::Interrupted) throw Interrupted();
  if (what == "csv") return text_file(name, ".csv", "text/csv", to_csv(run.trajectory));
  if (what == "json") return text_file(name, ".json", "application/json", to_json(run.trajectory));
  if (what == "plot.svg") return text_file(name, ".svg", "image/svg+xml", plot_of(run, model.system));
  if (what == "plot.png") return png_file(name, ".png", plot_of(run, model.system));
  const Drawing drawing = drawing_for(model, *study.equations(), run, work.request);
  if (what == "animation") return text_file(name, ".html", "text/html", animation_html(drawing, model.system.title));
  const std::string svg = frame_of(drawing, number_of(work.request, "t", drawing.times.front()));
  if (what == "drawing.svg") return text_file(name, ".svg", "image/svg+xml", svg);
  return png_file(name, ".png", svg);
}

}  // namespace maupertuis::studio
