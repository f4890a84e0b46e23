#include "kernel/llvm/rolled_emitter.hpp"

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

void RolledEmitter::open(const char* name, const std::vector<llvm::Type*>& others, llvm::Type* result) {
  std::vector<llvm::Type*> parameters{out_.pointer()};
  parameters.insert(parameters.end(), others.begin(), others.end());
  llvm::Function* const function = out_.function(name, parameters, true, result);
  arguments_ = function->getArg(0);
  recent_.clear(), final_.clear(), kept_.clear();
  passing_row_ = nullptr;
  rows_ = field(offsetof(packed::CompiledArguments, rows));
  coefficients_ = field(offsetof(packed::CompiledArguments, coefficients));
  sums_ = field(offsetof(packed::CompiledArguments, sums));
}

void RolledEmitter::open_stage(const char* name) {
  open(name, {out_.integer()});
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

void RolledEmitter::stage() {
  auto& b = out_.b;
  open_stage("stage");
  Value* const position = b.CreateAnd(b.CreateSub(stage_, b.getInt64(1)), b.getInt64(rolled_group - 1));
  sums_of_stage_.fill(out_.at(sums_, b.CreateShl(position, 6)));
  run_packs();
  out_.end_function();
}

void RolledEmitter::run_packs() {
  // q_{k+2} counts as 0 also where it is read with other numbers, or by what is called back.
  for (Slot slot = 0; slot < program_.unknowns; slot += lanes)
    save(llvm::Constant::getNullValue(vector_), slot_at(row(2), slot));
  recent_.clear();
  passing_row_ = field(offsetof(packed::CompiledArguments, passing_row));
  for (std::size_t i = 0; i < p_.packs.size(); ++i) {
    if (deferred_) correct_up_to(read_of_stage_before(i));
    pack(i);
    if (filling_) filling_->read = p_.packs[i].last_convolution;
    if (deferred_) correct_before(deferred_->packs.size() * (i + 1) / p_.packs.size());
    gap();
  }
}

}  // namespace maupertuis::llvm_backend
