#include "system/elaboration.hpp"

#include <fmt/format.h>

/// Applied forces and torques with what their virtual work is taken along: positions and angular velocities.
namespace maupertuis::elaboration {
namespace {

using syntax::ForceStatement;
using Kind = Declaration::Kind;

Declaration* target(Elaboration& e, const syntax::Name& name, std::initializer_list<Kind> kinds, const char* needed,
                    const char* help) {
  Declaration* d = find_declared(e, name);
  if (!d) return nullptr;
  for (const Kind k : kinds)
    if (d->kind == k) return d->done && !d->value.poisoned ? d : nullptr;
  if (d->kind == Kind::Field && d->value.poisoned) return nullptr;
  e.diagnostics.error("E0212", name.span, fmt::format("`{}` is a {}, not {}", name.text, word_of(d->kind), needed), "",
                      help);
  return nullptr;
}

std::optional<AppliedForce> on_point(Elaboration& e, const ForceStatement& s) {
  Declaration* d =
      target(e, s.on, {Kind::Point, Kind::Body}, "a point", "A force on a coordinate is written `force q = …`.");
  const Pose* frame = find_pose(e, s.in);
  if (!frame) return std::nullopt;
  Place place;
  place.frame = s.in ? frame : nullptr;
  const Value v = vector_of(e, *s.value, dimensions::force(), "a force", place);
  if (!d || v.poisoned || refuse_acceleration(e, v, *s.value, "a force")) return std::nullopt;
  AppliedForce f;
  f.kind = AppliedForce::Kind::OnPoint;
  f.components = v.parts;
  f.lever = d->value.parts;
  return f;
}

std::optional<AppliedForce> torque(Elaboration& e, const ForceStatement& s) {
  const char* help = "A point cannot be turned: declare a body or a frame.";
  Declaration* d = target(e, s.on, {Kind::Body, Kind::Frame}, "a body", help);
  Declaration* from = s.from ? target(e, *s.from, {Kind::Body, Kind::Frame}, "a body", help) : nullptr;
  const Pose* frame = find_pose(e, s.in);
  if (!frame) return std::nullopt;
  Place place;
  place.frame = s.in ? frame : nullptr;
  const bool plane = e.system().space_dimension == 2;
  const Value v = plane ? scalar_of(e, *s.value, dimensions::torque(), "a torque", place)
                        : vector_of(e, *s.value, dimensions::torque(), "a torque", place);
  if (!d || (s.from && !from) || v.poisoned || refuse_acceleration(e, v, *s.value, "a torque")) return std::nullopt;
  AppliedForce f;
  f.kind = AppliedForce::Kind::Torque;
  f.components = v.parts;
  f.lever = e.poses.at(e.table.id(*d)).omega_world;
  if (from) f.lever = vector_sum(f.lever, scaled(e.number(-1), e.poses.at(e.table.id(*from)).omega_world));
  if (from) f.reaction_on = from->name;
  return f;
}

std::optional<AppliedForce> generalized(Elaboration& e, const ForceStatement& s) {
  Declaration* d =
      target(e, s.on, {Kind::Coordinate}, "a coordinate", "A force on a point is written `force on P = (…)`.");
  const Dimension q = d ? d->value.dimension : Dimension{};
  const std::string what = fmt::format("the force along {}", s.on.text);
  const Value v =
      d ? scalar_of(e, *s.value, e.dimension(dimensions::energy()) / q, what) : evaluate_formula(e, *s.value);
  if (!d || v.poisoned || refuse_acceleration(e, v, *s.value, what)) return std::nullopt;
  AppliedForce f;
  f.kind = AppliedForce::Kind::Generalized;
  f.components = {v.scalar()};
  f.coordinate = d->index;
  return f;
}

}  // namespace

void elaborate_forces(Elaboration& e) {
  for (const syntax::Statement& statement : e.tree.statements) {
    const auto* s = std::get_if<ForceStatement>(&statement.body);
    if (!s) continue;
    std::optional<AppliedForce> force = s->target == ForceStatement::Target::Point          ? on_point(e, *s)
                                        : s->target == ForceStatement::Target::TorqueOnBody ? torque(e, *s)
                                                                                            : generalized(e, *s);
    if (!force) continue;
    force->target = s->on.text;
    force->span = statement.span;
    e.system().forces.push_back(std::move(*force));
  }
}

}  // namespace maupertuis::elaboration
