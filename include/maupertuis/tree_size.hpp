#pragma once
#include <maupertuis/expression.hpp>

#include <cstddef>

namespace maupertuis {

/// Nodes of the tree that a printer, or a multiplication that is carried out, would walk: a shared node counts as often
/// as it is used. Counted on the graph in linear time; no more than `most`.
std::size_t tree_size(Expr e, std::size_t most);

}  // namespace maupertuis
