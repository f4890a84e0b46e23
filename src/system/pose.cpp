#include "system/pose.hpp"

#include <maupertuis/transform.hpp>

#include <algorithm>

namespace maupertuis::elaboration {
namespace {

ExprMatrix identity(Context& c, std::size_t n) {
  ExprMatrix m{n, n, ExprVector(n * n, c.number(0))};
  for (std::size_t i = 0; i < n; ++i) m.at(i, i) = c.number(1);
  return m;
}

ExprMatrix planar(Expr angle) { return {2, 2, {cos(angle), -sin(angle), sin(angle), cos(angle)}}; }

ExprMatrix about_axis(int axis, Expr angle) {
  ExprMatrix m = identity(angle.context(), 3);
  const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
  m.at(i, i) = m.at(j, j) = cos(angle);
  m.at(i, j) = -sin(angle);
  m.at(j, i) = sin(angle);
  return m;
}

/// Rodrigues: R = c 1 + s [n]× + (1 − c) n nᵀ.
ExprMatrix about_vector(const ExprVector& n, Expr angle) {
  Context& context = angle.context();
  const Expr c = cos(angle), s = sin(angle), rest = -c + Rational(1);
  ExprMatrix m{3, 3, ExprVector(9, context.number(0))};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      m.at(i, j) = rest * n[i] * n[j];
      if (i == j)
        m.at(i, j) = m.at(i, j) + c;
      else
        m.at(i, j) = m.at(i, j) + ((j + 3 - i) % 3 == 1 ? -(s * n[3 - i - j]) : s * n[3 - i - j]);
    }
  return m;
}

/// The turn `r`, whose rate is `rate` in the axes after it, put after `pose`.
Pose compose(const Pose& pose, const ExprMatrix& r, const ExprVector& rate) {
  Pose out;
  out.origin = pose.origin;
  out.order = pose.order;
  out.rotation = matrix_product(pose.rotation, r);
  out.omega = vector_sum(rotate_back(r, pose.omega), rate);
  out.omega_world = vector_sum(pose.omega_world, rotate(out.rotation, rate));
  return out;
}

}  // namespace

ExprVector rotate(const ExprMatrix& r, const ExprVector& v) {
  ExprVector out;
  for (std::size_t i = 0; i < r.rows; ++i) {
    ExprVector terms;
    for (std::size_t j = 0; j < r.columns; ++j) terms.push_back(r.at(i, j) * v[j]);
    out.push_back(sum_of(terms, v.front().context()));
  }
  return out;
}

ExprVector rotate_back(const ExprMatrix& r, const ExprVector& v) {
  ExprMatrix transposed{r.columns, r.rows, r.entries};
  for (std::size_t i = 0; i < r.rows; ++i)
    for (std::size_t j = 0; j < r.columns; ++j) transposed.at(j, i) = r.at(i, j);
  return rotate(transposed, v);
}

ExprMatrix matrix_product(const ExprMatrix& a, const ExprMatrix& b) {
  ExprMatrix out{a.rows, b.columns, {}};
  for (std::size_t i = 0; i < a.rows; ++i)
    for (std::size_t j = 0; j < b.columns; ++j) {
      ExprVector terms;
      for (std::size_t k = 0; k < a.columns; ++k) terms.push_back(a.at(i, k) * b.at(k, j));
      out.entries.push_back(sum_of(terms, terms.front().context()));
    }
  return out;
}

ExprVector vector_sum(const ExprVector& a, const ExprVector& b) {
  ExprVector out;
  for (std::size_t i = 0; i < a.size(); ++i) out.push_back(a[i] + b[i]);
  return out;
}

ExprVector scaled(Expr s, const ExprVector& v) {
  ExprVector out;
  for (const Expr& x : v) out.push_back(s * x);
  return out;
}

Expr dot_of(const ExprVector& a, const ExprVector& b) {
  ExprVector terms;
  for (std::size_t i = 0; i < a.size(); ++i) terms.push_back(a[i] * b[i]);
  return sum_of(terms, a.front().context());
}

Expr square_of(const ExprVector& v) {
  constexpr std::size_t most_nodes = 400;
  const Expr square = dot_of(v, v);
  const auto nodes = topological_order({&square, 1});
  const bool turns = std::any_of(nodes.begin(), nodes.end(),
                                 [](Expr e) { return e.is(maupertuis::Kind::Sin) || e.is(maupertuis::Kind::Cos); });
  if (!turns || nodes.size() > most_nodes) return square;
  const ReadableForm form = readable(square, {});
  return form.intermediates.empty() && !form.value.is(maupertuis::Kind::Sum) ? form.value : square;
}

