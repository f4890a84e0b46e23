#pragma once
#include "symbolic/evaluate/field_numbers.hpp"

#include <unordered_map>

namespace maupertuis::invariants {

/// Field numbers in which some symbols have given values.
class GivenNumbers final : public evaluation::FieldNumbers {
 public:
  using FieldNumbers::FieldNumbers;
  Value symbol(Expr e) const {
    const auto given = given_.find(e.id());
    return given == given_.end() ? FieldNumbers::symbol(e) : given->second;
  }
  void give(Expr e, Value v) { given_[e.id()] = v; }
  void take_back(Expr e) { given_.erase(e.id()); }

 private:
  bool is_fixed(Expr symbol) const override { return given_.count(symbol.id()) > 0; }

  std::unordered_map<NodeId, Value> given_;
};

}  // namespace maupertuis::invariants
