#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/repeated_evaluation.hpp>

#include "fields/breaks.hpp"
#include "fields/density_form.hpp"
#include "fields/field_sides.hpp"
#include "fields/outlook.hpp"
#include "fields/resolution.hpp"
#include "fields/resting_fields.hpp"
#include "fields/semi_discrete.hpp"
#include "fields/start_fit.hpp"
#include "fields/steepening.hpp"
#include "fields/switching.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

/// The run of fields with coordinates and bodies, and of coarser meshes that tell how far off it is.
namespace maupertuis {
namespace {

constexpr int usual_coupled_cells = 6, usual_coupled_order = 8;
constexpr int usual_places = 200;  // of rows and pictures, about

struct CoupledRun {
  SimulationResult result;
  std::vector<double> answers;
  std::vector<std::vector<double>> near;  // [questions]: the same beside their places
  double energy = 0;
};

/// Where values are looked at beside their places, in widths of the first mesh's cells: where waves have breaks, two
/// meshes agree by chance at single places.
constexpr double beside_places[] = {-0.9, -0.6, -0.3, 0.3, 0.6, 0.9};

/// Adds what a question asks for, and the same beside its place where there is a width; false where it cannot be.
bool add_probes(const SemiDiscrete& mesh, const FieldQuestion& question, double width, Probe& probe,
                Diagnostics& diagnostics) {
  const auto add = [&](double shift) {
    const Expr value = mesh.discretised(question, diagnostics, shift);
    if (value) probe.expressions.push_back(expand_time_derivatives(value));
    return static_cast<bool>(value);
  };
  if (!add(0)) return false;
  for (const double part : beside_places)
    if (width > 0 && !question.total && !add(part * width)) return false;
  return true;
}

std::vector<double> times_of(const std::vector<FieldQuestion>& questions) {
  std::vector<double> out;
  for (const FieldQuestion& q : questions)
    if (std::find(out.begin(), out.end(), q.time) == out.end()) out.push_back(q.time);
  return out;
}

/// h_E of a state.
double energy_at(const EquationsOfMotion& equations, const State& state) {
  const MechanicalSystem& system = *equations.system;
  Bindings at{{system.context->time(), state.t}};
  for (const Parameter& p : system.parameters) at[p.symbol] = p.si_value;
  for (std::size_t i = 0; i < system.coordinates.size() && i < state.q.size(); ++i)
    at[system.coordinates[i].q] = state.q[i], at[system.coordinates[i].velocity] = state.v[i];
  for (const Input& input : system.inputs)
    if (input.formula) at[input.symbol] = evaluate(input.formula, at);
  const Expr h[] = {expand_time_derivatives(equations.energy_function)};
  return RepeatedEvaluation(h)([&](Expr symbol) {
           const auto value = at.find(symbol);
           return value == at.end() ? std::nan("") : value->second;
         })
      .front();
}

std::optional<CoupledRun> run_once(const SemiDiscrete& mesh, const std::vector<FieldQuestion>& questions, double width,
                                   const FieldRunOptions& options, Diagnostics& diagnostics) {
  const auto system = std::make_shared<const MechanicalSystem>(mesh.model().system);
  const auto equations = euler_lagrange(system, diagnostics);
  if (!equations) return std::nullopt;
  SimulationOptions settings;
  settings.at = times_of(questions);
  if (settings.at.empty()) settings.at.push_back(options.begin + options.duration);
  if (options.duration > 0) settings.duration = options.duration;
  if (options.every > 0) settings.output_every = options.every;
  settings.errors = ErrorEstimates::None;
  Outlook outlook(options);
  std::size_t steps = 0;
  settings.progress = [&](double share) {
    constexpr std::size_t between = 1024;  // steps from one call to the next
    outlook.after_steps(steps += between, share);
    if (options.progress) options.progress(share);
  };
  Probe probe;
  std::vector<std::size_t> of_question{0};  // the first probe of each
  for (const FieldQuestion& q : questions) {
    if (!add_probes(mesh, q, width, probe, diagnostics)) return std::nullopt;
    of_question.push_back(probe.expressions.size());
  }
  auto result = simulate(mesh.model(), *equations, settings, diagnostics, &probe);
  if (!result) return std::nullopt;
  CoupledRun out{std::move(*result), {}, {}, 0};
  out.answers.assign(questions.size(), std::nan("")), out.near.resize(questions.size());
  for (std::size_t i = 0; i < questions.size(); ++i)
    for (std::size_t k = 0; k < settings.at.size() && k < probe.values.size(); ++k)
      if (settings.at[k] == questions[i].time && of_question[i + 1] <= probe.values[k].size()) {
        const auto values = probe.values[k].begin();
        out.answers[i] = values[static_cast<std::ptrdiff_t>(of_question[i])];
        out.near[i].assign(values + static_cast<std::ptrdiff_t>(of_question[i] + 1),
                           values + static_cast<std::ptrdiff_t>(of_question[i + 1]));
      }
  out.energy = energy_at(*equations, out.result.final);
  return out;
}

/// Rows of fields at the places, then of the coordinates of the model.
class Rows {
 public:
  Rows(const SemiDiscrete& mesh, const Model& model, const FieldEquations& equations, const std::vector<double>& places)
      : model_(model), s_(equations.system()), equations_(equations), mesh_(mesh), places_(places) {
    for (const Parameter& p : model.system.parameters) parameters_[p.symbol] = p.si_value;
  }

