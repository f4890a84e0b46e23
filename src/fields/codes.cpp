#include <maupertuis/codes.hpp>

namespace maupertuis {
namespace {

constexpr CodeEntry kEntries[] = {
    {"E0641", "an ill-posed field equation",
     "Where the parts of the density in u' and in u_x have the same sign, the equation is elliptic in time: waves grow, the shorter the faster, so that no start determines what follows.",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 + 1/2 T u_x^2\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\n"},
    {"N0640", "field equations without the time",
     "The density holds no velocity: its equations are those of a field at rest.",
     "field u(x) : length on x = 0 m .. 1 m\nparam T = 1 N\ndensity = -1/2 T u_x^2\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\n"},
};

}  // namespace

std::span<const CodeEntry> fields_codes() { return kEntries; }

}  // namespace maupertuis
