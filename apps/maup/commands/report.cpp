#include "field_report.hpp"
#include "field_views.hpp"
#include "interrupt.hpp"
#include "orbits_options.hpp"
#include "outcome.hpp"
#include "output_files.hpp"
#include "quantity.hpp"
#include "run_options.hpp"
#include "section_budget.hpp"
#include "time_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <maupertuis/contact_mode.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/look_alikes.hpp>
#include <maupertuis/page_findings.hpp>
#include <maupertuis/report.hpp>
#include <maupertuis/verification.hpp>

#include <algorithm>

namespace maupertuis::app {
namespace {

struct ReportOptions {
  ModelOptions model;
  RunOptions run;
  std::string output;  // empty: NAME.html of the system
  bool without_run = false;
  OrbitsOptions orbits;
  std::vector<std::string> sections;
  std::string budget = "20s";
};

/// What the sections of a page show, as far as each has come.
struct PageFindings {
  std::optional<SimulationResult> run;
  std::optional<Verification> verification;
  std::optional<Invariants> invariants;
  std::optional<ModalStudy> modes;
  std::optional<Locus> locus;
  std::optional<FloquetResult> floquet;
  std::optional<SectionResult> section;
  std::string section_what;
  std::optional<LyapunovResult> lyapunov;
  std::optional<PathSearch> paths;

  ReportParts parts() const;
};

ReportParts PageFindings::parts() const {
  const auto pointer = [](const auto& found) { return found ? &*found : nullptr; };
  return {pointer(run),     pointer(verification), pointer(invariants), pointer(modes),    pointer(locus),
          pointer(floquet), pointer(section),      section_what,        pointer(lyapunov), pointer(paths)};
}

/// It says between what ends its paths run, and nothing of a run.
bool is_about_paths_alone(const Model& model) {
  const Experiment& e = model.experiment;
  return e.path && !e.duration && !e.until;
}

/// One page under construction.
class Page {
 public:
  Page(const ReportOptions& options, Study& study, SectionBudget& budget, const SimulationOptions& settings,
       const Console& console)
      : options_(options),
        study_(study),
        budget_(budget),
        settings_(settings),
        console_(console),
        context_(*study.model()->system.context) {}

  /// What every section stands on. Without it there is no page; the diagnostics say why. False where it did not come in
  /// time (E0814).
  bool certify() {
    if (budget_.wanted("equations") || budget_.wanted("derivation")) derive();
    const bool came = budget_.attempt("certificate", context_, [&](const Interrupt& interrupt) {
      study_.set_interrupt(interrupt);
      study_.certificate();
    });
    study_.set_interrupt(&interrupt_flag());
    if (came) return true;
    study_.diagnostics().error("E0814", {}, "the budget was used up before the equations were certified",
                               "Nothing is shown that is not.", "Give the page more time, such as --budget 10min.");
    return false;
  }

  /// A run that the budget ends is shown up to there.
  void run() {
    if (options_.without_run || is_about_paths_alone(model())) return;
    SimulationOptions of_run = settings_;
    of_run.rows_of_steps = true;
    if (of_run.errors != ErrorEstimates::None) of_run.errors = ErrorEstimates::Rows;
    budget_.carry_out_in_part("motion", [&](const Interrupt& interrupt) {
      of_run.interrupt = interrupt;
      found_.run = run_model(study_, of_run, console_);
    });
    if (found_.run && found_.run->ending == Ending::Interrupted)
      found_.run->reason = fmt::format("its share of the budget of {} was used up", options_.budget);
  }

  /// False where what was asked for cannot be had: an error of the study then, and no page is written.
  bool find() {
    if (!find_long_run()) return false;
    find_paths();
    if (study_.wrong()) return false;
    const bool has_modes = model().system.has_modes();
    if (has_modes)
      study_.diagnostics().note(
          "N0506", std::nullopt, "this page has the equations without contact and without dry friction",
          "Conserved quantities and modes of vibration belong to one mode of contacts and frictions, and are left out.",
          fmt::format("`maup report --mode \"{}\"` makes the page of a mode.", some_mode(model().system)));
    budget_.carry_out("expectations", context_, [&](const Interrupt& interrupt) { verify_model(interrupt); });
    if (has_modes) return true;
    budget_.carry_out("conserved", context_,
                      [&](const Interrupt&) { found_.invariants = page_invariants(model(), equations()); });
    if (budget_.wanted("modes")) study_.tell_events_left_out();
    if (moves_in_time(model().system))
      budget_.carry_out("modes", context_, [&](const Interrupt& interrupt) { find_modes(interrupt); });
    return true;
  }

  std::string html() {
    const Derivation none;
    const bool readable = budget_.wanted("equations") || budget_.wanted("derivation");
    const Derivation* derivation = readable && derived_ ? study_.derivation(true) : &none;
    ReportContent content =
        compose_report(model(), study_.source(), equations(), *derivation, *study_.certificate(), found_.parts(),
                       [&](std::string_view name, const std::function<void()>& work) { return compose(name, work); });
    if (const std::string changes = changed_values(); !changes.empty())
      content.summary.emplace_back("other than in the text", changes);
    study_.diagnostics().append(budget_.warnings());
    if (content.drawing && content.drawing->moments_only) note_moments_only(study_.diagnostics());
    add_messages(content, study_.diagnostics(), study_.source());
    return report_html(content);
  }

