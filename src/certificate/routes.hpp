#pragma once
// The independent routes to Lagrange's equations, over any numbers. Each compares, at one random point of a random path
// q(t), what a derivation claims with what the model says, and returns the differences, which must vanish.
//
// Along q(t) with the variations  δ₁q = c,  δ₂q = c t,  δ₃: t → t + ε, u(t) → u(t + ε)  at fixed q(t), all at t = 0:
//
//   δ₁L = c·∂L/∂q          δ₂L = c·∂L/∂q̇ + t (c·∂L/∂q)          δ₃L = ∂L/∂t + (∂L/∂u) u̇
//
// so that the residual in the direction c is  c·(d/dt ∂L/∂q̇ − ∂L/∂q) = [t¹] δ₂L − 2 [t⁰] δ₁L: the action principle,
// in which no derivative of L is ever written down.
#include "certificate/questions.hpp"
#include "certificate/unit_quaternion.hpp"
#include "symbolic/evaluate/jet_numbers.hpp"
#include "symbolic/evaluate/prime_field.hpp"

#include <string>
#include <unordered_map>

namespace maupertuis::certification {

using evaluation::Jet;
using evaluation::JetNumbers;

enum Variation : std::size_t { Base = 0, Shift = 1, Ramp = 2, Clock = 3 };

/// One answer to all questions as jets along one path, and the direction c.
template <class Numbers>
struct PathValues {
  using Scalar = typename Numbers::Value;
  const Questions& questions;
  std::size_t answer;
  JetNumbers<Numbers>& jets;
  const evaluation::Tape& tape;
  const std::vector<Jet<Scalar>>& values;
  std::vector<Scalar> direction;  // [n]

  const Jet<Scalar>& of(Root root) const { return values[tape.roots()[answer * questions.asked + root]]; }
  Scalar zero() const { return jets.base().number(0); }
  Scalar add(const Scalar& a, const Scalar& b) const { return jets.base().add(a, b); }
  Scalar subtract(const Scalar& a, const Scalar& b) const { return jets.base().subtract(a, b); }
  Scalar multiply(const Scalar& a, const Scalar& b) const { return jets.base().multiply(a, b); }

