#include "kernel/program/lowering.hpp"
#include "kernel/program/program.hpp"
#include "kernel/program/winding.hpp"
#include "machine_code/processor.hpp"

#include <maupertuis/arguments.hpp>

#include <algorithm>

namespace maupertuis {
namespace {

using lowering::Lowering;
using lowering::NodeIndex;
using lowering::Outputs;

Outputs lower_outputs(Lowering& lowering, const KernelSource& source) {
  std::vector<Expr> roots, values, rates, rows;
  for (const KernelConstraint& c : source.constraints) {
    rates.push_back(c.level == 0 ? c.value.context().time_derivative(c.value) : c.value);
    rows.push_back(-c.value.context().time_derivative(rates.back()));
    values.push_back(c.value);
  }
  using Roots = const std::vector<Expr>;
  for (Roots* list : std::initializer_list<Roots*>{&source.residual, &rows, &values, &rates, &source.events,
                                                   &source.integrands, &source.observables})
    roots.insert(roots.end(), list->begin(), list->end());
  const std::size_t followed = roots.size() - source.observables.size();  // between points of the motion too
  lowering.let_angles_jump({roots.data(), followed});
  const std::vector<NodeIndex> nodes = lowering.lower(roots);
  auto next = nodes.begin();
  const auto take = [&](std::size_t count) {
    std::vector<NodeIndex> part(next, next + static_cast<std::ptrdiff_t>(count));
    next += static_cast<std::ptrdiff_t>(count);
    return part;
  };
  Outputs outputs;
  outputs.residual = take(source.residual.size() + rows.size());
  outputs.constraint_values = take(values.size());
  outputs.constraint_rates = take(rates.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    if (source.constraints[i].level != 0) outputs.constraint_values[i] = lowering::no_node;
  outputs.events = take(source.events.size());
  outputs.integrands = take(source.integrands.size());
  outputs.observables = take(source.observables.size());
  outputs.switches = lowering.switch_nodes;
  return outputs;
}

void fuse_sums(Lowering& lowering, const Outputs& outputs) {
  std::vector<NodeIndex> roots;
  for (const auto* list : {&outputs.residual, &outputs.constraint_values, &outputs.constraint_rates, &outputs.events,
                           &outputs.integrands, &outputs.observables, &outputs.switches})
    roots.insert(roots.end(), list->begin(), list->end());
  lowering::fuse(lowering.graph, roots);
}

}  // namespace

Kernel build_kernel(const KernelSource& source) {
  check_argument(source.residual.size() == source.coordinates.size(),
                 "build_kernel: the source has another number of residuals than of coordinates");
  check_argument(source.multipliers.size() == source.constraints.size(),
                 "build_kernel: the source has another number of multipliers than of constraints");
  for (const auto* list : {&source.coordinates, &source.parameters, &source.residual, &source.multipliers,
                           &source.observables, &source.events, &source.integrands})
    check_argument(std::all_of(list->begin(), list->end(), [](const Expr& e) { return static_cast<bool>(e); }),
                   "build_kernel: an expression of the source is empty");
  auto program = std::make_shared<Program>();
  Lowering lowering(source);
  const Outputs outputs = lower_outputs(lowering, source);
  fuse_sums(lowering, outputs);
  lowering::schedule(lowering.graph, outputs, *program);

  program->constants = std::move(lowering.graph.constants.constants);
  program->constant_arguments = std::move(lowering.graph.constants.arguments);
  program->literals = std::move(lowering.graph.constants.literals);
  program->freedoms = source.coordinates.size();
  program->unknowns = source.coordinates.size() + source.multipliers.size();
  for (const KernelConstraint& c : source.constraints) program->constraint_names.push_back(c.name);
  program->parameters = source.parameters.size();
  program->switches = std::move(lowering.switches);
  for (const Expr& q : source.coordinates) program->coordinate_names.push_back(q.name());
  for (const Expr& p : source.parameters) program->parameter_names.push_back(p.name());
  program->winding = winding_of(*program);
  return Kernel(std::move(program));
}

std::size_t Kernel::freedoms() const { return program_->freedoms; }
std::size_t Kernel::constraints() const { return program_->unknowns - program_->freedoms; }
std::size_t Kernel::parameters() const { return program_->parameters; }
std::size_t Kernel::observables() const { return program_->observables.size(); }
std::size_t Kernel::events() const { return program_->events.size(); }
std::size_t Kernel::integrands() const { return program_->integrands.size(); }
std::span<const SwitchFunction> Kernel::switches() const { return program_->switches; }
const Winding& winding(const Kernel& kernel) { return kernel.program().winding; }
const std::string& Kernel::coordinate_name(std::size_t index) const { return program_->coordinate_names.at(index); }
const std::string& Kernel::constraint_name(std::size_t index) const { return program_->constraint_names.at(index); }
/// Code saves about the same time with each instruction of each step, and takes a time to compile that grows with their
/// number, beside what LLVM takes to begin (docs/design/kernel_speed.md, "Default runs").
double Kernel::steps_that_repay_code() const {
  constexpr double to_begin = 20e-3, to_compile = 0.14e-3;  // s, and s an instruction
  const double saved = vector_instructions() == VectorInstructions::Avx512 ? 22e-9 : 105e-9;
  const auto instructions = static_cast<double>(std::max<std::size_t>(1, program_->instructions.size()));
  return (to_begin / instructions + to_compile) / saved;
}

std::string Kernel::print() const { return maupertuis::print(*program_); }

}  // namespace maupertuis