  const std::optional<SimulationResult>& result() const { return found_.run; }

 private:
  const Model& model() const { return *study_.model(); }
  const EquationsOfMotion& equations() const { return *study_.equations(); }

  /// What the command line has in the place of the text, so that the page can be made again.
  std::string changed_values() const {
    std::vector<std::string> out;
    const auto add = [&](std::string_view option, const std::string& value) {
      if (!value.empty()) out.push_back(fmt::format("{} \"{}\"", option, value));
    };
    for (const std::string& value : options_.model.set) add("--set", value);
    for (const std::string& value : options_.model.start) add("--start", value);
    add("--mode", options_.model.mode.value_or(""));
    add("--duration", options_.run.duration.value_or(""));
    add("--until", options_.run.until);
    add("--method", options_.run.method.value_or(""));
    return out.empty() ? "" : fmt::format("by {}", fmt::join(out, " "));
  }

  bool compose(std::string_view name, const std::function<void()>& work) {
    const auto under_interrupt = [&](const Interrupt&) { work(); };
    return name == "model" ? budget_.attempt(name, context_, under_interrupt)
                           : budget_.carry_out(name, context_, under_interrupt);
  }

  /// Before the certificate, so that it vouches for the readable form too.
  void derive() {
    derived_ = budget_.attempt("equations", context_, [&](const Interrupt& interrupt) {
      study_.set_interrupt(interrupt);
      study_.derivation(true);
    });
    study_.set_interrupt(&interrupt_flag());
    if (!derived_) budget_.leave_out("derivation");
  }

  /// What was asked about the long run.
  bool find_long_run() {
    const OrbitsOptions& asked = options_.orbits;
    const bool any = asked.has_section() || asked.floquet || asked.lyapunov;
    if (!any) return true;
    if (study_.refuse_without_time()) return false;
    budget_.carry_out("orbits", context_, [&](const Interrupt& interrupt) {
      Diagnostics said;
      if (asked.has_section()) find_section(interrupt, said);
      if (asked.floquet) {
        FloquetOptions wanted = floquet_options(asked);
        wanted.interrupt = interrupt;
        found_.floquet = floquet(model(), equations(), wanted, said);
      }
      if (asked.lyapunov) {
        LyapunovOptions wanted = lyapunov_options(asked);
        wanted.interrupt = interrupt;
        found_.lyapunov = lyapunov_exponents(model(), equations(), wanted, said);
      }
      interrupt.throw_if_asked();
      study_.diagnostics().append(said);
    });
    return !study_.wrong();
  }

  void find_section(const Interrupt& interrupt, Diagnostics& said) {
    SectionOptions wanted = section_options(options_.orbits, study_);
    wanted.interrupt = interrupt;
    found_.section_what = section_text(options_.orbits);
    found_.section = poincare_section(model(), equations(), wanted, said);
  }

  void find_paths() {
    if (!model().experiment.path) return;
    budget_.carry_out("paths", context_, [&](const Interrupt& interrupt) {
      ActionOptions search;
      search.interrupt = interrupt;
      Diagnostics said;
      found_.paths = stationary_paths(model(), equations(), ends_of(model()), search, said);
      interrupt.throw_if_asked();
      study_.diagnostics().append(said);
    });
  }

  void verify_model(const Interrupt& interrupt) {
    const bool cannot_run = !found_.run && budget_.wanted("motion");
    if (cannot_run || model().experiment.expectations.empty()) return;
    SimulationOptions options = settings_;
    options.interrupt = interrupt;
    Diagnostics unheard;  // what the page cannot say of a system is no mistake of the model
    auto verification = verify(model(), equations(), study_.source(), options, unheard);
    interrupt.throw_if_asked();
    found_.verification = std::move(verification);
  }

  void find_modes(const Interrupt& interrupt) {
    PageModes found = page_modes(model(), equations(), interrupt);
    found_.modes = std::move(found.modes);
    found_.locus = std::move(found.locus);
  }

