#include "kernel/dynamics/point_writer.hpp"

#include "kernel/straight_line/power.hpp"

#include <algorithm>

namespace maupertuis::dynamics {

using straight::none;
using straight::Term;
using straight::Value;

Value Numbers::number(straight::Builder& to, NumberSource source) {
  const auto [found, fresh] =
      index_.try_emplace({source.what, source.index}, static_cast<std::uint32_t>(sources_.size()));
  if (fresh) sources_.push_back(source);
  return to.given(NumberArray, found->second);
}

PointWriter::PointWriter(straight::Builder& to, Numbers& numbers, const Program& program, bool with_accelerations)
    : to_(to),
      numbers_(numbers),
      program_(program),
      orders_(1 - program.first_stage),
      zero_(to.literal(0)),
      value_(program.slots, std::vector<Value>(static_cast<std::size_t>(orders_), zero_)) {
  if (program.one != no_slot) put(program.one, 0, to.literal(1));
  if (program.time != no_slot) put(program.time, 0, to.given(TimeArray, 0)), put(program.time, 1, to.literal(1));
  for (Slot i = 0; i < program.freedoms; ++i)
    put(i, 0, to.given(PositionArray, i)), put(i, 1, to.given(VelocityArray, i));
  for (Slot i = 0; i < program.freedoms && with_accelerations; ++i)
    put(i, 2, to.product(0.5, to.given(AccelerationArray, i)));
  for (int stage = program.first_stage; stage <= 0; ++stage)
    for (const Run& run : program.runs[Dynamics])
      if (const int order = stage + 2 - run.lag; order >= 0) write(run, order);
}

void PointWriter::write(const Run& run, int order) {
  if (run.op == Op::SinCos && order == 0) return sines(run);
  for (std::uint32_t i = run.first; i < run.last; ++i) write(program_.instructions[i], order);
}

void PointWriter::write(const Instruction& i, int k) {
  switch (i.op) {
    case Op::Linear:
    case Op::Products:
      return put(i.out, k, sum(i, k));
    case Op::Square: {
      Terms terms;
      for (int j = 0; j <= k; ++j) product(terms, {}, i.a, j, i.a, k - j);
      return put(i.out, k, to_.sum(std::move(terms)));
    }
    case Op::Quotient:
      return put(i.out, k, quotient(i, k));
    case Op::SquareRoot:
      return put(i.out, k, k == 0 ? to_.root(at(i.a)) : root(i, k));
    case Op::Power:
      return put(i.out, k, power(i, k));
    case Op::SinCos:
      return pair(i, k, -1);
    case Op::SinhCosh:
      return pair(i, k, 1);
    case Op::Function:
      return put(i.out, k, function(i, k));
    case Op::Derivative:
      return put(i.out, k, to_.product(k + 1, at(i.a, k + 1)));
    case Op::Select:
      return put(i.out, k, select(i, k));
    case Op::One:
    case Op::Time:
    case Op::Coordinate:
    case Op::Companion:
      return;
  }
  throw unknown_op(i.op, "a point of a program");
}

/// Adds factor · term.a · a_i b_j. Of a square a_i b_j and a_j b_i are one term.
void PointWriter::product(Terms& terms, Term term, Slot a, int i, Slot b, int j) const {
  const Value x = at(a, i), y = at(b, j);
  if (x == zero_ || y == zero_) return;
  const auto same = std::find_if(terms.begin(), terms.end(), [&](const Term& t) {
    return t.a == term.a && std::minmax(t.b, t.c) == std::minmax(x, y);
  });
  if (same != terms.end())
    same->factor += term.factor;
  else
    terms.push_back({term.factor, term.a, x, y});
}

Value PointWriter::sum(const Instruction& i, int k) {
  Terms terms;
  for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
    const auto& term = program_.terms[t];
    const Value c = numbers_.constant(to_, term.coefficient);
    if (term.b == no_slot) {
      const double factor = term.shift == 0 ? 1 : term.shift == 1 ? k + 1.0 : (k + 1.0) * (k + 2.0);
      terms.push_back({factor, c, at(term.a, k + static_cast<int>(term.shift))});
    } else {
      for (int j = 0; j <= k; ++j) product(terms, {1, c}, term.a, j, term.b, k - j);
    }
  }
  return to_.sum(std::move(terms));
}

