#pragma once
#include <maupertuis/integrator.hpp>
#include <maupertuis/motion_through_modes.hpp>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace maupertuis::orbits {

/// A motion step by step, by the Taylor steps of one set of equations or through modes. Observables of its samples
/// begin with the terms of h_E.
class AnyMotion {
 public:
  virtual ~AnyMotion() = default;
  virtual void start(double t, std::span<const double> q, std::span<const double> v) = 0;
  virtual Step step(double bound) = 0;
  virtual double time() const = 0;
  virtual Sample sample(double t) const = 0;
  virtual void state(double t, std::span<double> q, std::span<double> v) const = 0;
  /// The event of the model that stopped it.
  virtual std::optional<std::string> stopped_by() const = 0;
};

template <class Stepper>
class AnyMotionOf final : public AnyMotion {
 public:
  explicit AnyMotionOf(Stepper stepper) : stepper_(std::move(stepper)) {}
  void start(double t, std::span<const double> q, std::span<const double> v) override { stepper_.start(t, q, v); }
  Step step(double bound) override { return stepper_.step(bound); }
  double time() const override { return stepper_.time(); }
  Sample sample(double t) const override { return stepper_.sample(t); }
  void state(double t, std::span<double> q, std::span<double> v) const override { stepper_.state(t, q, v); }
  std::optional<std::string> stopped_by() const override {
    if constexpr (requires { stepper_.stopped_by(); })
      return stepper_.stopped_by();
    else
      return std::nullopt;
  }

 private:
  Stepper stepper_;
};

template <class Stepper>
std::unique_ptr<AnyMotion> any_motion(Stepper stepper) {
  return std::make_unique<AnyMotionOf<Stepper>>(std::move(stepper));
}

}  // namespace maupertuis::orbits
