#include "kernel/program/winding.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

namespace maupertuis {
namespace {

/// Beyond it a multiple would lose the digits that winding back keeps; products of two stay far within an int.
constexpr int most_turns = 1 << 10;

/// What a slot gains, in units of 2π, when coordinates make a turn. Derivatives gain nothing.
class Windings {
 public:
  explicit Windings(const Program& program) : program_(program), gains_(program.slots) {
    result_.coordinates.assign(program.freedoms, true);
    for (std::uint32_t i = 0; i < program.freedoms; ++i) gains_[i] = {{i, 1}};
  }

  Winding run() {
    for (const Instruction& i : program_.instructions) pass(i);
    for (const auto* outputs : {&program_.residual, &program_.constraint_values, &program_.constraint_rates,
                                &program_.switch_slots, &program_.events, &program_.integrands})
      for (const Slot slot : *outputs)
        if (slot != no_slot) refuse(slot);
    for (const Slot slot : program_.observables) result_.observables.push_back(gains_[slot]);
    for (auto& gains : result_.observables)
      gains.erase(std::remove_if(gains.begin(), gains.end(),
                                 [&](const TurnGain& g) { return !result_.coordinates[g.coordinate]; }),
                  gains.end());
    return std::move(result_);
  }

 private:
  void pass(const Instruction& i) {
    switch (i.op) {
      case Op::SinCos:
      case Op::Derivative:
        return;
      case Op::Linear:
      case Op::Products:
        return sum(i);
      case Op::One:
      case Op::Time:
      case Op::Coordinate:
      case Op::Companion:
      case Op::Square:
      case Op::Quotient:
      case Op::SquareRoot:
      case Op::Power:
      case Op::SinhCosh:
      case Op::Function:
      case Op::Select:
        break;
    }
    for (const Slot operand : {i.a, i.b})
      if (operand != no_slot) refuse(operand);
    // Of a differential w du only w; of a choice every value.
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) refuse(program_.terms[t].a);
  }

  void sum(const Instruction& i) {
    for (std::uint32_t t = i.first_term; t < i.first_product; ++t)
      if (const Term& term = program_.terms[t]; term.shift == 0) add(gains_[i.out], term);
    for (std::uint32_t t = i.first_product; t < i.last_term; ++t)
      refuse(program_.terms[t].a), refuse(program_.terms[t].b);
  }

  void add(std::vector<TurnGain>& to, const Term& term) {
    if (gains_[term.a].empty()) return;
    const std::optional<int> factor = whole(term.coefficient);
    if (!factor) return refuse(term.a);
    for (const TurnGain& gain : gains_[term.a]) {
      const auto same =
          std::find_if(to.begin(), to.end(), [&](const TurnGain& g) { return g.coordinate == gain.coordinate; });
      if (same == to.end())
        to.push_back({gain.coordinate, *factor * gain.turns});
      else
        same->turns += *factor * gain.turns;
    }
    if (std::any_of(to.begin(), to.end(), [](const TurnGain& g) { return std::abs(g.turns) > most_turns; }))
      refuse(term.a);
    to.erase(std::remove_if(to.begin(), to.end(), [](const TurnGain& g) { return g.turns == 0; }), to.end());
  }

  std::optional<int> whole(ConstantId id) const {
    const Constant& constant = program_.constants[id];
    if (constant.kind != Kind::Number) return std::nullopt;
    const double value = program_.literals[constant.index].to_double();
    if (std::abs(value) > most_turns || value != std::trunc(value)) return std::nullopt;
    return static_cast<int>(value);
  }

  void refuse(Slot slot) {
    for (const TurnGain& gain : gains_[slot]) result_.coordinates[gain.coordinate] = false;
  }

  const Program& program_;
  std::vector<std::vector<TurnGain>> gains_;
  Winding result_;
};

}  // namespace

Winding winding_of(const Program& program) { return Windings(program).run(); }

}  // namespace maupertuis
