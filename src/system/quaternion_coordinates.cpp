#include <maupertuis/quaternion_coordinates.hpp>

namespace maupertuis {

std::vector<std::array<std::size_t, 4>> quaternion_coordinates(const MechanicalSystem& system) {
  std::vector<std::array<std::size_t, 4>> out;
  for (const Constraint& c : system.constraints) {
    if (c.body.empty()) continue;
    std::array<std::size_t, 4> four{};
    std::size_t found = 0;
    for (const char* component : {"qw", "qx", "qy", "qz"})
      if (const Coordinate* q = system.find_coordinate(c.body + "." + component))
        four[found++] = static_cast<std::size_t>(q - system.coordinates.data());
    if (found == 4) out.push_back(four);
  }
  return out;
}

}  // namespace maupertuis