  Trajectory of(const SimulationResult& run) const {
    Trajectory out;
    out.independent = run.trajectory.independent;
    out.times = run.trajectory.times;
    out.metadata = run.trajectory.metadata;
    const std::vector<Expr> values = columns(out);
    const RepeatedEvaluation at(values);
    const std::unordered_map<Expr, std::size_t, ExprHash> columns_of_symbols = symbol_columns(values, run.trajectory);
    for (std::size_t row = 0; row < run.trajectory.rows(); ++row) {
      const std::vector<double> here = at([&](Expr symbol) {
        if (symbol.role() == Role::Time) return run.trajectory.times[row];
        const auto column = columns_of_symbols.find(symbol);
        return column == columns_of_symbols.end() ? parameters_.at(symbol) : run.trajectory.at(row, column->second);
      });
      out.values.insert(out.values.end(), here.begin(), here.end());
      for (const Coordinate& c : model_.system.coordinates)
        for (const char* prime : {"", "'"})
          if (const auto column = run.trajectory.column(c.name + prime))
            out.values.push_back(run.trajectory.at(row, *column));
    }
    for (const Coordinate& c : model_.system.coordinates)
      for (const char* prime : {"", "'"})
        if (const auto column = run.trajectory.column(c.name + prime))
          out.columns.push_back(run.trajectory.columns[*column]);
    return out;
  }

 private:
  std::vector<Expr> columns(Trajectory& out) const {
    std::vector<Expr> values;
    for (std::size_t a = 0; a < equations_.varied.size(); ++a)
      for (int order = 0; order < 2; ++order)
        for (const double x : places_) {
          const Field& f = s_.fields[equations_.varied[a]];
          out.columns.push_back({fmt::format("{}{}({:.10g})", f.name, order ? "'" : "", x),
                                 to_string(s_.dimension_of({equations_.varied[a], {0}, order}))});
          values.push_back(mesh_.value_at(a, order, 0, x));
        }
    return values;
  }
  static std::unordered_map<Expr, std::size_t, ExprHash> symbol_columns(const std::vector<Expr>& values,
                                                                        const Trajectory& rows) {
    std::unordered_map<Expr, std::size_t, ExprHash> out;
    for (const Expr& symbol : symbols_of(values))
      if (symbol.role() == Role::Coordinate)
        if (const auto column =
                rows.column(symbol.name() + std::string(static_cast<std::size_t>(symbol.order()), '\'')))
          out[symbol] = *column;
    return out;
  }

