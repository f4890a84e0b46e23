#pragma once
#include "simulation/contact/contact_functions.hpp"

#include <maupertuis/contact_mode.hpp>

#include <optional>
#include <vector>

namespace maupertuis {

/// Contacts that touch and do not open (g = 0, ġ = 0), and what the accelerations of their gaps and slips would be
/// without their forces.
struct ContactForceProblem {
  struct Contact {
    SparseRow normal, tangent;  // ∂g/∂q; ∂v_t/∂q̇, empty where there is no friction, or the contact never slides
    double gap_acceleration = 0;   // g̈ without contact forces
    double slip_acceleration = 0;  // v̇_t likewise
    int sliding = 0;               // ±1: it slides; 0: it does not, and may stick or begin to slide
    double friction = 0;           // μ where it slides, else μ_s
  };
  std::vector<Contact> contacts;
  Eigen::MatrixXd response, tangent_response;  // [n × contacts] M⁻¹ (∂g/∂q)ᵀ and M⁻¹ (∂v_t/∂q̇)ᵀ on the constraints
};

/// What the forces make of each contact.
struct ContactForces {
  std::vector<double> normal, acceleration;  // λ ≥ 0, g̈ ≥ 0: one of them is 0
  std::vector<FrictionState> friction;       // of those that press
};

/// 0 ≤ λ ⟂ g̈ ≥ 0 over all contacts, with Coulomb's friction in the plane: forces of those that slide are −σ μ λ, others
/// stick or begin to slide against λ_t = ±μ_s λ. One linear complementarity problem, of three more unknowns for each
/// contact that may stick (D. E. Stewart and J. C. Trinkle, Int. J. Numer. Methods Eng. 39 (1996) 2673, there for
/// velocities), by Lemke's pivoting. Exact where μ_s = μ; else a first guess. Nothing where none is found.
/// Cost: O((contacts + 3 sticking)³).
std::optional<ContactForces> contact_forces(const ContactForceProblem& problem);

}  // namespace maupertuis
