#include <maupertuis/evaluate.hpp>
#include <maupertuis/require.hpp>

#include "symbolic/evaluate/real_numbers.hpp"

namespace maupertuis {

std::vector<double> evaluate(std::span<const Expr> roots, const Bindings& bindings) {
  const evaluation::Tape tape(roots);
  evaluation::RealNumbers<double> numbers([&](Expr symbol) {
    const auto found = bindings.find(symbol);
    MAUP_REQUIRE(found != bindings.end() && "every symbol must be bound");
    return found->second;
  });
  std::vector<double> values;
  evaluation::run(tape, numbers, values);
  std::vector<double> out;
  out.reserve(roots.size());
  for (const evaluation::Position root : tape.roots()) out.push_back(values[root]);
  return out;
}

double evaluate(Expr e, const Bindings& bindings) { return evaluate({&e, 1}, bindings).front(); }

}  // namespace maupertuis
