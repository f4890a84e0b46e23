#include "kernel/packed/layout.hpp"

#include "kernel/packed/columns.hpp"
#include "kernel/packed/grouping.hpp"
#include "kernel/packed/numbering.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <tuple>

/// Sums are written out (collapse), groups of instructions of one shape and level found and ordered (grouping), their
/// slots numbered group by group (numbering), and packs of up to eight lanes cut from the groups: here, with the blocks
/// and columns (columns) that they read.
namespace maupertuis::packed {
namespace {

constexpr std::size_t longest_sum_of_small = 64, longest_sum_of_large = 10;
constexpr std::size_t most_of_small = 16, shortest_chain = 8;

class Packs {
 public:
  /// `holes`: see columns_of().
  Packs(Renumbered renumbered, std::vector<Slot> number, const std::vector<Step>& steps,
        const std::vector<Group>& groups, bool holes)
      : steps_(steps), groups_(groups), index_(std::move(renumbered.index)), holes_(holes) {
    out_.program = std::move(renumbered.program);
    out_.number = std::move(number);
    zero_ = literal(0);
  }

  PackedProgram run() {
    next_cell_ = padded(out_.program.slots);
    for (const Group& group : groups_) {
      if (!group.packs) {
        for (const std::size_t i : group.steps) scalar(i, group.level);
        continue;
      }
      if (group.in_strands) {
        write_strands(group);
        continue;
      }
      const std::size_t end = group.front + group.steps.size(), chunks = padded(end) / lanes;
      for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
        const std::size_t first = lanes * (group.down ? chunks - 1 - chunk : chunk),
                          front = first == 0 ? group.front : 0;
        const Members all = group.steps;
        write_pack(all.subspan(first + front - group.front, std::min<std::size_t>(first + lanes, end) - first - front),
                   group, front);
      }
    }
    out_.cells = next_cell_;
    for (Pack& pack : out_.packs) convolutions(pack);
    return std::move(out_);
  }

 private:
  void scalar(std::size_t i, int level) {
    out_.packs.push_back({.kind = Pack::Scalar,
                          .lag = step(i).head.lag,
                          .level = static_cast<std::int8_t>(std::min(level, 127)),
                          .width = 1,
                          .out = out_.number[step(i).head.out],
                          .instruction = index_[i]});
  }

  using Members = std::span<const std::size_t>;

  /// Vector by vector in the order of the sum, then what the lanes before come to.
  void write_strands(const Group& group) {
    const std::size_t strands = group.steps.size() / lanes;
    const auto place = [&](std::size_t vector) { return out_.number[step(group.steps[lanes * vector]).head.out]; };
    const std::size_t begin = std::min_element(group.steps.begin(), group.steps.end()) - group.steps.begin();
    const bool upwards = begin / lanes == 0;
    Slot before = no_slot;
    for (std::size_t i = 0; i < strands; ++i) {
      const std::size_t vector = upwards ? i : strands - 1 - i;
      const Members members = Members(group.steps).subspan(lanes * vector, lanes);
      Pack pack = pack_of(members, group);
      pack.kind = Pack::Strand, pack.carry = before;
      columns(pack, members);
      out_.packs.push_back(pack);
      before = place(vector);
    }
    Pack join = pack_of(Members(group.steps).first(lanes), group);
    join.kind = group.down ? Pack::JoinDown : Pack::Join;
    join.carry = sum_before(group.steps[begin]);
    join.strands = static_cast<std::uint32_t>(strands), join.last_strand = before;
    out_.packs.push_back(join);
  }

  /// What a running sum goes on with there; no_slot: nothing.
  Slot sum_before(std::size_t index) const {
    const Slot before = out_.number[step(index).linear.front().a];
    return before == out_.program.one ? no_slot : before;
  }

  Pack pack_of(Members members, const Group& group, std::size_t front = 0) const {
    const Instruction& head = step(members[0]).head;
    return {.lag = head.lag,
            .level = static_cast<std::int8_t>(std::min(group.level, 127)),
            .width = static_cast<std::uint32_t>(front + members.size()),
            .out = static_cast<Slot>(out_.number[head.out] - front),
            .instruction = index_[members[0]]};
  }

