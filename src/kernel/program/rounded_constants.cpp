#include <maupertuis/require.hpp>
#include <maupertuis/rounded_constants.hpp>

#include "kernel/program/program.hpp"

namespace maupertuis {

Kernel with_rounded_constants(const Kernel& kernel, std::size_t parameter) {
  MAUP_REQUIRE(parameter < kernel.parameters());
  auto program = std::make_shared<Program>(kernel.program());
  program->rounding = static_cast<std::uint32_t>(parameter);
  return Kernel(std::move(program));
}

}  // namespace maupertuis
