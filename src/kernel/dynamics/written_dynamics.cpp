#include "kernel/dynamics/written_dynamics.hpp"

#include "kernel/sparse/written_elimination.hpp"
#include "kernel/sparse/written_entries.hpp"

#include <map>
#include <stdexcept>
#include <tuple>

namespace maupertuis::dynamics {
namespace {

using straight::Builder;
using straight::Term;
using straight::Value;

/// A pivot below this leaves the solution to the interpreter, which knows other ways.
constexpr double least_share = 1e-3, least_full_share = 1e-6;
/// From this many coordinates on, columns of M₀ stand side by side in wide values.
constexpr std::size_t least_wide = 5;
/// Nodes. Of a full matrix more numbers are alive at a time.
constexpr std::size_t most_sorted = 2500, most_sorted_full = 400;

/// Numbers that both lines share.
class Numbers {
 public:
  Numbers(const Program& program, std::vector<NumberSource>& sources) : program_(program), sources_(sources) {}

  Value coefficient(Builder& to, const Coefficient& c) {
    if (c.constant == no_constant) return to.literal(c.offset);
    const Constant& constant = program_.constants[c.constant];
    if (constant.kind == Kind::Number) return to.literal(c.factor * constant.value + c.offset);
    return number(to, {NumberSource::OfCoefficient, c}, {c.factor, c.offset, c.constant});
  }
  Value constant(Builder& to, ConstantId id) { return coefficient(to, {id, 1, 0}); }
  Value choice(Builder& to, std::uint32_t edge) { return number(to, {NumberSource::OfChoice, {}, edge}, {0, 0, edge}); }
  Value usual_size(Builder& to, std::uint32_t pivot) { return number(to, {NumberSource::OfPivot, {}, pivot}, {0, 0, pivot}); }

 private:
  using Key = std::tuple<double, double, std::uint32_t>;
  Value number(Builder& to, const NumberSource& source, const Key& key) {
    const auto [found, fresh] = index_.try_emplace({source.what, key}, static_cast<std::uint32_t>(sources_.size()));
    if (fresh) sources_.push_back(source);
    return to.given(NumberArray, found->second);
  }

  const Program& program_;
  std::vector<NumberSource>& sources_;
  std::map<std::pair<std::uint8_t, Key>, std::uint32_t> index_;
};

/// A flat program, cell by cell.
class FlatWriter {
 public:
  FlatWriter(Builder& to, Numbers& numbers, const Program& program, const FlatProgram& flat)
      : to_(to), numbers_(numbers), flat_(flat), cells_(flat.cells, straight::none), read_(flat.cells, false) {
    const std::size_t n = program.unknowns;
    cells_[cell_of_one] = to.literal(1);
    cells_[cell_of_zero] = to.literal(0);
    cells_[cell_of_time] = to.given(TimeArray, 0);
    for (std::uint32_t i = 0; i < n; ++i) {
      cells_[first_coordinate_cell + i] = to.given(PositionArray, i);
      cells_[first_coordinate_cell + n + i] = to.given(VelocityArray, i);
      cells_[first_coordinate_cell + 2 * n + i] = to.product(0.5, to.given(AccelerationArray, i));
    }
    find_read();
  }

  void run() {
    for (const FlatStep& step : flat_.steps) switch (step.kind) {
        case FlatStep::Sum: sums(flat_.sums[step.index]); break;
        case FlatStep::Sine: sines(flat_.sines[step.index]); break;
        case FlatStep::Function: function(flat_.functions[step.index]); break;
        case FlatStep::Choose: choose(flat_.choices[step.index]); break;
      }
  }

  Value at(Cell cell) const {
    if (cells_[cell] == straight::none) throw std::logic_error("a cell is read before it is there; please report");
    return cells_[cell];
  }

