#include "machine_code/llvm/rolled_emitter.hpp"

#include "kernel/packed/code.hpp"

#include <algorithm>
#include <cstddef>

/// Sums of products that later stages will want. Within loops over the convolutions of a class every order is known but
/// for the stage: with D_a = lag − lag of a (D_b likewise), at the beginning of stage s, m = s + 2 − lag, the operand a
/// is final up to order m − 1 + D_a. That highest order stage s multiplies itself (late_terms()), so that sums need not
/// wait for it.
namespace maupertuis::llvm_backend {

using llvm::Value;
using packed::lanes;
using packed::rolled_group;

/// After stage s: s + 1 begins a group, or is one that is added up alone, or is given what s has made final.
void RolledEmitter::ahead() {
  auto& b = out_.b;
  const std::size_t blocks = p_.blocks.size();
  std::vector<llvm::Function*> parts;
  if (blocks > blocks_of_part)
    for (std::size_t first = 0; first < blocks; first += blocks_of_part)
      parts.push_back(part_of_blocks(first, std::min(blocks, first + blocks_of_part)));
  open_stage("ahead");
  if (parts.empty()) renew_blocks(0, blocks);
  for (llvm::Function* part : parts) b.CreateCall(part, {arguments_, stage_});
  renew_copies();
  llvm::Function* const function = b.GetInsertBlock()->getParent();
  const auto block = [&] { return llvm::BasicBlock::Create(out_.context, "", function); };
  llvm::BasicBlock *const alone = block(), *const grouped = block(), *const done = block();
  b.CreateCondBr(b.CreateICmpSLT(stage_, b.getInt64(rolled_group)), alone, grouped);

  b.SetInsertPoint(alone);
  llvm::BasicBlock* const last = block();
  llvm::SwitchInst* const early = b.CreateSwitch(stage_, last);
  for (int stage = 0; stage < rolled_group; ++stage) {
    llvm::BasicBlock* const adding = stage + 1 < rolled_group ? block() : last;
    if (adding != last) early->addCase(b.getInt64(static_cast<std::uint64_t>(stage)), adding);
    b.SetInsertPoint(adding);
    add_up_alone(stage);
    b.CreateBr(done);
  }

  b.SetInsertPoint(grouped);
  llvm::BasicBlock* const begin = block();
  llvm::SwitchInst* const position = b.CreateSwitch(b.CreateAnd(stage_, b.getInt64(rolled_group - 1)), begin);
  b.SetInsertPoint(begin);
  begin_group();
  b.CreateBr(done);
  for (int passed = 1; passed < rolled_group; ++passed) {
    llvm::BasicBlock* const passing = block();
    position->addCase(b.getInt64(static_cast<std::uint64_t>(passed)), passing);
    b.SetInsertPoint(passing);
    pass_on(passed);
    b.CreateBr(done);
  }
  b.SetInsertPoint(done);
  out_.end_function();
}

/// Copies of what is final now, but for those of coordinates.
void RolledEmitter::renew_blocks(std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i)
    if (const Block& block = p_.blocks[i]; !block.direct && !p_.copies_coordinates(block)) renew(block);
}

/// In functions of some blocks, as the packs of a stage.
llvm::Function* RolledEmitter::part_of_blocks(std::size_t first, std::size_t last) {
  open_stage("part_of_blocks", false);
  llvm::Function* const function = out_.b.GetInsertBlock()->getParent();
  renew_blocks(first, last);
  out_.end_function();
  return function;
}

/// Where the solution did not.
void RolledEmitter::renew_copies() {
  if (std::none_of(p_.blocks.begin(), p_.blocks.end(),
                   [this](const Block& block) { return p_.copies_coordinates(block); }))
    return;
  auto& b = out_.b;
  llvm::Function* const function = b.GetInsertBlock()->getParent();
  llvm::BasicBlock* const missing = llvm::BasicBlock::Create(out_.context, "", function);
  llvm::BasicBlock* const there = llvm::BasicBlock::Create(out_.context, "", function);
  Value* const has = b.CreateAlignedLoad(
      b.getInt64Ty(), at(arguments_, offsetof(packed::CompiledArguments, has_copies)), llvm::Align(8));
  b.CreateCondBr(b.CreateICmpEQ(has, b.getInt64(0)), missing, there);
  b.SetInsertPoint(missing);
  for (const Block& block : p_.blocks)
    if (p_.copies_coordinates(block)) renew(block);
  b.CreateBr(there);
  b.SetInsertPoint(there);
}

