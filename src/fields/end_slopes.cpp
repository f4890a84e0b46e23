#include "fields/end_slopes.hpp"

#include <cmath>

namespace maupertuis {
namespace {

FunctionKernel kernel_of(const PointForm& form, const std::vector<Parameter>& parameters, std::vector<Expr> outputs) {
  FunctionSource source{form.inputs, {}, std::move(outputs)};
  for (const Parameter& p : parameters) source.parameters.push_back(p.symbol);
  return build_function(source);
}

std::vector<Expr> equations_of_nodes(const PointForm& form) {
  std::vector<Expr> out = form.a;
  for (const auto* part : {&form.g, &form.s}) out.insert(out.end(), part->begin(), part->end());
  return out;
}

std::size_t inputs_of_field(const PointForm& form) { return 2 + 2 * form.directions; }

std::vector<Expr> stresses_and_slopes(const PointForm& form, std::size_t across) {
  const auto first = form.s.begin() + static_cast<std::ptrdiff_t>(across * form.fields);
  std::vector<Expr> out(first, first + static_cast<std::ptrdiff_t>(form.fields));
  for (std::size_t f = 0; f < form.fields; ++f)
    for (std::size_t o = 0; o < form.fields; ++o)
      out.push_back(differentiate(out[f], form.inputs[inputs_of_field(form) * o + 2 + across]));
  return out;
}

}  // namespace

EndSlopes::EndSlopes(const PointForm& form, const std::vector<Parameter>& parameters, std::size_t across)
    : fields_(form.fields),
      per_field_(inputs_of_field(form)),
      slope_(2 + across),
      at_nodes_(kernel_of(form, parameters, equations_of_nodes(form))),
      at_end_(kernel_of(form, parameters, stresses_and_slopes(form, across))),
      node_work_(at_nodes_),
      end_work_(at_end_) {
  std::vector<double> values;
  for (const Parameter& p : parameters) values.push_back(p.si_value);
  node_work_.set_parameters(values);
  end_work_.set_parameters(values);
}

std::vector<double> EndSlopes::stresses(const Lobatto& rule, double width, bool right,
                                        const std::vector<std::vector<double>>& inputs,
                                        const std::vector<double>& accelerations) {
  const std::size_t node = right ? inputs.size() - 1 : 0, pairs = fields_ * fields_;
  std::vector<double> out(fields_, 0), values(at_nodes_.outputs());
  for (std::size_t q = 0; q < inputs.size(); ++q) {
    node_work_.evaluate(inputs[q], values);
    for (std::size_t f = 0; f < fields_; ++f) {
      out[f] -= rule.w[q] * rule.derivative[q * inputs.size() + node] * values[pairs + fields_ + f];
      if (q != node) continue;
      double inertia = values[pairs + f];
      for (std::size_t o = 0; o < fields_; ++o) inertia += values[f * fields_ + o] * accelerations[o];
      out[f] += rule.w[node] * width / 2 * inertia;
    }
  }
  if (right)
    for (double& s : out) s = -s;
  return out;
}

void EndSlopes::solve(std::span<double> inputs, const std::vector<double>& s, const std::vector<bool>& kept) {
  const std::vector<double> guess(inputs.begin(), inputs.end());
  std::vector<double> out(at_end_.outputs()), inverse;
  constexpr int rounds = 8;
  constexpr double rounding = 1e-15, close = 1e-9;
  for (int round = 0; round < rounds; ++round) {
    end_work_.evaluate(inputs, out);
    double change = 0, size = 0;
    for (std::size_t f = 0; f < fields_; ++f)
      for (std::size_t o = 0; kept[f] && o < fields_; ++o) out[fields_ + f * fields_ + o] = f == o ? 1 : 0;
    if (!invert_mass({out.begin() + static_cast<std::ptrdiff_t>(fields_), out.end()}, inverse, fields_)) break;
    for (std::size_t f = 0; f < fields_; ++f) {
      double by = 0;
      for (std::size_t o = 0; o < fields_; ++o)
        if (!kept[o]) by += inverse[f * fields_ + o] * (s[o] - out[o]);
      double& slope = inputs[per_field_ * f + slope_];
      slope += by;
      change = std::max(change, std::abs(by)), size = std::max(size, std::abs(slope));
    }
    if (!std::isfinite(change)) break;
    if (change <= (round + 1 < rounds ? rounding : close) * size) return;
  }
  std::copy(guess.begin(), guess.end(), inputs.begin());
}

}  // namespace maupertuis
