#include <maupertuis/function_kernel.hpp>
#include <maupertuis/require.hpp>

#include "kernel/function/program.hpp"
#include "kernel/straight_line/evaluator.hpp"

#include <array>

namespace maupertuis {

FunctionKernel::FunctionKernel() : program_(std::make_shared<const FunctionProgram>()) {}
std::size_t FunctionKernel::inputs() const { return program_->inputs; }
std::size_t FunctionKernel::parameters() const { return program_->parameters; }
std::size_t FunctionKernel::outputs() const { return program_->line.stores.size(); }
std::size_t FunctionKernel::size() const { return program_->size; }
bool FunctionKernel::uses(std::size_t input) const { return program_->used[input]; }

struct FunctionWorkspace::Impl {
  explicit Impl(const FunctionKernel& k) : kernel(k), evaluator(k.program().line, std::array<std::uint32_t, 1>{ParameterArray}) {
    if (kernel.parameters() == 0) set({});
  }
  void set(std::span<const double> values) { evaluator.set(unused, values.data(), unused); }

  static constexpr const double* unused = nullptr;
  FunctionKernel kernel;
  straight::Evaluator evaluator;
};

FunctionWorkspace::FunctionWorkspace(const FunctionKernel& kernel) : impl_(std::make_unique<Impl>(kernel)) {}
FunctionWorkspace::~FunctionWorkspace() = default;
FunctionWorkspace::FunctionWorkspace(const FunctionWorkspace& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
FunctionWorkspace::FunctionWorkspace(FunctionWorkspace&&) noexcept = default;

void FunctionWorkspace::set_parameters(std::span<const double> values) {
  MAUP_REQUIRE(values.size() == impl_->kernel.parameters());
  impl_->set(values);
}

void FunctionWorkspace::evaluate(std::span<const double> inputs, std::span<double> outputs) {
  MAUP_REQUIRE(inputs.size() == impl_->kernel.inputs() && outputs.size() == impl_->kernel.outputs());
  impl_->evaluator(inputs.data(), impl_->unused, outputs.data());
}

}  // namespace maupertuis
