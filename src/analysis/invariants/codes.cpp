#include <maupertuis/codes.hpp>

#include <array>

namespace maupertuis {
namespace {

constexpr std::array entries{
    CodeEntry{"E1001", "the basis of a search for integrals is too large",
              "maup invariants looks for conserved quantities among the combinations of finitely many functions. "
              "Polynomials of "
              "high degree in many velocities have so many coefficients that the matrix of the search would not fit; "
              "the size is "
              "computed before anything else. A lower --degree asks for less; --largest-basis allows more.",
              "", ""},
    CodeEntry{"E1002", "the accelerations are not determined, so that nothing can be said of conservation",
              "dI/dt along the motion needs the accelerations. Where the mass matrix, bordered by the constraints, is "
              "singular, "
              "several motions start from one state.",
              "", ""},
    CodeEntry{"E1003", "constraints that are not linear in the velocities are not searched",
              "Points of the motion are drawn over a prime field. Velocities that satisfy linear equations are found "
              "there by "
              "elimination; others are not. A single candidate is proved by `expect conserved EXPR`.",
              "", ""},
    CodeEntry{"W1004", "the drift of the integrals was not measured",
              "The integrals are proved without a run. Their drift along the model's own run is measured in addition; "
              "this run "
              "failed or could not start.",
              "", ""},
};

}  // namespace

std::span<const CodeEntry> invariants_codes() { return entries; }

}  // namespace maupertuis