  const Model& model_;
  const FieldSystem& s_;
  const FieldEquations& equations_;
  const SemiDiscrete& mesh_;
  const std::vector<double>& places_;
  Bindings parameters_;
};

std::vector<double> shown_places(const SemiDiscrete& mesh) {
  std::vector<double> out;
  const std::vector<double>& b = mesh.borders();
  const int in_element = std::max(4, usual_places / static_cast<int>(mesh.elements()));
  for (std::size_t e = 0; e + 1 < b.size(); ++e)
    for (int k = 0; k < in_element; ++k) out.push_back(b[e] + (b[e + 1] - b[e]) * k / in_element);
  out.push_back(b.back());
  return out;
}

/// At the place of a question and beside it.
double largest_difference(const CoupledRun& one, const CoupledRun& other, std::size_t question) {
  double out = std::abs(one.answers[question] - other.answers[question]);
  const std::vector<double>&a = one.near[question], &b = other.near[question];
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) out = std::max(out, std::abs(a[k] - b[k]));
  return out;
}

/// The error of each answer from runs on two coarser meshes: what halving the elements gains is measured, not believed,
/// since a start or a load with a kink lets no high order come about. Beside a break, of the start or under a load that
/// moves through elements, differences may be small by chance: that of the coarser meshes counts too, less what two
/// halvings gain there at least (`gain_at_breaks` each; 0: no breaks). Of meshes of lower orders less is believed of a
/// gain, and the difference of the coarser two counts likewise.
std::vector<double> errors_of(const CoupledRun& fine, const std::optional<CoupledRun>& half,
                              const std::optional<CoupledRun>& quarter, double gain_at_breaks, bool lower_orders) {
  constexpr double least = 1.5, of_halvings = 33, of_orders = 5;  // of a gain that two differences show
  const double most = lower_orders ? of_orders : of_halvings;
  std::vector<double> out;
  for (std::size_t i = 0; i < fine.answers.size(); ++i) {
    if (!half) {
      out.push_back(std::numeric_limits<double>::infinity());
      continue;
    }
    const double first = largest_difference(fine, *half, i);
    const double second = quarter ? largest_difference(*half, *quarter, i) : 0;
    const double gain = first > 0 ? std::clamp(second / first, least, most) - 1 : 1;
    if (gain_at_breaks > 0)
      out.push_back(std::max(first, second / (gain_at_breaks * gain_at_breaks)));
    else
      out.push_back(std::max(first / gain, lower_orders ? second / (most * most) : 0));
  }
  return out;
}

/// The error of each answer from a run that is off by up to a fifth of it itself: by the difference to it, and as at
/// single places both may agree by chance, a sixteenth of what it is beside it.
std::vector<double> errors_by_sharper_run(const CoupledRun& fine, const CoupledRun& sharp) {
  constexpr double own = 5.0 / 4, by_chance = 1.0 / 16;
  std::vector<double> out;
  for (std::size_t i = 0; i < fine.answers.size(); ++i)
    out.push_back(own * std::abs(fine.answers[i] - sharp.answers[i]) + by_chance * largest_difference(fine, sharp, i));
  return out;
}

/// The same where a derivative jumps, which runs along the field: errors fall by the n-th power of the width of
/// elements, as half of them show, and by no less than that of the order, `less` from one to the other.
std::vector<double> errors_by_sharper_run(const CoupledRun& fine, const CoupledRun& sharp, const CoupledRun& half,
                                          double less) {
  constexpr double lowest = 1, highest = 8, by_chance = 1.0 / 4;
  std::vector<double> out;
  for (std::size_t i = 0; i < fine.answers.size(); ++i) {
    const double narrow = largest_difference(fine, sharp, i), wide = largest_difference(half, sharp, i);
    const double n = narrow > 0 ? std::clamp(std::log2(wide / narrow), lowest, highest) : highest;
    const double at_place = std::abs(fine.answers[i] - sharp.answers[i]);
    out.push_back((at_place + by_chance * narrow) / (1 - std::pow(less, n)));
  }
  return out;
}

/// Whether an element of one mesh is one of the other as well: there both may agree about what is wrong.
bool share_elements(const SemiDiscrete& fine, const SemiDiscrete& coarse) {
  const std::vector<double>&a = fine.borders(), &b = coarse.borders();
  const double near = 1e-9 * (a.back() - a.front());
  const auto is_border_of_fine = [&](double x) {
    const auto at = std::lower_bound(a.begin(), a.end(), x - near);
    return at != a.end() && *at <= x + near ? at - a.begin() : -1;
  };
  for (std::size_t i = 1; i < b.size(); ++i) {
    const auto left = is_border_of_fine(b[i - 1]), right = is_border_of_fine(b[i]);
    if (left >= 0 && right == left + 1) return true;
  }
  return false;
}

/// A coarser mesh: of a `by`th of the cells, or, where places leave an element as it is then, of a lower order. Nothing
/// where the order cannot be lowered.
std::optional<SemiDiscrete> coarser_mesh(const SemiDiscrete& fine, const Model& model, const FieldEquations& equations,
                                         int cells, int order, int by) {
  constexpr int first_halving = 2, least_order = 2;
  Diagnostics unheard;
  const auto half = SemiDiscrete::make(model, equations, std::max(cells / first_halving, 1), order, unheard);
  if (!half || !share_elements(fine, *half))
    return by == first_halving ? half : SemiDiscrete::make(model, equations, std::max(cells / by, 1), order, unheard);
  auto lower = SemiDiscrete::make(model, equations, cells, std::max(order - by, least_order), unheard);
  return lower && lower->order() < fine.order() ? std::move(lower) : std::nullopt;
}

/// The run on elements of an order higher by two; nothing where they would be too many unknowns.
std::optional<CoupledRun> sharper_run(const SemiDiscrete& fine, const Model& model, const FieldEquations& equations,
                                      int cells, const std::vector<FieldQuestion>& questions, double width,
                                      const FieldRunOptions& options) {
  Diagnostics unheard;
  const auto mesh = SemiDiscrete::make(model, equations, cells, fine.order() + 2, unheard);
  return mesh ? run_once(*mesh, questions, width, options, unheard) : std::nullopt;
}

/// What an answer feels of rounding beside its own size, as felt_rounding of fields without bodies; by the values and
/// velocities of the elements at the end of the run.
double felt_rounding(const CoupledRun& run, const SemiDiscrete& mesh, const FieldEquations& equations,
                     std::size_t answer, const FieldQuestion& question) {
  double out = std::abs(run.answers[answer]);
  if (question.total) return out;
  const FieldSystem& s = equations.system();
  const auto largest = [](const std::vector<double>& all) {
    double most = 0;
    for (const double x : all) most = std::max(most, std::abs(x));
    return most;
  };
  double width = mesh.borders().back() - mesh.borders().front();
  for (std::size_t i = 1; i < mesh.borders().size(); ++i)
    width = std::min(width, mesh.borders()[i] - mesh.borders()[i - 1]);
  const std::vector<Expr> asked = symbols_of({&question.value, 1});
  for (const PlaceValue& place : equations.model->places) {
    if (std::find(asked.begin(), asked.end(), place.symbol) == asked.end()) continue;
    const Expr slope = differentiate(question.value, place.symbol);
    const FieldJet jet = *s.jet_of(place.jet);
    const double weight = slope.is_number() ? std::abs(slope.number().to_double()) : 1;
    out += weight * largest(jet.time > 0 ? run.result.final.v : run.result.final.q) *
           std::pow(mesh.order() * mesh.order() / width, jet.order() - jet.time);
  }
  return out;
}

/// How many happenings of a run another mesh has too: the same ones, in the same order, and after about the same time
/// since the one before. Where a mesh rattles at a contact these times are those of its elements.
std::size_t alike(const std::vector<Happening>& a, const std::vector<Happening>& b, double begin) {
  constexpr double about = 0.25;
  double before_a = begin, before_b = begin;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (i == b.size() || a[i].name != b[i].name || a[i].kind != b[i].kind) return i;
    const double since = a[i].t - std::exchange(before_a, a[i].t), other = b[i].t - std::exchange(before_b, b[i].t);
    if (std::abs(since - other) > about * std::abs(since) + 1e-12 * std::abs(a[i].t)) return i;
  }
  return a.size();
}

