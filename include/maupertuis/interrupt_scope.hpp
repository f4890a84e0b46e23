#pragma once
#include <maupertuis/expression.hpp>
#include <maupertuis/interrupt.hpp>

namespace maupertuis {

/// What work on the expressions of a context looks at: making nodes does so now and then and throws Interrupted, and
/// whatever else goes on for long about them asks it too. Never, outside of any scope.
const Interrupt& interrupt_of(const Context& context);

/// While it lives, work on the expressions of a context ends by Interrupted when `interrupt` asks for it.
class InterruptScope {
 public:
  InterruptScope(const Context& context, const Interrupt& interrupt);
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

 private:
  const Context& context_;
  Interrupt before_;
};

}  // namespace maupertuis
