#pragma once
#include "analysis/action/rule.hpp"

#include <maupertuis/action.hpp>

#include <memory>
#include <vector>

namespace maupertuis::action {

const Rule& element_rule(const Rule& rule, Pace pace, std::size_t element, std::size_t elements);

/// Elements in the parameter s of a path.
struct Mesh {
  std::shared_ptr<const Rule> rule;
  double start = 0, whole = 0;  // t = start + whole · g(s)
  Pace pace = Pace::Even;
  bool closed = false;                  // the last node is the first one
  std::vector<double> begins, lengths;  // [elements] of s

  Index elements() const { return static_cast<Index>(lengths.size()); }
  Index nodes() const { return elements() * rule->degree + (closed ? 0 : 1); }
  Index node(Index element, Index j) const {
    const Index k = element * rule->degree + j;
    return closed && k == nodes() ? 0 : k;
  }
  bool wraps(Index element, Index j) const { return closed && element * rule->degree + j == nodes(); }
  double t(double s) const { return start + whole * maupertuis::pace(pace, s); }
  double rate(double s) const { return whole * pace_rate(pace, s); }
  double time(Index node) const;
  /// The polynomials of an element: flat next to an end at which the path runs slowly.
  const Rule& rule_of(Index element) const {
    return element_rule(*rule, pace, static_cast<std::size_t>(element), lengths.size());
  }
  /// s of a point ξ of an element.
  double parameter(Index element, double xi) const {
    return begins[static_cast<std::size_t>(element)] + lengths[static_cast<std::size_t>(element)] * (1 + xi) / 2;
  }
};

/// Elements of equal length in s.
Mesh even_mesh(std::shared_ptr<const Rule> rule, double start, double end, Index elements, bool closed = false,
               Pace pace = Pace::Even);

/// About as many elements, of equal length between breaks at the times `inner`, in order, strictly between the ends.
Mesh mesh_with_breaks(std::shared_ptr<const Rule> rule, double start, double end, Index elements,
                      const std::vector<double>& inner);

/// A path by its values at the nodes, with the multipliers of the integral constraints.
struct Trial {
  Mesh mesh;
  Matrix q;            // [n × nodes]
  Vector multipliers;  // [k]
  Vector advance;      // [n] of a closed path: by how much q grows in one turn; else zero

  Matrix element(Index e) const;  // [n × degree + 1]
};

/// The same path with some elements halved.
Trial halved(const Trial& from, const std::vector<bool>& which);
ActionPath to_path(const Trial& trial);

/// Where a point of Gauss's rule lies, and what it counts: values at t from the nodes, derivatives by t, weight.
struct Place {
  double t = 0, weight = 0;
  Vector value, slope;  // [p + 1]
};
Place place_of(const Mesh& mesh, Index element, Index point);

/// S and its derivatives by the nodes.
struct Assembly {
  bool finite = true;
  double action = 0;
  Vector integrals;                  // [k]
  Vector gradient;                   // [n nodes] of S + Σ λ ∫ G
  Vector gradient_terms;             // [n nodes] the absolute values of what the gradient is the sum of
  Matrix integral_gradients;         // [n nodes × k]
  std::vector<Matrix> hessians;      // [elements] each [n (degree + 1)]², node by node
  std::vector<Matrix> kinetic;       // order 2: the same for ∫ ξ' |M| ξ' dt: by what eigenvalues are measured
  std::vector<Matrix> displacement;  // order 2: the same for ∫ ξ |M| ξ dt/T², T the whole: what a translation, which
                                     // has no ξ', is measured by; of a q with q'' in L over T⁴
};

/// order as of Functional::evaluate.
Assembly assemble(Functional& functional, const Trial& trial, int order);

/// ∫ Σ |terms of L + λ G| dt: what S is measured by, also where L cancels to nothing.
double size_of_action(Functional& functional, const Trial& trial);

/// A bound on the rounding in `action` of a stationary trial. The nodes' own rounding counts to second order, as S is
/// stationary in them; what is left enters at each Gauss point anew: the values q and slopes q' formed there from the
/// nodes, each to one rounding of the sum of its terms' sizes, the terms of L, the time, the weight.
double rounding_of_action(Functional& functional, const Trial& trial);

}  // namespace maupertuis::action