  Scalar along_direction(const Roots& roots) const {
    Scalar sum = zero();
    for (std::size_t i = 0; i < roots.size(); ++i) sum = add(sum, multiply(direction[i], of(roots[i])(Base, 0)));
    return sum;
  }
  Scalar dot(const Roots& a, const Roots& b) const {
    Scalar sum = zero();
    for (std::size_t i = 0; i < a.size(); ++i) sum = add(sum, multiply(of(a[i])(Base, 0), of(b[i])(Base, 0)));
    return sum;
  }
};

/// c·(d/dt ∂/∂q̇ − ∂/∂q) of a function of q, q̇, t.
template <class P>
auto variation(const P& path, Root function) {
  const auto& f = path.of(function);
  return path.subtract(f(Ramp, 1), path.add(f(Shift, 0), f(Shift, 0)));
}

/// c·∂D/∂q̇.
template <class P>
auto dissipative_force(const P& path) {
  return path.of(path.questions.dissipation)(Ramp, 0);
}

/// The virtual work of the applied forces in the displacement c: F·δr, τ·δθ.
template <class P>
auto virtual_work(const P& path) {
  auto work = path.zero();
  for (const ForceQuestion& f : path.questions.forces) {
    if (f.kind == AppliedForce::Kind::Generalized) {
      work = path.add(work, path.multiply(path.direction[f.coordinate], path.of(f.components[0])(Base, 0)));
      continue;
    }
    // An angular velocity is linear in q̇: its variation under q̇ → q̇ + ε c is the virtual rotation.
    const Variation kind = f.kind == AppliedForce::Kind::OnPoint ? Shift : Ramp;
    for (std::size_t k = 0; k < f.components.size(); ++k)
      work = path.add(work, path.multiply(path.of(f.components[k])(Base, 0), path.of(f.lever[k])(kind, 0)));
  }
  return work;
}

/// (b) The residual, the momenta, Q, ∂D/∂q̇ and M q̈ + h against the action principle.
template <class P>
auto action_route(const P& path) {
  const Questions& ask = path.questions;
  const auto claimed = path.along_direction(ask.residual);
  const auto forces = path.subtract(dissipative_force(path), virtual_work(path));
  std::vector<typename P::Scalar> differences{
      path.subtract(claimed, path.add(variation(path, ask.lagrangian), forces)),
      path.subtract(path.along_direction(ask.momenta), path.of(ask.lagrangian)(Ramp, 0)),
      path.subtract(path.along_direction(ask.generalized_forces), virtual_work(path)),
      path.subtract(path.along_direction(ask.dissipative_terms), dissipative_force(path))};
  if (!ask.bias.empty()) {
    auto sum = path.along_direction(ask.bias);
    const std::size_t n = ask.accelerations.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        sum = path.add(sum, path.multiply(path.direction[i], path.multiply(path.of(ask.mass_matrix[i * n + j])(Base, 0),
                                                                           path.of(ask.accelerations[j])(Base, 0))));
    differences.push_back(path.subtract(sum, claimed));
  }
  return differences;
}

/// The virtual work of the forces of constraint in the displacement c: λ·δ₁φ, and λ·δ₂ψ by d'Alembert, Lagrange and
/// Chetaev. The vakonomic δ of ∫ λψ dt is another thing.
template <class P>
auto constraint_work(const P& path) {
  auto work = path.zero();
  for (const ConstraintQuestion& c : path.questions.constraints) {
    const Variation kind = c.level == Constraint::Level::Position ? Shift : Ramp;
    work = path.add(work, path.multiply(path.of(c.multiplier)(Base, 0), path.of(c.value)(kind, 0)));
  }
  return work;
}

/// The constraints in the equations: Aᵀλ first, then of each constraint dφ/dt or ψ and A q̈ − b against φ or ψ along the
/// path, the row of A and b, and that no velocity stands in φ.
template <class P>
auto constraint_route(const P& path) {
  const Questions& ask = path.questions;
  const auto claimed = path.along_direction(ask.constraint_forces);
  std::vector<typename P::Scalar> differences{path.subtract(claimed, constraint_work(path))};
  auto from_rows = path.zero();
  for (const ConstraintQuestion& c : ask.constraints) {
    const auto& value = path.of(c.value);
    const bool position = c.level == Constraint::Level::Position;
    const auto rate = value(Base, position ? 1 : 0);
    const auto acceleration = position ? path.add(value(Base, 2), value(Base, 2)) : value(Base, 1);
    differences.push_back(path.subtract(path.of(c.rate)(Base, 0), rate));
    differences.push_back(path.subtract(path.of(c.acceleration)(Base, 0), acceleration));
    if (position) differences.push_back(value(Ramp, 0));
    if (c.row.empty()) continue;
    differences.push_back(
        path.subtract(path.dot(c.row, ask.accelerations), path.add(path.of(c.bias)(Base, 0), acceleration)));
    from_rows = path.add(from_rows, path.multiply(path.of(c.multiplier)(Base, 0), path.along_direction(c.row)));
  }
  if (!ask.constraints.front().row.empty()) differences.push_back(path.subtract(from_rows, claimed));
  return differences;
}

/// (d) q̇·R = dh_E/dt + ∂L/∂t + q̇·∂D/∂q̇ − Q·q̇ for any q̈, and the power that is claimed, with λ·A q̇.
template <class P>
auto power_route(const P& path) {
  const Questions& ask = path.questions;
  const auto outflow =
      path.subtract(path.dot(ask.velocities, ask.dissipative_terms), path.dot(ask.velocities, ask.generalized_forces));
  const auto power = path.add(path.of(ask.lagrangian)(Clock, 0), outflow);  // minus what drives h_E
  const auto change = path.add(path.of(ask.energy_function)(Base, 1), power);
  // λ·A q̇, of which dφ/dt and ψ vanish along the motion.
  auto of_constraints = path.zero();
  if (!ask.constraints.empty()) of_constraints = path.dot(ask.velocities, ask.constraint_forces);
  for (const ConstraintQuestion& c : ask.constraints) {
    const auto rate = path.of(c.value)(Base, c.level == Constraint::Level::Position ? 1 : 0);
    of_constraints = path.subtract(of_constraints, path.multiply(path.of(c.multiplier)(Base, 0), rate));
  }
  return std::vector<typename P::Scalar>{path.subtract(path.dot(ask.velocities, ask.residual), change),
                                         path.subtract(path.add(path.of(ask.power)(Base, 0), power), of_constraints)};
}

template <class P>
using Matrix = std::vector<Jet<typename P::Scalar>>;  // by rows

template <class P>
Matrix<P> product(const P& path, const Matrix<P>& a, const Matrix<P>& b, std::size_t n, bool transpose_b) {
  Matrix<P> out;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      auto sum = path.jets.number(0);
      for (std::size_t k = 0; k < n; ++k)
        sum = path.jets.add(sum, path.jets.multiply(a[i * n + k], transpose_b ? b[j * n + k] : b[k * n + j]));
      out.push_back(sum);
    }
  return out;
}

