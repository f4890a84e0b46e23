#pragma once
#include "kernel/packed/layout.hpp"

#include <vector>

namespace maupertuis::packed {

/// Σ_j a_j b_{m−j} of a pack, whose lag says what m is at a stage.
struct Convolution {
  std::uint32_t a, b;                // blocks
  int lag;
};

/// Those of a pack: of a sum, one a product.
std::vector<Convolution> convolutions_of(const PackedProgram& program, const Pack& pack);

/// How many all packs have.
std::size_t count_convolutions(const PackedProgram& program);

}  // namespace maupertuis::packed
