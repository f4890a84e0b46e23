#include "disks/degrees.hpp"

#include <algorithm>

namespace maupertuis {
namespace {

int product(int a, int b) { return std::min(not_polynomial, a + b); }

/// Of dʳa/dtʳ.
int derivative(int degree, std::uint32_t times) {
  return degree == not_polynomial ? degree : std::max(0, degree - static_cast<int>(times));
}

int of_terms(const Program& program, const Instruction& i, const std::vector<int>& degrees) {
  int out = 0;
  for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
    const Term& term = program.terms[t];
    const bool multiplies = i.op == Op::Products && t >= i.first_product;
    out =
        std::max(out, multiplies ? product(degrees[term.a], degrees[term.b]) : derivative(degrees[term.a], term.shift));
  }
  return out;
}

}  // namespace

std::vector<int> degrees_in_time(const Program& program, int of_coordinates) {
  std::vector<int> out(program.slots, 0);
  std::fill_n(out.begin(), program.unknowns, of_coordinates);
  if (program.time != no_slot) out[program.time] = 1;
  for (const Section section : {Dynamics, Along})
    for (const Run& run : program.runs[section])
      for (std::uint32_t at = run.first; at < run.last; ++at) {
        const Instruction& i = program.instructions[at];
        int degree = not_polynomial;
        if (i.op == Op::Linear || i.op == Op::Products || i.op == Op::Select) degree = of_terms(program, i, out);
        if (i.op == Op::Square) degree = product(out[i.a], out[i.a]);
        if (i.op == Op::Derivative) degree = derivative(out[i.a], 1);
        out[i.out] = degree;
        if (i.second != no_slot) out[i.second] = not_polynomial;
      }
  return out;
}

bool moves_on_parabolas(const Program& program) {
  const std::vector<int> degrees = degrees_in_time(program, 2);
  return std::all_of(program.residual.begin(), program.residual.end(),
                     [&](Slot slot) { return slot == no_slot || degrees[slot] == 0; });
}

}  // namespace maupertuis