/// The axial vector of a skew matrix: three components in space, one in the plane.
template <class P>
Matrix<P> axial(const Matrix<P>& w, std::size_t n) {
  if (n == 2) return {w[2]};
  return {w[7], w[2], w[3]};
}

/// Euler's law for one body, from its rotation matrix R alone: ω from Ṙ Rᵀ, d/dt(I ω) · δθ with δθ from δR Rᵀ.
template <class P>
auto euler_term(const P& path, const BodyQuestion& body) {
  const std::size_t n = body.rotation.size() == 4 ? 2 : 3;
  Matrix<P> rotation, rate, inertia;
  for (const Root r : body.rotation) {
    rotation.push_back(path.of(r));
    rate.push_back(path.jets.derivative(rotation.back()));
  }
  for (const Root r : body.inertia) inertia.push_back(path.of(r));
  const Matrix<P> omega = axial<P>(product(path, rate, rotation, n, true), n);
  Matrix<P> momentum;
  if (n == 2) {
    momentum.push_back(path.jets.multiply(inertia[0], omega[0]));
  } else {
    const Matrix<P> world = product(path, product(path, rotation, inertia, n, false), rotation, n, true);
    for (std::size_t i = 0; i < n; ++i) {
      auto sum = path.jets.number(0);
      for (std::size_t k = 0; k < n; ++k) sum = path.jets.add(sum, path.jets.multiply(world[i * n + k], omega[k]));
      momentum.push_back(sum);
    }
  }
  // δθ: the variation of R alone, times Rᵀ without variation.
  Matrix<P> varied, still;
  for (const auto& entry : rotation) {
    varied.push_back(path.jets.constant(entry(Shift, 0)));
    still.push_back(path.jets.constant(entry(Base, 0)));
  }
  const Matrix<P> turn = axial<P>(product(path, varied, still, n, true), n);
  auto sum = path.zero();
  for (std::size_t i = 0; i < turn.size(); ++i)
    sum = path.add(sum, path.multiply(path.jets.derivative(momentum[i])(Base, 0), turn[i](Base, 0)));
  return sum;
}

/// (c) d'Alembert: Σ (d/dt(m ṙ) − m g)·δr + Σ d/dt(I ω)·δθ, with the given energies, D, the applied forces and those of
/// the constraints.
template <class P>
auto dalembert_route(const P& path) {
  const Questions& ask = path.questions;
  auto sum = variation(path, ask.given_energies);
  for (const ParticleQuestion& particle : ask.particles) {
    const auto& mass = path.of(particle.mass);
    for (std::size_t k = 0; k < particle.position.size(); ++k) {
      const auto& r = path.of(particle.position[k]);
      auto force = path.jets.derivative(path.jets.multiply(mass, path.jets.derivative(r)))(Base, 0);
      if (!ask.gravity.empty())
        force = path.subtract(force, path.multiply(mass(Base, 0), path.of(ask.gravity[k])(Base, 0)));
      sum = path.add(sum, path.multiply(force, r(Shift, 0)));
    }
  }
  for (const BodyQuestion& body : ask.bodies) sum = path.add(sum, euler_term(path, body));
  sum = path.add(sum, path.subtract(dissipative_force(path), virtual_work(path)));
  auto claimed = path.along_direction(ask.residual);
  if (!ask.constraints.empty()) {
    sum = path.subtract(sum, constraint_work(path));
    claimed = path.subtract(claimed, path.along_direction(ask.constraint_forces));
  }
  return std::vector<typename P::Scalar>{path.subtract(claimed, sum)};
}

/// The jets of the symbols along a random path.
template <class Numbers>
class RandomPath {
 public:
  using Scalar = typename Numbers::Value;

