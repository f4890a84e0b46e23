#pragma once
#include "analysis/linearization/point_equations.hpp"

namespace maupertuis {

/// How a small change of the state or of an input moves everything at the point: the columns are those of (x, u, u',
/// u'').
struct Response {
  Matrix motion;  // [2n × (f+g+3k)] of (q, q̇)
  Matrix answer;  // [(n+m) × (f+g+3k)] of (q̈, λ)
  Index states = 0;
};

/// The outputs to first order, by the chain rule. A row of C and D is NaN where the output has no derivative: at a
/// kink, a jump, or the border of where it has values.
MeasuredOutputs measured_outputs(PointEquations::Impl& equations, const OperatingPoint& point,
                                 const Response& response);

}  // namespace maupertuis
