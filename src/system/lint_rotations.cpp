#include "system/lint_manifold.hpp"

#include <fmt/format.h>

#include <cmath>

/// A quaternion of given components turns only where its norm is 1: R Rᵀ = |q|⁴ 1. Where the constraints of the model
/// (or its half angles) hold the norm, this is so at every state that they allow.
namespace maupertuis::lint_rules {
namespace {

bool is_orthogonal(const ExprMatrix& rotation, const Bindings& point) {
  const std::size_t n = rotation.rows;
  const std::vector<double> r = evaluate(expand_time_derivatives(rotation.entries), point);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double dot = 0;
      for (std::size_t k = 0; k < n; ++k) dot += r[i * n + k] * r[j * n + k];
      if (std::abs(dot - (i == j)) > 1e-6) return false;  // NaN: undefined here, another point decides
    }
  return true;
}

struct Turned {
  const std::string* name;
  const ExprMatrix* rotation;
  Span span;
};

}  // namespace

std::optional<Stretched> stretched_rotation(const Subject& s) {
  if (s.system.space_dimension != 3) return std::nullopt;
  std::vector<Turned> all;
  for (const Frame& f : s.system.frames) all.push_back({&f.name, &f.rotation, f.span});
  for (const Body& b : s.system.bodies) all.push_back({&b.name, &b.rotation, b.span});
  if (all.empty()) return std::nullopt;
  const Manifold manifold(s);
  for (int attempt = 0; attempt < 3; ++attempt) {
    Bindings point = sample(s, attempt);
    if (!manifold.reach(point)) continue;
    for (const Turned& x : all)
      if (!is_orthogonal(*x.rotation, point)) return Stretched{*x.name, x.span};
  }
  return std::nullopt;
}

void quaternion_norms(Subject& s) {
  const std::optional<Stretched> x = stretched_rotation(s);
  if (!x) return;
  s.diagnostics.warning(
      "W0427", x->span, fmt::format("nothing holds the quaternion of `{}` at norm 1", x->name),
      "A quaternion of another norm stretches what it turns.",
      "Add the constraint w^2 + x^2 + y^2 + z^2 = 1 for its components, or write `rotation quaternion` "
      "alone, which brings both.");
}

}  // namespace maupertuis::lint_rules
