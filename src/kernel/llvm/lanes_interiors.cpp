#include "kernel/llvm/lanes_emitter.hpp"

#include <algorithm>
#include <map>

namespace maupertuis::llvm_backend {
namespace {

/// Sums that a loop carries in registers.
constexpr std::size_t most_sums = 12;
/// With fewer a second chain of additions keeps the processor from waiting.
constexpr std::size_t few_sums = 4;
constexpr std::size_t none = ~std::size_t{0};

}  // namespace

using llvm::Value;

// -------------------------------------------------------------------------------------------------------------------- plan

std::uint32_t LanesEmitter::add_accumulator(int ahead, std::vector<Piece> pieces) {
  accumulators_.push_back({ahead, std::move(pieces)});
  return static_cast<std::uint32_t>(accumulators_.size() - 1);
}

void LanesEmitter::group_terms(const Instruction& i, std::uint32_t first, std::uint32_t last, Shape shape, std::vector<Group>& groups) {
  for (std::uint32_t t = first; t < last; ++t) {
    const Term& term = program_.terms[t];
    const bool minus = is_literal(term.coefficient, -1), unit = minus || is_literal(term.coefficient, 1);
    // Weighted: c w du, with a = w, b = u.
    const Piece piece = shape == Shape::Weighted ? Piece{shape, term.b, term.a, minus} : Piece{shape, term.a, term.b, minus};
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const Group& g) {
      return unit ? g.coefficient.unit == 1 : g.coefficient.unit == 0 && g.id == term.coefficient;
    });
    if (same != groups.end()) accumulators_[same->accumulator].pieces.push_back(piece);
    else groups.push_back({{nullptr, unit ? 1 : 0}, term.coefficient, add_accumulator(2 - i.lag, {piece})});
  }
}

void LanesEmitter::plan_accumulators() {
  groups_.resize(program_.instructions.size());
  for (const Run& run : program_.runs[Dynamics])
    for (std::uint32_t index = run.first; index < run.last; ++index) {
      const Instruction& i = program_.instructions[index];
      auto& groups = groups_[index];
      const auto one = [&](Piece piece) { groups.push_back({{nullptr, 1}, 0, add_accumulator(2 - i.lag, {piece})}); };
      switch (i.op) {
        case Op::Products: group_terms(i, i.first_product, i.last_term, Shape::Product, groups); break;
        case Op::Function: group_terms(i, i.first_term, i.last_term, Shape::Weighted, groups); break;
        case Op::Square: one({Shape::Square, i.a, i.a}); break;
        case Op::SquareRoot: one({Shape::Square, i.out, i.out}); break;
        case Op::Quotient: one({Shape::Product, i.b, i.out}); break;
        case Op::Power: one({Shape::Power, i.a, i.out, false, i.constant}); break;
        case Op::SinCos:
        case Op::SinhCosh:
          one({Shape::Weighted, i.a, i.second});
          one({Shape::Weighted, i.a, i.out, i.op == Op::SinCos});
          break;
        default: break;
      }
    }
}

// ------------------------------------------------------------------------------------------------------------------- pairs

/// A pair of orders j < m − j, and what was loaded there.
struct LanesEmitter::Turn {
  Value *low_row, *high_row;
  Value *low, *high;               // as numbers in every lane; null where no sum is weighted
  std::map<std::pair<Slot, bool>, Value*> loaded, weighted;
  std::map<ConstantId, std::pair<Value*, Value*>> weights;  // of powers
};

/// The products of order (j, m − j), or of (m − j, j), of all pieces.
Value* LanesEmitter::add_pair(const Accumulator& accumulator, Turn& turn, Value* sum, bool second_half) {
  const auto load_at = [&](Slot slot, bool high) {
    Value*& value = turn.loaded[{slot, high}];
    if (!value) value = load(high ? turn.high_row : turn.low_row, slot);
    return value;
  };
  for (const Piece& piece : accumulator.pieces) {
    if (piece.shape == Shape::Square && second_half) continue;
    Value* a = load_at(piece.a, second_half);
    Value* const b = load_at(piece.b, !second_half);
    if (piece.shape == Shape::Weighted) {
      Value*& weighted = turn.weighted[{piece.a, second_half}];
      if (!weighted) weighted = out_.multiply(a, second_half ? turn.high : turn.low);
      a = weighted;
    } else if (piece.shape == Shape::Power) {
      auto& [low, high] = turn.weights[piece.exponent];
      if (!low) {
        Value* const p = constant(piece.exponent);
        low = out_.fma(p, turn.low, out_.negate(turn.high));
        high = out_.fma(p, turn.high, out_.negate(turn.low));
      }
      a = out_.multiply(a, second_half ? high : low);
    }
    sum = plus(sum, a, b, piece.negative);
  }
  return sum;
}

