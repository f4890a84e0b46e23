#pragma once
#include "kernel/program/program.hpp"

#include <vector>

/// What is done to the sums of a program before its instructions become packs. d/dt becomes a shift of an index.
/// Running sums s_i = s_{i−1} + x_i are found, along a chain for instance. Other sums are written out in the sums that
/// read them,
///
///     s = a + b,  t = s + c,  u = s − d      →      t = a + b + c,  u = a + b − d
///
/// so that fewer wait for each other; what nothing reads any more is dropped.
namespace maupertuis::packed {

/// An instruction with terms of its own.
struct Step {
  Instruction head;
  std::vector<Term> linear, products;  // Function: its differential is in `products`; Select: its choices in `linear`
  /// The running sum that it is a member of; −1: none. The first linear term of a member is the member before it; that
  /// of the first member is the leaf 1 times 0.
  int chain = -1;
};

/// The instructions of section Dynamics, in order.
std::vector<Step> dynamics_of(const Program& program);

/// Finds running sums of at least `least` members and numbers them, as the positions along a chain are,
///
///     s_1 = x_1,   s_2 = s_1 + x_2,   s_3 = s_2 + x_3, …
///
/// where no x_i depends on one of the s. Precondition: write_derivatives() has been called. The coefficient 0 is
/// appended to the program's constants.
void find_chains(Program& program, std::vector<Step>& steps, std::size_t least);

/// d/dt becomes a linear term with a shift.
void write_derivatives(Program& program, std::vector<Step>& steps);

/// Where a sum has another sum among its terms, puts the terms of that one in its place (see above): the two need not
/// be computed one after the other then. Sums that nothing reads any more are dropped. A sum gets at most `longest`
/// terms that way. New coefficients are appended to the program's constants.
void collapse_sums(Program& program, std::vector<Step>& steps, std::size_t longest);

/// The coefficients of products go to factors that are sums and read nowhere else, whose slots then hold other values
/// than those of the program as it was.
void scale_factors(Program& program, std::vector<Step>& steps);

/// Whether the program selects nothing: then all that it computes is finite, or nothing is to be trusted, so that any
/// of it may be multiplied by 0.
bool has_no_choices(const Program& program);

/// Calls f(slot, shift) for each operand whose value of the same time is needed.
template <class F>
void for_operands(const Step& step, F&& f) {
  if (step.head.a != no_slot) f(step.head.a, 0);
  if (step.head.b != no_slot) f(step.head.b, 0);
  for (const Term& term : step.linear) f(term.a, static_cast<int>(term.shift));
  for (const Term& term : step.products) {
    if (step.head.op != Op::Function) f(term.a, 0);
    f(term.b, 0);
  }
}

}  // namespace maupertuis::packed
