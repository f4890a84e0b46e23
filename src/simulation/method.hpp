#pragma once
#include <maupertuis/integrator.hpp>
#include <maupertuis/step.hpp>
#include <maupertuis/variational.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

namespace maupertuis {

/// What a run needs of a stepper, whatever its method. The meaning of each function is told at TaylorStepper.
class Method {
 public:
  virtual ~Method() = default;
  virtual int order() const = 0;
  virtual void start(double t, std::span<const double> q, std::span<const double> v) = 0;
  virtual Step step(double bound) = 0;
  virtual double time() const = 0;
  virtual bool covers(double t) const = 0;
  virtual Sample sample(double t) const = 0;
  virtual void state(double t, std::span<double> q, std::span<double> v) const = 0;
  virtual const Sample& step_start() const = 0;
  virtual std::size_t steps() const = 0;
  virtual std::size_t rejected() const = 0;
  virtual std::size_t switches() const = 0;
  virtual double constraint_residual() const = 0;
  virtual BackendUse backend() const = 0;
};

template <class Stepper>
class MethodOf final : public Method {
 public:
  explicit MethodOf(Stepper stepper) : stepper_(std::move(stepper)) {}
  int order() const override { return stepper_.order(); }
  void start(double t, std::span<const double> q, std::span<const double> v) override { stepper_.start(t, q, v); }
  Step step(double bound) override { return stepper_.step(bound); }
  double time() const override { return stepper_.time(); }
  bool covers(double t) const override { return stepper_.covers(t); }
  Sample sample(double t) const override { return stepper_.sample(t); }
  void state(double t, std::span<double> q, std::span<double> v) const override {
    constexpr bool is_variational = std::is_same_v<Stepper, VariationalStepper>;  // its polynomials err more than its
                                                                                  // steps, from which samples follow
    if constexpr (!is_variational) return stepper_.state(t, q, v);
    const Sample found = stepper_.sample(t);
    std::copy(found.q.begin(), found.q.end(), q.begin());
    std::copy(found.v.begin(), found.v.end(), v.begin());
  }
  const Sample& step_start() const override { return stepper_.step_start(); }
  std::size_t steps() const override { return stepper_.steps(); }
  std::size_t rejected() const override {
    if constexpr (requires { stepper_.rejected(); })
      return stepper_.rejected();
    else
      return 0;
  }
  std::size_t switches() const override { return stepper_.switches(); }
  double constraint_residual() const override { return stepper_.constraint_residual(); }
  /// Other methods than Taylor's are interpreted.
  BackendUse backend() const override {
    BackendUse use;
    if constexpr (requires { stepper_.backend(); })
      use = stepper_.backend();
    else
      use.trouble = "Only Taylor's steps are compiled.";
    return use;
  }

 private:
  Stepper stepper_;
};

template <class Stepper>
std::unique_ptr<Method> method_of(Stepper stepper) {
  return std::make_unique<MethodOf<Stepper>>(std::move(stepper));
}

}  // namespace maupertuis
