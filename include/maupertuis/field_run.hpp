#pragma once
#include <maupertuis/fields.hpp>
#include <maupertuis/interrupt.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/trajectory.hpp>

#include <string>
#include <vector>

namespace maupertuis {

/// The motion of fields of one or two space variables whose density holds first derivatives: Galerkin's method with
/// Gauss-Lobatto elements, Taylor steps of order 8 within h ω_max ≤ 3.2 (docs/theory/fields.md).
struct FieldRunResult {
  struct Value {
    double value = 0, error = 0;  // SI; the error is estimated from a second mesh of half the cells
  };
  std::vector<Value> answers;   // to the questions, in their order
  Trajectory trajectory;        // fields and velocities at the borders of cells, or at as many parts of them
  std::vector<double> places;   // those borders, where there are rows
  std::vector<double> upwards;  // in the plane those of y; columns go along x first
  double end = 0;               // s
  std::size_t steps = 0, nodes = 0;
  int order = 0, cells = 0;
  int cells_upwards = 0;                 // in the plane
  double step = 0, omega_max = 0;        // s, rad/s
  double energy = 0, energy_drift = -1;  // J; relative to the terms of the energy; −1: forces act, none is conserved
  double seconds = 0;
  std::string trouble;  // why the run ended early; empty: it did not
};

/// What is asked of a run: an expression of jets at a place, or of place values; or integrated over space.
struct FieldQuestion {
  Expr value;  // in the symbols of FieldModel::places, or, where `total`, in jets, x and t
  bool total = false;
  double time = 0;  // s
};

struct FieldRunOptions {
  double duration = 0;      // s
  double every = 0;         // s; 0: a hundredth of the run
  bool trajectory = false;  // keep rows
  int least_values = 0;     // along a direction of a row: more than the borders of cells where those are few
  bool errors = true;       // a second run on a mesh of half the cells
  Interrupt interrupt;
};

/// Errors (in `diagnostics`): E0508 where such fields cannot be run yet, E0292 where a boundary condition contradicts
/// the natural one, E0642 where u' is not determined by the momenta.
std::optional<FieldRunResult> run_fields(const FieldEquations& equations, const std::vector<FieldQuestion>& questions,
                                         const FieldRunOptions& options, Diagnostics& diagnostics);

/// The lowest `count` angular frequencies of small motions about φ = 0, ascending: Ritz's method with Legendre
/// polynomials over the whole domain, for densities of first and second derivatives. Empty, and a diagnostic, where
/// there are none.
std::vector<double> field_frequencies(const FieldEquations& equations, std::size_t count, Diagnostics& diagnostics);

}  // namespace maupertuis
