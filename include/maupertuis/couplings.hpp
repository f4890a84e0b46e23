#pragma once
#include <maupertuis/equations_of_motion.hpp>

namespace maupertuis {

/// True if M has more entries than anybody reads: more than those of 100 coordinates that are all coupled, and more
/// than 10 for each coordinate. Then equations, momenta and energies are written by shared parts (shared_form.hpp).
/// Cost: that of as many entries.
bool couples_too_much_to_read(const EquationsOfMotion& equations);

}  // namespace maupertuis
