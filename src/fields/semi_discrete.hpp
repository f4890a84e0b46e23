#pragma once
#include <maupertuis/field_run.hpp>
#include <maupertuis/repeated_evaluation.hpp>
#include <maupertuis/simulation.hpp>

#include "fields/field_elements.hpp"
#include "fields/field_motion.hpp"

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace maupertuis {

class WrittenStart;

/// The borders of elements: the ends, each place that bodies hold, each change of the density, and what makes `cells`
/// of the whole.
std::vector<double> element_borders(const FieldEquations& equations, int cells);

/// Fields with coordinates and bodies as one ordinary mechanical system, by Galerkin's method in space:
///
///     L_h(c, q) = Σ_points w ℒ(Σ N_j c_j, …) + L of the bodies
///
/// Its coordinates are those of the model, the values of fields at places among them, and the further degrees of
/// freedom of the elements, so that it runs, with constraints, forces and events, as any other system.
class SemiDiscrete {
 public:
  /// Elements have borders at each place and each change of the density; `cells` of them over the whole domain, rounded
  /// up between these. Errors (in `diagnostics`): E0508, E0292, E0656 as for run_fields and for a mesh too large.
  static std::optional<SemiDiscrete> make(const Model& model, const FieldEquations& equations, int cells, int order,
                                          Diagnostics& diagnostics);

  const Model& model() const { return model_; }
  /// An expression of the questions of a run, in the coordinates: places and jets replaced. An empty handle, and E0508,
  /// where a derivative is asked for that the elements do not have. Places are shifted along x, within the domain.
  Expr discretised(const FieldQuestion& question, Diagnostics& diagnostics, double shift = 0) const;
  /// u or u' of a field at x, in the coordinates.
  Expr value_at(std::size_t varied_index, int by_time, int by_space, double x) const;
  /// Whether a question is about places with a mass alone, which short waves of the field move by far less than what is
  /// beside them.
  bool stands_on_masses(const FieldQuestion& question) const;
  std::size_t degrees_of_freedom() const { return dofs_; }
  std::size_t elements() const { return mesh_.borders.size() - 1; }
  int order() const { return mesh_.degree; }
  double begin() const;  // of the run, s
  bool forced() const { return forced_; }
  /// Whether the density of all fields that bodies take hold of along a path holds second derivatives.
  bool bends() const;
  const std::vector<double>& borders() const { return mesh_.borders; }
  const std::vector<FieldMotion::StartClash>& start_clashes() const { return clashes_; }
  /// A field without inertia that begins otherwise than written: where by most, what is written there, what it is, SI.
  struct MovedStart {
    std::size_t varied = 0;
    int order = 0;  // 1: its rate
    double x = 0, written = 0, found = 0;
  };
  /// `begin`: the coordinates of the run at its start; nothing where there is none.
  std::vector<MovedStart> moved_starts(const State& begin) const;
  /// Parameters, t, the coordinates and their rates, SI.
  Bindings bindings_at(const State& state) const;
  /// Names of events that end a run: a place that moves left the domain.
  const std::vector<std::string>& departures() const { return departures_; }
  /// Whether elements are left that have no inertia: they do not follow what they carry by linear forces.
  bool has_massless_elements() const;
  /// Values at places that move, and those of elements without mass, by the symbols of their coordinates, in the
  /// coordinates that are left and t.
  const ExprMap& moving() const { return moving_; }

 private:
  double inside(double x) const;
  ExprMap beside_attached(double shift) const;
  /// A point of quadrature and the functions of each field there.
  struct Point {
    std::size_t element = 0;
    double x = 0, weight = 0;
    std::vector<std::vector<ElementSpace::Part>> parts;  // [varied]
  };

  SemiDiscrete(const Model& model, const FieldEquations& equations);
  bool set_mesh(int cells, int order, Diagnostics& diagnostics);
  std::set<std::size_t> struck_borders() const;
  void set_quadrature();
  void set_degrees_of_freedom();
  void hold_ends();
  bool add_lagrangian(Diagnostics& diagnostics);
  bool add_given_slopes(Diagnostics& diagnostics);
  void add_force_densities();
  void add_end_forces();
  std::size_t dof_at(std::size_t a, const PlaceCoordinate& place) const;
  bool set_start(Diagnostics& diagnostics);
  std::vector<std::optional<double>> held_at_ends(std::size_t a, int order) const;
  void look_for_clashes(std::size_t a, int order, const WrittenStart& start, double size,
                        const std::vector<std::optional<double>>& held);
  void keep_places(std::size_t a, const WrittenStart& start, double size,
                   std::vector<std::optional<double>>& kept) const;
  void add_start(std::size_t a, int order, bool is_written, const std::vector<double>& coefficients);
  MovedStart most_moved(std::size_t a, int order, const WrittenStart& start, const State& begin) const;
  double value_in(Expr value, const State& state) const;
  /// Whether bodies give mass to a coordinate of theirs, such as the value of a field at a place.
  bool has_inertia(const Coordinate& c) const;
  bool refuse_starts_of_places(Diagnostics& diagnostics) const;
  bool replace_places(Diagnostics& diagnostics);
  bool has_slopes(std::size_t field) const;
  void follow_at_once();
  void put_in_place(const std::vector<std::size_t>& which, const ExprMap& values);
  bool set_moving_places(Diagnostics& diagnostics);
  bool refuse_turning(const PlaceCoordinate& place, Diagnostics& diagnostics) const;
  bool refuse_contact(const PlaceCoordinate& place, Diagnostics& diagnostics) const;
  bool follow(const PlaceCoordinate& place, Diagnostics& diagnostics);
  void share_forces(const std::set<std::size_t>& gone);
  void remove_coordinates(const std::set<std::size_t>& gone);
  Expr polynomial_in(std::size_t element, std::size_t a, int by_space, Expr place) const;
  Expr along_place(std::size_t a, int by_space, Expr place) const;
  Expr constant(double value) const;
  Expr combination(std::size_t a, const std::vector<ElementSpace::Part>& parts, int by_space, int by_time) const;
  /// A function of places and jets at a point of the quadrature.
  Expr at_point(Expr f, const std::vector<Expr>& jets, const Point& point) const;
  Expr integral(Expr density) const;
  void generalized_force(std::size_t a, std::size_t dof, Expr force, Span span);
  double number(Expr e) const;

  Model model_;
  const FieldEquations* equations_;
  ElementMesh mesh_;
  std::vector<ElementSpace> spaces_;       // [varied]
  std::vector<Point> points_;              // of all integrals, element by element
  std::vector<std::vector<Expr>> values_;  // [varied][dof] u of it: a coordinate, or what is given
  std::vector<std::vector<std::optional<std::size_t>>> coordinates_;  // [varied][dof]
  Bindings numbers_;                                                  // of parameters
  ExprMap moving_;                                                    // coordinates that are functions of others and t
  std::vector<std::string> departures_;
  std::size_t dofs_ = 0;
  bool forced_ = false;
  std::vector<FieldMotion::StartClash> clashes_;
};

}  // namespace maupertuis
