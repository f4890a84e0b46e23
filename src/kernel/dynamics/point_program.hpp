#pragma once
#include "kernel/dynamics/evaluate.hpp"
#include "kernel/interpreter/interpreter.hpp"

#include <span>

namespace maupertuis::dynamics {

/// A flat program with its numbers: evaluated at one point after the other.
class PointProgram {
 public:
  PointProgram(const Program& program, bool with_accelerations, const std::vector<bool>& kept);

  /// After all constants changed. [constants]
  void set_constants(const std::vector<double>& constants);
  /// After those changed that `live` constants stand in.
  void renew(const std::vector<double>& constants, const std::vector<bool>& live);
  /// a: q̈ [n], or empty for 0.
  void evaluate(double t, std::span<const double> q, std::span<const double> v, std::span<const double> a);

  double residual(std::size_t i) const { return cells_[flat_.residual[i]]; }
  const FlatProgram& flat() const { return flat_; }
  const double* cells() const { return cells_.data(); }

 private:
  struct LiveTerm {
    Coefficient coefficient;
    double* value;
  };

  static void other(void* self, const FlatStep& step);
  void call(const FunctionCall& call);
  void choose(const Choice& choice);

  std::size_t freedoms_, unknowns_;
  FlatProgram flat_;
  Evaluate evaluate_ = best_evaluate();
  interpreter::Doubles cells_;
  std::vector<double> linear_, products_;  // coefficients of terms
  std::vector<double> exponents_;          // [functions]
  std::vector<Cell> chosen_;               // [choices]
  std::vector<LiveTerm> live_terms_;
  std::vector<bool> live_;                 // for which live_terms_ were found
};

}  // namespace maupertuis::dynamics
