#pragma once
#include "fields/field_mesh.hpp"

#include <optional>

namespace maupertuis {

/// Something in x that the nodes of a mesh pass by: a bump or a jump of the density, or of the start, inside an
/// element.
struct Unresolved {
  std::vector<double> place;    // [space variables] where
  std::vector<double> element;  // the widths of an element
  bool of_start = false;        // else of the density
};

/// Looks at what stands in x (and y) between the nodes, where both meshes of an error estimate may be blind alike:
/// pieces of an element are halved along each direction until a disk that contains one bounds the change of the
/// function there (function_disks.hpp), and each is compared with the polynomial through the element's nodes. Nothing
/// where that is off by less than a quarter of the function's size at all pieces. Coefficients of the density are
/// looked at for one set of values of the field. Cost: some evaluations an element; more where something narrow is.
std::optional<Unresolved> unresolved_feature(const FieldEquations& equations, const PointForm& form,
                                             const std::vector<int>& cells, int order);

/// How much of a start the polynomials through the nodes leave out, beside its largest value: at some places of each
/// element that share no pattern with the nodes, of all lines of the start the largest. Cost: some evaluations an
/// element.
double left_out_of_start(const FieldEquations& equations, const std::vector<int>& cells, int order);

/// The same along t for what acts: boundary values, forces at ends, and the density at some places, beside the parabola
/// through the beginning, the middle and the end of each step. A series from the beginning of a step follows it about
/// as far; jumps are found too. The moment, or nothing. Cost: some evaluations a step, function and place.
std::optional<double> unresolved_moment(const FieldEquations& equations, const PointForm& form, double step,
                                        double begin, double duration);

}  // namespace maupertuis
