#pragma once
#include <string>

/// Numbers with what is known of them (docs/design/certain_digits.md). An error is a bound, ≥ 0, in the unit of its
/// value: 0 where the value is exact, infinite where no digit of it is certain, NaN where nobody asked.
namespace maupertuis {

/// -5.0034072(1): the digits that are certain, and in parentheses by how much the last of them may be off. The
/// parentheses take in what rounding to these digits changed, so that the value lies within. An exact value has no
/// parentheses: the fewest digits that read back as the same double. Large and small values are written 1.2345(3)e-9;
/// one that does not differ from zero by more than its error is 0(4)e-16. Infinite error: "?". NaN: all 17 digits.
std::string with_uncertainty(double value, double error);

}  // namespace maupertuis
