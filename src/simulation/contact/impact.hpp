#pragma once
#include "simulation/contact/contact_functions.hpp"

#include <maupertuis/contact.hpp>

#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

/// One impulse of an impact.
struct Impulse {
  std::size_t contact = 0;
  double normal = 0, tangential = 0;  // Λ ≥ 0, Λ_t
  double second_tangential = 0;       // the second component of Λ_t in space
  double speed = 0;                   // −ġ before it
  double loss = 0;                    // of energy in the frame of the contact
};

/// What became of the velocities.
struct ImpactResult {
  Eigen::VectorXd v;              // q̇⁺ [n]
  std::vector<Impulse> impulses;  // in their order
  double moving = 0;              // energy from contacts that move, −Λ ∂g/∂t
  double loss = 0;                // of energy otherwise
  bool bounded = false;           // the bound of sequential impulses was met: the rest was done at once, without bounce
  bool unsolved = false;          // no impulses were found that keep all contacts from closing
  std::optional<std::size_t> rubs_at_once{};  // a contact with friction that is hit together with others
};

/// What an impact is made of: at one configuration, contacts with g = 0.
struct ImpactProblem {
  std::vector<std::size_t> contacts;                           // that touch, by number
  std::vector<SparseRow> normal;                               // [contacts] ∂g/∂q
  std::vector<SparseRow> tangent;                              // [contacts] ∂v_t/∂q̇; empty: without friction
  std::vector<double> drive;                                   // [contacts] ∂g/∂t
  std::vector<double> slip_drive;                              // [contacts] what v_t has besides ∂v_t/∂q̇ q̇
  std::vector<double> restitution, friction, static_friction;  // [contacts] e, μ, μ_s
  std::vector<bool> sticking;                                  // [contacts] it never slides
  std::vector<double> rest;                                    // [contacts] speeds up to which ġ counts as 0
  Eigen::MatrixXd response;          // [n × contacts] M⁻¹ (∂g/∂q)ᵀ on the constraints
  Eigen::MatrixXd tangent_response;  // [n × contacts] the same for ∂v_t/∂q̇
  // Of friction in space the second components; empty where there is none.
  std::vector<SparseRow> second_tangent;
  std::vector<double> second_drive;
  Eigen::MatrixXd second_response;
};

enum class ImpactOrder { FastestFirst, FastestLast };

/// One impact after the other, each with Newton's restitution, or with Stronge's energetic one where there is friction
/// (Stronge, Impact Mechanics, 3.4), until no contact closes. The contact whose |ġ|/√(G M⁻¹ Gᵀ) is largest comes first.
/// After 1000 impulses a contact the rest is done at once with e = 0, and that is said.
ImpactResult sequential_impact(const ImpactProblem& problem, const Eigen::VectorXd& v, ImpactOrder order);

/// 0 ≤ Λ ⟂ ġ⁺ + e ġ⁻ ≥ 0 over the contacts that close or rest. Without friction. `plastic`: e = 0.
ImpactResult simultaneous_impact(const ImpactProblem& problem, const Eigen::VectorXd& v, bool plastic);

/// The same with the friction of a contact that is hit alone, as sequential_impact has it. Where one with friction is
/// hit together with others `rubs_at_once` names it: friction has no law there.
ImpactResult impact_at_once(const ImpactProblem& problem, const Eigen::VectorXd& v);

/// ġ⁺ = 0 at all contacts: what infinitely many bounces between them end in.
ImpactResult end_of_bounces(const ImpactProblem& problem, const Eigen::VectorXd& v);
/// ġ⁺ = 0 at contacts that open so slowly that they are kept closed. From now on they press as their bounces would have
/// pressed on the average, that is already while they would fly: the impulse −ġ/w that takes out ġ is negative, and
/// takes with it what friction would do too early, on contacts that slide on.
ImpactResult end_of_flights(const ImpactProblem& problem, const Eigen::VectorXd& v);

/// Normal and tangential impulse at one contact in the plane: w = [W_nn, W_nt, W_tt] gives what they change in
/// (v_n, v_t). Sliding, sticking and reversal follow each other while the normal impulse grows (Stronge). v_n < 0.
struct PlaneImpulse {
  double normal = 0, tangential = 0;
};
PlaneImpulse frictional_impulse(double w_nn, double w_nt, double w_tt, double v_n, double v_t, double friction,
                                double static_friction, bool sticking, double restitution);

}  // namespace maupertuis
