#include "kernel/packed/ready.hpp"

#include <algorithm>

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
    out_.packs.push_back(ready);
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
};

}  // namespace

ReadyProgram::ReadyProgram(const PackedProgram& program, const double* rows, std::size_t stride, const double* values) {
  Preparation(*this, program, rows, stride, values).run();
}

}  // namespace maupertuis::packed
