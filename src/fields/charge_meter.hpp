#pragma once
#include "fields/field_motion.hpp"

#include <maupertuis/field_run.hpp>
#include <maupertuis/function_kernel.hpp>

#include <deque>
#include <memory>
#include <optional>
#include <vector>

namespace maupertuis {

/// ∫ f dt of functions that are known at the moments of steps: through each interval goes the polynomial of the eight
/// moments nearest to it.
class SampledIntegral {
 public:
  explicit SampledIntegral(std::size_t functions) : functions_(functions) {}
  /// The next moment. One at hardly a distance of the last is no node of the polynomials, which would magnify rounding.
  void add(double t, std::vector<double> values);
  /// Number of the last node, under which the integral up to it is known later, and what is between it and the last
  /// moment.
  std::size_t moment() const { return count_ - 1; }
  const std::vector<double>& beyond() const { return beyond_; }
  /// All that is left: no moments follow.
  void finish();
  /// Calls for each moment, in order, with the integral from the first one; each once.
  template <class F>
  void take(F&& f) {
    for (; !known_.empty(); known_.pop_front()) f(known_.front().moment, known_.front().integral);
  }

 private:
  struct Sample {
    double t = 0;
    std::vector<double> values;
  };
  struct Known {
    std::size_t moment = 0;
    std::vector<double> integral;
  };
  void integrate_to(std::size_t sample);
  std::size_t functions_, count_ = 0, done_ = 0;  // moments; samples of the window up to which the integral is known
  std::deque<Sample> window_;
  std::vector<double> sum_, beyond_;
  std::deque<Known> known_;
};

/// Follows Q = ∫ j^t dx along a run, and what flows out of the sides by j^x.
class ChargeMeter {
 public:
  /// Of the currents whose density holds no other derivatives than the elements have. None where dissipation or forces
  /// inside act, which are no part of the currents.
  ChargeMeter(const FieldMotion& motion, const FieldEquations& equations, const FieldCurrents& currents);
  bool idle() const { return charges_.empty(); }
  /// At the start and after each step.
  void note_flux(FieldMotion& motion);
  /// At moments where note_flux was called before.
  void measure(FieldMotion& motion);
  std::vector<FieldCharge> finish();

 private:
  struct Row {
    std::size_t moment = 0;
    std::vector<double> q, beyond;
  };
  void balance();
  const FieldEquations& equations_;
  std::vector<FieldCharge> charges_;
  std::vector<double> size_;  // of the terms of each
  std::vector<Expr> jets_;    // in the fluxes
  std::unique_ptr<FunctionWorkspace> densities_, fluxes_;
  std::vector<std::vector<bool>> flows_;  // [charges][directions] whether anything can flow there
  bool any_flow_ = false;
  std::size_t outputs_ = 0;
  SampledIntegral out_;
  std::deque<Row> rows_;
};

}  // namespace maupertuis