  const ReportOptions& options_;
  Study& study_;
  SectionBudget& budget_;
  const SimulationOptions& settings_;
  const Console& console_;
  Context& context_;
  PageFindings found_;
  bool derived_ = false;
};

void check_sections(const std::vector<std::string>& chosen, Diagnostics& diagnostics) {
  const auto& names = SectionBudget::names();
  for (const std::string& name : chosen) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    const std::string near = did_you_mean(name, names);
    diagnostics.error(
        "E0809", {}, fmt::format("--sections: a report has no section `{}`.", name), {},
        near.empty() ? fmt::format("It has {}.", fmt::join(names, ", ")) : fmt::format("Did you mean {}?", near));
  }
}

/// `result`: of the run, if the page has one that may have ended early.
ExitCode write_page(const std::string& page, const std::optional<SimulationResult>& result,
                    const ReportOptions& options, Study& study, Json& document, Console& console) {
  const std::string& name = study.model()->system.name;  // empty without a line `system`
  const std::string path = options.output.empty() ? (name.empty() ? "report" : name) + ".html" : options.output;
  if (path == "-")
    console.print(page);
  else
    write_result(path, visible(page), study.diagnostics());  // titles and names may turn the direction of writing
  document["file"] = path;
  document["bytes"] = page.size();
  const bool written = !study.wrong();
  if (written && path != "-" && !console.json())
    console.say(fmt::format("Wrote {} ({} kB). Open it in any browser.\n", path, (page.size() + 999) / 1000));
  if (result && !result->ok() && !console.json()) console.say(fmt::format("The run ended early: {}\n", result->reason));
  finish(console, study, document);
  if (!written) return ExitCode::RunFailed;
  return !result || result->ending == Ending::Interrupted ? ExitCode::Fine : exit_code(result->ending);
}

/// Density, equations, currents, waves and runs of fields.
ExitCode report_fields(const ReportOptions& options, Study& study, Console& console) {
  Json document = json_document("report");
  const OrbitsOptions& o = options.orbits;
  refuse_options_of_motions(options.run,
                            {{"--floquet", o.floquet},
                             {"--lyapunov", o.lyapunov},
                             {"--section", o.has_section()},
                             {"--at", !options.run.at.empty()}},
                            study.diagnostics());
  const SimulationOptions settings = simulation_options(options.run, study.diagnostics(), study.tree());
  check_sections(options.sections, study.diagnostics());
  check_field_sections(options.sections, study.diagnostics());
  const auto seconds = budget_seconds(options.budget, study.diagnostics());
  if (options.output != "-")
    check_output_files({{"-o", options.output, FileKind::Page}}, options.model.path, study.diagnostics());
  if (study.wrong()) return finish_usage(console, study, "report");
  if (!study.model()) return finish(console, study, document);
  SectionBudget budget(seconds, options.sections, console);
  const auto html = page_of_fields(study, settings, !options.without_run, budget);
  if (!html) return finish(console, study, document);
  document["sections"] = budget.written();
  document["left_out"] = budget.left_out();
  return write_page(*html, std::nullopt, options, study, document, console);
}

ExitCode report(const ReportOptions& options, Console& console) {
  Study study = open_study(options.model);
  if (declares_fields(study.tree())) return report_fields(options, study, console);
  Json document = json_document("report");
  const bool readable_model = !study.wrong();
  const SimulationOptions settings = simulation_options(options.run, study.diagnostics(), study.tree());
  check_orbits_options(options.orbits, study.tree(), study.diagnostics());
  check_sections(options.sections, study.diagnostics());
  const auto seconds = budget_seconds(options.budget, study.diagnostics());
  if (options.output != "-")
    check_output_files({{"-o", options.output, FileKind::Page}}, options.model.path, study.diagnostics());
  if (readable_model && study.wrong()) return finish_usage(console, study, "report");
  put_in_run(options.run, study);
  put_in_section(options.orbits, study);
  if (study.refuse_held_integrals() || !study.model()) return finish(console, study, document);

  SectionBudget budget(seconds, options.sections, console);
  Page page(options, study, budget, settings, console);
  if (!page.certify()) return finish_without(console, study, "report");
  if (!study.wrong()) page.run();
  if (study.wrong()) return finish(console, study, document);
  if (!page.find()) return finish_without(console, study, "report");
  const std::string html = page.html();
  document["sections"] = budget.written();
  document["left_out"] = budget.left_out();
  return write_page(html, page.result(), options, study, document, console);
}

}  // namespace

void add_report(CommandLine& line) {
  const auto options = std::make_shared<ReportOptions>();
  Command& command = line.add("report", "The whole study on one page that needs no network",
                              "  maup report pendulum.lag               # writes pendulum.html\n"
                              "  maup report chain.lag --budget 2min -o study.html\n"
                              "  maup report pendulum.lag --sections equations,motion --duration 60s\n",
                              [options](Console& console) { return report(*options, console); });
  add_model_options(command, options->model);
  add_span_options(command, options->run);
  add_method_options(command, options->run);
  add_errors_option(command, options->run);
  command.add_option("-o,--output", options->output, "The page (default: SYSTEM.html), or - for standard output")
      ->type_name("FILE.html");
  add_orbits_options(command, options->orbits);
  command.add_flag("--no-run", options->without_run, "Equations alone: no motion, no pictures");
  command
      .add_option(
          "--sections", options->sections,
          fmt::format("These alone, beside the model and the certificate: {}", fmt::join(SectionBudget::names(), ", ")))
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME,...");
  command
      .add_option(
          "--budget", options->budget,
          "The time that the page may take (default 20s), or none; sections that do not come in it are left out")
      ->type_name("TIME");
}

}  // namespace maupertuis::app
