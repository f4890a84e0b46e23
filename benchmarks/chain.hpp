#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/integrator.hpp>
#include <maupertuis/kernel.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace bench {

/// A chain of n pendulums, each point defined from the one before, as `maup new chain` writes it.
std::string chain_text(int links);

/// Reads a model that is known to be right; throws otherwise.
std::shared_ptr<const maupertuis::Model> read(const std::string& text);
maupertuis::EquationsOfMotion derive(const std::shared_ptr<const maupertuis::Model>& model);

/// The chain as numbers: m = l = 1, g = 9.81, at rest from angles linearly from 2.0 to 2.5 rad.
struct ChainMotion {
  maupertuis::Kernel kernel;  // the residual alone
  std::vector<double> parameters, q, v;
};
ChainMotion chain_motion(int links);

/// Lets a stepper with compiled code come to the code of long runs, which it makes when the steps to come promise to
/// pay for it.
void settle(maupertuis::TaylorStepper& stepper, const ChainMotion& chain);

/// The energy of that chain by the closed form, and the size of its terms, the same for all motions from one start.
struct ChainEnergy {
  double value = 0;  // J
  double terms = 0;  // J, kinetic energy and the sum of |m g y|
};
ChainEnergy chain_energy(std::span<const double> q, std::span<const double> v);

}  // namespace bench
