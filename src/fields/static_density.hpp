#pragma once
#include <maupertuis/fields.hpp>

#include <string>
#include <vector>

namespace maupertuis {

/// ℒ of fields that do not move, with its derivatives by them.
struct StaticDensity {
  struct Slot {
    std::size_t a = 0;
    FieldJet jet;
    Expr symbol;
  };
  std::vector<Slot> slots;
  std::vector<Expr> roots;   // ℒ, then [slots] forces, then [slots × slots] their slopes
  std::vector<bool> smooth;  // [varied] whose second derivatives it holds

  /// Why it is none; empty: it is read.
  std::string read(const FieldEquations& equations);

 private:
  std::string read_roots(const FieldEquations& equations, Expr density);
};

}  // namespace maupertuis
