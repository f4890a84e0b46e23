#include "comparison/pull_back.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace maupertuis::comparison {
namespace {

Expr rebuilt(Expr node, const std::vector<Expr>& arguments, const ExprMap& replacements, Context& to) {
  if (node.is_number()) return to.number(node.number());
  if (node.is(Kind::Pi)) return to.pi();
  if (node.is_symbol()) {
    const auto found = replacements.find(node);
    if (found == replacements.end())
      throw std::logic_error("no counterpart for the symbol " + node.name() + "; please report");
    return found->second;
  }
  if (node.is(Kind::TimeDerivative)) throw std::logic_error("d/dt is to be carried out first; please report");
  return to.make(node.kind(), arguments);
}

bool same_value(double a, double b) { return std::abs(a - b) <= 1e-12 * std::max(std::abs(a), std::abs(b)); }

/// Whether parameters alone stand in it.
bool is_constant(Expr e) {
  for (const Expr& s : symbols_of({&e, 1}))
    if (s.role() != Role::Parameter && s.role() != Role::Constant) return false;
  return true;
}

}  // namespace

ExprVector carried_over(std::span<const Expr> roots, const ExprMap& replacements, Context& to) {
  ExprMap done;
  for (const Expr& node : topological_order(roots)) {
    std::vector<Expr> arguments;
    for (std::size_t i = 0; i < node.size(); ++i) arguments.push_back(done.at(node[i]));
    done.emplace(node, rebuilt(node, arguments, replacements, to));
  }
  ExprVector out;
  for (const Expr& root : roots) out.push_back(done.at(root));
  return out;
}

PullBack::PullBack(const MechanicalSystem& a, const CoordinateMap& map, Diagnostics& diagnostics)
    : a_(a), context_(*map.b->system.context) {
  const MechanicalSystem& b = map.b->system;
  positions_ = with_constants_as_numbers(b, in_terms_of_motion(b, map.values));
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    velocities_.push_back(total_time_derivative(positions_[i]));
    accelerations_.push_back(total_time_derivative(velocities_[i]));
    const Coordinate& c = a.coordinates[i];
    replacements_.emplace(c.q, positions_[i]);
    replacements_.emplace(c.velocity, velocities_[i]);
    replacements_.emplace(c.acceleration, accelerations_[i]);
  }
  replacements_.emplace(a.context->time(), context_.time());
  const Bindings values = parameter_bindings(b);
  const auto names = names_of(a, b);
  for (std::size_t i = 0; i < a.parameters.size(); ++i) {
    const Parameter& p = a.parameters[i];
    Expr counterpart = map.parameters[i];
    if (counterpart) {
      counterpart = with_constants_as_numbers(b, in_terms_of_motion(b, {&counterpart, 1})).front();
      if (!is_constant(counterpart)) {
        diagnostics.error("E0825", {}, fmt::format("the map gives the parameter `{}` a value that changes", p.name),
                          "A parameter is one number for a whole motion.",
                          "Give it a parameter or a number of the second model.");
        counterpart = context_.number(Rational::from_double(p.si_value));
      }
      const double other = evaluate(counterpart, values);
      if (!same_value(p.si_value, other))
        diagnostics.error(
            "E0825", {},
            fmt::format("the parameter `{}` differs: {:.12g} in {}, {:.12g} in {} (SI units)", p.name, p.si_value,
                        names.first, other, names.second),
            "Two models with different values move differently, whatever their equations.",
            fmt::format("Give both the same value, or say in the map what `{}` is in the second model.", p.name));
    } else {
      counterpart = carried_over({&p.value, 1}, {}, context_).front();
      if (p.symbol.role() == Role::Parameter && p.used)
        diagnostics.note("N0826", {}, fmt::format("`{}` is no name of {}: its value is put in", p.name, names.second),
                         fmt::format("What is shown then holds for {} = {:.12g} (SI units) alone.", p.name, p.si_value),
                         fmt::format("A map may say what it is: `{} = …`.", p.name));
    }
    replacements_.emplace(p.symbol, counterpart);
  }
}

std::pair<std::string, std::string> names_of(const MechanicalSystem& a, const MechanicalSystem& b) {
  const bool same = a.name == b.name;
  const auto called = [](const std::string& name, const char* unnamed, const char* mark) {
    return name.empty() ? unnamed : name + mark;
  };
  return {called(a.name, "the first model", same ? " (first)" : ""),
          called(b.name, "the second model", same ? " (second)" : "")};
}

ExprVector PullBack::operator()(std::span<const Expr> of_a) const {
  if (of_a.empty()) return {};
  return carried_over(expand_time_derivatives(in_terms_of_motion(a_, of_a)), replacements_, context_);
}

}  // namespace maupertuis::comparison
