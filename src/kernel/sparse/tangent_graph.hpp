#pragma once
#include "kernel/program/program.hpp"
#include "kernel/series/rules.hpp"

#include <vector>

/// Directional derivatives of order 0 are linear: ∂(slot)/∂q^(ℓ) is a sum over the operands of equal lag, each with a
/// factor that the coefficients of order 0 give. The factors are the edges of a graph that leads from q̈ to the
/// residual.
namespace maupertuis::sparse {

using series::chosen;

/// What the factor of an edge is made of. x and y are values at order 0, c a coefficient of a term.
enum class Rule : std::uint8_t {
  One,             // 1
  Coefficient,     // c
  Scaled,          // c x
  Value,           // x
  Negative,        // −x
  Double,          // 2 x
  Reciprocal,      // 1/x
  HalfReciprocal,  // 1/(2 x)
  Ratio,           // −y/x
  PowerSlope,      // p y/x with the constant p
  Choice,          // 1 if a Select takes this term, else 0
};

struct Edge {
  Rule rule = Rule::One;
  Slot out = no_slot, operand = no_slot;
  std::uint32_t index = 0;        // of the constant c or p; Choice: of the term
  Slot x = no_slot, y = no_slot;  // Choice: first and last term
};

/// Every edge of section Dynamics, in the order of the instructions; those of one result stand together.
std::vector<Edge> tangent_edges(const Program& program);
/// Of one instruction.
std::vector<Edge> tangent_edges(const Program& program, const Instruction& instruction);
/// Those through which q̈ has an influence on slots that are needed. [slots]
std::vector<Edge> edges_to(const Program& program, std::vector<bool> needed);
/// Those that M₀ goes through.
std::vector<Edge> edges_of_mass(const Program& program);

/// Whether the residual of every unknown i follows q̈_j where that of j follows q̈_i. Elsewhere M₀ is not symmetric
/// however small the entries are that have no counterpart: those of a motion with its tangents beside it are as small
/// as the tangents, and yet all that these know of the motion. Cost: edges × unknowns / 64.
bool has_symmetric_pattern(const Program& program);

/// Whether it depends on parameters and sides of switches alone.
inline bool is_constant(Rule rule) { return rule == Rule::One || rule == Rule::Coefficient || rule == Rule::Choice; }

template <class T>
T constant_factor(const Edge& edge, const Term* terms, const T* constants) {
  if (edge.rule == Rule::One) return T(1);
  if (edge.rule == Rule::Coefficient) return constants[edge.index];
  // Choice: the first term whose condition holds is taken, the last one if none does.
  T taken = T(1);
  if (edge.index + 1 < edge.y) taken = chosen(constants[terms[edge.index].coefficient], T(1), T(0));
  for (std::uint32_t t = edge.x; t < edge.index; ++t) taken = chosen(constants[terms[t].coefficient], T(0), taken);
  return taken;
}

/// Of any edge. `now`: [slots] values at order 0.
template <class T>
T factor_at(const Edge& edge, const Term* terms, const T* constants, const T* now) {
  switch (edge.rule) {
    case Rule::Scaled:
      return constants[edge.index] * now[edge.x];
    case Rule::Value:
      return now[edge.x];
    case Rule::Negative:
      return -now[edge.x];
    case Rule::Double:
      return now[edge.x] + now[edge.x];
    case Rule::Reciprocal:
      return T(1) / now[edge.x];
    case Rule::HalfReciprocal:
      return T(0.5) / now[edge.x];
    case Rule::Ratio:
      return -now[edge.y] / now[edge.x];
    case Rule::PowerSlope:
      return constants[edge.index] * now[edge.y] / now[edge.x];
    case Rule::One:
    case Rule::Coefficient:
    case Rule::Choice:
      break;
  }
  return constant_factor(edge, terms, constants);
}

}  // namespace maupertuis::sparse
