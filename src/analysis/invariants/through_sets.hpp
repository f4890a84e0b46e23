#pragma once
#include <maupertuis/integrals_through_modes.hpp>
#include <maupertuis/simulation.hpp>

#include <memory>

namespace maupertuis::invariants {

/// |F(after) − F(before)| against the sizes of the terms of F.
double relative_change(Expr f, const Bindings& before, const Bindings& after);

/// What an event that sets the state does to functions of q, q', t: unchanged where F(after) − F(before) vanishes as a
/// formula; else looked at in random states near the start at which the function of the event is 0.
class AtSets {
 public:
  AtSets(const Model& model, const EquationsOfMotion& equations, const MotionState& start);
  ~AtSets();
  IntegralThroughModes::AtEvent at(const ModelEvent& event, Expr integral);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace maupertuis::invariants
