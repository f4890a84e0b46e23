#pragma once
#include "simulation/contact/contact_functions.hpp"

#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace maupertuis::hybrid {

/// Where a motion is, and what its contacts and frictions are there.
class State {
 public:
  State(std::shared_ptr<const ContactPrograms> contacts, std::span<const double> parameters)
      : functions_(std::move(contacts), parameters) {}

  double t = 0, t_rest = 0;  // a located instant is t + t_rest
  std::vector<double> q, v;

  /// They stay until those of another point are asked for.
  const ContactValues& values() const { return functions_.at(t, q, v); }
  const ContactValues& values_at(double time, std::span<const double> places, std::span<const double> speeds) const {
    return functions_.at(time, places, speeds);
  }
  // See ContactFunctions.
  Eigen::MatrixXd response(std::span<const SparseRow> rows, std::span<const SparseRow> held = {}) const {
    return functions_.response(t, q, v, rows, held);
  }
  std::vector<SparseRow> constraint_rows() const { return functions_.constraint_rows(t, q, v); }
  Eigen::VectorXd multipliers(const Eigen::VectorXd& change, const Eigen::VectorXd& force,
                              std::span<const SparseRow> held) const {
    return functions_.multipliers(t, q, v, change, force, held);
  }
  std::span<const double> drifts() const { return functions_.drifts(t, q, v); }

 private:
  mutable ContactFunctions functions_;  // what they were last asked for is kept
};

}  // namespace maupertuis::hybrid
