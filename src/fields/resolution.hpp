#pragma once
#include <maupertuis/fields.hpp>

#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

/// Of elements along each direction, in ascending order.
using Borders = std::vector<std::vector<double>>;

struct RunTime {
  double begin = 0, duration = 0;  // s
};

/// Of so many elements of one width.
Borders even_borders(const FieldEquations& equations, const std::vector<int>& cells);

/// E0647 for a bump or a jump in x (and y) of the start, the density, the dissipation or a force density that lies
/// between the nodes, where both meshes of an error estimate may be blind alike: pieces of an element are halved along
/// each direction until a disk that contains one bounds the change of the function there (function_disks.hpp), and each
/// is compared with the polynomial through the element's nodes. False where that is off by less than a quarter of the
/// function's size at all pieces. What depends on t is looked at as it is when the run begins, and when it is strongest
/// in each of some parts of the run. Derivatives of ℒ and 𝒟 by jets are looked at for one set of values of the field.
/// Cost: some evaluations an element; more where something narrow is.
bool refuse_unresolved(const FieldEquations& equations, const Borders& borders, int order, const RunTime& run,
                       Diagnostics& diagnostics);

/// The same of what acts alone, told: "the density has at x = 0.537". Nothing where all is seen.
std::optional<std::string> passed_by(const FieldEquations& equations, const Borders& borders, int order);

/// How much of a start the polynomials through the nodes leave out, beside its largest value: at some places of each
/// element that share no pattern with the nodes, of all lines of the start the largest. Cost: some evaluations an
/// element.
double left_out_of_start(const FieldEquations& equations, const std::vector<int>& cells, int order);

/// The same along t for what acts: boundary values, forces at ends, and the density, at some places and where each is
/// strongest (of more steps than can be looked at, those next to that), beside the parabola
/// through the beginning, the middle and the end of each step. A series from the beginning of a step follows it about
/// as far; jumps are found too, but for those at moments where steps end (`switching`). The moment, or nothing. Cost:
/// some evaluations a step, function and place.
std::optional<double> unresolved_moment(const FieldEquations& equations, const std::vector<double>& switching,
                                        double step, const RunTime& run);

}  // namespace maupertuis