bool LanesEmitter::is_weighted(const Accumulator& accumulator) const {
  return std::any_of(accumulator.pieces.begin(), accumulator.pieces.end(),
                     [](const Piece& piece) { return piece.shape == Shape::Weighted || piece.shape == Shape::Power; });
}

/// The product at j = m/2 > 1: of a square half of it, since the whole is doubled.
Value* LanesEmitter::middle_of(const Accumulator& accumulator, int ahead) {
  Value* const at = row_of(half(ahead));
  Value* sum = nullptr;
  for (const Piece& piece : accumulator.pieces) {
    Value* a = load(at, piece.a);
    Value* const b = load(at, piece.b);
    Value* const j = out_.multiply(order(ahead), number(0.5));
    if (piece.shape == Shape::Square) a = out_.multiply(a, number(0.5));
    if (piece.shape == Shape::Weighted) a = out_.multiply(a, j);
    if (piece.shape == Shape::Power) a = out_.multiply(a, out_.fma(constant(piece.exponent), j, out_.negate(j)));
    sum = plus(sum, a, b, piece.negative);
  }
  return sum;
}

/// The products of orders 1 and m − 1, the last of which is of the stage before.
Value* LanesEmitter::newest(const Piece& piece, int m, Value* sum) {
  if (is_known() && known(m) < 2) return sum;
  const bool middle = is_known() && known(m) == 2;
  Value *const first_row = out_.at(rows_, row_bytes_), *const last_row = row(m - 1);
  Value *a = load(first_row, piece.a), *b = load(first_row, piece.b);
  Value *last_a = middle ? nullptr : load(last_row, piece.a), *const last_b = middle ? b : load(last_row, piece.b);
  switch (piece.shape) {
    case Shape::Square: return plus(sum, middle ? out_.multiply(a, number(0.5)) : a, last_b);
    case Shape::Product: break;
    case Shape::Weighted:
      if (last_a) last_a = out_.multiply(last_a, order(m - 1));
      break;
    case Shape::Power: {
      Value* const p = constant(piece.exponent);
      a = out_.multiply(a, out_.fma(p, number(1), out_.negate(order(m - 1))));
      b = out_.multiply(b, out_.fma(p, order(m - 1), number(-1)));
      break;
    }
  }
  sum = plus(sum, a, last_b, piece.negative);
  return plus(sum, b, last_a, piece.negative);
}

// ------------------------------------------------------------------------------------------------------------------- loops

/// Those of the next stage, which wait for nothing of this one.
void LanesEmitter::prepare_next() {
  std::vector<std::uint32_t> list;
  for (std::uint32_t k = 0; k < accumulators_.size(); ++k) {
    accumulators_[k].next = nullptr;
    if (!is_known() || known(accumulators_[k].ahead + 1) >= 4) list.push_back(k);
  }
  std::stable_sort(list.begin(), list.end(), [&](std::uint32_t x, std::uint32_t y) { return accumulators_[x].ahead < accumulators_[y].ahead; });
  for (std::size_t first = 0; first < list.size(); first += most_sums) {
    const std::size_t last = std::min(first + most_sums, list.size());
    interiors_of({list.begin() + static_cast<std::ptrdiff_t>(first), list.begin() + static_cast<std::ptrdiff_t>(last)});
  }
}

/// The middle, then all pairs from the middle outward, as long as j ≥ 2. Of several orders the higher ones have more pairs:
/// those come first and alone, and the rest goes through a loop together.
void LanesEmitter::interiors_of(const std::vector<std::uint32_t>& group) {
  const int least = accumulators_[group[0]].ahead + 1;
  const bool few = group.size() <= few_sums;
  std::vector<Value*> sums, seconds(group.size(), nullptr);
  std::vector<Shift> shifts;
  for (const std::uint32_t k : group) {
    const int ahead = accumulators_[k].ahead + 1;
    sums.push_back(is_odd(ahead) ? nullptr : middle_of(accumulators_[k], ahead));
    if (shifts.empty() || shifts.back().ahead != ahead) shifts.push_back({ahead, 0, false});
    shifts.back().weighted = shifts.back().weighted || is_weighted(accumulators_[k]);
    ++shifts.back().count;
  }
  const auto add_turn = [&](std::vector<Turn>& turns, const std::vector<std::size_t>& turn_of) {
    for (std::size_t k = 0; k < group.size(); ++k) {
      if (turn_of[k] == none) continue;
      Turn& turn = turns[turn_of[k]];
      sums[k] = add_pair(accumulators_[group[k]], turn, sums[k], false);
      Value*& second = few ? seconds[k] : sums[k];
      second = add_pair(accumulators_[group[k]], turn, second, true);
    }
  };
  std::vector<std::size_t> shift_of;
  for (std::size_t s = 0; s < shifts.size(); ++s) shift_of.insert(shift_of.end(), shifts[s].count, s);

  if (is_known()) {
    for (std::size_t s = 0; s < shifts.size(); ++s) {
      const int m = known(shifts[s].ahead);
      std::vector<std::size_t> turn_of(group.size(), none);
      for (std::size_t k = 0; k < group.size(); ++k)
        if (shift_of[k] == s) turn_of[k] = 0;
      for (int j = (m - 1) / 2; j >= 2; --j) {
        std::vector<Turn> turns{{out_.at(rows_, j * row_bytes_), out_.at(rows_, (m - j) * row_bytes_), number(j), number(m - j), {}, {}, {}}};
        add_turn(turns, turn_of);
      }
    }
  } else {
    rolled_pairs(least, shifts, shift_of, sums, seconds, add_turn);
  }
  for (std::size_t k = 0; k < group.size(); ++k) accumulators_[group[k]].next = plus(sums[k], seconds[k]);
}

