#pragma once
#include "integrator/point/step_search.hpp"

#include <maupertuis/motion_functions.hpp>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace maupertuis {

/// Where within a step an event function first comes to zero: looked for everywhere along the step (StepSearch), so
/// that no pair of roots is passed over; a jump is no root.
class EventSearch {
 public:
  struct Root {
    std::size_t event = 0;
    double t = 0;  // just at the root, or the first number behind it
  };
  enum class Outcome { Seen, TooRough, NoValue };
  struct Result {
    Outcome outcome = Outcome::Seen;  // other than Seen: the step was not searched to its end
    std::optional<Root> root;
  };
  /// The point (q, v, a, λ, t) of the motion at a time within the step.
  using PointAt = std::function<std::span<const double>(double t)>;

  EventSearch(const MotionFunctions& functions, std::span<const double> parameters);
  bool empty() const { return events_.outputs() == 0; }
  /// From begin to end, which may lie before it. A zero at the very beginning does not count.
  Result first(double begin, double end, const PointAt& point);

 private:
  struct Look {
    double x = 0, value = 0;
  };
  void follow(const PointAt& point);
  bool visit(const PointAt& point, Result& result);
  std::optional<double> first_root(std::size_t event, const PointAt& point);
  std::optional<double> root_between(std::size_t event, const Look& low, const Look& high, const PointAt& point);
  std::optional<double> touch_about(std::size_t event, std::span<const Look, 3> looks, const PointAt& point);
  Look lowest(std::size_t event, std::span<const Look, 3> looks);
  std::span<const double> values(double t, const PointAt& point);
  double time_at(double x) const { return x == 1 ? end_ : 0.5 * (begin_ + end_) + 0.5 * x * (end_ - begin_); }

  FunctionKernel events_;
  FunctionWorkspace work_;
  StepSearch search_;
  double begin_ = 0, end_ = 0;
  std::vector<double> path_, values_;
  std::vector<std::vector<Look>> looks_;  // [events] along the step
  std::vector<double> sizes_;             // [events] the largest |value| there
};

/// Why a step was not searched: one sentence.
std::string reason_of(EventSearch::Outcome outcome, double begin, double end);

}  // namespace maupertuis
