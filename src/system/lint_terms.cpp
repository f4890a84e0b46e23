#include "system/lint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

/// Rules about the terms of the energies.
namespace maupertuis::lint_rules {
namespace {

using Which = syntax::EnergyStatement::Which;
using Symbols = std::unordered_set<Expr, ExprHash>;

Symbols symbols_in(const ExprVector& roots) {
  const std::vector<Expr> list = symbols_of(roots);
  return {list.begin(), list.end()};
}

bool is_velocity(Expr e) { return e.is_symbol() && e.role() == Role::Coordinate && e.order() >= 1; }

bool has_velocity(Expr e) {
  const ExprVector roots = {expand_time_derivatives(e)};
  for (const Expr& s : symbols_of(roots))
    if (is_velocity(s)) return true;
  return false;
}

/// The terms of a formula as it was written; sums within sums are opened, up to a bound.
void collect_terms(Expr e, std::vector<Expr>& out) {
  if (out.size() > 200) return;
  if (!e.is(Kind::Sum)) return out.push_back(e);
  for (std::size_t i = 0; i < e.size(); ++i) collect_terms(e[i], out);
}

/// One velocity as a factor, to the first power, and no other function of velocities.
bool is_linear_in_velocities(Expr term) {
  int degree = 0;
  const std::size_t factors = term.is(Kind::Product) ? term.size() : 1;
  for (std::size_t i = 0; i < factors; ++i) {
    const Expr factor = term.is(Kind::Product) ? term[i] : term;
    if (is_velocity(factor))
      ++degree;
    else if (has_velocity(factor))
      return false;
  }
  return degree == 1;
}

void check_terms(Subject& s, const EnergyTerm& energy) {
  std::vector<Expr> terms;
  collect_terms(expand_time_derivatives(energy.value), terms);
  for (const Expr& term : terms) {
    if (!is_linear_in_velocities(term)) continue;
    if (zero_test(variational_residual(term, s.order.coordinates)).verdict != Verdict::Zero) continue;
    const std::string text = s.show(term);
    s.diagnostics.warning(
        "W0412", energy.span,
        text.empty() ? "a term of the Lagrangian has no effect" : fmt::format("the term {} has no effect", text),
        "It is the total time derivative of a function of the coordinates, which adds nothing to Lagrange's equations.",
        "Leave it out. If friction was meant, write D = 1/2 c q'^2.");
  }
}

}  // namespace

/// A place or a rotation that depends on the coordinate, and carries nothing.
std::string advice_on_unused(const Subject& s, const Coordinate& c) {
  const auto moves = [&](const ExprVector& parts) {
    const Symbols found = symbols_in(expand_time_derivatives(parts));
    return found.count(c.q) || found.count(c.velocity);
  };
  for (const Body& b : s.system.bodies) {
    if (!b.mass && moves(b.position))
      return fmt::format("{} moves with it and has no mass: write body {} mass m ….", b.name, b.name);
    if (b.inertia.entries.empty() && moves(b.angular_velocity))
      return fmt::format("{} turns with it and has no inertia: write body {} … inertia ….", b.name, b.name);
  }
  for (const Point& p : s.system.points)
    if (!p.mass && moves(p.position))
      return fmt::format("{} moves with it and has no mass: write point {} mass m at ….", p.name, p.name);
  return "Remove it, or use it in a position or an energy.";
}

std::vector<bool> unused_coordinates(Subject& s) {
  ExprVector roots = {s.lagrangian, expand_time_derivatives(s.system.dissipation_function())};
  for (const AppliedForce& f : s.system.forces)
    for (const ExprVector* v : {&f.components, &f.lever}) roots.insert(roots.end(), v->begin(), v->end());
  for (const Constraint& c : s.system.constraints) roots.push_back(c.value);
  const Symbols used = symbols_in(expand_time_derivatives(roots));
  std::vector<bool> out;
  for (const Coordinate& c : s.system.coordinates) {
    const bool unused = !used.count(c.q) && !used.count(c.velocity);
    out.push_back(unused);
    if (unused)
      s.diagnostics.error("E0406", c.span, fmt::format("the coordinate `{}` is never used", c.name),
                          s.system.constrained()
                              ? "No energy, force or constraint depends on it: nothing determines its motion."
                              : "No energy and no force depends on it: nothing determines its motion.",
                          advice_on_unused(s, c));
  }
  return out;
}

/// At a free end of a path such a term changes what p = 0 says there.
bool has_free_end(const Experiment& experiment) {
  if (!experiment.path) return false;
  const auto is_free = [](Expr end) { return !end; };
  const PathEnds& path = *experiment.path;
  return std::any_of(path.from.begin(), path.from.end(), is_free) ||
         std::any_of(path.to.begin(), path.to.end(), is_free);
}

void total_derivatives(Subject& s) {
  if (has_free_end(s.model.experiment)) return;
  for (const auto* terms : {&s.system.generalized_potential, &s.system.lagrangian_extra, &s.system.kinetic})
    for (const EnergyTerm& t : *terms)
      if (t.origin.size() == 1) check_terms(s, t);
  if (s.system.lagrangian_given) check_terms(s, *s.system.lagrangian_given);
}

void gravity_twice(Subject& s) {
  if (s.system.gravity.empty()) return;
  const Symbols g = symbols_in(s.system.gravity);
  ExprVector masses;
  for (const Point& p : s.system.points)
    if (p.mass) masses.push_back(p.mass);
  for (const Body& b : s.system.bodies)
    if (b.mass) masses.push_back(b.mass);
  const Symbols mass = symbols_in(masses);
  for (const EnergyTerm& t : s.system.potential) {
    if (t.origin != "V") continue;
    const Symbols here = symbols_in({t.value});
    const auto in = [&](const Symbols& set) {
      return std::any_of(set.begin(), set.end(), [&](const Expr& x) { return here.count(x) != 0; });
    };
    if (in(g) && in(mass))
      s.diagnostics.warning("W0413", t.span, "the weight is counted twice",
                            "`gravity` already gives every mass its potential energy.",
                            "Remove this part of V, or the `gravity` statement.");
  }
}

namespace {

/// The first of `parts` that `written` says again; of masses all together, too.
void tell_again(Subject& s, const std::vector<EnergyTerm>& terms, const char* written, const char* help) {
  constexpr std::size_t most_parts = 50;
  std::vector<const EnergyTerm*> parts;
  Expr all = s.system.context->number(0);
  for (const EnergyTerm& t : terms)
    if (t.origin != "T" && t.origin != "V" && t.origin.rfind("gravity", 0) != 0)
      parts.push_back(&t), all = all + t.value;
  if (parts.empty() || parts.size() > most_parts) return;
  const auto is_same = [&](const Expr& x, const Expr& y) {
    const Expr difference = expand_time_derivatives(x - y);
    return zero_test({&difference, 1}).verdict == Verdict::Zero;
  };
  for (const EnergyTerm& t : terms) {
    if (t.origin != written) continue;
    const auto again =
        std::find_if(parts.begin(), parts.end(), [&](const EnergyTerm* p) { return is_same(t.value, p->value); });
    if (again == parts.end() && !is_same(t.value, all)) continue;
    s.diagnostics.warning("W0442", t.span, "this energy is counted twice",
                          again == parts.end()
                              ? fmt::format("It is the {} that the statements before it give.", written)
                              : fmt::format("The model has it already: {}.", (*again)->origin),
                          help);
  }
}

}  // namespace

void parts_twice(Subject& s) {
  tell_again(s, s.system.kinetic, "T",
             "Remove it: points and bodies with a mass give their kinetic energy by themselves.");
  tell_again(s, s.system.potential, "V", "Remove it: springs give their potential energy by themselves.");
}

void energies_without_velocity(Subject& s) {
  for (const EnergyTerm& t : s.system.kinetic)  // where q'' stands in L, v stands in T for q'
    if (t.origin == "T" && s.system.higher.empty() && !s.system.lagrangian_given &&
        !has_velocity(s.system.kinetic_energy()))
      s.diagnostics.warning("W0421", t.span, "no velocity stands in the kinetic energy",
                            "A kinetic energy is made of velocities: 1/2 m x'^2.",
                            "Write x' for a velocity; a potential energy belongs in V.");
  for (const EnergyTerm& t : s.system.dissipation)
    if (t.origin == "D" && !has_velocity(t.value))
      s.diagnostics.warning("W0422", t.span, "no velocity stands in the dissipation function",
                            "It enters as ∂D/∂q̇: without a velocity it has no effect.",
                            "Linear damping is D = 1/2 c x'^2.");
}

void negative_dissipation(Subject& s) {
  constexpr int places = 12;
  Expr power = s.system.context->number(0);
  const EnergyTerm* written = nullptr;
  for (const EnergyTerm& t : s.system.dissipation) {
    if (t.origin != "D") continue;
    if (!written) written = &t;
    const Expr d = expand_time_derivatives(t.value);
    const ExprVector slopes = gradient(d, s.velocities);
    for (std::size_t i = 0; i < slopes.size(); ++i) power = power + slopes[i] * s.velocities[i];
  }
  if (!written) return;
  for (int attempt = 0; attempt < places; ++attempt)
    if (!(evaluate(power, sample(s, attempt)) < 0)) return;
  s.diagnostics.warning("W0419", written->span, "this D is negative",
                        "Its forces −∂D/∂q̇ point along the velocities wherever it was looked at: they feed energy in.",
                        "Friction is D = 1/2 c x'^2, with its positive sign.");
}

bool claims(Subject& s) {
  bool contested = false;
  const char* name[] = {"T", "V", "U", "L", "D"};
  const char* long_name[] = {"kinetic energy", "potential energy", "generalized potential", "Lagrangian",
                             "dissipation function"};
  for (const EnergyClaim& c : s.system.claims) {
    const int k = static_cast<int>(c.which);
    const Expr actual = c.which == Which::T   ? s.system.kinetic_energy()
                        : c.which == Which::V ? s.system.potential_energy()
                                              : s.system.lagrangian();
    const Expr difference = expand_time_derivatives(c.value - actual);
    ExprVector must_vanish = {difference};
    if (c.which == Which::V) must_vanish = gradient(difference, s.order.coordinates);  // its zero level is free
    if (c.which == Which::L) must_vanish = variational_residual(difference, s.order.coordinates);
    const ZeroTest test = zero_test(must_vanish);
    if (test.verdict == Verdict::Zero) continue;
    const std::string text = s.show(difference);
    const char* parts = c.which == Which::T   ? "the points and bodies"
                        : c.which == Which::V ? "gravity and springs"
                                              : "points, bodies, springs and gravity";
    if (test.verdict == Verdict::Undecided) {
      s.diagnostics.warning(
          "W0411", c.span, fmt::format("whether this is the {} that {} give could not be decided", long_name[k], parts),
          test.reason, "");
      continue;
    }
    contested = contested || c.which == Which::T || c.which == Which::L;
    s.diagnostics.error("E0411", c.span, fmt::format("this is not the {} that {} give", long_name[k], parts),
                        text.empty() ? fmt::format("Beside them `{} = …` is a claim, and it is false.", name[k])
                                     : fmt::format("It differs by {}.", text),
                        fmt::format("Remove the line, correct it, or write `{} += …` for a further part.", name[k]));
  }
  return contested;
}

}  // namespace maupertuis::lint_rules