/// ⌊(m − 1)/2⌋, the j of the innermost pair.
Value* LanesEmitter::innermost(int ahead) {
  return is_odd(ahead) ? half(ahead) : out_.b.CreateSub(half(ahead), out_.b.getInt64(1));
}

void LanesEmitter::rolled_pairs(int least, const std::vector<Shift>& shifts, const std::vector<std::size_t>& shift_of,
                                std::vector<Value*>& sums, std::vector<Value*>& seconds, const AddTurn& add_turn) {
  auto& b = out_.b;
  Value* const common = innermost(least);  // j runs from here down to 2 in the loop
  struct Walk {
    Value *low_row, *high_row, *low = nullptr, *high = nullptr;
  };
  std::vector<Walk> walks;
  const auto turn_at = [&](const Walk& w) { return Turn{w.low_row, w.high_row, w.low, w.high, {}, {}, {}}; };
  const auto step = [&](Walk& w) {
    w.low_row = out_.at(w.low_row, -row_bytes_), w.high_row = out_.at(w.high_row, row_bytes_);
    if (w.low) w.low = out_.subtract(w.low, number(1)), w.high = out_.add(w.high, number(1));
  };
  for (std::size_t s = 0; s < shifts.size(); ++s) {
    Value* const j = innermost(shifts[s].ahead);
    Value* const m = b.CreateNUWAdd(stage_, b.getInt64(static_cast<std::uint64_t>(shifts[s].ahead)));
    Walk walk{row_of(j), row_of(b.CreateSub(m, j))};
    if (shifts[s].weighted) {
      walk.low = out_.splat(b.CreateSIToFP(j, b.getDoubleTy()), real_);
      walk.high = out_.subtract(order(shifts[s].ahead), walk.low);
    }
    // Pairs that the lowest order does not have.
    const int more = (shifts[s].ahead - least + (is_odd(least) ? 0 : 1)) / 2;
    std::vector<std::size_t> turn_of(shift_of.size(), none);
    for (std::size_t k = 0; k < shift_of.size(); ++k)
      if (shift_of[k] == s) turn_of[k] = 0;
    for (int extra = 0; extra < more; ++extra) {
      std::vector<Turn> turns{turn_at(walk)};
      add_turn(turns, turn_of);
      step(walk);
    }
    walks.push_back(walk);
  }
  std::vector<Value*> carried;
  const auto pack = [&] {
    carried.clear();
    for (const Walk& w : walks) {
      carried.insert(carried.end(), {w.low_row, w.high_row});
      if (w.low) carried.insert(carried.end(), {w.low, w.high});
    }
    for (std::size_t k = 0; k < sums.size(); ++k) carried.push_back(or_zero(sums[k]));
    if (sums.size() <= few_sums)
      for (std::size_t k = 0; k < sums.size(); ++k) carried.push_back(or_zero(seconds[k]));
    return carried;
  };
  const auto unpack = [&](const std::vector<Value*>& from) {
    auto next = from.begin();
    for (Walk& w : walks) {
      w.low_row = *next++, w.high_row = *next++;
      if (w.low) w.low = *next++, w.high = *next++;
    }
    for (Value*& sum : sums) sum = *next++;
    if (sums.size() <= few_sums)
      for (Value*& second : seconds) second = *next++;
  };
  const std::vector<Value*> last = out_.loop(b.getInt64(1), common, pack(), [&](Value*, const std::vector<Value*>& now) {
    unpack(now);
    std::vector<Turn> turns;
    for (const Walk& w : walks) turns.push_back(turn_at(w));
    add_turn(turns, shift_of);
    for (Walk& w : walks) step(w);
    return pack();
  });
  unpack(last);
}

}  // namespace maupertuis::llvm_backend
