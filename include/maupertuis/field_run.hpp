#pragma once
#include <maupertuis/fields.hpp>
#include <maupertuis/interrupt.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/trajectory.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

/// Q = ∫ j^t dx of a conserved current along a run, and what flowed out of the sides.
struct FieldCharge {
  std::size_t current = 0;    // its place in FieldCurrents
  std::string name, meaning;  // of the current
  double start = 0, end = 0;  // SI
  double outflow = 0;         // ∮ j·n over the sides and the time of the run
  double imbalance = 0;       // the largest |Q(t) − Q(0) + outflow(t)| at some 20 moments
  double size = 0;            // of the terms: the largest ∫ |j^t| dx, or outflow where that is more
  bool booked = false;        // else j^x holds derivatives that the elements do not have
  bool measured = false;
  double left_over() const { return size > 0 ? imbalance / size : 0; }  // beside its terms
  std::string label() const;                                            // of a line: shifts by what they add
};

/// The motion of fields by Galerkin's method. Waves of one or two space variables, whose density holds first
/// derivatives with the velocities squared: Gauss-Lobatto elements, Taylor steps of order 8 within h ω_max ≤ 3.2. Beams
/// and fields of first order in t, of one space variable: smooth elements where ℒ holds u_xx, Gauss's collocation
/// (docs/theory/fields.md).
struct FieldRunResult {
  struct Value {
    double value = 0, error = 0;  // SI; estimated from a run that is off by less
    double order = 0;  // the power of the width of cells by which it converges, by half the cells; 0: not measured
  };
  std::vector<Value> answers;   // to the questions, in their order
  Trajectory trajectory;        // fields and velocities at the borders of cells, or at as many parts of them
  std::vector<double> places;   // those borders, where there are rows
  std::vector<double> upwards;  // in the plane those of y; columns go along x first
  double end = 0;               // s
  std::size_t steps = 0, nodes = 0;
  int order = 0, cells = 0;
  int cells_upwards = 0;                 // in the plane
  std::string method;                    // of the steps, in words
  double step = 0, omega_max = 0;        // s, rad/s; 0: not known, no step depends on it
  double energy = 0, energy_drift = -1;  // J; relative to the terms of the energy; −1: forces act, none is conserved
  struct Range {
    std::string name, unit;  // of a field
    double low = 0, high = 0;
  };
  std::vector<FieldCharge> charges;  // of FieldRunOptions::currents
  std::vector<Range> at_end;         // of the values at the borders of cells; without coordinates and bodies
  double seconds = 0;
  std::string trouble;  // why the run ended early; empty: it did not
  // With coordinates and bodies:
  bool coupled = false;
  struct Coordinate {
    std::string name;
    double q = 0, v = 0;  // SI
  };
  std::vector<Coordinate> final_coordinates;  // values of fields at places among them
  std::vector<Happening> happenings;  // events, contacts, friction; q and v are those of the coordinates of the model
  std::string first_mode;             // of contacts and friction, as in SimulationResult
  std::optional<EnergyBooks> books;   // where the model has contacts or friction
  std::vector<std::string> remarks;   // a sentence each
};

/// What is asked of a run: an expression of jets at a place, or of place values; or integrated over space.
struct FieldQuestion {
  Expr value;  // in the symbols of FieldModel::places, or, where `total`, in jets, x and t
  bool total = false;
  double time = 0;  // s
};

struct FieldRunOptions {
  double begin = 0;                  // s, of fields without bodies; the others begin as their model says
  double duration = 0;               // s
  double every = 0;                  // s; 0: a hundredth of the run
  bool trajectory = false;           // keep rows
  int least_values = 0;              // along a direction of a row: more than the borders of cells where those are few
  std::vector<double> moments = {};  // s; rows at these times beside the others
  bool errors = true;                // further runs, on other meshes
  bool orders = false;               // one more, for FieldRunResult::Value::order
  /// Whose charges are followed, without coordinates and bodies, dissipation and forces inside; null: none.
  const FieldCurrents* currents = nullptr;
  Interrupt interrupt;
  std::function<void(double)> progress = {};  // told the fraction of the first run that is done, at each step
  /// Told once, in a sentence, as the run begins: what it takes, where that is more than a minute or a gigabyte.
  std::function<void(const std::string&)> announce = {};
};