/// (a_k − Σ_{j≥1} b_j y_{k−j})/b_0
Value PointWriter::quotient(const Instruction& i, int k) {
  Terms terms{{1, at(i.a, k)}};
  for (int j = 1; j <= k; ++j) product(terms, {-1}, i.b, j, i.out, k - j);
  return to_.sum(std::move(terms), none, at(i.b));
}

/// ½ (a_k − Σ_{0<j<k} y_j y_{k−j})/y_0
Value PointWriter::root(const Instruction& i, int k) {
  Terms terms{{0.5, at(i.a, k)}};
  for (int j = 1; j < k; ++j) product(terms, {-0.5}, i.out, j, i.out, k - j);
  return to_.sum(std::move(terms), none, at(i.out));
}

/// Σ_{j=1..k} (p j − (k − j)) u_j y_{k−j}/(k u_0)
Value PointWriter::power(const Instruction& i, int k) {
  const Value p = numbers_.constant(to_, i.constant);
  if (k == 0) return straight::power(to_, at(i.a), p);
  Terms terms;
  for (int j = 1; j <= k; ++j) {
    const Value factor = to_.sum({{static_cast<double>(j) / k, p}, {-static_cast<double>(k - j) / k}});
    product(terms, {1, factor}, i.a, j, i.out, k - j);
  }
  return to_.sum(std::move(terms), none, at(i.a));
}

/// y with dy = Σ c w du
Value PointWriter::function(const Instruction& i, int k) {
  if (k == 0) return to_.call(i.function, at(i.a), i.b == no_slot ? none : at(i.b));
  Terms terms;
  for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
    const auto& term = program_.terms[t];
    const Value c = numbers_.constant(to_, term.coefficient);
    for (int j = 1; j <= k; ++j) product(terms, {static_cast<double>(j) / k, c}, term.b, j, term.a, k - j);
  }
  return to_.sum(std::move(terms));
}

/// The first whose condition holds, else the last.
Value PointWriter::select(const Instruction& i, int k) {
  Value value = at(program_.terms[i.last_term - 1].a, k);
  for (std::uint32_t t = i.last_term - 1; t-- > i.first_term;)
    value = to_.choose(numbers_.constant(to_, program_.terms[t].coefficient), at(program_.terms[t].a, k), value);
  return value;
}

/// (y, z) with dy = z du, dz = ± y du
void PointWriter::pair(const Instruction& i, int k, double sign) {
  if (k == 0) return put(i.out, 0, to_.call(Kind::Sinh, at(i.a))), put(i.second, 0, to_.call(Kind::Cosh, at(i.a)));
  Terms first, second;
  for (int j = 1; j <= k; ++j) {
    product(first, {static_cast<double>(j) / k}, i.a, j, i.second, k - j);
    product(second, {sign * j / k}, i.a, j, i.out, k - j);
  }
  put(i.out, k, to_.sum(std::move(first)));
  put(i.second, k, to_.sum(std::move(second)));
}

/// Eight at a time.
void PointWriter::sines(const Run& run) {
  for (std::uint32_t first = run.first; first < run.last; first += 8) {
    std::vector<Value> angles;
    for (std::uint32_t i = first; i < std::min(run.last, first + 8); ++i)
      angles.push_back(at(program_.instructions[i].a));
    const auto both = to_.sines(angles);
    for (std::uint32_t i = 0; i < both.size(); ++i) {
      put(program_.instructions[first + i].out, 0, both[i].first);
      put(program_.instructions[first + i].second, 0, both[i].second);
    }
  }
}

}  // namespace maupertuis::dynamics