/// How far off moments are: twice the difference to half the cells, since an impact leaves a jump of the velocity to
/// the field. Infinite where half the cells do not have them.
void estimate_moments(std::vector<Happening>& fine, const std::optional<CoupledRun>& half,
                      const std::optional<CoupledRun>& quarter, double begin) {
  const std::size_t known = half ? alike(fine, half->result.happenings, begin) : 0;
  const std::size_t twice = quarter ? alike(fine, quarter->result.happenings, begin) : 0;
  for (std::size_t i = 0; i < fine.size(); ++i) {
    Happening& h = fine[i];
    h.error = std::numeric_limits<double>::infinity();
    if (i >= known) continue;
    const double first = half->result.happenings[i].t;
    const double second = i < twice ? quarter->result.happenings[i].t : first;
    h.error = 2 * std::max(std::abs(first - h.t), std::abs(second - first) / 4) + 2.2e-16 * std::abs(h.t);
  }
}

/// Whether contacts or friction made forces or velocities jump.
bool jumps(const CoupledRun& run) {
  return std::any_of(run.result.happenings.begin(), run.result.happenings.end(),
                     [](const Happening& h) { return h.kind != Happening::Kind::Event; });
}

constexpr double gain_of_kinks = 2;

/// What halving the elements gains at least beside a break; 0 where there is none. A plucked string and one under a
/// moving load have kinks, a beam under a load a jump of its third derivative; of waves without bodies at their ends a
/// higher derivative may jump where the start does not fit them.
double gain_at_breaks(const FieldEquations& equations, const SemiDiscrete& mesh, bool start_breaks,
                      const std::optional<SwitchingBreak>& switching, double begin, double end) {
  constexpr double of_loads_on_beams = 8;
  if (start_breaks) return gain_of_kinks;
  if (!mesh.departures().empty()) return mesh.bends() ? of_loads_on_beams : gain_of_kinks;
  double spacing = 0;
  for (std::size_t i = 1; i < mesh.borders().size(); ++i)
    spacing = std::max(spacing, (mesh.borders()[i] - mesh.borders()[i - 1]) / mesh.order());
  std::optional<int> jump = fit_of_sides(equations, begin, end, spacing).jump;
  if (switching && !mesh.bends()) jump = std::min(jump.value_or(switching->order), switching->order);
  if (!jump) return 0;
  if (mesh.bends()) return std::pow(2.0, *jump);
  return *jump <= 1 ? gain_of_kinks : std::pow(2.0, *jump + 1);
}

