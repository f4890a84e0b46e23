#include "field_table.hpp"

#include <fmt/format.h>

#include <maupertuis/evaluate.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis::app {

bool FieldTable::has_formulas_alone(Study& study) const {
  const WrittenColumns formulas = columns_.formulas(study);
  for (const std::string& name : columns_.names()) {
    if (formulas.count(name) != 0) continue;
    study.diagnostics().error("E0811", {}, fmt::format("--columns: `{}` is no formula of values of fields", name),
                              "The columns of a run with fields are formulas of values at places and of coordinates.",
                              "Write for example --columns \"u(3 m), u_x(1 m)\".");
    return false;
  }
  return true;
}

std::vector<FieldQuestion> FieldTable::questions(Study& study, const SimulationOptions& settings, bool rows) {
  if (columns_.empty() || !has_formulas_alone(study)) return {};
  const Model& model = *study.model();
  Bindings values;
  for (const Parameter& p : model.system.parameters) values[p.symbol] = p.si_value;
  const auto number = [&](Expr e) { return e ? evaluate(model.fields->system.expanded(e), values) : 0.0; };
  const double begin = number(model.experiment.start_time),
               duration = settings.duration ? *settings.duration : number(model.experiment.duration),
               end = begin + duration;
  shown_ = settings.at.empty() ? std::vector<double>{end} : settings.at;
  for (const double t : shown_)
    if (!(t >= begin && t <= end))
      study.diagnostics().error("E0809", {}, fmt::format("--at {:g} lies outside of the run.", t),
                                fmt::format("It goes from {:g} s to {:g} s.", begin, end), "Give a moment within it.");
  const double written = settings.output_every ? *settings.output_every : number(model.experiment.output_every);
  const double every = written > 0 ? written : duration / 100;
  constexpr double most_rows = 1e5;
  if (rows && duration / every > most_rows)
    study.diagnostics().error("E0809", {}, "--every asks for more than a hundred thousand rows.",
                              "Each of them is a question to the run.", "Give a longer time between rows.");
  if (study.wrong()) return {};
  for (std::size_t k = 0; rows && begin + static_cast<double>(k) * every <= end + 1e-9 * every; ++k)
    rows_.push_back(std::min(begin + static_cast<double>(k) * every, end));
  std::vector<FieldQuestion> out;
  for (const std::vector<double>* moments : {&shown_, &rows_})
    for (const double t : *moments)
      for (const AskedFormula& one : model.experiment.asked)
        out.push_back({model.fields->system.expanded(one.value), false, t});
  for (const AskedFormula& one : model.experiment.asked) {
    const std::string unit = to_string(one.dimension);
    units_.push_back(model.system.dimensionless || unit == "1" ? "" : unit);
  }
  return out;
}

std::string FieldTable::text(const FieldRunResult& run) const {
  std::string out;
  std::size_t next = 0;
  for (const double t : shown_) {
    out += fmt::format("  at t = {:.10g}\n", t);
    for (std::size_t i = 0; i < columns_.names().size() && next < run.answers.size(); ++i) {
      const FieldRunResult::Value& v = run.answers[next++];
      const std::string unit = units_[i].empty() ? "" : " " + units_[i];
      out += fmt::format("    {:<28} ", columns_.names()[i]);
      out += std::isfinite(v.value) ? fmt::format("{:.16g}{}", v.value, unit) : "no value";
      if (std::isfinite(v.value) && std::isfinite(v.error)) out += fmt::format(" ± {:.2g}", v.error);
      if (v.order > 0) out += fmt::format("   converges by the power {:.1f} of the cells", v.order);
      out += "\n";
    }
  }
  return out;
}

Json FieldTable::json(const FieldRunResult& run) const {
  const auto number = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
  Json out = Json::array();
  std::size_t next = 0;
  for (const double t : shown_) {
    Json one{{"t", t}, {"values", Json::object()}, {"errors", Json::object()}, {"orders", Json::object()}};
    for (std::size_t i = 0; i < columns_.names().size() && next < run.answers.size(); ++i, ++next) {
      one["values"][columns_.names()[i]] = number(run.answers[next].value);
      one["errors"][columns_.names()[i]] = number(run.answers[next].error);
      one["orders"][columns_.names()[i]] = run.answers[next].order > 0 ? Json(run.answers[next].order) : Json(nullptr);
    }
    out.push_back(std::move(one));
  }
  return out;
}

Trajectory FieldTable::rows(const FieldRunResult& run, bool errors) const {
  Trajectory out;
  const std::size_t n = columns_.names().size();
  for (std::size_t i = 0; i < n; ++i) out.columns.push_back({columns_.names()[i], units_[i]});
  for (std::size_t row = 0; row < rows_.size() && (shown_.size() + row + 1) * n <= run.answers.size(); ++row) {
    out.times.push_back(rows_[row]);
    for (std::size_t i = 0; i < n; ++i) {
      const FieldRunResult::Value& v = run.answers[(shown_.size() + row) * n + i];
      out.values.push_back(v.value);
      if (errors) out.errors.push_back(v.error);
    }
  }
  return errors ? with_error_columns(out) : out;
}

}  // namespace maupertuis::app
