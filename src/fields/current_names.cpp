#include <maupertuis/evaluate.hpp>
#include <maupertuis/print.hpp>

#include "fields/noether_ansatz.hpp"
#include "symbolic/evaluate/field_numbers.hpp"
#include "symbolic/evaluate/normalize.hpp"

#include <fmt/format.h>

#include <algorithm>

/// What the currents of Noether's theorem are called.
namespace maupertuis {

bool is_nowhere_positive(const FieldEquations& equations, Expr e) {
  const FieldSystem& s = equations.system();
  Bindings values;
  for (const Parameter& p : equations.model->parameters) values[p.symbol] = p.si_value;
  const Expr root = s.expanded(e);
  std::uint64_t seed = 1;
  bool negative = false;
  constexpr int points = 24;
  for (int point = 0; point < points; ++point) {
    for (const Expr& symbol : symbols_of({&root, 1}))
      if (s.jet_of(symbol) || symbol.role() == Role::Time ||
          std::any_of(s.space.begin(), s.space.end(), [&](const SpaceVariable& x) { return x.symbol == symbol; }))
        seed = evaluation::mix(seed), values[symbol] = static_cast<double>(seed % 2001) / 1000 - 1;
    const double value = evaluate(root, values);
    if (!(value <= 0)) return false;
    negative = negative || value < 0;
  }
  return negative;
}

namespace {

/// Whether two shifts turn two fields into each other: φ_b in η_a and φ_a in η_b.
bool turn_into_each_other(const FieldEquations& equations, const Generator& one, const Generator& other) {
  const FieldSystem& s = equations.system();
  const auto one_of = s.jet_of(one.factor), other_of = s.jet_of(other.factor);
  return one_of && other_of && one_of->field == equations.varied[other.index] &&
         other_of->field == equations.varied[one.index];
}

}  // namespace

NamedCurrent name_of(const FieldEquations& equations, const std::vector<const Generator*>& parts) {
  const FieldSystem& s = equations.system();
  const std::size_t n = s.space.size();
  const auto variable = [&](std::size_t mu) { return mu == n ? std::string("t") : s.space[mu].name; };
  const auto field = [&](std::size_t a) { return s.fields[equations.varied[a]].name; };
  std::vector<const Generator*> motions, shifts;
  for (const Generator* g : parts) (g->moves_space ? motions : shifts).push_back(g);
  if (motions.size() == 1 && motions[0]->factor.is_one() && shifts.empty())
    return motions[0]->index == n ? NamedCurrent{"energy", "translations in time"}
                                  : NamedCurrent{"momentum along " + variable(motions[0]->index),
                                                 "translations along " + variable(motions[0]->index), true};
  if (motions.size() == 2) {
    const std::size_t a = motions[0]->index, b = motions[1]->index;
    if (a < n && b < n)
      return {"angular momentum", fmt::format("rotations in the plane of {} and {}", variable(a), variable(b))};
    const auto moves_by = [&](std::size_t mu) { return mu == n ? s.context->time() : s.space[mu].symbol; };
    if (a != b && motions[0]->factor == moves_by(b) && motions[1]->factor == moves_by(a))
      return {"boost along " + variable(std::min(a, b)), "motions at constant speed"};
  }
  if (motions.size() == 1 && motions[0]->index < n && motions[0]->factor.role() == Role::Time &&
      motions[0]->factor.is_symbol())
    return {"boost along " + variable(motions[0]->index), "motions at constant speed"};
  if (!motions.empty() && motions.size() >= n) return {"dilation", "a change of scale"};
  const bool of_places =
      std::all_of(shifts.begin(), shifts.end(), [&](const Generator* g) { return s.jets_in(g->factor).empty(); });
  if (motions.empty() && of_places) {
    NamedCurrent out{"shift of ", ""};
    for (const Generator* g : shifts) {
      const bool first = g == shifts.front();
      out.name += (first ? "" : " and ") + field(g->index);
      out.meaning += (first ? "" : ", ") + field(g->index) + " + ε" +
                     (g->factor.is_one() ? std::string() : " " + to_plain(lay_out(g->factor, equations.order)));
    }
    if (shifts.size() > 1) out.meaning = "together: " + out.meaning + ", each times a factor that Q shows";
    return out;
  }
  if (motions.empty() && shifts.size() == 2 && turn_into_each_other(equations, *shifts[0], *shifts[1]))
    return {"charge",
            fmt::format("rotations of {} and {} into each other", field(shifts[0]->index), field(shifts[1]->index))};
  if (motions.empty()) return {"inner symmetry", "changes of the fields alone"};
  return {"symmetry", "motions of space and time with a change of the fields"};
}

}  // namespace maupertuis
