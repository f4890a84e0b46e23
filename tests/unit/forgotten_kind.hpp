#pragma once
#include "symbolic/expression/storage.hpp"

#include <array>

/// A kind that no pass has a rule for, as a new one would be in a pass that was forgotten.
inline constexpr maupertuis::Kind forgotten_kind =
    static_cast<maupertuis::Kind>(static_cast<int>(maupertuis::Kind::Or) + 1);

/// The constructors refuse such a kind; the storage below them makes it.
inline maupertuis::Expr node_of_forgotten_kind(maupertuis::Expr x) {
  const std::array arguments{x.id()};
  maupertuis::Context& context = x.context();
  return {&context, const_cast<maupertuis::Context::Storage&>(context.storage()).intern(forgotten_kind, arguments)};
}