 private:
  void find_read() {
    for (const auto* list : {&flat_.linear_cell, &flat_.product_a, &flat_.product_b, &flat_.sum_divisor, &flat_.choice_cells, &flat_.residual, &flat_.value_of_slot})
      for (const Cell cell : *list) read_[cell] = true;
    for (const FunctionCall& call : flat_.functions) read_[call.a] = read_[call.b] = true;
    for (const SineRun& run : flat_.sines)
      for (const Cell cell : run.angle) read_[cell] = true;
  }

  void sums(const SumRun& run) {
    std::uint32_t linear = run.first_linear, product = run.first_product;
    for (std::uint32_t i = run.first; i < run.last; ++i) {
      std::vector<Term> terms;
      for (std::uint32_t k = 0; k < run.linear; ++k, ++linear)
        terms.push_back({1, numbers_.coefficient(to_, flat_.linear_coefficient[linear]), at(flat_.linear_cell[linear])});
      for (std::uint32_t k = 0; k < run.products; ++k, ++product)
        terms.push_back({1, numbers_.coefficient(to_, flat_.product_coefficient[product]), at(flat_.product_a[product]), at(flat_.product_b[product])});
      cells_[flat_.sum_out[i]] = to_.sum(std::move(terms), straight::none, run.divides ? at(flat_.sum_divisor[i]) : straight::none);
    }
  }

  void sines(const SineRun& run) {
    std::vector<Value> angles;
    std::vector<std::uint32_t> lanes;
    for (std::uint32_t lane = 0; lane < run.angle.size(); ++lane)
      if (read_[run.out + lane] || read_[run.out + 8 + lane]) angles.push_back(at(run.angle[lane])), lanes.push_back(lane);
    const auto both = to_.sines(angles);
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      cells_[run.out + lanes[i]] = both[i].first;
      cells_[run.out + 8 + lanes[i]] = both[i].second;
    }
  }

  void function(const FunctionCall& call) {
    const Value a = at(call.a);
    switch (call.op) {
      case Op::SquareRoot: cells_[call.out] = to_.root(a); break;
      case Op::Power: cells_[call.out] = to_.call(Kind::Power, a, numbers_.constant(to_, call.exponent)); break;
      case Op::SinhCosh:
        cells_[call.out] = to_.call(Kind::Sinh, a);
        cells_[call.second] = to_.call(Kind::Cosh, a);
        break;
      case Op::Function: cells_[call.out] = to_.call(call.function, a, call.function == Kind::Atan2 ? at(call.b) : straight::none); break;
      case Op::One: case Op::Time: case Op::Coordinate: case Op::Companion: case Op::Linear: case Op::Products: case Op::Square:
      case Op::Quotient: case Op::SinCos: case Op::Derivative: case Op::Select: throw unknown_op(call.op, "a call");
    }
  }

  /// The first whose condition holds, else the last.
  void choose(const Choice& choice) {
    Value value = at(flat_.choice_cells[choice.last - 1]);
    for (std::uint32_t k = choice.last - 1; k-- > choice.first;)
      value = to_.choose(numbers_.constant(to_, flat_.choice_conditions[k]), at(flat_.choice_cells[k]), value);
    cells_[choice.out] = value;
  }

  Builder& to_;
  Numbers& numbers_;
  const FlatProgram& flat_;
  std::vector<Value> cells_;
  std::vector<bool> read_;  // [cells]
};

/// The entries of a lifted system from the values at order 0.
std::vector<Value> write_entries(Builder& to, Numbers& numbers, const sparse::LiftedSystem& system, const FlatWriter& flat,
                                 const FlatProgram& program) {
  const sparse::EntryWriter write(system, {.value = [&](Builder&, Slot slot) { return flat.at(program.value_of_slot[slot]); },
                                           .constant = [&](Builder& b, ConstantId id) { return numbers.constant(b, id); },
                                           .choice = [&](Builder& b, std::uint32_t edge) { return numbers.choice(b, edge); }});
  std::vector<Value> out;
  for (std::uint32_t e = 0; e < system.entries.size(); ++e) out.push_back(write(to, e));
  return out;
}

// ---------------------------------------------------------------------------------------------------------------- the full matrix

/// The lower triangle of M₀ along the tangent graph, its columns one by one or side by side.
class MatrixWriter {
 public:
  MatrixWriter(Builder& to, const sparse::LiftedSystem& system, std::span<const Value> entries)
      : to_(to), system_(system), entries_(entries), n_(system.row_of_residual.size()), is_wide_(n_ >= least_wide) {}

