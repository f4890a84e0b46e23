#pragma once
#include <maupertuis/field_run.hpp>

#include <chrono>
#include <cstddef>

namespace maupertuis {

/// Says how long a run takes as soon as its first steps tell, where that is more than a minute.
class Outlook {
 public:
  explicit Outlook(const FieldRunOptions& options) : options_(options) {}
  /// After so many steps this share of the run is done.
  void after_steps(std::size_t done, double share);

 private:
  using Clock = std::chrono::steady_clock;
  const FieldRunOptions& options_;
  bool told_ = false;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace maupertuis
