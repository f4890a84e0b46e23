#include "kernel/packed/ready.hpp"

#include "kernel/packed/compiled.hpp"
#include "kernel/packed/convolutions.hpp"

#include <algorithm>
#include <cmath>
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
  Preparation(ReadyProgram& out, const PackedProgram& program, const Numbers& numbers) : out_(out), in_(program), numbers_(numbers) {}

  void run() {
    reserve();
    for (const Column& column : in_.columns) out_.places.push_back(static_cast<Slot>(column.source + column.shift * numbers_.stride));
    for (const ColumnRun& run : in_.runs)
      out_.runs.push_back({run.kind, run.shift, is_of_neighbours(run), run.last - run.first, in_.columns.data() + run.first, out_.places.data() + run.first,
                           numbers_.coefficients + in_.columns[run.first].coefficients});
    for (const Block& block : in_.blocks)
      if (!block.direct) out_.copies.push_back(copy_of(block));
    for (const Pack& pack : in_.packs) add(pack);
    order_convolutions();
  }

 private:
  /// Room for all that comes, since lists are known by their addresses.
  void reserve() {
    constexpr std::size_t most_ends = 4;
    const std::size_t convolutions = count_convolutions(in_);
    out_.places.reserve(in_.columns.size());
    out_.runs.reserve(in_.runs.size());
    out_.brought.reserve(2 * (in_.packs.size() + convolutions));
    out_.products.reserve(convolutions);
    out_.ends.reserve(most_ends * convolutions);
    out_.convolutions.reserve(convolutions);
  }

  /// Behind what is there.
  template <class T>
  static T* end_of(std::vector<T>& list) { return list.data() + list.size(); }

  const double* cells(std::uint32_t block) const { return block == no_block ? nullptr : numbers_.rows + in_.blocks[block].first; }
  const double* at(const double* operand, int order) const { return operand + order * static_cast<std::ptrdiff_t>(numbers_.stride); }

  void add(const Pack& pack) {
    ReadyPack ready{.kind = pack.kind, .lag = pack.lag, .out = pack.out, .carry = pack.carry,
                    .runs = out_.runs.data() + pack.first_run, .last_run = out_.runs.data() + pack.last_run,
                    .a = cells(pack.a), .b = cells(pack.b), .y = cells(pack.y), .coefficients = numbers_.coefficients + pack.coefficients,
                    .pack = &pack};
    ready.later_runs = ready.runs + (pack.first_run != pack.last_run && is_of_one(in_.runs[pack.first_run]));
    ready.products = end_of(out_.products);
    std::uint32_t term = pack.first_product;
    for (const Convolution& c : convolutions_of(in_, pack)) {
      add(c, pack.kind);
      if (pack.kind == Pack::Sum) out_.products.back().coefficients = numbers_.coefficients + in_.products[term++].coefficients;
    }
    ready.last_product = end_of(out_.products);
    ready.way = way_of(ready);
    bring(ready);
    out_.packs.push_back(ready);
  }

  static bool has_sums(const ReadyPack& pack) {
    return std::all_of(pack.products, pack.last_product, [](const ReadyProduct& product) { return product.sum != nullptr; });
  }

  static std::uint8_t way_of(const ReadyPack& pack) {
    const bool is_one_run = pack.last_run - pack.later_runs == 1 && pack.products == pack.last_product;
    if (pack.kind == Pack::Sum && is_one_run && pack.later_runs->neighbours) return Neighbours;
    if (pack.kind == Pack::Sum && pack.later_runs == pack.last_run && has_sums(pack)) return Products;
    if (pack.kind == Pack::Integral && has_sums(pack)) return IntegralBySum;
    return pack.kind;
  }

  bool is_of_neighbours(const ColumnRun& run) const {
    for (std::uint32_t i = run.first; i < run.last; ++i)
      if (in_.columns[i].source != in_.columns[run.first].source + (i - run.first)) return false;
    return run.kind == Column::Broadcast;
  }

  /// The number 1 has no orders but 0.
  bool is_of_one(const ColumnRun& run) const {
    return run.kind == Column::Broadcast && std::all_of(in_.columns.begin() + run.first, in_.columns.begin() + run.last,
                                                        [this](const Column& column) { return column.source == in_.program.one; });
  }

  // --------------------------------------------------------------------------------------------------------- copies

  /// Coordinates that a pack reads in sums made ahead alone come last: q_{k+2} is 0 from stage 1 on, and so are their copies.
  void bring(ReadyPack& ready) {
    const Pack& pack = *ready.pack;
    Copy* const first = end_of(out_.brought);
    bring(pack, first, pack.a);
    // The integral at order k reads w up to order k − 1, where it is final.
    if (pack.kind != Pack::Integral) bring(pack, first, pack.b);
    for (std::uint32_t p = pack.first_product; p < pack.last_product; ++p) bring(pack, first, in_.products[p].a), bring(pack, first, in_.products[p].b);
    Copy* const last = end_of(out_.brought);
    const bool by_sums = (pack.kind == Pack::Integral || pack.kind == Pack::Sum) && has_sums(ready);
    const auto is_needed = [&](const Copy& copy) { return !by_sums || !are_coordinates(copy.slots); };
    ready.copies = first;
    ready.last_copy = last;
    ready.last_copy_ahead = std::stable_partition(first, last, is_needed);
  }

  /// An operand at an order that is not final yet, or not there: its copy is not either.
  void bring(const Pack& pack, const Copy* first, std::uint32_t index) {
    if (index == no_block || in_.blocks[index].direct || in_.blocks[index].lag < pack.lag) return;
    const Copy copy = copy_of(in_.blocks[index]);
    const Copy* const last = end_of(out_.brought);
    if (std::none_of(first, last, [&](const Copy& other) { return other.to == copy.to; })) out_.brought.push_back(copy);
  }

  bool are_coordinates(const Slot* slots) const { return std::all_of(slots, slots + lanes, [this](Slot slot) { return slot < in_.program.unknowns; }); }
  bool is_of_coordinates(std::uint32_t block) const { return !in_.blocks[block].direct && are_coordinates(in_.blocks[block].slots.data()); }

  // ----------------------------------------------------------------------------------------------------------- sums

  /// Operands that are ahead of q̈, as functions of t alone may be, are left to the stages.
  void add(const Convolution& c, Pack::Kind kind) {
    const int a_ahead = c.lag - in_.blocks[c.a].lag, b_ahead = c.lag - in_.blocks[c.b].lag;
    ReadyProduct product{.a = cells(c.a), .b = cells(c.b)};
    if (numbers_.sums && c.lag >= 0 && a_ahead <= c.lag && b_ahead <= c.lag) {
      double* const sums = numbers_.sums + convolutions_++ * (rolled_group * lanes);
      classes_[{c.lag, a_ahead, b_ahead}].push_back({product.a, product.b, sums});
      product.sum = sums;
      add_ends(c, kind, a_ahead, b_ahead, product);
    }
    out_.products.push_back(product);
  }

  /// What the stage before has found of an operand that is D_a ahead is a_{k−1+D_a}, and meets b_{1−D_a}. This stage finds a_k, unless it is the end that an
  /// integral does not have at w, and quotients and roots not at what they find.
  void add_ends(const Convolution& c, Pack::Kind kind, int a_ahead, int b_ahead, ReadyProduct& product) {
    const double *const a = product.a, *const b = product.b;
    product.ends = end_of(out_.ends);
    if (a_ahead <= 1) out_.ends.push_back({at(a, a_ahead - 1), at(b, 1 - a_ahead)});
    if (b_ahead <= 1) out_.ends.push_back({at(b, b_ahead - 1), at(a, 1 - b_ahead)});
    product.new_ends = end_of(out_.ends);
    if (a_ahead == 0 && !is_of_coordinates(c.a) && kind != Pack::SquareRoot) out_.ends.push_back({a, b});
    if (b_ahead == 0 && !is_of_coordinates(c.b) && kind == Pack::Sum) out_.ends.push_back({b, a});
    product.last_end = end_of(out_.ends);
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
        const ReadyConvolution* const first = end_of(out_.convolutions);
        for (std::size_t i = members.size() * turn / turns; i < members.size() * (turn + 1) / turns; ++i) out_.convolutions.push_back(members[i]);
        const ReadyConvolution* const last = end_of(out_.convolutions);
        if (first != last) out_.convolution_runs.push_back({static_cast<std::uint8_t>(kind_of(lag, a_ahead, b_ahead)), first, last});
      }
  }

  ReadyProgram& out_;
  const PackedProgram& in_;
  const Numbers& numbers_;
  std::map<std::array<int, 3>, std::vector<ReadyConvolution>> classes_;  // by lag and how far the operands are ahead
  std::size_t convolutions_ = 0;
};

}  // namespace

std::vector<Order> orders_of(double* rows, std::size_t stride, int count) {
  std::vector<Order> out;
  for (int number = 0; number < count; ++number) {
    const std::ptrdiff_t offset = number * static_cast<std::ptrdiff_t>(stride);
    const double k = number;
    const Reciprocal reciprocal = number == 0 ? Reciprocal{} : Reciprocal{1 / k, std::fma(-k, 1 / k, 1.0) / k};
    out.push_back({rows + offset, offset, {1, k + 1, (k + 1) * (k + 2)}, reciprocal, number});
  }
  return out;
}

ReadyProgram::ReadyProgram(const PackedProgram& program, const Numbers& numbers) { Preparation(*this, program, numbers).run(); }

}  // namespace maupertuis::packed
