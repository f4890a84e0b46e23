#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/repeated_evaluation.hpp>

#include "fields/breaks.hpp"
#include "fields/coupled_errors.hpp"
#include "fields/density_form.hpp"
#include "fields/field_run_messages.hpp"
#include "fields/resolution.hpp"
#include "fields/resting_fields.hpp"
#include "fields/steepening.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <unordered_map>
#include <utility>

/// The run of fields with coordinates and bodies.
namespace maupertuis {
namespace {

constexpr int usual_coupled_cells = 6, usual_coupled_order = 8;
constexpr int usual_places = 200;  // of rows and pictures, about

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

/// Nothing, and the diagnostics, where nothing moves, conditions are too many, or no mesh follows the start.
std::optional<SemiDiscrete> mesh_for(const CoupledProblem& p, Diagnostics& diagnostics) {
  const FieldSystem& s = p.equations.system();
  if (refuse_too_many_conditions(p.equations, diagnostics)) return std::nullopt;
  if (nothing_moves(p.equations)) {
    diagnostics.error("E0642", s.density_span, "no equation says how this model moves",
                      "No equation of its fields and of what takes hold of them holds a derivative by t.",
                      "The rest is that of `maup modes` and `expect equilibrium at …`.");
    return std::nullopt;
  }
  auto mesh = SemiDiscrete::make(p.model, p.equations, p.cells, p.order, diagnostics);
  if (!mesh || refuse_unresolved(p.equations, {mesh->borders()}, mesh->order(), {p.options.begin, p.options.duration},
                                 diagnostics))
    return std::nullopt;
  warn_of_clashes(mesh->start_clashes(), p.equations, diagnostics);
  return mesh;
}

/// Jumps and kinks of the start, and what switches along the run.
void look_at_breaks(CoupledProblem& p, const SemiDiscrete& mesh, Diagnostics& diagnostics) {
  p.breaks = warn_of_breaks(p.equations, {p.cells}, diagnostics);
  const double begin = p.options.begin, end = begin + p.options.duration;
  std::optional<SwitchingBreak> switching;
  if (const auto moments = switching_moments(p.equations, begin, end))
    switching = lowest_break(p.equations, *moments, begin, end);
  if (switching && switching->order <= 1 && !mesh.bends()) warn_of_switching(*switching, diagnostics);
  p.gain_of_start = gain_at_breaks(p.equations, mesh, p.breaks, switching, begin, end);
  p.width = (mesh.borders().back() - mesh.borders().front()) / p.cells;
}

/// All but the answers.
FieldRunResult result_of(const CoupledRun& fine, const SemiDiscrete& mesh, const CoupledProblem& p) {
  const SimulationResult& run = fine.result;
  FieldRunResult out;
  out.cells = static_cast<int>(mesh.elements()), out.order = mesh.order();
  out.nodes = mesh.degrees_of_freedom();
  out.steps = run.statistics.steps;
  out.end = run.final.t;
  out.energy = fine.energy;
  out.energy_drift = mesh.forced() || bodies_are_forced(p.equations) ? -1 : run.statistics.energy_drift;
  out.coupled = true;
  out.method = run.statistics.method == "stiff" ? "implicit steps (Radau)"
                                                : fmt::format("Taylor steps of order {}", run.statistics.order);
  if (!run.ok()) out.trouble = run.reason;
  if (!run.ok() && run.statistics.steps == 0 && mesh.has_massless_elements())
    out.trouble =
        "Elements of the field have no inertia, and do not follow what they carry by forces that are linear in them: "
        "nothing tells how they move. Give them their mass, 1/2 ρ u'^2.";
  out.final_coordinates = final_coordinates(mesh, p.model.system, run.final);
  const std::vector<std::string>& departures = mesh.departures();
  for (const Happening& h : run.happenings)
    if (std::find(departures.begin(), departures.end(), h.name) == departures.end())
      out.happenings.push_back(in_coordinates_of(h, mesh, p.model.system));
    else
      out.trouble = h.name;
  out.first_mode = run.first_mode;
  out.books = run.books;
  out.remarks = run.remarks;
  if (p.options.trajectory) {
    out.places = shown_places(mesh);
    out.trajectory = Rows(mesh, p.model, p.equations, out.places).of(run);
  }
  return out;
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
  CoupledProblem problem{model, equations, questions, options};
  problem.cells = s.space.front().cells ? s.space.front().cells : usual_coupled_cells;
  problem.order = s.element_order ? s.element_order : usual_coupled_order;
  const auto mesh = mesh_for(problem, diagnostics);
  if (!mesh) return std::nullopt;
  look_at_breaks(problem, *mesh, diagnostics);
  const auto fine = run_once(*mesh, questions, problem.width, options, diagnostics);
  if (!fine) return std::nullopt;
  tell_moved_starts(mesh->moved_starts(fine->result.start), equations, diagnostics);
  FieldRunResult out = result_of(*fine, *mesh, problem);
  const std::vector<double> errors = coupled_errors(*fine, *mesh, problem, out.happenings, out.trouble.empty());
  for (std::size_t i = 0; i < questions.size(); ++i) out.answers.push_back({fine->answers[i], errors[i]});
  if (out.happenings.empty()) warn_of_drift(out, equations, diagnostics);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

}  // namespace maupertuis