/// Whether forces or what changes in time feed the bodies, or friction takes from them.
bool bodies_are_forced(const FieldEquations& equations) {
  if (!equations.bodies) return false;
  const EquationsOfMotion& bodies = *equations.bodies;
  const Expr t = bodies.system->context->time();
  std::vector<Expr> feeding = bodies.generalized_forces;
  feeding.insert(feeding.end(), bodies.dissipative_terms.begin(), bodies.dissipative_terms.end());
  feeding.push_back(differentiate(bodies.lagrangian_expanded, t));
  for (const Constraint& c : bodies.system->constraints) feeding.push_back(differentiate(c.value, t));
  return std::any_of(feeding.begin(), feeding.end(), [](const Expr& e) { return !e.is_zero(); });
}

/// Of the model: coordinates of the run, and values at places that move.
std::vector<FieldRunResult::Coordinate> final_coordinates(const SemiDiscrete& mesh, const MechanicalSystem& system,
                                                          const State& state) {
  const std::vector<Coordinate>& moving = mesh.model().system.coordinates;
  Bindings at{{system.context->time(), state.t}};
  for (const Parameter& p : system.parameters) at[p.symbol] = p.si_value;
  for (std::size_t i = 0; i < moving.size() && i < state.q.size(); ++i)
    at[moving[i].q] = state.q[i], at[moving[i].velocity] = state.v[i];
  std::vector<FieldRunResult::Coordinate> out;
  for (const Coordinate& c : system.coordinates) {
    const auto value = mesh.moving().find(c.q), rate = mesh.moving().find(c.velocity);
    if (value != mesh.moving().end())
      out.push_back({c.name, evaluate(value->second, at), evaluate(rate->second, at)});
    else if (at.count(c.q))
      out.push_back({c.name, at.at(c.q), at.at(c.velocity)});
  }
  return out;
}

/// With the state of the coordinates of the model.
Happening in_coordinates_of(Happening h, const SemiDiscrete& mesh, const MechanicalSystem& system) {
  State state;
  state.t = h.t, state.q = std::move(h.q), state.v = std::move(h.v);
  h.q.clear(), h.v.clear();
  if (state.q.empty()) return h;
  for (const FieldRunResult::Coordinate& c : final_coordinates(mesh, system, state)) {
    h.q.push_back(c.q);
    h.v.push_back(c.v);
  }
  return h;
}

}  // namespace

bool runs_as_one_system(const FieldEquations& equations) {
  return equations.model->coupled || !density_borders(equations).empty();
}

