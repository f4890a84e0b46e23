#pragma once
#include "fields/collocation.hpp"
#include "fields/field_mesh.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace maupertuis {

using Cells = std::vector<int>;  // [space variables]

/// How the fields of a density are put on a mesh and moved: waves by Taylor steps, where ω_max grows like 1/h;
/// densities of second derivatives or linear in the velocities, and with friction on slopes, where it grows like 1/h²
/// to 1/h⁴, by collocation.
class FieldMethod {
 public:
  /// Nothing, and the diagnostics, where there is none for this density.
  static std::optional<FieldMethod> of(const FieldEquations& equations, Diagnostics& diagnostics);

  /// A method that is off by less: elements of an order higher by so many, steps of three quarters.
  FieldMethod sharper(int orders) const;

  bool is_wave() const { return waves_.has_value(); }
  int order() const { return order_; }  // of the elements
  bool conserves() const { return waves_ ? waves_->conserves : stiff_->conserves; }
  std::string name() const;  // of the steps, in words
  /// `first`: else one of those that tell the error, of which steps are twice as long where a series bounds them.
  std::unique_ptr<FieldMotion> mesh(const FieldEquations& equations, const Cells& cells, bool first) const;
  /// Bytes that a mesh takes.
  double bytes(const FieldEquations& equations, const Cells& cells) const;
  /// By collocation as much longer on the other meshes as their cells are wider, so that their difference tells the
  /// error of steps as well. `omega` is set where steps depend on it.
  double longest_step(FieldMotion& mesh, double duration, double every, const Interrupt& interrupt, double& omega);
  /// Of a cell of the first mesh, where values are looked at beside their places; 0: nowhere.
  double width() const { return width_; }
  double width_of_cell(const FieldEquations& equations, const Cells& cells) const;  // along the first direction
  /// Of a varied field: whether its slopes are continuous, and its rates follow from its values.
  bool is_smooth(std::size_t field) const { return stiff_ && stiff_->smooth[field]; }
  bool is_first_order(std::size_t field) const { return stiff_ && stiff_->first_order[field]; }
  void look_beside(double width) { width_ = width; }
  /// Waves, whose errors are told by a coarser mesh of the cells `half`: answers are looked at before their moments
  /// too. `alike`: at places that lie in elements as the place itself does, where that is a border of elements of both
  /// meshes, which are off there by far less than between.
  void compare_with(Cells half, bool alike) { half_ = std::move(half), alike_ = alike; }
  bool looks_alike() const { return alike_; }
  /// Whether that is done for a question.
  bool looks_alike(const FieldEquations& equations, const FieldQuestion& question) const {
    return alike_ && stands_on_borders(equations, question, half_);
  }
  /// The first time that answers are looked at before their moments: by this step of the first mesh, then by 2, 4, 8 …
  /// of them up to so many as it has nodes, which is about how long a wave takes through the domain.
  void look_before(double step, double nodes) {
    if (!half_.empty()) before_ = step, nodes_ = nodes;
  }
  /// The moment of an answer, then those before it.
  std::vector<double> looks_at(double time, double begin) const;
  /// Moments at which steps end, since what is given at the sides has other branches from there on.
  void end_steps_at(std::vector<double> moments) { switching_ = std::move(moments); }
  const std::vector<double>& switching() const { return switching_; }
  /// Whether all places that a question asks about are borders of so many cells.
  static bool stands_on_borders(const FieldEquations& equations, const FieldQuestion& question, const Cells& cells);
  /// The power of the width of a cell by which an answer is off on two meshes with their steps; `half`: the coarser.
  int power(const FieldEquations& equations, const FieldQuestion& question, const Cells& half) const;

 private:
  int order_of_collocation() const;
  int power_of_waves(const FieldEquations& equations, const FieldQuestion& question, const Cells& half) const;

  std::optional<PointForm> waves_;
  std::optional<DensityForm> stiff_;
  int order_ = 0;
  double step_ = 0;  // of the first mesh by collocation
  double width_ = 0;
  double part_ = 0;  // of the step of the first mesh, of a sharper method; 0: as the mesh says
  double before_ = 0, nodes_ = 0;
  bool alike_ = false;
  Cells half_;
  std::vector<double> switching_;
};

}  // namespace maupertuis
