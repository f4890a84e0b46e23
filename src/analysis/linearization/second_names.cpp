#include "analysis/linearization/second_names.hpp"

#include <maupertuis/evaluate.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace maupertuis {
namespace {

constexpr std::uint64_t first_seed = 5021;
constexpr int compared_places = 3;
constexpr double rounding_of_names = 1e-9;  // of the largest value

bool agree_to_rounding(const Vector& a, const Vector& b) {
  if (a.size() == 0) return true;
  return (a - b).lpNorm<Eigen::Infinity>() <= rounding_of_names * a.lpNorm<Eigen::Infinity>();
}

/// Places of points and bodies, and how bodies are turned.
ExprVector places_of(const MechanicalSystem& system) {
  ExprVector out;
  const auto add = [&](const ExprVector& part) { out.insert(out.end(), part.begin(), part.end()); };
  for (const Point& p : system.points) add(p.position);
  for (const Body& b : system.bodies) {
    add(b.position);
    add(b.rotation.entries);
  }
  return out;
}

}  // namespace

OperatingPoint SecondNames::renamed(OperatingPoint point, const Name& name) const {
  const auto reverse = [&](std::size_t i) {
    for (auto* part : {&point.q, &point.v, &point.a}) (*part)[i] = -(*part)[i];
  };
  reverse(name.reversed);
  if (name.mirrored) {
    reverse(*name.mirrored);
    point.q[*name.mirrored] = std::remainder(std::numbers::pi + point.q[*name.mirrored], 2 * std::numbers::pi);
  }
  return point;
}

bool SecondNames::keeps_equations(const Name& name) const {
  int compared = 0;
  for (std::uint64_t seed = first_seed; seed < first_seed + 8 && compared < compared_places; ++seed) {
    const OperatingPoint here = random_point(e_, seed), there = renamed(here, name);
    Vector forces = e_.value(e_.balance, there);
    if (!forces.allFinite()) continue;
    forces[static_cast<Index>(name.reversed)] *= -1;
    if (name.mirrored) forces[static_cast<Index>(*name.mirrored)] *= -1;
    if (!agree_to_rounding(e_.value(e_.balance, here), forces)) return false;
    for (auto* rows : {&e_.positions, &e_.velocities, &e_.relations})
      if (!agree_to_rounding(e_.value(*rows, here), e_.value(*rows, there))) return false;
    ++compared;
  }
  return compared == compared_places;
}

bool SecondNames::keeps_places(const Name& name) const {
  const ExprVector places = places_of(*e_.system);
  if (places.empty()) return true;
  for (std::uint64_t seed = first_seed; seed < first_seed + compared_places; ++seed) {
    const OperatingPoint here = random_point(e_, seed);
    OperatingPoint there = renamed(here, name);
    for (std::size_t i = 0; i < e_.n; ++i) there.q[i] += std::numbers::pi * name.turned[i];
    const std::vector<double> from = evaluate(places, values_at(e_, here)), to = evaluate(places, values_at(e_, there));
    if (!agree_to_rounding(to_eigen(from), to_eigen(to))) return false;
  }
  return true;
}

/// Of what loses its inertia at 0 of coordinate i the one whose change of names keeps everything.
std::optional<SecondNames::Name> SecondNames::found(std::size_t i) const {
  constexpr double small = 1e-4, as_in_a_plane = 1e-6;
  OperatingPoint near = random_point(e_, first_seed);
  near.q[i] = small * typical_sizes(*e_.system, {})[i];
  const Matrix inertia = e_.at(e_.balance, near).by_a;
  const double of_plane = near.q[i] * near.q[i] * inertia(static_cast<Index>(i), static_cast<Index>(i));
  const auto is_in_plane = [&](double of_turn) { return std::abs(of_turn - of_plane) <= as_in_a_plane * of_plane; };
  const auto holds = [&](const Name& name) { return keeps_equations(name) && keeps_places(name); };
  for (const Translation& t : translations_) {
    const Vector d = to_eigen(t.direction);
    Name name{i, {}, t.direction};
    if (t.direction[i] == 0 && is_in_plane(d.dot(inertia * d)) && holds(name)) return name;
    for (std::size_t j = 0; j < e_.n; ++j) {
      const auto k = static_cast<Index>(j);
      name.mirrored = j;
      if (j != i && t.direction[j] == 0 && e_.is_periodic[j] && is_in_plane(inertia(k, k)) && holds(name)) return name;
    }
  }
  return std::nullopt;
}

const std::optional<SecondNames::Name>& SecondNames::name_that_reverses(std::size_t i) {
  const auto at = known_.find(i);
  return at != known_.end() ? at->second : known_.emplace(i, found(i)).first->second;
}

OperatingPoint SecondNames::first_name(OperatingPoint point) {
  if (translations_.empty()) return point;
  for (int pass = 0; pass < 2; ++pass)  // r < 0 may turn θ below 0
    for (std::size_t i = 0; i < e_.n; ++i)
      if (point.q[i] < 0)
        if (const auto& name = name_that_reverses(i)) point = renamed(point, *name);
  return point;
}

}  // namespace maupertuis
