#include "verification/term_variants.hpp"

#include <maupertuis/print.hpp>

#include <fmt/format.h>

namespace maupertuis {
namespace {

class Slips {
 public:
  Slips(Expr term, const EquationsOfMotion& equations)
      : term_(term), equations_(equations), context_(*equations.system->context) {}

  std::vector<TermVariant> all() {
    ExprVector functions;
    for (const Expr& node : topological_order({&term_, 1}))
      if (node.is(Kind::Sin) || node.is(Kind::Cos) || node.is(Kind::Tan)) functions.push_back(node);
    // The plain slip first: sin θ for sin θ cos θ is a factor left out, not a tan θ cos θ.
    for (const Expr& node : functions) add(term_ / node, fmt::format("a factor {} is missing", text(node)));
    for (const Expr& node : functions) of_function(node);
    for (const Coordinate& c : equations_.system->coordinates) of_coordinate(c);
    return std::move(variants_);
  }

 private:
  std::string text(Expr e) const { return to_plain(e, equations_.order); }

  void add(Expr value, std::string sentence) {
    if (value != term_) variants_.push_back({value, std::move(sentence)});
  }
  void replace(Expr what, Expr by) {
    add(substitute(term_, {{what, by}}), fmt::format("{} stands in the place of {}", text(by), text(what)));
  }
  Expr function(Kind kind, Expr argument) { return context_.function(kind, {&argument, 1}); }

  void of_function(Expr node) {
    const Expr argument = node[0];
    for (const Kind kind : {Kind::Sin, Kind::Cos, Kind::Tan})
      if (!node.is(kind)) replace(node, function(kind, argument));
    const Expr small = node.is(Kind::Cos) ? context_.number(Rational(1)) : argument;
    add(substitute(term_, {{node, small}}),
        fmt::format("{} is written as {}, which holds for small angles only", text(node), text(small)));
    for (const Rational& factor : {Rational(2), Rational(1, 2)})
      replace(node, function(node.kind(), factor * argument));
    for (const Expr& s : symbols_of({&argument, 1}))  // θ1 + θ2 for θ1 − θ2
      if (s.role() == Role::Coordinate) replace(node, function(node.kind(), substitute(argument, {{s, -s}})));
    add(term_ * node, fmt::format("{} stands with a power too many", text(node)));
    for (const Kind kind : {Kind::Sin, Kind::Cos})
      if (!node.is(kind)) {
        const Expr more = function(kind, argument);
        add(term_ * more, fmt::format("a factor {} is too many", text(more)));
      }
  }

  bool stands(Expr symbol) const {
    for (const Expr& s : symbols_of({&term_, 1}))
      if (s == symbol) return true;
    return false;
  }

  void of_coordinate(const Coordinate& c) {
    for (const auto& [symbol, lower] : {std::pair(c.velocity, c.q), std::pair(c.acceleration, c.velocity)}) {
      if (!stands(symbol)) continue;
      replace(symbol, lower);
      add(term_ / symbol, fmt::format("{} stands with a power too few", text(symbol)));
      add(term_ * symbol, fmt::format("{} stands with a power too many", text(symbol)));
    }
    if (stands(c.acceleration)) replace(c.acceleration, c.q);
    if (stands(c.velocity)) replace(c.velocity, c.acceleration);
    if (stands(c.q)) {
      replace(c.q, c.velocity);
      for (const Expr& power : {term_ / c.q, term_ * c.q}) add(power, fmt::format("a power of {} is wrong", text(c.q)));
    }
    for (const Coordinate& other : equations_.system->coordinates) {
      if (other.q == c.q) continue;
      if (stands(c.velocity)) {
        replace(c.velocity, other.velocity);
        add(term_ * other.velocity / c.velocity,
            fmt::format("one {} stands in the place of {}", text(other.velocity), text(c.velocity)));
      }
      if (stands(c.acceleration)) replace(c.acceleration, other.acceleration);
      if (stands(c.q)) replace(c.q, other.q);
    }
  }

  Expr term_;
  const EquationsOfMotion& equations_;
  Context& context_;
  std::vector<TermVariant> variants_;
};

}  // namespace

std::vector<TermVariant> term_variants(Expr term, const EquationsOfMotion& equations) {
  return Slips(term, equations).all();
}

}  // namespace maupertuis
