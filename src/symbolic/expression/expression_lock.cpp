#include <maupertuis/expression_lock.hpp>

#include "symbolic/expression/storage.hpp"

namespace maupertuis {

ExpressionLock::ExpressionLock(const Context& context) : lock_(context.storage().mutex) {}

}  // namespace maupertuis
