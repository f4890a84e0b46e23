#pragma once
#include "kernel/packed/code.hpp"
#include "kernel/packed/layout.hpp"

#include <maupertuis/kernel.hpp>

#include <memory>
#include <utility>

namespace maupertuis::workspace {

/// Machine code for one program, row stride and order; `memory` keeps it there. Either for the whole expansion
/// (unrolled), or for one stage (rolled).
struct ExpansionCode {
  packed::CompiledExpand expand = nullptr;
  packed::CompiledRadius radius = nullptr;
  packed::CompiledIncrements increments = nullptr;
  packed::CompiledAccelerations accelerations = nullptr;
  packed::CompiledSizes sizes = nullptr;
  packed::CompiledFirst first = nullptr;
  packed::CompiledStage stage = nullptr, solve = nullptr, correct = nullptr, ahead = nullptr;
  packed::CompiledLater later = nullptr;
  packed::CompiledTangents tangents = nullptr;
  std::shared_ptr<const void> memory;
};

std::pair<ExpansionCode, CompileReport> compile(const packed::PackedProgram& program, int order, std::size_t stride,
                                                const CompileOptions& options);

}  // namespace maupertuis::workspace
