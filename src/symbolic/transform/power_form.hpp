#pragma once
#include "symbolic/transform/term_algebra.hpp"

#include <unordered_map>

/// From harmonics back to powers of sines and cosines, one angle at a time: −1/2 cos 2θ + 1/2 is sin² θ to a reader.
namespace maupertuis::terms {

/// Which square Pythagoras removes: sin² = 1 − cos² or cos² = 1 − sin².
enum class Eliminate { SineSquared, CosineSquared };

/// Takes the angle out of every harmonic that holds a whole multiple of it:
/// cos(kα + β) = cos kα cos β − sin kα sin β, with cos kα, sin kα as polynomials in cos α and sin α.
Polynomial power_form(TermAlgebra& algebra, const Polynomial& p, const std::vector<Frequency>& angle,
                      Eliminate eliminate);

/// The angles worth trying: every single angle of the polynomial in its unit, and combinations of which a multiple
/// occurs (sin²(θ1 − θ2) has the harmonic 2θ1 − 2θ2).
std::vector<std::vector<Frequency>> candidate_angles(const TermAlgebra& algebra, const Polynomial& p,
                                                     const std::unordered_map<NodeId, Fraction>& units);

/// True if some harmonic has an angle at more than its unit: only then can powers be shorter for one term alone.
bool has_multiple_angle(const TermAlgebra& algebra, const Polynomial& p,
                        const std::unordered_map<NodeId, Fraction>& units);

}  // namespace maupertuis::terms
