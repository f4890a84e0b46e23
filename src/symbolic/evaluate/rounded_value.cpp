#include <maupertuis/require.hpp>
#include <maupertuis/rounded_value.hpp>

#include "symbolic/evaluate/real100.hpp"
#include "symbolic/evaluate/real_numbers.hpp"

namespace maupertuis {

std::vector<double> rounded_values(std::span<const Expr> roots, const std::function<double(Expr)>& value_of) {
  using evaluation::Real100;
  const evaluation::Tape tape(roots);
  evaluation::RealNumbers<Real100> numbers([&](Expr symbol) { return Real100(value_of(symbol)); });
  std::vector<Real100> values;
  evaluation::run(tape, numbers, values);
  std::vector<double> out;
  for (const evaluation::Position root : tape.roots()) out.push_back(static_cast<double>(values[root]));
  return out;
}

double rounded_value(Expr e, const Bindings& bindings) {
  return rounded_values({&e, 1},
                        [&](Expr symbol) {
                          const auto found = bindings.find(symbol);
                          MAUP_REQUIRE(found != bindings.end() && "every symbol must be bound");
                          return found->second;
                        })
      .front();
}

}  // namespace maupertuis