ExprVector cross_of(const ExprVector& a, const ExprVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Pose world_pose(Context& context, int dimension) {
  Pose p;
  const auto n = static_cast<std::size_t>(dimension);
  p.origin.assign(n, context.number(0));
  p.rotation = identity(context, n);
  p.omega.assign(n == 2 ? 1 : 3, context.number(0));
  p.omega_world = p.omega;
  p.angle = context.number(0);
  return p;
}

Pose turned(const Pose& pose, Expr angle) {
  Pose out = pose;
  out.angle = pose.angle + angle;
  out.rotation = planar(out.angle);
  out.omega = {pose.omega[0] + angle.context().time_derivative(angle)};
  out.omega_world = out.omega;
  return out;
}

Pose turned_about(const Pose& pose, int axis, Expr angle) {
  if (pose.before_last && pose.last_axis == axis) {
    Pose base = *pose.before_last;
    base.origin = pose.origin;
    return turned_about(base, axis, pose.angle + angle);
  }
  Context& context = angle.context();
  ExprVector rate(3, context.number(0));
  rate[static_cast<std::size_t>(axis)] = context.time_derivative(angle);
  Pose out = compose(pose, about_axis(axis, angle), rate);
  out.angle = angle;
  out.last_axis = axis;
  Pose before = pose;
  before.before_last = nullptr;  // the turn before it is about another axis: nothing would be added to it
  out.before_last = std::make_shared<const Pose>(std::move(before));
  return out;
}

Pose turned_about(const Pose& pose, const ExprVector& axis, Expr angle) {
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!axis[(k + 1) % 3].is_zero() || !axis[(k + 2) % 3].is_zero() || !axis[k].is_number()) continue;
    return turned_about(pose, i, axis[k].number().sign() > 0 ? angle : -angle);
  }
  Context& context = angle.context();
  ExprVector rate = scaled(context.time_derivative(angle), axis);
  ExprVector axis_rate;
  bool moves = false;
  for (const Expr& n : axis) {
    axis_rate.push_back(context.time_derivative(n));
    moves = moves || !axis_rate.back().is_zero();
  }
  if (moves) {  // ω = α̇ n + sin α ṅ − (1 − cos α) n × ṅ in the axes after the turn
    rate = vector_sum(rate, scaled(sin(angle), axis_rate));
    rate = vector_sum(rate, scaled(cos(angle) - Rational(1), cross_of(axis, axis_rate)));
  }
  return compose(pose, about_vector(axis, angle), rate);
}

namespace {

/// v → q v q̄
ExprMatrix of_quaternion(const ExprVector& q) {
  const Expr w = q[0], x = q[1], y = q[2], z = q[3];
  const Expr ww = w * w, xx = x * x, yy = y * y, zz = z * z;
  const auto twice = [](Expr a, Expr b) { return Rational(2) * sum_of({a, b}); };
  return {3,
          3,
          {sum_of({ww, xx, -yy, -zz}), twice(x * y, -(w * z)), twice(x * z, w * y), twice(x * y, w * z),
           sum_of({ww, -xx, yy, -zz}), twice(y * z, -(w * x)), twice(x * z, -(w * y)), twice(y * z, w * x),
           sum_of({ww, -xx, -yy, zz})}};
}

}  // namespace

Pose turned_by(const Pose& pose, const ExprVector& q) {
  Context& context = q[0].context();
  ExprVector rates;
  for (const Expr& c : q) rates.push_back(context.time_derivative(c));
  const ExprVector v = {q[1], q[2], q[3]}, v_rate = {rates[1], rates[2], rates[3]};
  const ExprVector common = vector_sum(scaled(q[0], v_rate), scaled(-rates[0], v)), turning = cross_of(v, v_rate);
  const auto twice = [&](const ExprVector& u) { return scaled(context.number(2), u); };
  Pose out = pose;
  out.before_last = nullptr;
  out.last_axis = -1;
  const ExprMatrix r = of_quaternion(q);
  out.rotation = matrix_product(pose.rotation, r);
  // ω is twice the vector part of q̄ q̇ along the axes after the turn, of q̇ q̄ along those before it.
  out.omega = vector_sum(rotate_back(r, pose.omega), twice(vector_sum(common, scaled(context.number(-1), turning))));
  out.omega_world = vector_sum(pose.omega_world, rotate(pose.rotation, twice(vector_sum(common, turning))));
  return out;
}

}  // namespace maupertuis::elaboration
