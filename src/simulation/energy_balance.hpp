#pragma once
#include "simulation/method.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace maupertuis {

/// energy_drift = max |h_E(t) − h_E(0) − work(t)| / max Σ |terms of h_E| of a run. Without power there is no integral.
/// What is more than rounding of h_E is measured by what can change as well: terms of places alone count by how far
/// they are from their first value, so that a constant in V, a height above the centre of the earth, hides nothing.
class EnergyBalance {
 public:
  /// `terms`: so many first observables add up to h_E. `jumps`: its formula jumps at switches in time.
  /// `of_places`: [terms] it knows no velocity; empty where nobody says.
  EnergyBalance(std::size_t terms, bool jumps, std::vector<bool> of_places = {})
      : terms_(terms),
        jumps_(jumps),
        of_places_(std::move(of_places)),
        knows_velocity_(std::find(of_places_.begin(), of_places_.end(), false) != of_places_.end()) {}

  void before_step(const Method& method);
  void after_step(const Method& method, const Step& step);
  void add(const Sample& sample);
  /// Another method takes over: its integrals start at zero again.
  void carry_over(const Sample& last) { work_before_ += work_of(last); }

  /// `rounding`: of energies; where there have been no larger ones they do not drift.
  double drift(double rounding = 0) const;
  /// Nothing is known of it: a term was infinite, or it had no value at any state.
  bool is_lost() const { return overflows_ || (terms_ > 0 && !begun_); }
  static constexpr const char* lost =
      "The energy is infinite or has no value along this motion, so that nothing tells whether it is right.";

 private:
  double energy_of(const Sample& sample) const;
  double change_of_term(std::size_t i, double value) const;
  static double work_of(const Sample& sample) { return sample.integrals.empty() ? 0 : sample.integrals[0]; }

  std::size_t terms_;
  bool jumps_, at_switch_ = false;  // the last step ended there
  std::vector<bool> of_places_;
  bool knows_velocity_;  // some term does
  std::vector<double> first_terms_;
  std::optional<Sample> on_switch_;
  bool begun_ = false, overflows_ = false;
  double first_ = 0, largest_scale_ = 0, largest_change_ = 0, largest_error_ = 0, work_before_ = 0;
};

}  // namespace maupertuis
