#include "symbolic/evaluate/real100.hpp"
#include "symbolic/evaluate/real_numbers.hpp"
#include "symbolic/evaluate/witness.hpp"

namespace maupertuis::evaluation {

std::optional<Witness> find_precise_witness(const Tape& tape, int points, std::uint64_t seed) {
  using Range = Interval<Real100>;
  std::vector<Range> values;
  for (int trial = 0; trial < points; ++trial) {
    const Bindings point = random_real_point(tape, trial, seed);
    RealNumbers<Range> numbers([&](Expr symbol) { const Real100 x = point.at(symbol); return Range{x, x}; });
    run(tape, numbers, values);
    for (std::size_t i = 0; i < tape.roots().size(); ++i) {
      const Range& v = values[tape.roots()[i]];
      if (!v.is_nan() && !v.contains_zero() && isfinite(v.low) && isfinite(v.high))
        return Witness{point, static_cast<double>(Real100((v.low + v.high) / 2)), i};
    }
  }
  return std::nullopt;
}

}  // namespace maupertuis::evaluation
