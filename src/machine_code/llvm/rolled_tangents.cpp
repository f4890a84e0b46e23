#include "machine_code/llvm/rolled_emitter.hpp"

#include "kernel/packed/code.hpp"

#include <cstddef>

/// Tangents of order 0 in one direction. The highest derivative of q in a slot of lag ℓ enters through operands of lag
/// ℓ alone.
namespace maupertuis::llvm_backend {

using llvm::Value;

void RolledEmitter::tangents() {
  open("tangents", {out_.pointer()});
  Value* const row = out_.b.GetInsertBlock()->getParent()->getArg(1);
  for (const Pack& pack : p_.packs) {
    ++time_;
    tangent(pack, row);
  }
  out_.end_function();
}

void RolledEmitter::tangent(const Pack& pack, Value* row) {
  auto& b = out_.b;
  switch (pack.kind) {
    case Pack::Sum:
      return keep(pack, tangent_products(pack, row, tangent_columns(pack, row)), row);
    case Pack::Scan:
      return keep(pack, carried(pack, running_sum(tangent_columns(pack, row), false), row), row);
    case Pack::ScanDown:
      return keep(pack, carried(pack, running_sum(tangent_columns(pack, row), true), row), row);
    case Pack::Strand:
      return strand(pack, tangent_columns(pack, row));
    case Pack::Join:
      return join(pack, false, row);
    case Pack::JoinDown:
      return join(pack, true, row);
    case Pack::Integral: {
      Value* const factor = plus_scaled(nullptr, pack.coefficients, at_point(pack.b));
      Value* const u = change(pack, pack.a, row);
      return keep(pack, u ? out_.multiply(factor, u) : llvm::Constant::getNullValue(vector_), row);
    }
    case Pack::Quotient: {
      Value *const a = change(pack, pack.a, row), *const d = change(pack, pack.b, row);
      Value* const first = a ? a : llvm::Constant::getNullValue(vector_);
      Value* const rest = d ? out_.subtract(first, out_.multiply(at_point(pack.y), d)) : first;
      return keep(pack, out_.divide(rest, at_point(pack.b)), row);
    }
    case Pack::SquareRoot: {
      Value *const u = change(pack, pack.a, row), *const y = at_point(pack.y);
      return keep(pack, u ? out_.divide(u, out_.add(y, y)) : llvm::Constant::getNullValue(vector_), row);
    }
    case Pack::Scalar:
      break;
  }
  Value* const context = b.CreateLoad(out_.pointer(), at(arguments_, offsetof(packed::CompiledArguments, context)));
  Value* const rule = b.CreateLoad(out_.pointer(), at(arguments_, offsetof(packed::CompiledArguments, tangent)));
  auto* const signature =
      llvm::FunctionType::get(b.getVoidTy(), {out_.pointer(), b.getInt32Ty(), out_.pointer()}, false);
  b.CreateCall(signature, rule, {context, b.getInt32(pack.instruction), row});
}

/// Null: zero.
Value* RolledEmitter::tangent_columns(const Pack& pack, Value* row) {
  Value* result = nullptr;
  for (std::uint32_t c = pack.first_column; c < pack.last_column; ++c)
    if (const Column& column = p_.columns[c]; column.passes_tangent)
      result = plus_scaled(result, column.coefficients, column_values(column, row, true));
  return result;
}

Value* RolledEmitter::tangent_products(const Pack& pack, Value* row, Value* result) {
  for (std::uint32_t i = pack.first_product; i < pack.last_product; ++i) {
    const packed::ProductTerm& term = p_.products[i];
    Value *const a = change(pack, term.a, row), *const d = change(pack, term.b, row);
    Value* sum = a ? out_.multiply(a, at_point(term.b)) : nullptr;
    if (d) sum = plus(sum, at_point(term.a), d);
    if (sum) result = plus_scaled(result, term.coefficients, sum);
  }
  return result ? result : llvm::Constant::getNullValue(vector_);
}

/// The tangents of a block's slots; null where they do not pass.
Value* RolledEmitter::change(const Pack& pack, std::uint32_t index, Value* row) {
  const Block& block = p_.blocks[index];
  if (block.lag != pack.lag) return nullptr;
  Value* const here = block.direct || block.is_range ? in_register(block.slots[0]) : nullptr;
  return here ? here : values_of(block, row);
}

}  // namespace maupertuis::llvm_backend