  RandomPath(const Questions& questions, Numbers& numbers, std::size_t orders, const std::vector<Scalar>& direction)
      : numbers_(numbers), half_(numbers.number(Rational(1, 2))), orders_(orders) {
    const auto& coordinates = questions.system.coordinates;
    for (std::size_t i = 0; i < coordinates.size(); ++i)
      tracks_.emplace(coordinates[i].name, Track{track_of(coordinates[i]), direction[i]});
  }

  /// Moves the quaternions to the unit sphere and the direction into its tangent space.
  void keep_to_rotations(const Questions& questions, std::vector<Scalar>& direction) {
    const UnitQuaternion<Numbers> unit(numbers_);
    const auto& coordinates = questions.system.coordinates;
    for (const std::array<std::size_t, 4>& four : questions.unit_quaternions) {
      typename UnitQuaternion<Numbers>::Quaternion track;
      std::array<Scalar, 4> c;
      for (std::size_t k = 0; k < 4; ++k) {
        track[k] = tracks_.at(coordinates[four[k]].name).coefficients;
        c[k] = direction[four[k]];
      }
      track = unit.from(track);
      c = unit.tangent(c, track);
      for (std::size_t k = 0; k < 4; ++k) {
        direction[four[k]] = c[k];
        tracks_.at(coordinates[four[k]].name) = {track[k], c[k]};
      }
    }
  }

  Jet<Scalar> operator()(Expr symbol) {
    Jet<Scalar> out = blank();
    const auto order = static_cast<std::size_t>(symbol.order());
    switch (symbol.role()) {
      case Role::Coordinate: {
        const Track& track = tracks_.at(symbol.name());
        set_derivative(out, Base, track.coefficients, order);
        if (order == 0) out(Shift, 0) = track.direction;
        if (order <= 1 && orders_ > 1 - order) out(Ramp, 1 - order) = track.direction;
        break;
      }
      case Role::Input: {
        const std::vector<Scalar>& track = input_track(symbol);
        set_derivative(out, Base, track, order);
        set_derivative(out, Clock, track, order + 1);
        break;
      }
      case Role::Time:
        out(Base, 0) = numbers_.symbol(symbol);
        if (orders_ > 1) out(Base, 1) = numbers_.number(1);
        out(Clock, 0) = numbers_.number(1);
        break;
      case Role::Parameter:
      case Role::Constant:
      case Role::Multiplier:
      case Role::Auxiliary:
        out(Base, 0) = numbers_.symbol(symbol);
    }
    return out;
  }

 private:
  struct Track {
    std::vector<Scalar> coefficients;
    Scalar direction;
  };
  static constexpr std::size_t track_length = Jet<Scalar>::max_orders + 4;

  Jet<Scalar> blank() const {
    Jet<Scalar> out;
    for (auto& part : out.c) part.fill(numbers_.number(0));
    return out;
  }

  /// Coefficients of q(t) whose first three values belong to the symbols q, q', q''.
  std::vector<Scalar> track_of(const Coordinate& c) const {
    std::vector<Scalar> out{numbers_.symbol(c.q), numbers_.symbol(c.velocity),
                            numbers_.multiply(numbers_.symbol(c.acceleration), half_)};
    for (std::size_t k = 3; k < track_length; ++k) out.push_back(numbers_.random(c.q.id(), k));
    return out;
  }

  const std::vector<Scalar>& input_track(Expr symbol) {
    const auto [found, fresh] = inputs_.try_emplace(symbol.name());
    if (fresh) {
      std::uint64_t key = 0x696e;
      for (const char ch : symbol.name()) key = evaluation::mix(key ^ static_cast<unsigned char>(ch));
      for (std::size_t k = 0; k < track_length; ++k) found->second.push_back(numbers_.random(key, k));
    }
    return found->second;
  }

  /// The series of the `order`-th derivative.
  void set_derivative(Jet<Scalar>& out, std::size_t part, const std::vector<Scalar>& track, std::size_t order) const {
    for (std::size_t k = 0; k < orders_ && k + order < track.size(); ++k) {
      std::int64_t factor = 1;
      for (std::size_t j = k + 1; j <= k + order; ++j) factor *= static_cast<std::int64_t>(j);
      out(part, k) = numbers_.multiply(numbers_.number(factor), track[k + order]);
    }
  }

  Numbers& numbers_;
  Scalar half_;
  std::size_t orders_;
  std::unordered_map<std::string, Track> tracks_;
  std::unordered_map<std::string, std::vector<Scalar>> inputs_;
};

}  // namespace maupertuis::certification
