#include <maupertuis/field_run.hpp>

#include "fields/answer_errors.hpp"
#include "fields/breaks.hpp"
#include "fields/field_run_messages.hpp"
#include "fields/field_sides.hpp"
#include "fields/resolution.hpp"
#include "fields/switching.hpp"
#include "fields/well_posed.hpp"

#include <chrono>

/// The run of a field, and of other meshes that tell how far off it is.
namespace maupertuis {
namespace {

constexpr int usual_cells = 100, usual_cells_of_plane = 32, usual_cells_of_plate = 4;

}  // namespace

std::optional<FieldRunResult> run_fields(const FieldEquations& equations, const std::vector<FieldQuestion>& questions,
                                         const FieldRunOptions& options, Diagnostics& diagnostics) {
  const auto begin = std::chrono::steady_clock::now();
  auto method = FieldMethod::of(equations, diagnostics);
  if (!method || refuse_too_many_conditions(equations, diagnostics)) return std::nullopt;
  if (refuse_ill_posed_start(equations, diagnostics)) return std::nullopt;
  const FieldSystem& s = equations.system();
  Cells cells;
  for (const SpaceVariable& x : s.space) {
    const int usual = s.space.size() == 1 ? usual_cells
                      : method->is_wave() ? usual_cells_of_plane
                                          : usual_cells_of_plate;
    cells.push_back(x.cells ? x.cells : s.space.front().cells ? s.space.front().cells : usual);
  }
  if (refuse_large_mesh(equations, *method, cells, diagnostics)) return std::nullopt;
  announce_memory(options, method->bytes(equations, cells));
  if (refuse_unresolved(equations, even_borders(equations, cells), method->order(), {options.begin, options.duration},
                        diagnostics))
    return std::nullopt;
  if (auto moments = switching_moments(equations, options.begin, options.begin + options.duration))
    method->end_steps_at(std::move(*moments));
  const Rough start = roughness_of(equations, *method, cells, options, diagnostics);
  if (method->is_wave()) {
    const std::vector<double> borders = even_borders(equations, cells).front();
    method->look_beside(borders[1] - borders[0]);
    if (!start.smooth()) method->compare_with(divided(cells, 2), !start.jump);
  }
  std::vector<std::vector<double>> rows;
  if (options.trajectory) rows = places_of_rows(equations, cells, options.least_values);
  if (refuse_too_many_rows(equations, options, rows, diagnostics)) return std::nullopt;
  auto fine = run_on(equations, *method, cells, questions, options, rows, true, diagnostics);
  if (!fine) return std::nullopt;
  FieldRunResult out;
  out.cells = cells.front(), out.order = method->order(), out.method = method->name(), out.nodes = 1;
  if (cells.size() == 2) out.cells_upwards = cells[1];
  for (const int n : cells) out.nodes *= static_cast<std::size_t>(n) * static_cast<std::size_t>(out.order) + 1;
  out.steps = fine->steps, out.step = fine->h, out.omega_max = fine->omega;
  out.energy = fine->energy, out.energy_drift = method->conserves() ? fine->drift : -1;
  warn_of_drift(out, equations, diagnostics);
  out.end = options.begin + options.duration;
  out.trajectory = std::move(fine->trajectory);
  out.at_end = std::move(fine->at_end);
  out.charges = std::move(fine->charges);
  if (!rows.empty()) out.places = rows[0];
  if (rows.size() == 2) out.upwards = rows[1];
  const std::vector<AnswerError> errors =
      errors_of(*fine, equations, *method, cells, questions, options, start, diagnostics);
  for (std::size_t i = 0; i < questions.size(); ++i)
    out.answers.push_back({fine->answers[i], errors[i].size, errors[i].order});
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

}  // namespace maupertuis