/// Errors (in `diagnostics`): E0508 where such fields cannot be run yet, E0292 where a boundary condition contradicts
/// the natural one, E0642 where u' is not determined by the momenta.
std::optional<FieldRunResult> run_fields(const FieldEquations& equations, const std::vector<FieldQuestion>& questions,
                                         const FieldRunOptions& options, Diagnostics& diagnostics);

/// Whether a run is one of run_coupled: bodies stand beside the fields, or the density changes at a place.
bool runs_as_one_system(const FieldEquations& equations);
/// The run of a model in which fields are coupled with coordinates and bodies: elements of continuous fields, or of
/// continuous slopes where the density bends, as one system of at most 200 unknowns that `simulate` runs. Columns of
/// the trajectory: fields and velocities at `places`, then the coordinates. Errors as above; E0656: too many elements.
std::optional<FieldRunResult> run_coupled(const Model& model, const FieldEquations& equations,
                                          const std::vector<FieldQuestion>& questions, const FieldRunOptions& options,
                                          Diagnostics& diagnostics);

/// Fields that stay what they are, in numbers.
struct FieldEquilibrium {
  std::vector<double> places;
  std::vector<double> upwards;                         // in the plane those of y
  std::vector<std::vector<double>> fields;             // [varied][places], in the plane [varied][upwards × places], SI
  std::vector<double> errors;                          // [varied] the largest at those places, from fewer functions
  std::vector<double> coordinates, coordinate_errors;  // [coordinates of `bodies`] SI
  double energy = 0, energy_error = 0;                 // −∫ℒ, and −L of the bodies, SI
  /// The lowest eigenvalue of the second variation of the energy in the mean square, and how many lie below zero: none
  /// of a minimum. With bodies, whose coordinates have squares of their own, the sign alone counts. Nothing where they
  /// have no lower bound, or forces no potential.
  std::optional<double> lowest;
  std::size_t falling = 0;
};

/// Small motions about rest, of fields with the coordinates and bodies beside them.
struct FieldModes {
  std::vector<double> frequencies;  // rad/s, ascending; below 0: the rate of growth of an unstable one, negative
  /// The shape of each, its largest value 1, that of a coordinate where the field stands still; none where velocities
  /// act sideways (gyroscopic terms).
  struct Shape {
    std::vector<std::vector<double>> fields;  // [varied][places], in the plane [varied][upwards × places]
    std::vector<double> coordinates;          // [coordinates of `bodies`], SI
  };
  std::vector<Shape> shapes;
  std::vector<double> places;
  std::vector<double> upwards;                  // in the plane those of y
  std::vector<double> errors;                   // rad/s, from fewer functions
  std::string about;                            // the rest, where frequencies depend on it: "u = 0"
  std::optional<FieldEquilibrium> equilibrium;  // where the rest was computed
};

/// The lowest `count` about the start, where that is a rest, else about φ = 0, else about the equilibrium that Newton's
/// method finds from the start; none where nothing has inertia: the equilibrium alone. Ritz's method with Legendre
/// polynomials on elements between the places of bodies and the borders of the density, for densities of first and
/// second derivatives; rectangles: products of polynomials over all of the domain, without bodies. Functions become
/// more until frequencies stand still, up to 400 unknowns, in the plane some 1000. Friction is left out, and told
/// (W0653). Empty, and E0644, where there are none, E0647 where a coefficient is passed by.
FieldModes field_modes(const FieldEquations& equations, std::size_t count, Diagnostics& diagnostics);
/// Their frequencies alone.
std::vector<double> field_frequencies(const FieldEquations& equations, std::size_t count, Diagnostics& diagnostics);

}  // namespace maupertuis
