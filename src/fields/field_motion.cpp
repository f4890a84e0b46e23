#include "fields/field_motion.hpp"

#include "fields/careful_sum.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/repeated_evaluation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace maupertuis {

double FieldMotion::value_of(Expr e, const Bindings& extra) const {
  Bindings all = values_;
  all.insert(extra.begin(), extra.end());
  return evaluate(s_.expanded(e), all);
}

std::size_t FieldMotion::varied(std::size_t field) const {
  std::size_t a = 0;
  while (a < equations_.varied.size() && equations_.varied[a] != field) ++a;
  return a;
}

double FieldMotion::answer_at_places(Expr value, double shift) const {
  Bindings extra{{s_.context->time(), t_}};
  const Expr answer[] = {value};
  const std::vector<Expr> symbols = symbols_of(answer);
  for (const PlaceValue& place : equations_.model->places) {
    if (std::find(symbols.begin(), symbols.end(), place.symbol) == symbols.end()) continue;
    const FieldJet jet = *s_.jet_of(place.jet);
    const std::size_t a = varied(jet.field);
    if (a == equations_.varied.size() || place.side != 0) {
      extra[place.symbol] = std::nan("");
      continue;
    }
    std::vector<double> at;
    for (const Expr& x : place.place) at.push_back(value_of(x, {}));
    const SpaceVariable& x = s_.space.front();
    if (shift != 0) at[0] = std::clamp(at[0] + shift, value_of(x.from, {}), value_of(x.to, {}));
    extra[place.symbol] = field_at(a, jet, at);
  }
  return value_of(value, extra);
}

double FieldMotion::answer(const FieldQuestion& question) {
  if (!question.total) return answer_at_places(question.value);
  const Expr root[] = {s_.expanded(question.value)};
  const RepeatedEvaluation at(root);
  std::unordered_map<Expr, std::size_t, ExprHash> inputs;
  for (std::size_t i = 0; i < point_inputs().size(); ++i) inputs[point_inputs()[i]] = i;
  CarefulSum sum;
  visit_points([&](double weight, const double* values) {
    sum.add(weight * at([&](Expr symbol) {
                       if (const auto i = inputs.find(symbol); i != inputs.end()) return values[i->second];
                       return s_.jet_of(symbol) ? std::nan("") : values_.at(symbol);
                     }).front());
  });
  return sum.value();
}

/// Of one space variable: its two ends.
void FieldMotion::visit_sides(const std::vector<Expr>& jets, const SideVisitor& visit) {
  std::vector<double> values(jets.size() + 2);
  for (const bool far : {false, true}) {
    const SpaceVariable& x = s_.space.front();
    const double place = value_of(far ? x.to : x.from, {});
    for (std::size_t i = 0; i < jets.size(); ++i) {
      const FieldJet jet = *s_.jet_of(jets[i]);
      const std::size_t a = varied(jet.field);
      values[i] = a < equations_.varied.size() ? field_at(a, jet, {place}) : std::nan("");
    }
    values[jets.size()] = place, values[jets.size() + 1] = t_;
    visit({0, far, 1}, values.data());
  }
}

void FieldMotion::add_row(Trajectory& rows, const std::vector<std::vector<double>>& places) const {
  const bool first = rows.columns.empty(), plane = places.size() == 2;
  rows.times.push_back(t_);
  for (std::size_t a = 0; a < equations_.varied.size(); ++a)
    for (int order = 0; order < 2; ++order) {
      const FieldJet jet{equations_.varied[a], std::vector<int>(places.size(), 0), order};
      for (std::size_t j = 0; j < (plane ? places[1].size() : 1); ++j)
        for (const double x : places[0]) {
          const std::vector<double> at = plane ? std::vector<double>{x, places[1][j]} : std::vector<double>{x};
          if (first)
            rows.columns.push_back({plane ? fmt::format("{}({:.10g}, {:.10g})", s_.jet_name(jet), x, at[1])
                                          : fmt::format("{}({:.10g})", s_.jet_name(jet), x),
                                    to_string(s_.dimension_of(jet))});
          rows.values.push_back(field_at(a, jet, at));
        }
    }
}

}  // namespace maupertuis
