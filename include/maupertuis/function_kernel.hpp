#pragma once
#include <maupertuis/expression.hpp>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

/// Values of functions at points, in double: what a method needs that does not expand the motion in powers of time.
///
///     FunctionKernel kernel = build_function({.inputs = {q, v}, .parameters = {k}, .outputs = {k * q, v * v}});
///     FunctionWorkspace work(kernel);
///     work.set_parameters(values);
///     work.evaluate(point, out);
///
/// docs/design/function_kernel.md tells how; nothing here knows mechanics.
namespace maupertuis {

struct FunctionSource {
  std::vector<Expr> inputs;      // symbols that change from call to call
  std::vector<Expr> parameters;  // symbols that stay as set
  std::vector<Expr> outputs;     // no TimeDerivative nodes; no symbols but those above
};

struct FunctionProgram;

/// An immutable straight-line program; cheap to copy, safe to share between threads.
class FunctionKernel {
 public:
  FunctionKernel();  // without inputs and outputs
  explicit FunctionKernel(std::shared_ptr<const FunctionProgram> program) : program_(std::move(program)) {}

  std::size_t inputs() const;
  std::size_t parameters() const;
  std::size_t outputs() const;
  /// Instructions of a call, those of parameters alone not counted.
  std::size_t size() const;
  /// Whether any output depends on this input.
  bool uses(std::size_t input) const;

  const FunctionProgram& program() const { return *program_; }

 private:
  std::shared_ptr<const FunctionProgram> program_;
};

/// Lowers expressions: equal sub-expressions are computed once, those of parameters alone once for all calls. Functions
/// with switches are evaluated as they stand (sign(0) = 0, step(0) = 1). Cost about linear in the number of nodes.
/// Throws std::logic_error for a symbol that the source does not list and for a TimeDerivative node.
FunctionKernel build_function(const FunctionSource& source);

/// Everything that a call changes. One thread at a time; as many as wanted for one kernel.
class FunctionWorkspace {
 public:
  explicit FunctionWorkspace(const FunctionKernel& kernel);

  /// Precondition: values.size() == kernel.parameters().
  void set_parameters(std::span<const double> values);
  /// NaN or infinity where a function has no value. Nothing is allocated.
  /// Precondition: inputs.size() == kernel.inputs(), outputs.size() == kernel.outputs().
  void evaluate(std::span<const double> inputs, std::span<double> outputs);

 private:
  FunctionKernel kernel_;
  std::vector<double> slots_;
};

/// ∂ value[row] / ∂ input[column], where it does not vanish identically.
struct JacobianEntry {
  std::size_t row = 0, column = 0;
};

/// A vector function and its derivatives by inputs, exact and sparse: the entries follow the values in one program.
struct DifferentiableKernel {
  FunctionKernel values;              // outputs: the values alone
  FunctionKernel values_and_entries;  // outputs: the values, then one a JacobianEntry
  std::vector<JacobianEntry> entries;
  std::size_t size() const { return values.outputs(); }
};

/// Derivatives by reverse mode, one sweep a value; of inputs [first, last) alone, or of all.
DifferentiableKernel build_differentiable(const FunctionSource& source);
DifferentiableKernel build_differentiable(const FunctionSource& source, std::size_t first, std::size_t last);

}  // namespace maupertuis