  /// `front`: lanes before the first member.
  void write_pack(Members members, const Group& group, std::size_t front) {
    const Step& shape = step(members[0]);
    Pack pack = pack_of(members, group, front);
    if (shape.chain >= 0) return scan(pack, members, group, front);
    switch (shape.head.op) {
      case Op::SinCos:
        return pairs(pack, members, group, -1);
      case Op::SinhCosh:
        return pairs(pack, members, group, 1);
      case Op::Function:
        function(pack, members);
        break;
      case Op::Quotient:
        pack.kind = Pack::Quotient;
        pack.a = heads(members, &Instruction::a), pack.b = heads(members, &Instruction::b, true),
        pack.y = heads(members, &Instruction::out);
        break;
      case Op::SquareRoot:
        pack.kind = Pack::SquareRoot;
        pack.a = heads(members, &Instruction::a, true), pack.y = heads(members, &Instruction::out);
        break;
      case Op::Linear:
      case Op::Products:
      case Op::Square:
        sum(pack, members);
        break;
      case Op::Power:
      case Op::Derivative:
      case Op::Select:
      case Op::One:
      case Op::Time:
      case Op::Coordinate:
      case Op::Companion:
        throw unknown_op(shape.head.op, "a pack");
    }
    out_.packs.push_back(pack);
  }

  /// `filled`: lanes that are not in use repeat the first, since 0/0 would not be a number, and what reads vectors with
  /// holes reads them too.
  std::uint32_t heads(Members members, Slot Instruction::*operand, bool filled = false) {
    std::vector<Slot> slots;
    for (const std::size_t i : members) slots.push_back(out_.number[step(i).head.*operand]);
    return block(slots, false, holes_ && filled && slots.size() < lanes);
  }

  void function(Pack& pack, Members members) {
    pack.kind = Pack::Integral;
    std::vector<Slot> u, w;
    std::vector<ConstantId> c;
    functions(pack, members);
    for (const std::size_t i : members) {
      const Term& term = step(i).products[0];
      u.push_back(out_.number[term.b]), w.push_back(out_.number[term.a]), c.push_back(term.coefficient);
    }
    pack.a = block(u, true), pack.b = block(w, false), pack.coefficients = coefficients(c);
  }

  void functions(Pack& pack, Members members) {
    pack.first_function = static_cast<std::uint32_t>(out_.functions.size());
    for (const std::size_t i : members) out_.functions.push_back(index_[i]);
    pack.last_function = static_cast<std::uint32_t>(out_.functions.size());
  }

  /// d sin u = cos u du, d cos u = −sin u du: one pack if both fit, else two.
  void pairs(Pack pack, Members members, const Group& group, int sign) {
    pack.kind = Pack::Integral;
    const ConstantId plus = literal(1), other = literal(sign);
    std::vector<Slot> u, out, second;
    for (const std::size_t i : members)
      u.push_back(out_.number[step(i).head.a]), out.push_back(out_.number[step(i).head.out]),
          second.push_back(out_.number[step(i).head.second]);
    functions(pack, members);
    if (sign < 0) pack.pairs = second[0];
    const std::size_t count = members.size();
    if (2 * group.steps.size() <= lanes) {
      pack.width = static_cast<std::uint32_t>(2 * count);
      u.insert(u.end(), u.begin(), u.begin() + static_cast<std::ptrdiff_t>(count));
      std::vector<Slot> w = second;
      w.insert(w.end(), out.begin(), out.end());
      std::vector<ConstantId> c(count, plus);
      c.insert(c.end(), count, other);
      pack.a = block(u, true), pack.b = block(w, false), pack.coefficients = coefficients(c);
      out_.packs.push_back(pack);
      return;
    }
    pack.a = block(u, true), pack.b = block(second, false);
    pack.coefficients = coefficients(std::vector<ConstantId>(count, plus));
    out_.packs.push_back(pack);
    pack.out = second[0];
    pack.b = block(out, false);
    pack.coefficients = coefficients(std::vector<ConstantId>(count, other));
    pack.first_function = pack.last_function;
    out_.packs.push_back(pack);
  }

  void scan(Pack pack, Members members, const Group& group, std::size_t front) {
    pack.kind = group.down ? Pack::ScanDown : Pack::Scan;
    pack.carry = sum_before(group.down ? members.back() : members.front());
    columns(pack, members, front);
    out_.packs.push_back(pack);
  }

