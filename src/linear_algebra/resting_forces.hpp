#pragma once
#include "linear_algebra/cone_problem.hpp"

#include <optional>

namespace maupertuis {

/// Forces within their cones and limits under which nothing accelerates, W λ + free = 0, where there are such: of the
/// many that a statically indeterminate rest may have one that leaves friction a margin: of the parts ½, ⅛, 1/32, … of
/// its limits that may be left, the largest that can, and there the least forces. Nothing where less than 10⁻¹² is
/// left. By planes that touch the cones and the shortest way between them (least_distance). Of many contacts in the
/// plane those that W tells apart are as few as there are freedoms: whether there are forces is found over that few
/// rows, by edges of the cones, and the least ones by as few unknowns. Cost: some hundred small least-squares problems;
/// of many contacts O(contacts² · freedoms).
inline constexpr double least_margin_of_rest = 1.8e-12;  // 2⁻³⁹: above rounding
std::optional<Eigen::VectorXd> resting_forces(const ConeProblem& problem, double least_margin = least_margin_of_rest);

}  // namespace maupertuis
