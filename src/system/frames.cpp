#include "system/elaboration.hpp"

#include <fmt/format.h>

/// Frames: where they are, how they are turned.
namespace maupertuis::elaboration {
namespace {

using syntax::Rotation;
using Kind = Declaration::Kind;

/// An angle; `order` becomes 0 if a coordinate stands in it.
std::optional<Expr> angle_of(Elaboration& e, const syntax::Expression& x, int& order) {
  const Value v = scalar_of(e, x, dimensions::angle(), "an angle");
  if (v.poisoned) return std::nullopt;
  warn_of_degrees(e, v, dimensions::angle(), x);
  if (v.order > 0) {
    e.diagnostics.error("E0401", culprit_of_order(e, x, 1), "a velocity stands in an angle of rotation",
                        "A rotation depends on the coordinates and on time alone.", "");
    return std::nullopt;
  }
  order = std::max(order, v.order);
  return v.scalar();
}

std::optional<Pose> in_the_plane(Elaboration& e, const Pose& pose, const Rotation& r, int& order) {
  if (r.kind != Rotation::Kind::Angle) {
    e.diagnostics.error("E0402", r.span, "a rotation of space in a two-dimensional model",
                        "In the plane a frame has one angle.", "Write `rotation angle θ`.");
    return std::nullopt;
  }
  const std::optional<Expr> angle = angle_of(e, *r.values[0], order);
  return angle ? std::optional(turned(pose, *angle)) : std::nullopt;
}

std::optional<Pose> about_axis(Elaboration& e, const Pose& pose, const Rotation& r, int& order) {
  const Value axis = evaluate_formula(e, *r.axis);
  const std::optional<Expr> angle = angle_of(e, *r.values[0], order);
  if (axis.poisoned || !angle) return std::nullopt;
  if (!axis.is_vector) {
    e.diagnostics.error("E0210", r.axis->span, "an axis is a vector, not a number", "",
                        "Write its components: axis (0, 0, 1).");
    return std::nullopt;
  }
  const Expr square = dot_of(axis.parts, axis.parts);
  const std::optional<double> size = constant_value(e, square);
  if (square.is_zero() || (size && *size == 0)) {
    e.diagnostics.error("E0402", r.axis->span, "this axis has no direction",
                        "An axis of rotation is a vector other than zero.", "");
    return std::nullopt;
  }
  return turned_about(pose, scaled(pow(sqrt(square), Rational(-1)), axis.parts), *angle);
}

/// Turns about the axes of the frame itself, one after the other.
std::optional<Pose> in_sequence(Elaboration& e, Pose pose, const Rotation& r, const std::string& sequence,
                                bool reversed, int& order) {
  std::vector<Expr> angles;
  for (const syntax::ExpressionPtr& x : r.values) {
    const std::optional<Expr> angle = angle_of(e, *x, order);
    if (!angle) return std::nullopt;
    angles.push_back(*angle);
  }
  for (std::size_t i = 0; i < 3; ++i) pose = turned_about(pose, sequence[i] - 'x', angles[reversed ? 2 - i : i]);
  return pose;
}

bool is_sequence(const std::string& s) {
  if (s.size() != 3) return false;
  for (const char c : s)
    if (c < 'x' || c > 'z') return false;
  return s[0] != s[1] && s[1] != s[2];
}

std::optional<Pose> by_quaternion(Elaboration& e, const Pose& pose, const Rotation& r, int& order) {
  ExprVector q;
  bool poisoned = false;
  for (const syntax::ExpressionPtr& x : r.values) {
    const Value v = scalar_of(e, *x, Dimension{}, "a component of a quaternion");
    poisoned = poisoned || v.poisoned;
    if (v.poisoned) continue;
    if (v.order > 0) {
      e.diagnostics.error("E0401", culprit_of_order(e, *x, 1), "a velocity stands in a quaternion of rotation",
                          "A rotation depends on the coordinates and on time alone.", "");
      poisoned = true;
    }
    order = std::max(order, v.order);
    q.push_back(v.scalar());
  }
  return poisoned ? std::nullopt : std::optional(turned_by(pose, q));
}

bool complete(Elaboration& e, const Rotation& r, std::size_t count) {
  if (r.values.size() == count) return true;
  e.diagnostics.error("E0402", r.span, fmt::format("this rotation has {} angles, not {}", r.values.size(), count),
                      "A rotation of space is made of three turns.", "");
  return false;
}

std::optional<Pose> in_space(Elaboration& e, const Declaration& d, const Pose& pose, const Rotation& r, int& order) {
  switch (r.kind) {
    case Rotation::Kind::Angle:
      e.diagnostics.error("E0402", r.span, "a rotation in space needs an axis", "An angle alone turns in the plane.",
                          "Write `rotation axis (0, 0, 1) angle θ`.");
      return std::nullopt;
    case Rotation::Kind::AxisAngle:
      return about_axis(e, pose, r, order);
    case Rotation::Kind::Euler:
      if (!is_sequence(r.sequence)) {
        e.diagnostics.error("E0402", r.sequence_span, fmt::format("`{}` is no sequence of Euler angles", r.sequence),
                            "A sequence names three axes of the body, neighbours different: zxz, zyz, zyx, ….", "");
        return std::nullopt;
      }
      return complete(e, r, 3) ? in_sequence(e, pose, r, r.sequence, false, order) : std::nullopt;
    // Roll about x, pitch about y, yaw about z, axes fixed: the same as yaw, pitch, roll about the axes of the body.
    case Rotation::Kind::RollPitchYaw:
      return complete(e, r, 3) ? in_sequence(e, pose, r, "zyx", true, order) : std::nullopt;
    case Rotation::Kind::Quaternion:
      return by_quaternion(e, pose, r, order);
    case Rotation::Kind::QuaternionCoordinates:
      order = std::max(order, 0);
      return turned_by(pose, quaternion_coordinates(e, d));
  }
  return std::nullopt;
}

const Pose& world(Elaboration& e) {
  const auto [found, added] = e.poses.try_emplace(SIZE_MAX);
  if (added) found->second = world_pose(e.context, e.system().space_dimension);
  return found->second;
}

}  // namespace

const Pose* find_pose(Elaboration& e, const std::optional<syntax::Name>& name) {
  if (!name) return &world(e);
  Declaration* d = find_declared(e, *name);
  if (!d) return nullptr;
  if (d->kind != Kind::Frame && d->kind != Kind::Body) {
    e.diagnostics.error("E0212", name->span, fmt::format("`{}` is a {}, not a frame", name->text, word_of(d->kind)),
                        "Axes belong to frames and bodies.",
                        d->kind == Kind::Point ? "Declare a frame there, or leave `in` out." : "");
    return nullptr;
  }
  const auto found = e.poses.find(e.table.id(*d));
  return found == e.poses.end() ? nullptr : &found->second;
}

Value position_of(Elaboration& e, const syntax::Expression& x, const Pose* frame) {
  Place place;
  place.frame = frame;
  Value v = vector_of(e, x, dimensions::length(), "a position", place);
  if (v.poisoned) return v;
  if (v.order > 0) {
    e.diagnostics.error("E0401", culprit_of_order(e, x, 1), "a velocity stands in a position",
                        "A position depends on the coordinates and on time alone.", "");
    return Value::poison();
  }
  if (frame) {
    v.parts = vector_sum(frame->origin, v.parts);
    v.order = std::max(v.order, frame->order);
  }
  return v;
}

/// The pose of a frame or body; the place and the rotation may both be absent.
std::optional<Pose> pose_of(Elaboration& e, const Declaration& d, const syntax::ExpressionPtr& at,
                            const std::optional<Rotation>& rotation, const std::optional<syntax::Name>& in) {
  const Pose* parent = find_pose(e, in);
  if (!parent) return std::nullopt;
  std::optional<Pose> pose = *parent;
  if (at) {
    const Value place = position_of(e, *at, in ? parent : nullptr);
    if (place.poisoned)
      pose.reset();
    else {
      pose->origin = place.parts;
      pose->order = std::max(pose->order, place.order);
    }
  }
  if (!rotation) return pose;
  int order = pose ? pose->order : -1;
  std::optional<Pose> after = e.system().space_dimension == 2
                                  ? in_the_plane(e, pose ? *pose : *parent, *rotation, order)
                                  : in_space(e, d, pose ? *pose : *parent, *rotation, order);
  if (after) after->order = order;
  return pose ? after : std::nullopt;
}

void elaborate_frame(Elaboration& e, Declaration& d) {
  const auto& s = std::get<syntax::FrameStatement>(d.statement->body);
  d.done = true;
  d.value = Value::poison();
  const std::optional<Pose> pose = pose_of(e, d, s.at, s.rotation, s.in);
  if (!pose) return;
  e.system().frames.push_back({d.name, pose->origin, pose->rotation, pose->omega, d.span});
  e.poses.emplace(e.table.id(d), *pose);
  d.value = Value::of(e.number(0), e.dimension(dimensions::length()), pose->order);
  d.value.parts = pose->origin;
  d.value.is_vector = d.value.anchored = true;
  d.value.weight = e.number(1);
}

}  // namespace maupertuis::elaboration