  /// [n × n] below the diagonal and on it.
  std::vector<Value> run() {
    sort_entries();
    std::vector<Value> m(n_ * n_, straight::none);
    if (is_wide_) tangents_.resize(system_.size, straight::none);
    columns_.assign(is_wide_ ? 0 : system_.size, std::vector<Value>(n_, to_.literal(0)));
    for (std::uint32_t j = 0; j < n_; ++j) {
      if (is_wide_) tangents_[j] = to_.unit(j);
      else columns_[j][j] = to_.literal(1);
    }
    for (const std::uint32_t row : system_.rows_of_slots)
      if (column_[row] != straight::none) tangent(row);
    for (std::uint32_t i = 0; i < n_; ++i) {
      const std::uint32_t row = system_.row_of_residual[i];
      const Value all = is_wide_ ? to_.wide(wide_terms(row)) : straight::none;
      for (std::uint32_t j = 0; j <= i; ++j) m[i * n_ + j] = is_wide_ ? to_.lane(all, j) : to_.sum(terms(row, j));
    }
    return m;
  }

 private:
  void sort_entries() {
    of_row_.resize(system_.size);
    column_.assign(system_.size, straight::none);
    for (std::uint32_t e = 0; e < system_.entries.size(); ++e) of_row_[system_.entries[e].row].push_back(e);
    for (const std::uint32_t e : system_.minus_one) {
      column_[system_.entries[e].row] = system_.entries[e].column;
      std::erase(of_row_[system_.entries[e].row], e);
    }
  }

  void tangent(std::uint32_t row) {
    const std::uint32_t out = column_[row];
    if (is_wide_) tangents_[out] = to_.wide(wide_terms(row));
    else
      for (std::uint32_t j = 0; j < n_; ++j) columns_[out][j] = to_.sum(terms(row, j));
  }

  std::vector<Term> terms(std::uint32_t row, std::uint32_t j) const {
    std::vector<Term> out;
    for (const std::uint32_t e : of_row_[row]) out.push_back({1, entries_[e], columns_[system_.entries[e].column][j]});
    return out;
  }
  std::vector<Term> wide_terms(std::uint32_t row) const {
    std::vector<Term> out;
    for (const std::uint32_t e : of_row_[row]) out.push_back({1, entries_[e], straight::none, tangents_[system_.entries[e].column]});
    return out;
  }

