#include <maupertuis/codes.hpp>

#include <array>

namespace maupertuis {
namespace {

constexpr std::array entries{
    CodeEntry{
        "W1101", "a singular Legendre transform",
        "p = ∂L/∂q' cannot be solved for every velocity, since M = ∂²L/∂q'∂q' has no inverse: a coordinate without "
        "kinetic energy, "
        "the four components of a quaternion, a Lagrangian that is linear in a velocity. The momenta then obey primary "
        "constraints, and H is determined on them alone. Lagrange's equations are right as they are; leaving out the "
        "coordinate that carries no inertia, or using angles instead of a quaternion, gives a regular transform.",
        "# maup hamiltonian\nparam I = 2 g m^2, J = 3 g m^2\nbody top inertia diag(I, I, J) rotation quaternion\n",
        "# maup hamiltonian\nparam I = 2 g m^2, J = 3 g m^2\ncoord φ, θ, ψ : angle\n"
        "body top inertia diag(I, I, J) rotation euler zxz (φ, θ, ψ)\n"},
    CodeEntry{"E1102", "canonical equations that cannot be integrated",
              "Hamilton's equations need every velocity as a function of the momenta. Where the Legendre transform is "
              "singular or has "
              "no closed form there is no such function; `maup simulate` integrates Lagrange's equations instead.",
              "# maup hamiltonian --integrate\nparam I = 2 g m^2, J = 3 g m^2\n"
              "body top inertia diag(I, I, J) rotation quaternion\nstart top.ω = (1, 0, 9) rad/s\nrun 1 s\n",
              "# maup hamiltonian --integrate\nparam I = 2 g m^2, J = 3 g m^2\ncoord φ, θ, ψ : angle\n"
              "body top inertia diag(I, I, J) rotation euler zxz (φ, θ, ψ)\n"
              "start θ = 60 deg, φ' = 2 rad/s, ψ' = 9 rad/s\nrun 1 s\n"},
    CodeEntry{"W1103", "velocities that are not written in terms of the momenta",
              "L is not quadratic in the velocities, and p = ∂L/∂q' was not solved: only quadratic Lagrangians and "
              "those with one square root of a "
              "quadratic form, as of the relativistic particle, are; or more than 16 coordinates are coupled. The "
              "momenta are right; H is the "
              "energy function h_E at the velocities that belong to p.",
              "# maup hamiltonian\nparam m = 1 kg, a = 1 kg s^2/m^2, k = 4 N/m\ncoord x : length\n"
              "L = 1/2 m x'^2 + 1/4 a x'^4 - 1/2 k x^2\n",
              "# maup hamiltonian\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nL = 1/2 m x'^2 - 1/2 k x^2\n"},
    CodeEntry{"E1104", "a bracket that cannot be formed",
              "A Poisson bracket differentiates functions of q, p and t. A velocity stands for ∂H/∂p, which is not "
              "known where the Legendre "
              "transform is singular or has no closed form; accelerations have no place in phase space.",
              "# maup hamiltonian --bracket x ẍ\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nT = 1/2 m x'^2\n"
              "V = 1/2 k x^2\n",
              "# maup hamiltonian --bracket x p_x\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nT = 1/2 m x'^2\n"
              "V = 1/2 k x^2\n"},
    CodeEntry{"E1105", "no such coordinate for a Routhian",
              "--routhian takes the names of coordinates of the model, separated by commas: those whose velocities are "
              "replaced by their momenta.",
              "# maup hamiltonian --routhian p_φ\nparam m = 1 kg, k = 1 J m\ncoord r : length, φ : angle\n"
              "T = 1/2 m (r'^2 + r^2 φ'^2)\nV = -k/r\n",
              "# maup hamiltonian --routhian φ\nparam m = 1 kg, k = 1 J m\ncoord r : length, φ : angle\n"
              "T = 1/2 m (r'^2 + r^2 φ'^2)\nV = -k/r\n"},
    CodeEntry{
        "E1106", "a Dirac bracket where there is none",
        "{A, B}_D = {A, B} − {A, χ_i} C⁻¹_ij {χ_j, B} belongs to constraints χ of the second class, which a singular "
        "Legendre transform leaves in phase space. Forces, dissipation and velocity constraints have no place in it.",
        "# maup hamiltonian --dirac-bracket x p_x\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nT = 1/2 m x'^2\n"
        "V = 1/2 k x^2\n",
        "# maup hamiltonian --bracket x p_x\nparam m = 1 kg, k = 4 N/m\ncoord x : length\nT = 1/2 m x'^2\n"
        "V = 1/2 k x^2\n"},
};

}  // namespace

std::span<const CodeEntry> hamiltonian_codes() { return entries; }

}  // namespace maupertuis
