#pragma once
#include "kernel/program/program.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace maupertuis {

/// The rows R_j = Σ c f as sums of terms, of which several rows may have the same: the force between two bodies.
class ResidualTerms {
 public:
  /// dʳa/dtʳ with r = shift, or a b.
  struct Term {
    Slot a, b;
    std::uint32_t shift;
    bool operator==(const Term&) const = default;
  };
  /// The program must outlive this.
  explicit ResidualTerms(const Program& program);

  std::size_t rows() const { return ends_.size(); }
  /// [program.constants]; anew whenever parameters or sides change.
  void set_constants(const double* constants);
  /// Each once.
  const std::vector<Term>& terms() const { return terms_; }
  /// bounds: [terms], ≥ 0; row j at most Σ |c| bound: [rows].
  void add_up(std::span<const double> bounds, std::span<double> rows) const;

 private:
  void add_parts(Slot slot, int depth);

  const Program& program_;
  std::vector<int> maker_;  // [slots] instruction; −1: none
  std::vector<Term> terms_;
  /// A summand of a row.
  struct Part {
    std::size_t term;
    std::size_t factors_end;  // its coefficient is a product of constants
    double size;              // |c|
  };
  std::vector<Part> parts_;        // row after row
  std::vector<std::size_t> ends_;  // [rows] of their parts
  std::vector<ConstantId> path_, factors_;
};

}  // namespace maupertuis