/// From registers, if what it copies has just been corrected.
void RolledEmitter::renew(const Block& block) {
  const int ahead = 2 - block.lag;
  if (written_ && *written_ + ahead < 0) return;
  const auto found = final_.find(block.slots[0]);
  Value* const values = block.is_range && found != final_.end() ? found->second : values_of(block, row(ahead));
  Value* const renewed = block.weighted ? out_.multiply(values, real(stage_plus(ahead))) : values;
  save(renewed, slot_at(row(ahead), block.first));
  final_[block.first] = renewed;
}

/// Loops over the convolutions of each class, a few of each in turn, since neighbours have operands in common, which
/// are then still in the first cache. `body` gets the addresses of their operands at order 0 and of their sums.
void RolledEmitter::each_convolution(const std::function<void(const Class&, Value*, Value*, Value*)>& body,
                                     const std::function<bool(const Class&)>& takes_part) {
  constexpr std::size_t at_once = 4;
  auto& b = out_.b;
  std::size_t most = 0;
  for (const auto& [key, members] : classes_)
    if (takes_part(key)) most = std::max(most, members.size());
  if (most == 0) return;
  const std::size_t turns = classes_.size() < 2 ? 1 : std::max<std::size_t>(1, most / at_once);
  out_.loop(b.getInt64(0), b.getInt64(turns), {}, [&](Value* turn, const std::vector<Value*>&) {
    for (const auto& [key, members] : classes_) {
      if (!takes_part(key)) continue;
      const auto bound = [&](Value* at_turn) {
        return b.CreateUDiv(b.CreateMul(at_turn, b.getInt64(members.size())), b.getInt64(turns));
      };
      loop_over(key, members, bound(turn), bound(b.CreateAdd(turn, b.getInt64(1))), body);
    }
    return std::vector<Value*>{};
  });
}

/// Over neighbouring members of a class, whose sums lie side by side.
void RolledEmitter::loop_over(const Class& key, const std::vector<std::size_t>& members, Value* first, Value* end,
                              const std::function<void(const Class&, Value*, Value*, Value*)>& body) {
  auto& b = out_.b;
  Value* const places = offsets(members);
  Value* const sums = at(sums_, static_cast<std::int64_t>(sums_of_[members.front()]) * sums_bytes);
  out_.loop(first, end, {}, [&](Value* i, const std::vector<Value*>&) {
    Value* const entry = out_.at(places, b.CreateShl(i, 3));
    const auto operand = [&](std::int64_t place) {
      return out_.at(
          rows_, b.CreateZExt(b.CreateAlignedLoad(b.getInt32Ty(), at(entry, place), llvm::Align(4)), b.getInt64Ty()));
    };
    body(key, operand(0), operand(4), out_.at(sums, b.CreateMul(i, b.getInt64(sums_bytes))));
    return std::vector<Value*>{};
  });
}

/// Where the operands begin in a row, in bytes.
llvm::GlobalVariable* RolledEmitter::offsets(const std::vector<std::size_t>& members) {
  std::vector<std::uint32_t> bytes;
  for (const std::size_t i : members)
    for (const std::uint32_t block : {p_.convolutions[i].a, p_.convolutions[i].b})
      bytes.push_back(8 * p_.blocks[block].first);
  return table(bytes);
}

llvm::GlobalVariable* RolledEmitter::table(const std::vector<std::uint32_t>& numbers) {
  llvm::Constant* const values = llvm::ConstantDataArray::get(out_.context, numbers);
  return new llvm::GlobalVariable(*out_.module, values->getType(), true, llvm::GlobalValue::PrivateLinkage, values);
}

