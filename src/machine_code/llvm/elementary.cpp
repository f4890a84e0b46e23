#include "machine_code/llvm/emission.hpp"
#include "machine_code/llvm/emitters.hpp"
#include "machine_code/request.hpp"

#include <maupertuis/functions.hpp>

#include <algorithm>
#include <numeric>

/// Elementary functions, where SLEEF has them, by its deterministic variants: `finz` with fused multiply-adds, `cinz`
/// without. Both give the same bits at every width of vector, so that a wide number is cut into what the processor's
/// registers hold.
namespace maupertuis::llvm_backend {
namespace {

/// The stem of SLEEF's name; empty: it has none.
std::string sleef_name(Kind function) {
  if (function == Kind::Power) return "pow";
  if (function == Kind::Atan2) return "atan2";
  if (is_function(function)) return functions::of_row(function, [](const auto& row) { return std::string(row.sleef); });
  throw Declined("an elementary function that is not compiled");
}

/// Of the processor whose registers hold `width` doubles: "avx512f".
const char* flavour(int width, bool fma) {
  switch (width) {
    case 1:
      return fma ? "purecfma" : "purec";
    case 2:
      return fma ? "avx2128" : "sse2";
    case 4:
      return fma ? "avx2" : "avx";
    default:
      return "avx512f";
  }
}

int width_of(llvm::Type* type) {
  const auto* const vector = llvm::dyn_cast<llvm::FixedVectorType>(type);
  return vector ? static_cast<int>(vector->getNumElements()) : 1;
}

}  // namespace

using llvm::Value;

/// x in pieces of `width` lanes.
std::vector<Value*> Emission::parts(Value* x, int width) {
  const int whole = width_of(x->getType());
  if (whole == width) return {x};
  std::vector<Value*> out;
  for (int first = 0; first < whole; first += width) {
    if (width == 1) {
      out.push_back(b.CreateExtractElement(x, static_cast<std::uint64_t>(first)));
      continue;
    }
    std::vector<int> lanes(static_cast<std::size_t>(width));
    std::iota(lanes.begin(), lanes.end(), first);
    out.push_back(b.CreateShuffleVector(x, lanes));
  }
  return out;
}

Value* Emission::joined(const std::vector<Value*>& pieces) {
  if (pieces.size() == 1) return pieces[0];
  std::vector<int> lanes(2 * static_cast<std::size_t>(width_of(pieces[0]->getType())));
  std::iota(lanes.begin(), lanes.end(), 0);
  std::vector<Value*> halves;
  for (std::size_t i = 0; i < pieces.size(); i += 2)
    halves.push_back(b.CreateShuffleVector(pieces[i], pieces[i + 1], lanes));
  return joined(halves);
}

/// One call. A pair of doubles comes back in registers, a pair of vectors through memory, as the calling convention of
/// C has it.
std::vector<Value*> Emission::call(const std::string& name, int width, const std::vector<Value*>& arguments,
                                   int results) {
  std::vector<llvm::Type*> types(arguments.size(), real(width));
  llvm::Type* const pair = llvm::StructType::get(real(width), real(width));
  const bool by_memory = results == 2 && width > 1;
  if (by_memory) types.insert(types.begin(), pointer());
  llvm::Type* const result = by_memory ? b.getVoidTy() : results == 2 ? pair : real(width);
  llvm::FunctionCallee callee = module->getOrInsertFunction(name, llvm::FunctionType::get(result, types, false));
  auto* const function = llvm::cast<llvm::Function>(callee.getCallee());
  function->addFnAttr(llvm::Attribute::NoUnwind);
  if (!by_memory) {
    llvm::CallInst* const value = b.CreateCall(callee, arguments);
    if (results == 1) return {value};
    return {b.CreateExtractValue(value, 0), b.CreateExtractValue(value, 1)};
  }
  // Room on the stack belongs to the entry, or a loop would take new room each turn.
  llvm::BasicBlock& entry = b.GetInsertBlock()->getParent()->getEntryBlock();
  llvm::IRBuilder<> first(&entry, entry.begin());
  llvm::AllocaInst* const room = first.CreateAlloca(pair);
  room->setAlignment(llvm::Align(64));
  std::vector<Value*> all{room};
  all.insert(all.end(), arguments.begin(), arguments.end());
  llvm::CallInst* const done = b.CreateCall(callee, all);
  done->addParamAttr(0, llvm::Attribute::getWithStructRetType(context, pair));
  return {load(real(width), room), load(real(width), at(room, 8 * width))};
}

std::vector<Value*> Emission::call_wide(const std::string& stem, const std::vector<Value*>& arguments, int results) {
  const int width = std::min(width_of(arguments[0]->getType()), features.vector_width);
  const std::string name = std::string(features.fma ? "Sleef_finz_" : "Sleef_cinz_") + stem + "d" +
                           std::to_string(width) + "_u10" + flavour(width, features.fma);
  std::vector<std::vector<Value*>> pieces;  // [arguments][pieces]
  for (Value* const argument : arguments) pieces.push_back(parts(argument, width));
  std::vector<std::vector<Value*>> out(static_cast<std::size_t>(results));
  for (std::size_t i = 0; i < pieces[0].size(); ++i) {
    std::vector<Value*> now;
    for (const auto& list : pieces) now.push_back(list[i]);
    const std::vector<Value*> values = call(name, width, now, results);
    for (std::size_t r = 0; r < out.size(); ++r) out[r].push_back(values[r]);
  }
  std::vector<Value*> joined_results;
  for (const auto& list : out) joined_results.push_back(joined(list));
  return joined_results;
}

/// Lane by lane, by the program's own function: a name that machine_code resolves.
Value* Emission::call_program(Kind function, Value* x) {
  const std::string name = machine_code::program_function_prefix + std::string(name_of(function));
  std::vector<Value*> values;
  for (Value* const lane : parts(x, 1)) values.push_back(call(name, 1, {lane}, 1)[0]);
  if (values.size() == 1) return values[0];
  Value* out = llvm::PoisonValue::get(x->getType());
  for (std::size_t i = 0; i < values.size(); ++i) out = b.CreateInsertElement(out, values[i], std::uint64_t{i});
  return out;
}

Value* Emission::elementary(Kind function, Value* x, Value* y) {
  const std::string name = sleef_name(function);
  if (name.empty()) return call_program(function, x);
  return call_wide(name, y ? std::vector<Value*>{x, y} : std::vector<Value*>{x}, 1)[0];
}

std::pair<Value*, Value*> Emission::sincos(Value* x) {
  const std::vector<Value*> both = call_wide("sincos", {x}, 2);
  return {both[0], both[1]};
}

}  // namespace maupertuis::llvm_backend
