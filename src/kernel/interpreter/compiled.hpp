#pragma once
#include "kernel/packed/compiled.hpp"
#include "kernel/packed/layout.hpp"

#include <maupertuis/kernel.hpp>

#include <memory>
#include <utility>

namespace maupertuis::interpreter {

/// Machine code for one program, row stride and order; `memory` keeps it there. Either for the whole expansion, or rolled: for one stage.
struct CompiledCode {
  packed::CompiledExpand expand = nullptr;
  packed::CompiledRadius radius = nullptr;
  packed::CompiledIncrements increments = nullptr;
  packed::CompiledFirst first = nullptr;
  packed::CompiledStage stage = nullptr, solve = nullptr, correct = nullptr, ahead = nullptr;
  packed::CompiledLater later = nullptr;
  packed::CompiledTangents tangents = nullptr;
  std::shared_ptr<const void> memory;
};

std::pair<CompiledCode, CompileReport> compile(const packed::PackedProgram& program, int order, std::size_t stride,
                                               const CompileOptions& options);

}  // namespace maupertuis::interpreter
