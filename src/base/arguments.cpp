#include <maupertuis/arguments.hpp>

#include <stdexcept>

namespace maupertuis {

void check_argument(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

}  // namespace maupertuis