/// Of the stage s + 1: Σ a_j b_{m−j} over all that is final, but for what that stage adds, which may be one product
/// twice.
void RolledEmitter::add_up_alone(int stage) {
  each_convolution([&](const Class& c, Value* x, Value* y, Value* sums) {
    const auto [lag, a_ahead, b_ahead] = c;
    const int m = stage + 3 - lag;
    std::vector<int> times(static_cast<std::size_t>(m) + 1, 0);
    for (int j = std::max(0, 1 - b_ahead); j <= m - std::max(0, 1 - a_ahead); ++j) ++times[static_cast<std::size_t>(j)];
    if (adds_late(c) && a_ahead <= 1) --times[static_cast<std::size_t>(m - 1 + a_ahead)];
    if (adds_late(c) && b_ahead <= 1) --times[static_cast<std::size_t>(1 - b_ahead)];
    Value* sum = llvm::Constant::getNullValue(vector_);
    for (int j = 0; j <= m; ++j) {
      const int count = times[static_cast<std::size_t>(j)];
      if (count == 0) continue;
      Value *const a = load(at(x, j * row_bytes_)), *const b = load(at(y, (m - j) * row_bytes_));
      sum = out_.fma(count > 0 ? a : out_.negate(a), b, sum);
    }
    save(sum, at(sums, stage % rolled_group * vector_bytes));
  });
}

/// Whether a stage multiplies the highest orders of its operands itself. Not where both have the lag 2 of the result:
/// the highest order of a meets b_1 then, which stage 1 itself has still to find.
bool RolledEmitter::adds_late(const Class& c) {
  const auto [lag, a_ahead, b_ahead] = c;
  return lag < 2 || a_ahead > 0 || b_ahead > 0;
}

/// sum + the products that stage s adds itself: the highest order of a that is final before it, a_{m−1+D_a} b_{1−D_a},
/// and the same with a and b exchanged. None where an operand is two orders ahead.
Value* RolledEmitter::late_terms(const packed::Convolution& c, Value* sum) {
  const int a_ahead = c.lag - p_.blocks[c.a].lag, b_ahead = c.lag - p_.blocks[c.b].lag;
  if (!adds_late({c.lag, a_ahead, b_ahead})) return sum;
  const auto term = [&](std::uint32_t x, std::uint32_t y, int ahead) {
    if (ahead > 1) return;
    Value* const newest = load(at(slot_at(row(0), p_.blocks[x].first), (1 - p_.blocks[x].lag) * row_bytes_));
    sum = out_.fma(newest, load(at(slot_at(rows_, p_.blocks[y].first), (1 - ahead) * row_bytes_)), sum);
  };
  term(c.a, c.b, a_ahead);
  term(c.b, c.a, b_ahead);
  return sum;
}

// ------------------------------------------------------------------------------------------------------------- a group

/// Of the stages s + 1 … s + 4, what is final now.
void RolledEmitter::begin_group() {
  each_convolution([&](const Class& c, Value* x, Value* y, Value* sums) { add_up_group(c, {0, 0}, x, y, sums); });
}

