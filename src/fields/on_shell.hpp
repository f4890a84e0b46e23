#pragma once
#include <maupertuis/fields.hpp>

namespace maupertuis {

/// Replaces derivatives by what the field equations say of them. Each equation is solved for one derivative in which it
/// is linear, the highest in time, then in space, together where they hold those of each other; derivatives of it
/// follow.
class OnShell {
 public:
  explicit OnShell(const FieldEquations& equations);

  /// Whether each equation has a derivative of its own that it can be solved for.
  bool complete() const { return complete_; }
  /// Nothing where derivatives come up without end. With the values of definitions.
  std::optional<Expr> reduced(Expr e) const;
  Expr leading(std::size_t a) const { return leading_[a]; }
  Expr coefficient(std::size_t a) const { return coefficient_[a]; }

 private:
  struct Solved {
    FieldJet jet;
    Expr value;
  };
  const FieldSystem& s_;
  bool complete_ = true;
  std::vector<Expr> leading_, coefficient_;
  std::vector<Solved> solved_;
};

}  // namespace maupertuis
