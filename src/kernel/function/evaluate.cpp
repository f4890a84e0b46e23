#include <maupertuis/function_kernel.hpp>
#include <maupertuis/require.hpp>

#include "kernel/function/program.hpp"

namespace maupertuis {

FunctionKernel::FunctionKernel() : program_(std::make_shared<const FunctionProgram>()) {}
std::size_t FunctionKernel::inputs() const { return program_->inputs; }
std::size_t FunctionKernel::parameters() const { return program_->parameters; }
std::size_t FunctionKernel::outputs() const { return program_->line.stores.size(); }
std::size_t FunctionKernel::size() const { return program_->size; }
bool FunctionKernel::uses(std::size_t input) const { return program_->used[input]; }

FunctionWorkspace::FunctionWorkspace(const FunctionKernel& kernel)
    : kernel_(kernel), slots_(kernel.program().evaluation.cells().begin(), kernel.program().evaluation.cells().end()) {}

void FunctionWorkspace::set_parameters(std::span<const double> values) {
  MAUP_REQUIRE(values.size() == kernel_.parameters());
  double* const arrays[] = {nullptr, const_cast<double*>(values.data()), nullptr};
  kernel_.program().evaluation.set(slots_.data(), arrays);
}

void FunctionWorkspace::evaluate(std::span<const double> inputs, std::span<double> outputs) {
  MAUP_REQUIRE(inputs.size() == kernel_.inputs() && outputs.size() == kernel_.outputs());
  double* const arrays[] = {const_cast<double*>(inputs.data()), nullptr, outputs.data()};
  kernel_.program().evaluation.run(slots_.data(), arrays);
}

}  // namespace maupertuis