  /// What the engine reads, run by run.
  void columns(Pack& pack, Members members, std::size_t front = 0) {
    pack.first_column = static_cast<std::uint32_t>(out_.columns.size());
    pack.first_run = static_cast<std::uint32_t>(out_.runs.size());
    Sums sums = sums_of(members);
    sums.insert(sums.begin(), front, {});
    auto found = columns_of(out_.program, sums, zero_, holes_);
    const auto key = [&](const Column& column) {
      return std::tuple(column.shift, column.kind, passes_tangent(column, pack.lag));
    };
    std::stable_sort(found.begin(), found.end(),
                     [&](const ReadColumn& x, const ReadColumn& y) { return key(x.column) < key(y.column); });
    for (ReadColumn& read : found) {
      const auto at = static_cast<std::uint32_t>(out_.columns.size());
      if (at == pack.first_column || key(read.column) != key(out_.columns.back()))
        out_.runs.push_back({.kind = read.column.kind,
                             .shift = read.column.shift,
                             .passes_tangent = passes_tangent(read.column, pack.lag),
                             .first = at,
                             .last = at,
                             .source = read.column.source,
                             .coefficients = static_cast<std::uint32_t>(out_.coefficients.size()),
                             .neighbours = read.column.kind == Column::Broadcast});
      ColumnRun& run = out_.runs.back();
      run.neighbours = run.neighbours &&
                       (run.first == at || read.column.source == out_.columns[run.first].source + (at - run.first));
      ++run.last;
      add_column(std::move(read), pack.lag);
    }
    pack.last_column = static_cast<std::uint32_t>(out_.columns.size());
    pack.last_run = static_cast<std::uint32_t>(out_.runs.size());
    pack.first_later_run = pack.first_run + (pack.first_run != pack.last_run && is_of_one(out_.runs[pack.first_run]));
  }

  /// The number 1 has no orders but 0.
  bool is_of_one(const ColumnRun& run) const {
    return run.kind == Column::Broadcast &&
           std::all_of(out_.columns.begin() + run.first, out_.columns.begin() + run.last,
                       [this](const Column& column) { return column.source == out_.program.one; });
  }

  Sums sums_of(Members members) const {
    Sums sums;
    for (const std::size_t i : members) sums.push_back(terms_of(i));
    return sums;
  }

  /// Of a running sum: what is added.
  std::vector<Term> terms_of(std::size_t index) const {
    std::vector<Term> terms(step(index).linear.begin() + (step(index).chain >= 0 ? 1 : 0), step(index).linear.end());
    for (Term& term : terms) term.a = out_.number[term.a];
    return terms;
  }

  void sum(Pack& pack, Members members) {
    pack.kind = Pack::Sum;
    columns(pack, members);
    pack.first_aligned = static_cast<std::uint32_t>(out_.columns.size());
    for (ReadColumn& read : aligned_columns_of(out_.program, sums_of(members), zero_))
      add_column(std::move(read), pack.lag);
    pack.last_aligned = static_cast<std::uint32_t>(out_.columns.size());
    pack.first_product = static_cast<std::uint32_t>(out_.products.size());
    const Step& shape = step(members[0]);
    if (shape.head.op == Op::Square) {
      const std::uint32_t a = heads(members, &Instruction::a);
      out_.products.push_back({a, a, coefficients(std::vector<ConstantId>(members.size(), literal(1)))});
    }
    for (std::size_t t = 0; t < shape.products.size(); ++t) {
      std::vector<Slot> a, b;
      std::vector<ConstantId> c;
      for (const std::size_t i : members) {
        const Term& term = step(i).products[t];
        a.push_back(out_.number[term.a]), b.push_back(out_.number[term.b]), c.push_back(term.coefficient);
      }
      out_.products.push_back({block(a, false), block(b, false), coefficients(c)});
    }
    pack.last_product = static_cast<std::uint32_t>(out_.products.size());
  }

  void convolutions(Pack& pack) {
    pack.first_convolution = static_cast<std::uint32_t>(out_.convolutions.size());
    switch (pack.kind) {
      case Pack::Sum:
        for (std::uint32_t i = pack.first_product; i < pack.last_product; ++i)
          convolution(pack, out_.products[i].a, out_.products[i].b);
        break;
      case Pack::Integral:
        convolution(pack, pack.a, pack.b);
        break;
      case Pack::Quotient:
        convolution(pack, pack.b, pack.y);
        break;
      case Pack::SquareRoot:
        convolution(pack, pack.y, pack.y);
        break;
      case Pack::Scan:
      case Pack::ScanDown:
      case Pack::Strand:
      case Pack::Join:
      case Pack::JoinDown:
      case Pack::Scalar:
        break;
    }
    pack.last_convolution = static_cast<std::uint32_t>(out_.convolutions.size());
    pack.is_neighbours = pack.kind == Pack::Sum && pack.first_convolution == pack.last_convolution &&
                         pack.last_run - pack.first_later_run == 1 && out_.runs[pack.first_later_run].neighbours;
  }

