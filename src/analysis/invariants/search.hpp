#pragma once
#include "analysis/invariants/basis.hpp"
#include "analysis/invariants/motion_sampler.hpp"

#include <vector>

namespace maupertuis::invariants {

/// A combination of basis functions that is constant along the motion: Σ coefficient · monomial.
struct Combination {
  struct Term {
    Expr coefficient;  // in the parameters; denominators are cleared
    Monomial monomial;
  };
  std::vector<Term> terms;
  Expr value;
};

struct SearchResult {
  std::vector<Combination> found;  // short ones first
  std::size_t dimension = 0;       // of the space of combinations, without those that are constant functions
  std::size_t too_long = 0;        // of those whose coefficients could not be written in the parameters
  bool sampled = true;             // false: no points were found, or they would cost more than `work`
  bool singular = false;           // the accelerations were not determined at them
};

/// All I = Σ c_k B_k, c_k functions of the parameters, with dI/dt = 0 along the motion, as functions modulo 1 and the
/// span of `known`. At most `work` nodes are evaluated for the matrix. Cost: monomials³/3 multiplications, and as much
/// again for each parameter and short combination.
SearchResult conserved_combinations(const MotionRows& rows, const Generators& generators, const Basis& basis,
                                    const std::vector<Expr>& known, std::size_t work, std::uint64_t seed);

/// The relations Σ c_k B_k = 0 among functions that hold at all points of the motion: what null_vectors gives, with
/// coefficients in the parameters.
SearchResult vanishing_combinations(const MotionRows& rows, const Generators& generators, const Basis& basis,
                                    std::uint64_t seed);

}  // namespace maupertuis::invariants
