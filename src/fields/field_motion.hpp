#pragma once
#include <maupertuis/field_run.hpp>

#include <functional>
#include <string>
#include <vector>

namespace maupertuis {

/// A discrete field in motion: what a run asks of it, whatever its elements and its steps are.
class FieldMotion {
 public:
  explicit FieldMotion(const FieldEquations& equations) : equations_(equations), s_(equations.system()) {}
  virtual ~FieldMotion() = default;
  FieldMotion(const FieldMotion&) = delete;
  FieldMotion& operator=(const FieldMotion&) = delete;

  /// Why it cannot go on; empty: it can.
  const std::string& trouble() const { return trouble_; }
  /// Where the start says something else than a boundary condition, which is followed.
  struct StartClash {
    std::size_t field = 0;    // of those that are varied
    int space = 0, time = 0;  // derivatives: u, u_x; u', u_tx
    BoundaryCondition::Side side = BoundaryCondition::Side::Left;
    double start = 0, condition = 0;
  };
  const std::vector<StartClash>& start_clashes() const { return clashes_; }
  double time() const { return t_; }
  /// Steps beside those that were asked for, where these were too long.
  std::size_t further_steps() const { return further_steps_; }
  /// Fields (of those that are varied) whose value at the left end stands still, since ℒ holds their derivatives alone.
  const std::vector<std::size_t>& fixed_fields() const { return fixed_; }

  /// The moment of the start, before it.
  void begin_at(double t) { t_ = t; }
  virtual void start() = 0;
  /// At the moment `from`, until another one what is given at the sides has the branches that hold between the two:
  /// series go on from there. Held sides take what they are given.
  virtual void follow_branches(double from, double until) { t_ = from, static_cast<void>(until); }
  /// False, and `trouble`, where it left the numbers.
  virtual bool step(double h) = 0;
  /// h_E of the mesh, and the integral of the size of its density.
  virtual double energy(double& size) = 0;
  /// Of an expression in place values; of one in jets at a place or integrated.
  double answer(const FieldQuestion& question);
  /// What is known at a point of the integral: jets of the varied fields, then the space variables, then t.
  virtual const std::vector<Expr>& point_inputs() const = 0;
  /// Calls with the weight of each point of the integral and the values of `point_inputs` there.
  using PointVisitor = std::function<void(double weight, const double* values)>;
  virtual void visit_points(const PointVisitor& visit) = 0;
  /// A point of a side x_along = const, its weight in the integral over the side.
  struct SidePoint {
    std::size_t along = 0;
    bool far = false;  // right, top
    double weight = 1;
  };
  /// Calls for the points of all sides with the values of `jets` there, then of the space variables, then t. NaN for
  /// jets that the elements do not have.
  using SideVisitor = std::function<void(const SidePoint& point, const double* values)>;
  virtual void visit_sides(const std::vector<Expr>& jets, const SideVisitor& visit);
  /// The same at places shifted along x, within the domain.
  double answer_beside(const FieldQuestion& question, double shift) const {
    return answer_at_places(question.value, shift);
  }
  /// A derivative of a varied field at a place of each direction; that of `jet` counts, not its field.
  virtual double field_at(std::size_t field, const FieldJet& jet, const std::vector<double>& place) const = 0;
  /// Fields and velocities at these places of each direction, x first, as a row; columns are named by the first one.
  void add_row(Trajectory& rows, const std::vector<std::vector<double>>& places) const;

 protected:
  double value_of(Expr e, const Bindings& extra) const;
  /// The index among the varied fields, or their number.
  std::size_t varied(std::size_t field) const;
  /// Of an expression in place values, now; at places that are shifted along x where `shift` is not 0.
  double answer_at_places(Expr value, double shift = 0) const;

  const FieldEquations& equations_;
  const FieldSystem& s_;
  double t_ = 0;
  std::size_t further_steps_ = 0;
  Bindings values_;  // of parameters
  std::string trouble_;
  std::vector<StartClash> clashes_;
  std::vector<std::size_t> fixed_;
};

}  // namespace maupertuis