  void convolution(const Pack& pack, std::uint32_t a, std::uint32_t b) {
    const auto ahead = [&](std::uint32_t block) { return static_cast<std::int8_t>(pack.lag - out_.blocks[block].lag); };
    out_.convolutions.push_back({a, b, pack.lag, ahead(a), ahead(b), out_.blocks[a].first, out_.blocks[b].first});
  }

  bool passes_tangent(const Column& column, int lag) const {
    return out_.program.tangent_lags[column.source] + column.shift == lag;
  }

  void add_column(ReadColumn read, int lag) {
    read.column.passes_tangent = passes_tangent(read.column, lag);
    read.column.coefficients = coefficients(std::move(read.coefficients));
    out_.columns.push_back(read.column);
  }

  std::uint32_t coefficients(std::vector<ConstantId> c) {
    const auto first = static_cast<std::uint32_t>(out_.coefficients.size());
    c.resize(lanes, zero_);
    out_.coefficients.insert(out_.coefficients.end(), c.begin(), c.end());
    return first;
  }

  std::uint32_t block(const std::vector<Slot>& slots, bool weighted, bool filled = false) {
    bool range = !weighted && !filled && (slots.size() == lanes || slots[0] % lanes == 0);
    for (std::size_t lane = 0; lane < slots.size(); ++lane) range = range && slots[lane] == slots[0] + lane;
    const auto [place, fresh] = blocks_.try_emplace({slots, weighted ? 1
                                                            : filled ? 2
                                                                     : 0},
                                                    static_cast<std::uint32_t>(out_.blocks.size()));
    if (!fresh) return place->second;
    Block result{.first = slots[0],
                 .direct = range,
                 .weighted = weighted,
                 .lag = out_.program.lags[slots[0]],
                 .width = static_cast<std::uint32_t>(slots.size())};
    result.slots.fill(slots[0]);
    std::copy(slots.begin(), slots.end(), result.slots.begin());
    result.is_range = !filled && (slots.size() == lanes || slots[0] % lanes == 0);
    for (std::size_t lane = 0; lane < slots.size(); ++lane)
      result.is_range = result.is_range && slots[lane] == slots[0] + lane;
    find_vectors(result);
    if (!range) {
      result.first = static_cast<Slot>(next_cell_);
      next_cell_ += lanes;
    }
    out_.blocks.push_back(result);
    return place->second;
  }

  static void find_vectors(Block& block) {
    const auto vector_of = [&](std::size_t lane) { return block.slots[lane] / lanes * lanes; };
    block.vectors = {vector_of(0), vector_of(0)};
    block.in_two_vectors = true;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      auto& [first, second] = block.vectors;
      if (first == second) second = vector_of(lane);
      block.in_two_vectors = block.in_two_vectors && (vector_of(lane) == first || vector_of(lane) == second);
      block.places[lane] = block.slots[lane] % lanes + (vector_of(lane) == first ? 0 : lanes);
    }
  }

  ConstantId literal(int value) {
    const auto [place, fresh] = literals_.try_emplace(value, 0);
    if (fresh) {
      out_.program.constants.push_back({.kind = Kind::Number, .value = static_cast<double>(value)});
      place->second = static_cast<ConstantId>(out_.program.constants.size() - 1);
    }
    return place->second;
  }

  const Step& step(std::size_t index) const { return steps_[index]; }

  PackedProgram out_;
  const std::vector<Step>& steps_;
  const std::vector<Group>& groups_;
  std::vector<std::uint32_t> index_;  // [steps] of their instructions
  std::map<std::pair<std::vector<Slot>, int>, std::uint32_t> blocks_;
  std::map<int, ConstantId> literals_;
  ConstantId zero_ = 0;
  std::size_t next_cell_ = 0;
  bool holes_;
};

}  // namespace

PackedProgram pack(const Program& program, const LaneOrder& order) {
  const bool large = program.unknowns > most_of_small;
  Program extended = program;  // with the constants of the steps
  std::vector<Step> steps = dynamics_of(program);
  write_derivatives(extended, steps);
  if (large) find_chains(extended, steps, shortest_chain);
  collapse_sums(extended, steps, large ? longest_sum_of_large : longest_sum_of_small);
  // of large ones, lifted solutions know the slots of the program as it was
  if (!large) scale_factors(extended, steps);
  const std::vector<Group> groups = group_steps(program, steps, order);
  Numbering numbering = number_slots(program, steps, groups);
  Renumbered renumbered = renumber(program, std::move(extended), steps, groups, numbering);
  return Packs(std::move(renumbered), std::move(numbering.number), steps, groups, large && has_no_choices(program))
      .run();
}

}  // namespace maupertuis::packed
