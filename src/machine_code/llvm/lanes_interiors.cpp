#include "machine_code/llvm/lanes_emitter.hpp"

#include <algorithm>
#include <map>

namespace maupertuis::llvm_backend {
namespace {

/// Accumulators of a loop, of two stages each.
constexpr std::ptrdiff_t most_side_by_side = 4;
/// Below, a stage has no pairs that are final two stages before.
constexpr int least_order_of_two = 6;

}  // namespace

using llvm::Value;

// ---------------------------------------------------------------------------------------------------------------- plan

std::uint32_t LanesEmitter::add_accumulator(int ahead, std::vector<Piece> pieces) {
  accumulators_.push_back({ahead, std::move(pieces), nullptr, {}, {}, false});
  return static_cast<std::uint32_t>(accumulators_.size() - 1);
}

void LanesEmitter::group_terms(const Instruction& i, std::uint32_t first, std::uint32_t last, Shape shape,
                               std::vector<Group>& groups) {
  for (std::uint32_t t = first; t < last; ++t) {
    const Term& term = program_.terms[t];
    const bool minus = is_literal(term.coefficient, -1), unit = minus || is_literal(term.coefficient, 1);
    // Weighted: c w du, with a = w, b = u.
    const Piece piece =
        shape == Shape::Weighted ? Piece{shape, term.b, term.a, minus} : Piece{shape, term.a, term.b, minus};
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const Group& g) {
      return unit ? g.coefficient.unit == 1 : g.coefficient.unit == 0 && g.id == term.coefficient;
    });
    if (same != groups.end())
      accumulators_[same->accumulator].pieces.push_back(piece);
    else
      groups.push_back({{nullptr, unit ? 1 : 0}, term.coefficient, add_accumulator(2 - i.lag, {piece})});
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
        case Op::Products:
          group_terms(i, i.first_product, i.last_term, Shape::Product, groups);
          break;
        case Op::Function:
          group_terms(i, i.first_term, i.last_term, Shape::Weighted, groups);
          break;
        case Op::Square:
          one({Shape::Square, i.a, i.a});
          break;
        case Op::SquareRoot:
          one({Shape::Square, i.out, i.out});
          break;
        case Op::Quotient:
          one({Shape::Product, i.b, i.out});
          break;
        case Op::Power:
          one({Shape::Power, i.a, i.out, false, i.constant});
          break;
        case Op::SinCos:
        case Op::SinhCosh:
          one({Shape::Weighted, i.a, i.second});
          one({Shape::Weighted, i.a, i.out, i.op == Op::SinCos});
          break;
        case Op::Linear:
        case Op::Derivative:
        case Op::Select:
          break;  // without sums over orders
        case Op::One:
        case Op::Time:
        case Op::Coordinate:
        case Op::Companion:
          break;
      }
    }
}

// --------------------------------------------------------------------------------------------------------------- pairs

/// The coefficients of an order, and what of them was loaded.
struct LanesEmitter::Row {
  Value *address, *number;  // the order in every lane
  std::map<Slot, Value*> loaded, weighted;
};

Value* LanesEmitter::loaded(Row& row, Slot slot) {
  Value*& value = row.loaded[slot];
  return value ? value : value = load(row.address, slot);
}

/// The factor a_j of a piece with its weight, in the pair with the other row.
Value* LanesEmitter::weighted(const Piece& piece, Row& row, const Row& other) {
  Value* const a = loaded(row, piece.a);
  if (piece.shape == Shape::Power)
    return out_.multiply(a, out_.fma(constant(piece.exponent), row.number, out_.negate(other.number)));
  if (piece.shape != Shape::Weighted) return a;
  Value*& value = row.weighted[piece.a];
  return value ? value : value = out_.multiply(a, row.number);
}