  Builder& to_;
  const sparse::LiftedSystem& system_;
  std::span<const Value> entries_;
  std::size_t n_;
  bool is_wide_;
  std::vector<std::vector<std::uint32_t>> of_row_;  // [rows] entries but that of its own slot
  std::vector<std::uint32_t> column_;               // [rows] of the slot that it gives
  std::vector<Value> tangents_;                     // [columns]
  std::vector<std::vector<Value>> columns_;         // [columns][n]
};

/// x of two equations by their determinant, so that one division is all that waits for it.
std::vector<Value> write_pair_solution(Builder& to, Value a, Value b, Value c, std::span<const Value> right) {
  const Value determinant = to.sum({{1, a, c}, {-1, b, b}});
  to.check({a, a, least_full_share});
  to.check({determinant, to.product(1, a, c), least_full_share});
  const Value inverse = to.reciprocal(determinant);
  return {to.sum({{1, c, right[0]}, {-1, b, right[1]}}, inverse), to.sum({{1, a, right[1]}, {-1, b, right[0]}}, inverse)};
}

/// x with L D Lᵀ x = b; m: [n × n], its lower triangle.
std::vector<Value> write_full_solution(Builder& to, std::vector<Value> m, std::span<const Value> b) {
  const std::size_t n = b.size();
  if (n == 2) return write_pair_solution(to, m[0], m[2], m[3], b);
  const auto at = [&](std::size_t i, std::size_t j) -> Value& { return m[i * n + j]; };  // above the diagonal: D Lᵀ
  std::vector<Value> y(b.begin(), b.end()), x(n), inverse(n);
  for (std::size_t j = 0; j < n; ++j) {
    std::vector<Term> pivot{{1, at(j, j)}};
    for (std::size_t k = 0; k < j; ++k) pivot.push_back({-1, at(j, k), at(k, j)});
    const Value d = to.sum(pivot);
    to.check({d, at(j, j), least_full_share});
    inverse[j] = to.reciprocal(d);
    for (std::size_t i = j + 1; i < n; ++i) {
      std::vector<Term> sum{{1, at(i, j)}};
      for (std::size_t k = 0; k < j; ++k) sum.push_back({-1, at(i, k), at(k, j)});
      at(j, i) = to.sum(std::move(sum));
      at(i, j) = to.product(1, at(j, i), inverse[j]);
    }
    for (std::size_t i = j + 1; i < n; ++i) y[i] = to.sum({{1, y[i]}, {-1, at(i, j), y[j]}});
  }
  for (std::size_t i = n; i-- > 0;) {
    std::vector<Term> sum{{1, y[i], inverse[i]}};
    for (std::size_t k = i + 1; k < n; ++k) sum.push_back({-1, at(k, i), x[k]});
    x[i] = to.sum(std::move(sum));
  }
  return x;
}

straight::StraightLine write_forces(const Program& program, const FlatProgram& moving, Numbers& numbers) {
  Builder to;
  FlatWriter flat(to, numbers, program, moving);
  flat.run();
  const Value anchor = to.next();
  for (std::uint32_t i = 0; i < moving.residual.size(); ++i) to.store(flat.at(moving.residual[i]), ResultArray, i);
  to.guard();
  return to.finish(arrays, 1, anchor);
}

straight::StraightLine write_accelerations(const Program& program, const FlatProgram& at_rest, const WrittenPlan& plan, Numbers& numbers) {
  Builder to;
  FlatWriter flat(to, numbers, program, at_rest);
  flat.run();
  const std::vector<Value> entries = write_entries(to, numbers, plan.system, flat, at_rest);
  const Value anchor = to.next();
  // M₀ comes first, since more waits for it.
  const std::vector<Value> m = plan.pivots ? std::vector<Value>() : MatrixWriter(to, plan.system, entries).run();
  std::vector<Value> b, x, usual;
  for (const Cell cell : at_rest.residual) b.push_back(to.product(-1, flat.at(cell)));
  if (plan.pivots) {
    for (std::uint32_t p = 0; p < plan.pivots->size(); ++p) usual.push_back(numbers.usual_size(to, p));
    x = sparse::write_solution(to, {plan.system, *plan.pivots, entries, usual, least_share}, b);
  } else {
    x = write_full_solution(to, m, b);
  }
  for (std::uint32_t i = 0; i < b.size(); ++i) to.store(x[i], ResultArray, i), to.require_finite(x[i]);
  to.guard();
  std::uint32_t wide = 1;
  while (wide < b.size() && wide < 8) wide *= 2;
  return to.finish(arrays, wide, anchor, plan.pivots ? most_sorted : most_sorted_full);
}

}  // namespace

WrittenDynamics write_dynamics(const Program& program, const FlatProgram& moving, const FlatProgram& at_rest, const WrittenPlan& plan) {
  WrittenDynamics out;
  Numbers numbers(program, out.numbers);
  out.forces = write_forces(program, moving, numbers);
  out.accelerations = write_accelerations(program, at_rest, plan, numbers);
  return out;
}

}  // namespace maupertuis::dynamics
