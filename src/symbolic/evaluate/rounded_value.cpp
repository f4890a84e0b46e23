#include <maupertuis/require.hpp>
#include <maupertuis/rounded_value.hpp>

#include "symbolic/evaluate/real100.hpp"
#include "symbolic/evaluate/real_numbers.hpp"

namespace maupertuis {

double rounded_value(Expr e, const Bindings& bindings) {
  using evaluation::Real100;
  const evaluation::Tape tape({&e, 1});
  const auto value_of = [&](Expr symbol) {
    const auto found = bindings.find(symbol);
    MAUP_REQUIRE(found != bindings.end() && "every symbol must be bound");
    return Real100(found->second);
  };
  evaluation::RealNumbers<Real100> numbers(value_of);
  std::vector<Real100> values;
  evaluation::run(tape, numbers, values);
  return static_cast<double>(values[tape.roots().front()]);
}

}  // namespace maupertuis
