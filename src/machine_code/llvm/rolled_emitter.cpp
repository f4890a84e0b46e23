#include "machine_code/llvm/rolled_emitter.hpp"

#include "kernel/packed/code.hpp"

#include <cstddef>

namespace maupertuis::llvm_backend {

using llvm::Value;
using packed::lanes;
using packed::rolled_group;

RolledEmitter::RolledEmitter(Emission& out, const packed::PackedProgram& program, std::size_t stride)
    : out_(out),
      p_(program),
      program_(program.program),
      row_bytes_(8 * static_cast<std::int64_t>(stride)),
      vector_(out.real(static_cast<int>(lanes))) {
  find_convolutions();
  find_passing(false);
}

void RolledEmitter::run(bool long_run) {
  if (long_run) first_stages();
  stage();
  ahead();
  tangents();
  solution();
  correction();
  if (long_run) later();
}

// -------------------------------------------------------------------------------------------------------- convolutions

void RolledEmitter::find_convolutions() {
  for (std::size_t i = 0; i < p_.convolutions.size(); ++i) classes_[class_of(p_.convolutions[i])].push_back(i);
  sums_of_.resize(p_.convolutions.size());
  phase_.resize(p_.convolutions.size(), 0);
  std::size_t place = 0;  // sums of one class lie side by side
  for (const auto& [key, members] : classes_)
    for (const std::size_t i : members) sums_of_[i] = place++;
}

// -------------------------------------------------------------------------------------------------------------- stages

Value* RolledEmitter::field(std::size_t offset) {
  return out_.b.CreateLoad(out_.pointer(), at(arguments_, static_cast<std::int64_t>(offset)));
}

void RolledEmitter::open(const char* name, const std::vector<llvm::Type*>& others, llvm::Type* result, bool exported) {
  std::vector<llvm::Type*> parameters{out_.pointer()};
  parameters.insert(parameters.end(), others.begin(), others.end());
  llvm::Function* const function = out_.function(name, parameters, exported, result);
  arguments_ = function->getArg(0);
  recent_.clear(), final_.clear();
  scan_ = {no_slot, 0, nullptr, nullptr};
  passing_row_ = nullptr;
  rows_ = field(offsetof(packed::CompiledArguments, rows));
  coefficients_ = field(offsetof(packed::CompiledArguments, coefficients));
  sums_ = field(offsetof(packed::CompiledArguments, sums));
}

void RolledEmitter::open_stage(const char* name, bool exported) {
  open(name, {out_.integer()}, nullptr, exported);
  set_stage(out_.b.GetInsertBlock()->getParent()->getArg(1));
}

void RolledEmitter::set_stage(Value* stage) {
  stage_ = stage;
  rows_of_stage_.clear();
  for (int k = 0; k <= -program_.first_stage; ++k) rows_of_stage_.push_back(row_of(stage_plus(k)));
}

Value* RolledEmitter::row_of(Value* order) {
  return out_.at(rows_, out_.b.CreateNSWMul(order, out_.b.getInt64(static_cast<std::uint64_t>(row_bytes_))));
}

/// In functions of some hundreds of packs, since what LLVM does with one grows faster than its size: the pairs of many
/// bodies.
void RolledEmitter::stage() {
  const std::vector<std::size_t> ends = parts_of_stage();
  std::vector<llvm::Function*> parts;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) parts.push_back(part_of_stage(ends[i], ends[i + 1]));
  open_stage("stage");
  begin_packs();
  if (parts.empty()) {
    find_sums_of_stage();
    run_packs(0, p_.packs.size());
  }
  for (llvm::Function* part : parts) out_.b.CreateCall(part, {arguments_, stage_});
  out_.end_function();
}

llvm::Function* RolledEmitter::part_of_stage(std::size_t first, std::size_t last) {
  open_stage("part_of_stage", false);
  llvm::Function* const function = out_.b.GetInsertBlock()->getParent();
  find_sums_of_stage();
  passing_row_ = field(offsetof(packed::CompiledArguments, passing_row));
  run_packs(first, last);
  out_.end_function();
  return function;
}

/// The packs where parts begin, and the end; none where one function does. Running sums stay whole.
std::vector<std::size_t> RolledEmitter::parts_of_stage() const {
  constexpr std::size_t most = 32;
  std::vector<std::size_t> out{0};
  const auto runs_on = [](const Pack& pack) {
    return pack.kind == Pack::Scan || pack.kind == Pack::ScanDown || pack.kind == Pack::Strand ||
           pack.kind == Pack::Join || pack.kind == Pack::JoinDown;
  };
  for (std::size_t i = 1; i < p_.packs.size(); ++i)
    if (i - out.back() >= most && !runs_on(p_.packs[i])) out.push_back(i);
  if (out.size() == 1) return {};
  out.push_back(p_.packs.size());
  return out;
}

void RolledEmitter::find_sums_of_stage() {
  auto& b = out_.b;
  Value* const position = b.CreateAnd(b.CreateSub(stage_, b.getInt64(1)), b.getInt64(rolled_group - 1));
  sums_of_stage_.fill(out_.at(sums_, b.CreateShl(position, 6)));
}

/// q_{k+2} counts as 0 also where it is read with other numbers, or by what is called back.
void RolledEmitter::begin_packs() {
  for (Slot slot = 0; slot < program_.unknowns; slot += lanes)
    save(llvm::Constant::getNullValue(vector_), slot_at(row(2), slot));
  recent_.clear();
  passing_row_ = field(offsetof(packed::CompiledArguments, passing_row));
}

void RolledEmitter::run_packs(std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    pack(i);
    if (filling_) filling_->read = p_.packs[i].last_convolution;
    gap();
  }
}

}  // namespace maupertuis::llvm_backend
