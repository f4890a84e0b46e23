#pragma once
#include "simulation/function_kernels.hpp"

#include <maupertuis/equations_of_motion.hpp>

#include <memory>
#include <vector>

/// Numbers that stand in formulas, and which of them double does not hold exactly (docs/design/certain_digits.md).
namespace maupertuis {

/// `exact` is a number, or something that is none: π, a root. Infinite values have nothing to be moved.
bool is_rounded(Expr exact, double value);

/// Those in these formulas that are rounded, π among them. Numbers in exponents choose which power is taken, and are
/// left out.
std::vector<Expr> rounded_literals(const std::vector<Expr>& roots);

/// A model in which they are parameters, behind its own, with its equations and with what is wanted of its motion.
struct ModelOfLiterals {
  Model model;
  EquationsOfMotion equations;
  WantedFunctions wanted;
};

/// Of a model with contacts or friction, whose modes are derived one by one. Nothing where no literal is rounded, and
/// where there are more than 64 contacts. Cost: that of euler_lagrange.
std::unique_ptr<const ModelOfLiterals> with_literals_as_parameters(const Model& model, const WantedFunctions& wanted);

}  // namespace maupertuis
