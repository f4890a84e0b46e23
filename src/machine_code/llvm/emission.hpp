#pragma once
#include "machine_code/llvm/target.hpp"

#include <maupertuis/expression.hpp>

#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/Module.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace maupertuis::llvm_backend {

/// What emitters write with: a module, a builder in the function that is open, and the arithmetic that all of them
/// share. Numbers are doubles or vectors of them, as the caller makes them; every operation works lane by lane in the
/// same way at each width, so that the results of a lane do not depend on the width.
class Emission {
 public:
  using Value = llvm::Value;

  Emission(llvm::TargetMachine& machine, const Features& features);

  // -------------------------------------------------------------------------------------------------- types, functions
  llvm::Type* real(int width);  // double, or <width x double>
  llvm::Type* pointer() { return b.getPtrTy(); }
  llvm::Type* integer() { return b.getInt64Ty(); }
  /// Opens a function: exported under its name, or private to the module (never inlined) where `exported` is false. Its
  /// pointers do not alias. `result`: void where it is null.
  llvm::Function* function(const std::string& name, const std::vector<llvm::Type*>& parameters, bool exported = true,
                           llvm::Type* result = nullptr);
  /// Closes it: `ret void`.
  void end_function() { b.CreateRetVoid(); }

  // ------------------------------------------------------------------------------------------------------------ memory
  Value* load(llvm::Type* type, Value* address);
  void store(Value* value, Value* address);
  /// address + offset bytes
  Value* at(Value* address, std::int64_t offset);
  Value* at(Value* address, Value* offset);

  // -------------------------------------------------------------------------------------------------------- arithmetic
  Value* number(double value, llvm::Type* like);
  Value* splat(Value* scalar, llvm::Type* like);
  Value* add(Value* x, Value* y) { return b.CreateFAdd(x, y); }
  Value* subtract(Value* x, Value* y) { return b.CreateFSub(x, y); }
  Value* multiply(Value* x, Value* y) { return b.CreateFMul(x, y); }
  Value* divide(Value* x, Value* y) { return b.CreateFDiv(x, y); }
  Value* negate(Value* x) { return b.CreateFNeg(x); }
  /// x y + z, rounded once where the processor can
  Value* fma(Value* x, Value* y, Value* z);
  Value* square_root(Value* x);
  Value* absolute(Value* x);
  Value* minimum(Value* x, Value* y);  // NaN if one is
  Value* maximum(Value* x, Value* y);
  /// x / y given r = 1/y, rounded: within 0.51 ulp, and without a division
  Value* quotient(Value* x, Value* y, Value* reciprocal);

  /// f(x), or f(x, y) of Atan2 and Power: SLEEF's functions of 1 ulp that give the same results at every width; what
  /// SLEEF lacks is asked of the program lane by lane.
  Value* elementary(Kind function, Value* x, Value* y = nullptr);
  std::pair<Value*, Value*> sincos(Value* x);

  // ------------------------------------------------------------------------------------------------------------- loops
  /// for (i = begin; i < end; ++i) with values carried from turn to turn; returns their last ones. `body` gets i and
  /// the carried values, and returns the next ones.
  std::vector<Value*> loop(Value* begin, Value* end, std::vector<Value*> carried,
                           const std::function<std::vector<Value*>(Value* i, const std::vector<Value*>&)>& body);
  /// if (condition) { body }
  void when(Value* condition, const std::function<void()>& body);

  llvm::LLVMContext context;
  std::unique_ptr<llvm::Module> module;
  llvm::IRBuilder<> b;
  const Features features;

 private:
  std::vector<Value*> parts(Value* x, int width);
  Value* joined(const std::vector<Value*>& parts);
  std::vector<Value*> call(const std::string& name, int width, const std::vector<Value*>& arguments, int results);
  Value* call_program(Kind function, Value* x);
  std::vector<Value*> call_wide(const std::string& stem, const std::vector<Value*>& arguments, int results);
};

}  // namespace maupertuis::llvm_backend
