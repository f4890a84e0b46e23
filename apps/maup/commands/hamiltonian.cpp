#include "command.hpp"
#include "hamiltonian_text.hpp"
#include "outcome.hpp"
#include "output_files.hpp"
#include "quantity.hpp"
#include "run_options.hpp"

#include <fmt/format.h>

#include <cmath>

#include <algorithm>

#include <maupertuis/print.hpp>

namespace maupertuis::app {
namespace {

struct HamiltonianOptions {
  ModelOptions model;
  RunOptions run;
  std::vector<std::string> routhian, bracket, dirac_bracket;
  bool latex = false, mathml = false, plain = false, integrate = false;
  std::string output;
};

/// The coordinates of --routhian; E1105 for a name that is none.
std::vector<std::size_t> coordinates_named(const std::vector<std::string>& names, Study& study) {
  const auto& coordinates = study.model()->system.coordinates;
  std::vector<std::string> known;
  for (const Coordinate& c : coordinates) known.push_back(c.name);
  std::vector<std::size_t> found;
  for (const std::string& name : names) {
    const auto place = std::find(known.begin(), known.end(), name);
    if (place == known.end()) {
      const std::string near = did_you_mean(name, known);
      study.diagnostics().error("E1105", {},
                                fmt::format("`{}` is no coordinate of {}", name, spoken_name(study.model()->system)),
                                "A Routhian replaces velocities of coordinates by their momenta.",
                                near.empty() ? "" : fmt::format("Did you mean `{}`?", near));
    } else if (const auto i = static_cast<std::size_t>(place - known.begin());
               std::find(found.begin(), found.end(), i) == found.end()) {
      found.push_back(i);
    }
  }
  return found;
}

/// Of the formulas of --bracket, two for each.
std::vector<Bracket> brackets_of(const HamiltonianOptions& options, const Hamiltonian& h,
                                 const std::optional<DiracAnalysis>& dirac, Study& study) {
  const std::vector<AskedFormula>& asked = study.model()->experiment.asked;
  std::vector<Bracket> found;
  for (std::size_t i = 0; i + 1 < asked.size(); i += 2) {
    const Expr a = asked[i].value, b = asked[i + 1].value;
    const bool of_dirac = i >= options.bracket.size();
    if (of_dirac && (!dirac || dirac->outcome != ConstraintChain::Outcome::Closed)) {
      study.diagnostics().error("E1106", asked[i].span, "this system has no Dirac bracket",
                                "It belongs to constraints of the second class in phase space, of a singular Legendre "
                                "transform that can be written out.",
                                "--bracket gives Poisson's.");
      continue;
    }
    const auto value = of_dirac ? dirac_bracket(a, b, h, *dirac) : poisson_bracket(a, b, h);
    if (!value)
      study.diagnostics().error("E1104", asked[i].span, "this bracket cannot be formed",
                                "A velocity stands in it that does not follow from the momenta, or an acceleration.",
                                "Write it in coordinates, momenta and t.");
    else
      found.push_back({a, b, *value, of_dirac});
  }
  return found;
}

/// A result that fails its own proof is not shown (E0690); one that is undecided is shown with a warning (W0691).
void judge(const Certificate& certificate, Diagnostics& diagnostics) {
  for (const CertificateCheck& check : certificate.checks) {
    if (check.verdict == Verdict::Nonzero)
      diagnostics.error("E0690", {}, fmt::format("the transform failed its check {}: {}", check.name, check.reason),
                        "What was derived is wrong, and is not shown.", "Please report this model.");
    else if (check.verdict == Verdict::Undecided)
      diagnostics.warning("W0691", {}, fmt::format("the check {} was undecided: {}", check.name, check.reason),
                          "Nothing vouches for this part.", "");
  }
}

/// The constraints in phase space are those of L, whatever a gauge chooses: Lagrange's count beside them is so too.
std::optional<DegenerateAnalysis> count_of_lagrange(Study& study) {
  const DegenerateAnalysis* found = study.degenerate();
  if (!found) return std::nullopt;
  if (found->gauges == 0) return *found;
  const Bindings start = start_on_constraints(*study.model(), *study.equations());
  return analyse_degenerate(*study.equations(), generic_state(*study.model()), false, true, &start);
}

PhaseSpace analyse(const HamiltonianOptions& options, Study& study, const Console& console) {
  PhaseSpace found;
  const InterruptScope scope = study.interruptible();
  const EquationsOfMotion& equations = *study.equations();
  console.at("Legendre transform");
  found.hamiltonian = hamiltonian(equations);
  report_legendre(found.hamiltonian, study.diagnostics());
  const std::vector<std::size_t> replaced = coordinates_named(options.routhian, study);
  found.routhian = routhian(equations, found.hamiltonian, replaced.empty() ? nullptr : &replaced);
  if (found.hamiltonian.legendre.has(LegendreKind::Singular))
    found.dirac = dirac_analysis(found.hamiltonian, equations, generic_state(*study.model()),
                                 start_on_constraints(*study.model(), equations));
  found.brackets = brackets_of(options, found.hamiltonian, found.dirac, study);
  console.at("proofs");
  found.certificate = certify(found.hamiltonian, equations);
  if (found.routhian)
    for (CertificateCheck& check : certify(*found.routhian, found.hamiltonian, equations).checks)
      found.certificate.checks.push_back(std::move(check));
  judge(found.certificate, study.diagnostics());
  console.at("lines to read");
  found.lines = phase_space_lines(found.hamiltonian, found.routhian ? &*found.routhian : nullptr, equations);
  if (found.dirac) {
    const auto lagrange = count_of_lagrange(study);
    for (DerivationStep& line : dirac_lines(*found.dirac, found.hamiltonian, lagrange ? &*lagrange : nullptr))
      found.lines.push_back(std::move(line));
  }
  return found;
}

/// Both begin in one state, so that the first row compares nothing.
bool is_compared(const CanonicalMotion& motion) { return motion.trajectory.rows() > 1; }

std::string difference_text(const CanonicalMotion& motion, const MechanicalSystem& system) {
  if (!is_compared(motion)) return "  the two motions were not compared: no row behind the start was reached\n";
  const std::string until =
      motion.ending.empty() ? "" : fmt::format(" up to {}", system.moment(brief(motion.trajectory.times.back())));
  if (motion.difference == 0) return fmt::format("  the two motions agree to the last digit{}\n", until);
  return fmt::format("  the two motions differ{} by {} of its size in {}, at {}\n", until, brief(motion.difference),
                     motion.difference_name, system.moment(brief(motion.difference_time)));
}

std::string motion_text(const CanonicalMotion& motion, const SimulationResult& run, const MechanicalSystem& system) {
  const Trajectory& rows = motion.trajectory;
  std::string out = fmt::format("\nCanonical integration\n  {}\n", system.moment(exact(motion.final_time)));
  const std::size_t n = motion.final_q.size();
  bool complete = std::isfinite(motion.difference);
  for (std::size_t i = 0; i < 2 * n; ++i) {
    const double value = i < n ? motion.final_q[i] : motion.final_p[i - n];
    if (!std::isfinite(value)) {
      out += fmt::format("  {:<8}  has no value\n", rows.columns[i].name);
      complete = false;
      continue;
    }
    out += fmt::format("  {:<8} {: .17g}{}{}\n", rows.columns[i].name, value, rows.columns[i].unit.empty() ? "" : " ",
                       rows.columns[i].unit);
  }
  out += fmt::format("  {} steps of order {}; Lagrange's equations took {}\n", motion.steps, motion.order,
                     run.statistics.steps);
  return complete ? out + difference_text(motion, system) : out;
}

Json motion_json(const CanonicalMotion& motion) {
  Json state;
  const std::size_t n = motion.final_q.size();
  for (std::size_t i = 0; i < 2 * n; ++i)
    state[motion.trajectory.columns[i].name] = i < n ? motion.final_q[i] : motion.final_p[i - n];
  return {{"final", {{"t", motion.final_time}, {"state", std::move(state)}}},
          {"steps", motion.steps},
          {"order", motion.order},
          {"difference", is_compared(motion) ? Json(motion.difference) : Json()},
          {"difference_in", motion.difference_name},
          {"difference_at", is_compared(motion) ? Json(motion.difference_time) : Json()},
          {"ended", motion.ending}};
}

/// Both motions; the exit code of what went wrong, if something did.
ExitCode integrate(const HamiltonianOptions& options, const PhaseSpace& found, Study& study, Console& console,
                   Json& document) {
  const SimulationOptions settings = simulation_options(options.run, study.diagnostics());
  if (study.wrong()) return ExitCode::Usage;
  const auto run = run_model(study, settings, console);
  if (!run) return ExitCode::ModelWrong;
  const auto motion = canonical_motion(found.hamiltonian, *study.equations(), *run, settings, study.diagnostics());
  if (!motion) return ExitCode::ModelWrong;
  write_rows(options.output, motion->trajectory, study.diagnostics());
  document["integration"] = motion_json(*motion);
  if (!console.json()) console.print(motion_text(*motion, *run, study.model()->system));
  if (!motion->ending.empty() && !console.json())
    console.say(fmt::format("The canonical run ended at {}: {}\n",
                            study.model()->system.moment(exact(motion->final_time)), motion->ending));
  return motion->ending.empty() ? exit_code(run->ending) : ExitCode::RunFailed;
}

ExitCode hamiltonian_of(const HamiltonianOptions& options, Console& console) {
  Study study = open_study(options.model);
  Json document = json_document("hamiltonian");
  const bool readable_model = !study.wrong();
  check_output_files({{"-o", options.output, FileKind::Table}}, options.model.path, study.diagnostics());
  if (readable_model && study.wrong()) return finish_usage(console, study, "hamiltonian");
  put_in_run(options.run, study);
  for (const std::string& formula : options.bracket) study.ask("--bracket", formula);
  for (const std::string& formula : options.dirac_bracket) study.ask("--dirac-bracket", formula);
  if (!options.integrate) study.admit_singular_mass_matrix();  // then there are primary constraints
  if (!study.model() || study.refuse_held_integrals() || study.refuse_modes() ||
      (options.integrate && study.refuse_acting_events()) || !study.certificate())
    return finish(console, study, document);
  const PhaseSpace found = analyse(options, study, console);
  if (study.wrong()) return finish(console, study, document);
  if (!console.json()) {
    if (options.latex)
      console.print(phase_space_text(found, Notation::Latex));
    else if (options.mathml)
      console.print(phase_space_text(found, Notation::Mathml));
    else if (options.plain)
      console.print(phase_space_text(found, Notation::Plain));
    else
      console.print(phase_space_text(found));
  }
  if (console.json()) add_to(document, found);
  const ExitCode ended = options.integrate ? integrate(options, found, study, console, document) : ExitCode::Fine;
  const ExitCode told = finish(console, study, document);
  return told != ExitCode::Fine ? (ended == ExitCode::Usage ? ended : told) : ended;
}

}  // namespace

void add_hamiltonian(CommandLine& line) {
  const auto options = std::make_shared<HamiltonianOptions>();
  Command& command = line.add("hamiltonian", "Momenta, H, canonical equations, Routhian, Poisson brackets",
                              "  maup hamiltonian top.lag\n"
                              "  maup hamiltonian kepler.lag --bracket \"x p_y - y p_x\" \"p_x^2 + p_y^2\"\n"
                              "  maup hamiltonian double_pendulum.lag --integrate --duration 5s\n",
                              [options](Console& console) { return hamiltonian_of(*options, console); });
  add_model_options(command, options->model);
  command
      .add_option("--routhian", options->routhian, "The Routhian without these coordinates (default: the cyclic ones)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME,...");
  command
      .add_option("--bracket", options->bracket,
                  "{A, B} of two formulas in coordinates, momenta and t, e.g. x p_x; may be repeated")
      ->type_size(2)
      ->allow_extra_args(false)
      ->type_name("A B");
  command
      .add_option("--dirac-bracket", options->dirac_bracket,
                  "{A, B} of Dirac, in which constraints of the second class may be put to 0; may be repeated")
      ->type_size(2)
      ->allow_extra_args(false)
      ->type_name("A B");
  const auto latex = command.add_flag("--latex", options->latex, "A LaTeX document of the formulas");
  const auto mathml = command.add_flag("--mathml", options->mathml, "MathML")->excludes(latex);
  command.add_flag("--plain", options->plain, "The formulas alone, one a line")->excludes(latex)->excludes(mathml);
  const auto integrate = command.add_flag("--integrate", options->integrate,
                                          "Integrate the canonical equations, and compare with Lagrange's");
  add_span_options(command, options->run);
  command.add_option("-o,--output", options->output, "q, p and H of --integrate: .csv, .npy or .json")
      ->type_name("FILE")
      ->needs(integrate);
}

}  // namespace maupertuis::app
