#pragma once
#include <maupertuis/kernel.hpp>

#include <cstddef>

namespace maupertuis {

/// The same program with constants that are rounded another way, which the value of this parameter chooses: each that
/// double does not hold exactly (0.1, √2, 1 + 1e-8), and that is no exponent, is off by as many units in the last place
/// as it may have been before, up or down. Constants that differ by a sign and a power of two go the same way. What
/// runs with several of its values differ by is what the constants were rounded by. Precondition: nothing else holds
/// the parameter.
Kernel with_rounded_constants(const Kernel& kernel, std::size_t parameter);

}  // namespace maupertuis
