#include <maupertuis/interrupt_scope.hpp>

#include "symbolic/expression/storage.hpp"

namespace maupertuis {

const Interrupt& interrupt_of(const Context& context) { return context.storage().interrupt; }

InterruptScope::InterruptScope(const Context& context, const Interrupt& interrupt)
    : context_(context), before_(interrupt_of(context)) {
  context.storage().interrupt = interrupt;
}
InterruptScope::~InterruptScope() { context_.storage().interrupt = before_; }

}  // namespace maupertuis