/// With m the order of the group's first stage, operands are final up to m − 1 + D, or `left_out` orders less: a_j for
/// first ≤ j < m meets b_{m+r−j} of all four stages r, which slide by one from j to j + 1. The first stage adds late
/// terms itself.
void RolledEmitter::add_up_group(const Class& c, const Group& group, Value* x, Value* y, Value* sums) {
  auto& b = out_.b;
  const auto [lag, a_ahead, b_ahead] = c;
  Value* const stride = b.getInt64(static_cast<std::uint64_t>(row_bytes_));
  Value* const top_a = out_.at(x, b.CreateNSWMul(stage_plus(3 - lag), stride));  // a_m
  Value* const top_b = out_.at(y, b.CreateNSWMul(stage_plus(3 - lag), stride));
  const auto from = [&](Value* address, int order) { return load(at(address, order * row_bytes_)); };
  const auto known = [&](std::map<int, Value*>& values, Value* address, int order) {
    Value*& value = values[order];
    if (!value) value = from(address, order);
    return value;
  };
  const bool late = adds_late(c);
  const int first = rolled_group + (b_ahead == 0 ? group.left_out : 0);
  std::map<int, Value*> low_a, high_b;
  std::vector<Value*> now{at(x, first * row_bytes_), at(top_b, -first * row_bytes_)};
  for (int r = 0; r < rolled_group; ++r) {
    const int beyond = 1 + std::max(r + group.left_out, r == 0 && late ? 1 : 0);
    Value* sum = nullptr;
    for (int j = std::max(0, beyond - b_ahead); j < first; ++j)
      sum = plus(sum, known(low_a, x, j), known(high_b, top_b, r - j));
    for (int i = std::max(0, beyond - a_ahead); i <= r; ++i) sum = plus(sum, from(top_a, r - i), from(y, i));
    now.push_back(sum ? sum : llvm::Constant::getNullValue(vector_));
  }
  for (int r = 0; r < rolled_group; ++r) now.push_back(known(high_b, top_b, r - first));
  // One order j further: a_j from the first address, and the next of b from below the second, which is where the first
  // of the window came from.
  const auto turn = [&](const std::vector<Value*>& values, int steps, int first_of_last) {
    std::vector<Value*> totals(values.begin() + 2, values.begin() + 2 + rolled_group),
        window(values.begin() + 2 + rolled_group, values.end());
    for (int u = 0; u < steps; ++u) {
      Value* const a_j = from(values[0], u);
      for (std::size_t r = u + 1 < steps ? 0 : static_cast<std::size_t>(first_of_last); r < rolled_group; ++r)
        totals[r] = out_.fma(a_j, window[r], totals[r]);
      std::copy_backward(window.begin(), window.end() - 1, window.end());
      window[0] = from(values[1], -(u + 1));
    }
    std::vector<Value*> next{at(values[0], steps * row_bytes_), at(values[1], -steps * row_bytes_)};
    next.insert(next.end(), totals.begin(), totals.end());
    next.insert(next.end(), window.begin(), window.end());
    return next;
  };
  // m − first orders, less what is left out of a; s = 4 ⌊s/4⌋ + phase. The last one is a_{m−1} b_1 for the first stage,
  // and late.
  const int beyond = group.phase + 3 - lag - first - (a_ahead == 0 ? group.left_out : 0),
            rest = (beyond + 2 * rolled_group) % rolled_group;
  Value* const turns =
      b.CreateNSWAdd(b.CreateLShr(stage_, 2), b.getInt64(static_cast<std::uint64_t>((beyond - rest) / rolled_group)));
  now = out_.loop(b.getInt64(0), turns, now,
                  [&](Value*, const std::vector<Value*>& values) { return turn(values, rolled_group, 0); });
  now = turn(now, rest, late && a_ahead == 0 && group.left_out == 0 ? 1 : 0);
  for (std::size_t r = 0; r < rolled_group; ++r)
    save(now[2 + r], at(sums, static_cast<std::int64_t>(r) * vector_bytes));
}

/// What stage s, the `passed`-th of its group, has made final, for those that follow the next one in the group.
void RolledEmitter::pass_on(int passed) {
  each_convolution([&](const Class& c, Value* x, Value* y, Value* sums) { pass_on(c, passed, 0, x, y, sums); },
                   [&](const Class& c) { return passed + nearest(c) <= rolled_group; });
}

/// The same of stage s − `behind`: at a distance t the newest a meets b_{t−D_a}.
void RolledEmitter::pass_on(const Class& c, int passed, int behind, Value* x, Value* y, Value* sums) {
  const auto [lag, a_ahead, b_ahead] = c;
  Value* const stride = out_.b.getInt64(static_cast<std::uint64_t>(row_bytes_));
  const auto newest = [&](Value* operand, int its_lag) {
    return load(out_.at(operand, out_.b.CreateNSWMul(stage_plus(2 - its_lag - behind), stride)));
  };
  Value *const a = newest(x, lag - a_ahead), *const b = newest(y, lag - b_ahead);
  for (int t = nearest(c); passed + t <= rolled_group; ++t) {
    Value* const place = at(sums, (passed + t - 1) * vector_bytes);
    Value* sum = load(place);
    if (t >= a_ahead) sum = out_.fma(a, load(at(y, (t - a_ahead) * row_bytes_)), sum);
    if (t >= b_ahead) sum = out_.fma(b, load(at(x, (t - b_ahead) * row_bytes_)), sum);
    save(sum, place);
  }
}

}  // namespace maupertuis::llvm_backend
