#pragma once
#include <maupertuis/expression.hpp>

#include <string_view>

namespace maupertuis {

/// The word for a kind in the model language (functions) and in dumps ("sin", "add").
std::string_view name_of(Kind kind);

}  // namespace maupertuis
