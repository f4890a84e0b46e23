#pragma once
#include <maupertuis/field_run.hpp>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace maupertuis {

constexpr std::size_t kOrder = 8;  // of Taylor steps: on the imaginary axis stable up to hω = 3.40

/// A discretised field and its state, as a run sees it.
class MovingMesh {
 public:
  virtual ~MovingMesh() = default;

  /// Why the mesh cannot be made or moved; empty: it can.
  const std::string& trouble() const { return trouble_; }
  /// Where the start says something else than a boundary condition, which is followed.
  struct StartClash {
    std::size_t field = 0;  // of those that are varied
    int order = 0;          // 0: u, 1: u'
    BoundaryCondition::Side side = BoundaryCondition::Side::Left;
    double start = 0, condition = 0;
  };
  const std::vector<StartClash>& start_clashes() const { return clashes_; }

  virtual void start() = 0;
  /// Largest frequency of small motions about the present state, by power iteration.
  virtual double omega_max(const Interrupt& interrupt) = 0;
  /// One Taylor step. False, and `trouble`, where it left the numbers.
  virtual bool step(double h) = 0;
  virtual double time() const = 0;
  /// h_E of the mesh, and the integral of the size of its density.
  virtual double energy(double& size) = 0;
  /// Of an expression in place values; of one in jets at a place or integrated.
  virtual double answer(const FieldQuestion& question) = 0;
  /// Fields and velocities at these places of each direction, as a row; columns are named by the first one.
  virtual void add_row(Trajectory& rows, const std::vector<std::vector<double>>& places) const = 0;

 protected:
  std::string trouble_;
  std::vector<StartClash> clashes_;
};

/// The largest frequency of small motions about u by power iteration from the direction w.
/// accelerations(u) is φ'' at a state; `trouble` ends the iteration.
using FieldValues = std::vector<std::vector<double>>;  // [fields][lanes]
double largest_frequency(const FieldValues& u, FieldValues w,
                         const std::function<FieldValues(const FieldValues&)>& accelerations, int rounds,
                         const std::string& trouble, const Interrupt& interrupt);
/// Numbers of −1/2 .. 1/2, always the same.
void fill_randomly(FieldValues& w);

/// A⁻¹ of one point, [n²]; false where it is singular.
bool invert_mass(std::vector<double> a, std::vector<double>& inverse, std::size_t n);

/// A sum with what each addition loses (Neumaier).
class CarefulSum {
 public:
  void add(double term) {
    const double total = sum_ + term;
    lost_ += std::abs(sum_) >= std::abs(term) ? (sum_ - total) + term : (term - total) + sum_;
    sum_ = total;
  }
  double value() const { return sum_ + lost_; }

 private:
  double sum_ = 0, lost_ = 0;
};

}  // namespace maupertuis
