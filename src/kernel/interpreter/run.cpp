#include "kernel/interpreter/run_code.hpp"

namespace maupertuis::interpreter {

template void run_instruction(Memory&, std::uint32_t, int);
template void run_instructions(Memory&, const Run&, int);
template void run_section(Memory&, Section, int);

}  // namespace maupertuis::interpreter