std::optional<FieldRunResult> run_coupled(const Model& model, const FieldEquations& equations,
                                          const std::vector<FieldQuestion>& questions, const FieldRunOptions& options,
                                          Diagnostics& diagnostics) {
  const auto begin = std::chrono::steady_clock::now();
  const FieldSystem& s = equations.system();
  const int cells = s.space.front().cells ? s.space.front().cells : usual_coupled_cells;
  const int order = s.element_order ? s.element_order : usual_coupled_order;
  if (refuse_too_many_conditions(equations, diagnostics)) return std::nullopt;
  if (nothing_moves(equations)) {
    diagnostics.error("E0642", s.density_span, "no equation says how this model moves",
                      "No equation of its fields and of what takes hold of them holds a derivative by t.",
                      "The rest is that of `maup modes` and `expect equilibrium at …`.");
    return std::nullopt;
  }
  const auto mesh = SemiDiscrete::make(model, equations, cells, order, diagnostics);
  if (!mesh ||
      refuse_unresolved(equations, {mesh->borders()}, mesh->order(), {options.begin, options.duration}, diagnostics))
    return std::nullopt;
  if (mesh->start_clashes())
    diagnostics.warning("W0646", equations.model->start.empty() ? s.density_span : equations.model->start.front().span,
                        "the start does not fit the condition at an end",
                        "The condition is followed, so that a jump runs into the field, which no mesh resolves.",
                        "Give a start that has the value of the condition there.");
  const bool breaks = warn_of_breaks(equations, {cells}, diagnostics);
  const double end = options.begin + options.duration;
  std::optional<SwitchingBreak> switching;
  if (const auto moments = switching_moments(equations, options.begin, end))
    switching = lowest_break(equations, *moments, options.begin, end);
  if (switching && switching->order <= 1 && !mesh->bends()) warn_of_switching(*switching, diagnostics);
  const double gain_of_start = gain_at_breaks(equations, *mesh, breaks, switching, options.begin, end);
  const double width = (mesh->borders().back() - mesh->borders().front()) / cells;
  const auto fine = run_once(*mesh, questions, width, options, diagnostics);
  if (!fine) return std::nullopt;
  FieldRunResult out;
  out.cells = static_cast<int>(mesh->elements()), out.order = mesh->order();
  out.nodes = mesh->degrees_of_freedom();
  out.steps = fine->result.statistics.steps;
  out.end = fine->result.final.t;
  out.energy = fine->energy;
  out.energy_drift = mesh->forced() || bodies_are_forced(equations) ? -1 : fine->result.statistics.energy_drift;
  out.coupled = true;
  out.method = fine->result.statistics.method == "stiff"
                   ? "implicit steps (Radau)"
                   : fmt::format("Taylor steps of order {}", fine->result.statistics.order);
  if (!fine->result.ok()) out.trouble = fine->result.reason;
  out.final_coordinates = final_coordinates(*mesh, model.system, fine->result.final);
  for (const Happening& h : fine->result.happenings) {
    const std::vector<std::string>& departures = mesh->departures();
    if (std::find(departures.begin(), departures.end(), h.name) == departures.end())
      out.happenings.push_back(in_coordinates_of(h, *mesh, model.system));
    else
      out.trouble = h.name;
  }
  out.first_mode = fine->result.first_mode;
  out.books = fine->result.books;
  out.remarks = fine->result.remarks;
  if (options.trajectory) {
    out.places = shown_places(*mesh);
    out.trajectory = Rows(*mesh, model, equations, out.places).of(fine->result);
  }
  std::optional<CoupledRun> half, quarter;
  bool lower_orders = false;  // in the place of fewer cells
  const double gain = jumps(*fine) ? gain_of_kinks : gain_of_start;
  std::optional<CoupledRun> sharp;
  bool jumps_at_ends = false;
  if (options.errors && (!questions.empty() || !out.happenings.empty()) && out.trouble.empty()) {
    FieldRunOptions quiet = options;
    quiet.trajectory = false, quiet.progress = {}, quiet.announce = {};
    jumps_at_ends = gain > 0 && !jumps(*fine) && !breaks && mesh->departures().empty();
    if (gain == 0 || jumps_at_ends) sharp = sharper_run(*mesh, model, equations, cells, questions, width, quiet);
    const auto coarser = [&](int by) {
      Diagnostics unheard;
      const auto other = coarser_mesh(*mesh, model, equations, cells, order, by);
      lower_orders = other && other->order() < mesh->order();
      return other ? run_once(*other, questions, width, quiet, unheard) : std::nullopt;
    };
    if (!sharp || jumps_at_ends) half = coarser(2);
    if (jumps_at_ends && (!half || lower_orders)) sharp.reset();
    if (!sharp) quarter = coarser(4);
  }
  if (options.errors) estimate_moments(out.happenings, sharp ? sharp : half, quarter, options.begin);
  const double less = mesh->order() / (mesh->order() + 2.0);
  std::vector<double> errors = !sharp          ? errors_of(*fine, half, quarter, gain, lower_orders)
                               : jumps_at_ends ? errors_by_sharper_run(*fine, *sharp, *half, less)
                                               : errors_by_sharper_run(*fine, *sharp);
  if (!sharp && gain > 0 && !breaks)
    for (double& e : errors) e *= 2;
  const double rounding = 2.2e-16 * std::sqrt(static_cast<double>(out.steps) + 1);
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const double felt = felt_rounding(*fine, *mesh, equations, i, questions[i]);
    out.answers.push_back({fine->answers[i], errors[i] + rounding * std::max(felt, 1e-300)});
  }
  if (out.happenings.empty()) warn_of_drift(out, equations, diagnostics);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

}  // namespace maupertuis
