#include "kernel/reference/run_code.hpp"

namespace maupertuis::reference {

void throw_unknown(Op op) { throw unknown_op(op, "the interpreter"); }

template void run_instruction(Memory&, std::uint32_t, int);
template void run_instructions(Memory&, const Run&, int);
template void run_section(Memory&, Section, int);

}  // namespace maupertuis::reference
