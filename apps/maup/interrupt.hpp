#pragma once
#include <atomic>

namespace maupertuis::app {

/// From the first call on, Ctrl-C sets the flag instead of ending the program; a second Ctrl-C ends it at once.
const std::atomic<bool>& interrupt_flag();

}  // namespace maupertuis::app
