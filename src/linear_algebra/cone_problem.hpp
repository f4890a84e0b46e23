#pragma once
#include "linear_algebra/dense.hpp"

#include <vector>

namespace maupertuis {

/// Contacts with Coulomb's circular cones: for each a normal force and its friction along `tangents` directions at
/// right angles to each other (0, 1 or 2), one after the other in the vectors. Friction with a limit of its own, behind
/// all contacts, has no normal force.
struct ConeProblem {
  struct Contact {
    int tangents = 2;
    double friction = 0;
  };
  std::vector<Contact> contacts;
  std::vector<double> limits;  // of frictions without a contact; resting_forces alone knows them
  Eigen::MatrixXd response;    // W [Σ (1 + tangents) + limits]²
  Eigen::VectorXd free;        // accelerations (or velocities) of gaps and slips without the forces
};

}  // namespace maupertuis
