#pragma once
#include "machine_code/request.hpp"
#include "kernel/straight_line/straight_line.hpp"

#include <cstddef>
#include <stdexcept>
#include <string>

namespace maupertuis::llvm_backend {

class Emission;

/// An emitter does not do this; the sentence says why.
struct Declined : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void emit_self_test(Emission& out, const machine_code::Request& request);
void emit_lanes(Emission& out, const machine_code::Request& request);
void emit_straight_lines(Emission& out, const machine_code::Request& request);
/// A line that is not guarded as one function, however long it is. Its arrays may overlap.
void emit_as_one_function(Emission& out, const straight::StraightLine& line, const std::string& name);
/// What a step does with the rows besides: radius and increments, as the engine's.
void emit_step(Emission& out, std::size_t unknowns, std::size_t stride, int order);
/// Unrolled code where the program is small and runs long, else rolled code.
void emit_packed(Emission& out, const machine_code::Request& request);

}  // namespace maupertuis::llvm_backend
