#include "kernel/packed/ready.hpp"

#include "kernel/packed/convolutions.hpp"

#include <algorithm>
#include <map>

namespace maupertuis::packed {
namespace {

/// All slots of the block within two vectors of a row, if they are.
bool find_vectors(const Block& block, Copy& copy) {
  copy.first = copy.second = block.slots[0] / lanes * lanes;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const Slot vector = block.slots[lane] / lanes * lanes;
    if (vector != copy.first && copy.second == copy.first) copy.second = vector;
    if (vector != copy.first && vector != copy.second) return false;
    copy.places[lane] = static_cast<long long>(block.slots[lane] % lanes + (vector == copy.first ? 0 : lanes));
  }
  return true;
}

Copy copy_of(const Block& block) {
  Copy copy{.lag = block.lag, .weighted = block.weighted, .to = block.first, .slots = block.slots.data()};
  if (block.is_range) copy.kind = Copy::Range, copy.first = block.slots[0];
  else if (find_vectors(block, copy)) copy.kind = Copy::TwoVectors;
  return copy;
}

class Preparation {
 public:
  Preparation(ReadyProgram& out, const PackedProgram& program, const double* rows, std::size_t stride, const double* coefficients)
      : out_(out), in_(program), rows_(rows), stride_(stride), coefficients_(coefficients) {}

  void run() {
    for (const Column& column : in_.columns) out_.places.push_back(static_cast<Slot>(column.source + column.shift * stride_));
    for (const ColumnRun& run : in_.runs)
      out_.runs.push_back({run.kind, run.shift, run.last - run.first, in_.columns.data() + run.first, out_.places.data() + run.first,
                           coefficients_ + in_.columns[run.first].coefficients});
    for (const ProductTerm& term : in_.products) out_.products.push_back({cells(term.a), cells(term.b), coefficients_ + term.coefficients});
    for (const Block& block : in_.blocks)
      if (!block.direct) out_.copies.push_back(copy_of(block));
    for (const Pack& pack : in_.packs) add(pack);
    order_convolutions();
  }

 private:
  const double* cells(std::uint32_t block) const { return block == no_block ? nullptr : rows_ + in_.blocks[block].first; }

  void add(const Pack& pack) {
    ReadyPack ready{.kind = pack.kind, .lag = pack.lag, .out = pack.out, .carry = pack.carry, .first_run = pack.first_run,
                    .last_run = pack.last_run, .first_product = pack.first_product, .last_product = pack.last_product,
                    .a = cells(pack.a), .b = cells(pack.b), .y = cells(pack.y), .coefficients = coefficients_ + pack.coefficients,
                    .pack = &pack};
    ready.first_copy = static_cast<std::uint32_t>(out_.brought.size());
    bring(pack, pack.a);
    // The integral at order k reads w up to order k − 1, where it is final.
    if (pack.kind != Pack::Integral) bring(pack, pack.b);
    for (std::uint32_t p = pack.first_product; p < pack.last_product; ++p) bring(pack, in_.products[p].a), bring(pack, in_.products[p].b);
    ready.last_copy = static_cast<std::uint32_t>(out_.brought.size());
    ready.first_sum = static_cast<std::uint32_t>(out_.sums.size());
    for (const Convolution& c : convolutions_of(in_, pack)) add(c);
    mark_coordinates(ready);
    out_.packs.push_back(ready);
  }

  /// Of packs that read them in sums which are made ahead alone.
  void mark_coordinates(const ReadyPack& pack) {
    if (pack.kind != Pack::Integral && pack.kind != Pack::Sum) return;
    const auto has_sum = [](const SumAhead& sum) { return sum.number != SumAhead::no_sum; };
    if (!std::all_of(out_.sums.begin() + pack.first_sum, out_.sums.end(), has_sum)) return;
    for (std::uint32_t c = pack.first_copy; c < pack.last_copy; ++c) {
      Copy& copy = out_.brought[c];
      copy.of_coordinates = are_coordinates(copy.slots);
    }
  }
  bool are_coordinates(const Slot* slots) const { return std::all_of(slots, slots + lanes, [this](Slot slot) { return slot < in_.program.unknowns; }); }
  bool is_of_coordinates(std::uint32_t block) const { return !in_.blocks[block].direct && are_coordinates(in_.blocks[block].slots.data()); }

  /// Operands that are ahead of q̈, as functions of t alone may be, are left to the stages.
  void add(const Convolution& c) {
    const int a_ahead = c.lag - in_.blocks[c.a].lag, b_ahead = c.lag - in_.blocks[c.b].lag;
    SumAhead sum{.a_is_new = a_ahead == 0 && !is_of_coordinates(c.a), .b_is_new = b_ahead == 0 && !is_of_coordinates(c.b)};
    if (c.lag >= 0 && a_ahead <= c.lag && b_ahead <= c.lag) {
      sum.number = static_cast<std::uint32_t>(convolutions_++);
      classes_[{c.lag, a_ahead, b_ahead}].push_back({cells(c.a), cells(c.b), sum.number});
    }
    out_.sums.push_back(sum);
  }

  /// A few of each class in turn: neighbours have operands in common, which are then still in the first cache.
  void order_convolutions() {
    constexpr std::size_t at_once = 4;
    std::size_t most = 0;
    for (const auto& [key, members] : classes_) most = std::max(most, members.size());
    const std::size_t turns = std::max<std::size_t>(1, most / at_once);
    for (std::size_t turn = 0; turn < turns; ++turn)
      for (const auto& [key, members] : classes_) {
        const auto [lag, a_ahead, b_ahead] = key;
        const auto first = static_cast<std::uint32_t>(out_.convolutions.size());
        for (std::size_t i = members.size() * turn / turns; i < members.size() * (turn + 1) / turns; ++i) out_.convolutions.push_back(members[i]);
        const auto last = static_cast<std::uint32_t>(out_.convolutions.size());
        if (first != last) out_.convolution_runs.push_back({static_cast<std::int8_t>(lag), static_cast<std::int8_t>(a_ahead), static_cast<std::int8_t>(b_ahead), first, last});
      }
  }

  /// An operand at an order that is not final yet, or not there: its copy is not either.
  void bring(const Pack& pack, std::uint32_t index) {
    if (index == no_block || in_.blocks[index].direct || in_.blocks[index].lag < pack.lag) return;
    const Copy copy = copy_of(in_.blocks[index]);
    const std::uint32_t first = out_.packs.empty() ? 0 : out_.packs.back().last_copy;
    for (std::size_t i = first; i < out_.brought.size(); ++i)
      if (out_.brought[i].to == copy.to) return;
    out_.brought.push_back(copy);
  }

  ReadyProgram& out_;
  const PackedProgram& in_;
  const double* rows_;
  std::size_t stride_;
  const double* coefficients_;
  std::map<std::array<int, 3>, std::vector<ReadyConvolution>> classes_;  // by lag and how far the operands are ahead
  std::size_t convolutions_ = 0;
};

}  // namespace

ReadyProgram::ReadyProgram(const PackedProgram& program, const double* rows, std::size_t stride, const double* values) {
  Preparation(*this, program, rows, stride, values).run();
}

}  // namespace maupertuis::packed