/// The products of orders (j, m − j) and (m − j, j) of all pieces, these in a chain of their own where there are
/// several.
void LanesEmitter::add_pair(const Accumulator& accumulator, Row& low, Row& high, Sum& sum) {
  for (const Piece& piece : accumulator.pieces)
    sum.first = plus(sum.first, weighted(piece, low, high), loaded(high, piece.b), piece.negative);
  Value*& second = accumulator.pieces.size() > 1 ? sum.second : sum.first;
  for (const Piece& piece : accumulator.pieces)
    if (piece.shape != Shape::Square)
      second = plus(second, weighted(piece, high, low), loaded(low, piece.b), piece.negative);
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

/// A coefficient after its stage is solved: of this one from a register.
Value* LanesEmitter::latest(Slot slot, int ahead) {
  const bool is_found = ahead == ahead_of(slot) && slot != program_.one && slot != program_.time;
  return is_found ? now_[slot] : load(row(ahead), slot);
}

/// Of the order after `last`, m = last + 1: the products of orders 1 and m − 1.
Value* LanesEmitter::newest(const Piece& piece, int last, Value* sum) {
  if (is_known() && known(last) < 1) return sum;
  const bool middle = is_known() && known(last) == 1;
  Value* const first_row = out_.at(rows_, row_bytes_);
  Value *a = load(first_row, piece.a), *b = load(first_row, piece.b);
  Value *last_a = middle ? nullptr : latest(piece.a, last), *const last_b = middle ? b : latest(piece.b, last);
  switch (piece.shape) {
    case Shape::Square:
      return plus(sum, middle ? out_.multiply(a, number(0.5)) : a, last_b);
    case Shape::Product:
      break;
    case Shape::Weighted:
      if (last_a) last_a = out_.multiply(last_a, order(last));
      break;
    case Shape::Power: {
      Value* const p = constant(piece.exponent);
      a = out_.multiply(a, out_.fma(p, number(1), out_.negate(order(last))));
      b = out_.multiply(b, out_.fma(p, order(last), number(-1)));
      break;
    }
  }
  sum = plus(sum, a, last_b, piece.negative);
  return plus(sum, b, last_a, piece.negative);
}

// --------------------------------------------------------------------------------------------------------------- loops

/// The interiors of the next stage, which wait for nothing of this one: every other time together with those of the
/// stage after it, of which the pair of order 2 is left for that stage.
void LanesEmitter::prepare_next() {
  std::vector<std::uint32_t> list;
  for (std::uint32_t k = 0; k < accumulators_.size(); ++k) {
    accumulators_[k].next = {};
    if (!is_known() || known(accumulators_[k].ahead + 1) >= 4) list.push_back(k);
  }
  std::stable_sort(list.begin(), list.end(),
                   [&](std::uint32_t x, std::uint32_t y) { return accumulators_[x].ahead < accumulators_[y].ahead; });
  for (auto first = list.begin(); first != list.end();) {
    const int ahead = accumulators_[*first].ahead;
    auto last = first;
    while (last != list.end() && last - first < most_side_by_side && accumulators_[*last].ahead == ahead) ++last;
    const std::vector<std::uint32_t> group(first, last);
    if (accumulators_[*first].begun)
      finish(group);
    else
      interiors_of(group, prepares_two() && (!is_known() || known(ahead + 2) >= least_order_of_two));
    first = last;
  }
}

bool LanesEmitter::prepares_two() const { return ((is_known() ? known(0) : parity_) & 1) == (first_rolled & 1); }

LanesEmitter::Row LanesEmitter::row_at(Value* j) {
  return {row_of(j), out_.splat(out_.b.CreateSIToFP(j, out_.b.getDoubleTy()), real_), {}, {}};
}

/// The pair of order 2, which the stage before left.
void LanesEmitter::finish(const std::vector<std::uint32_t>& group) {
  const int ahead = accumulators_[group[0]].ahead + 1;
  Value* const two = out_.b.getInt64(2);
  Row low = row_at(two), high = row_at(out_.b.CreateSub(index(ahead), two));
  for (const std::uint32_t k : group) {
    Accumulator& accumulator = accumulators_[k];
    accumulator.next = accumulator.after;
    add_pair(accumulator, low, high, accumulator.next);
    accumulator.begun = false;
  }
}

/// The middle, then all pairs from the middle outward: (j, m − j) with j ≥ 2, and of the stage after it (j + 1, m − j),
/// so that what was loaded serves twice.
void LanesEmitter::interiors_of(const std::vector<std::uint32_t>& group, bool two) {
  const int ahead = accumulators_[group[0]].ahead + 1;
  for (const std::uint32_t k : group) {
    Accumulator& accumulator = accumulators_[k];
    accumulator.begun = two;
    accumulator.next = {is_odd(ahead) ? nullptr : middle_of(accumulator, ahead)};
    accumulator.after = {two && is_odd(ahead) ? middle_of(accumulator, ahead + 1) : nullptr};
  }
  const auto add = [&](Row& low, Row& high, bool after) {
    for (const std::uint32_t k : group)
      add_pair(accumulators_[k], low, high, after ? accumulators_[k].after : accumulators_[k].next);
  };
  if (is_known()) {
    const int m = known(ahead);
    const auto at = [&](int j) { return row_at(out_.b.getInt64(static_cast<std::uint64_t>(j))); };
    Row above = at(m / 2);
    if (m % 2 != 0) {
      Row high = at(m - m / 2);
      add(above, high, false);
    }
    for (int j = m / 2 - 1; j >= 2; --j) {
      Row low = at(j), high = at(m - j);
      if (two) add(above, high, true);
      add(low, high, false);
      above = std::move(low);
    }
  } else {
    rolled_pairs(group, two, add);
  }
}

/// The same as a loop.
void LanesEmitter::rolled_pairs(const std::vector<std::uint32_t>& group, bool two, const AddRows& add) {
  auto& b = out_.b;
  const int ahead = accumulators_[group[0]].ahead + 1;
  Value* const center = half(ahead);
  Row above = row_at(center), high = row_at(b.CreateSub(index(ahead), center));
  if (is_odd(ahead)) add(above, high, false);
  const auto move = [&](Row& row, int by) {
    row = {out_.at(row.address, by * row_bytes_), out_.add(row.number, number(by)), {}, {}};
  };
  if (two) load_lows(group, above);
  Row low{above.address, above.number, {}, {}};
  move(low, -1);
  high = row_at(b.CreateSub(index(ahead), b.CreateSub(center, b.getInt64(1))));
  // What the loop hands on: rows, sums, and the row that was low a turn before.
  const auto values = [&](const std::function<void(Value*&)>& visit) {
    for (Value** v : {&low.address, &low.number, &high.address, &high.number}) visit(*v);
    if (two) visit(above.number);
    for (const std::uint32_t k : group)
      for (Sum* sum : {&accumulators_[k].next, &accumulators_[k].after}) {
        if (!two && sum == &accumulators_[k].after) continue;
        visit(sum->first);
        if (accumulators_[k].pieces.size() > 1) visit(sum->second);
      }
    if (!two) return;
    for (auto* values : {&above.loaded, &above.weighted})
      for (auto& [slot, value] : *values) visit(value);
  };
  const auto pack = [&] {
    std::vector<Value*> carried;
    values([&](Value*& v) { carried.push_back(or_zero(v)); });
    return carried;
  };
  const auto unpack = [&](const std::vector<Value*>& from) {
    auto next = from.begin();
    values([&](Value*& v) { v = *next++; });
  };
  unpack(out_.loop(b.getInt64(2), center, pack(), [&](Value*, const std::vector<Value*>& now) {
    unpack(now);
    low.loaded.clear(), low.weighted.clear(), high.loaded.clear(), high.weighted.clear();
    if (two) add(above, high, true);
    add(low, high, false);
    if (two) {
      load_lows(group, low);
      above.number = low.number, above.loaded = low.loaded, above.weighted = low.weighted;
    }
    move(low, -1), move(high, 1);
    return pack();
  }));
}

/// What pairs read of their lower row.
void LanesEmitter::load_lows(const std::vector<std::uint32_t>& group, Row& row) {
  Row kept{row.address, row.number, {}, {}};
  for (const std::uint32_t k : group)
    for (const Piece& piece : accumulators_[k].pieces) {
      if (piece.shape == Shape::Weighted)
        kept.weighted[piece.a] = weighted(piece, row, row);
      else
        kept.loaded[piece.a] = loaded(row, piece.a);
      if (piece.shape != Shape::Square) kept.loaded[piece.b] = loaded(row, piece.b);
    }
  row = std::move(kept);
}

}  // namespace maupertuis::llvm_backend
