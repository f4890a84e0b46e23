#include "kernel/dynamics/point_program.hpp"

#include "kernel/interpreter/elementary.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::dynamics {
PointProgram::PointProgram(const Program& program, bool with_accelerations, const std::vector<bool>& kept)
    : freedoms_(program.freedoms), unknowns_(program.unknowns), flat_(flatten(program, with_accelerations, kept)),
      cells_(flat_.cells, 0.0), linear_(flat_.linear_cell.size()), products_(flat_.product_a.size()),
      exponents_(flat_.functions.size()), chosen_(flat_.choices.size()) {
  cells_[cell_of_one] = 1;
}

void PointProgram::set_constants(const std::vector<double>& constants) {
  for (std::size_t i = 0; i < linear_.size(); ++i) linear_[i] = value_of(flat_.linear_coefficient[i], constants);
  for (std::size_t i = 0; i < products_.size(); ++i) products_[i] = value_of(flat_.product_coefficient[i], constants);
  for (std::size_t i = 0; i < exponents_.size(); ++i)
    if (flat_.functions[i].op == Op::Power) exponents_[i] = constants[flat_.functions[i].exponent];
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    std::uint32_t k = flat_.choices[i].first;
    while (k + 1 < flat_.choices[i].last && constants[flat_.choice_conditions[k]] == 0) ++k;
    chosen_[i] = flat_.choice_cells[k];
  }
}

void PointProgram::renew(const std::vector<double>& constants, const std::vector<bool>& live) {
  if (live_ != live) {
    live_ = live;
    live_terms_.clear();
    const auto collect = [&](const std::vector<Coefficient>& coefficients, std::vector<double>& values) {
      for (std::size_t i = 0; i < values.size(); ++i)
        if (coefficients[i].constant != no_constant && live[coefficients[i].constant])
          live_terms_.push_back({coefficients[i], &values[i]});
    };
    collect(flat_.linear_coefficient, linear_);
    collect(flat_.product_coefficient, products_);
  }
  for (const LiveTerm& term : live_terms_) *term.value = value_of(term.coefficient, constants);
  for (std::size_t i = 0; i < exponents_.size(); ++i)
    if (flat_.functions[i].op == Op::Power) exponents_[i] = constants[flat_.functions[i].exponent];
}

void PointProgram::call(const FunctionCall& call) {
  const double a = cells_[call.a];
  switch (call.op) {
    case Op::SquareRoot: cells_[call.out] = std::sqrt(a); break;
    case Op::Power: cells_[call.out] = std::pow(a, exponents_[static_cast<std::size_t>(&call - flat_.functions.data())]); break;
    case Op::SinhCosh:
      cells_[call.out] = std::sinh(a);
      cells_[call.second] = std::cosh(a);
      break;
    case Op::Function: cells_[call.out] = interpreter::elementary<double>(call.function, a, cells_[call.b]); break;
    case Op::One: case Op::Time: case Op::Coordinate: case Op::Companion: case Op::Linear: case Op::Products: case Op::Square:
    case Op::Quotient: case Op::SinCos: case Op::Derivative: case Op::Select: throw unknown_op(call.op, "a call");
  }
}

void PointProgram::choose(const Choice& choice) {
  cells_[choice.out] = cells_[chosen_[static_cast<std::size_t>(&choice - flat_.choices.data())]];
}

void PointProgram::other(void* self, const FlatStep& step) {
  auto& program = *static_cast<PointProgram*>(self);
  if (step.kind == FlatStep::Function) program.call(program.flat_.functions[step.index]);
  else program.choose(program.flat_.choices[step.index]);
}

void PointProgram::evaluate(double t, std::span<const double> q, std::span<const double> v, std::span<const double> a) {
  double* const given = cells_.data() + first_coordinate_cell;
  cells_[cell_of_time] = t;
  std::copy_n(q.data(), freedoms_, given);
  std::copy_n(v.data(), freedoms_, given + unknowns_);
  for (std::size_t i = 0; i < a.size(); ++i) given[2 * unknowns_ + i] = a[i] / 2;
  evaluate_({flat_.steps.data(), flat_.steps.size(), flat_.sums.data(), flat_.sines.data(), flat_.sum_out.data(),
             flat_.sum_divisor.data(), flat_.linear_cell.data(), flat_.product_a.data(), flat_.product_b.data(), linear_.data(),
             products_.data(), cells_.data(), this, other});
}

}  // namespace maupertuis::dynamics
