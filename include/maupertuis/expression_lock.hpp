#pragma once
#include <maupertuis/expression.hpp>

#include <mutex>

namespace maupertuis {

/// Holds the expressions of a context for one thread while it lives; others that want them wait. The same thread
/// may take it again. What makes expressions of a model that several threads could share takes it: simulate,
/// motion_kernel, dynamics_source, consistent_start, the constructors of PointEquations, TangentFlow and
/// TangentGeometry, PointEquations::set_parameter, derivations and certificates. Whatever else makes or reads
/// expressions does not: library.md has the rule.
class ExpressionLock {
 public:
  explicit ExpressionLock(const Context& context);

 private:
  std::unique_lock<std::recursive_mutex> lock_;
};

}  // namespace maupertuis
