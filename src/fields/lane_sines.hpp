#pragma once
#include <cstddef>

namespace maupertuis {

/// out = sin x or cos x of n lanes, within 1e-15 beside 1. Arguments beyond 1e6, and what is no number, go to the
/// standard library. Some 1 ns a lane where the library takes 6 (AVX-512).
void set_sines(double* out, const double* x, std::size_t n, bool cosine);

}  // namespace maupertuis
