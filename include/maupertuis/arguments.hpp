#pragma once

namespace maupertuis {

/// Throws std::invalid_argument with the sentence `what`, which names the function and the argument: a caller of the
/// library gave what a public function does not take.
void check_argument(bool holds, const char* what);

}  // namespace maupertuis
