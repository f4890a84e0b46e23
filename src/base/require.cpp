#include <maupertuis/require.hpp>

#include <cstdio>
#include <cstdlib>

namespace maupertuis {

void requirement_failed(const char* condition, const char* file, int line) {
  std::fprintf(stderr,
               "maup: internal precondition broken: %s (%s:%d)\nThis is a defect of the program; please report it.\n",
               condition, file, line);
  std::abort();
}

}  // namespace maupertuis
