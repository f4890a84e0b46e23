#pragma once
#include <maupertuis/expression.hpp>

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace maupertuis {

/// Values of the same expressions at many points, in double: they are laid out once. The same numbers as `evaluate`
/// gives. Precondition: no TimeDerivative nodes.
class RepeatedEvaluation {
 public:
  explicit RepeatedEvaluation(std::span<const Expr> roots);
  ~RepeatedEvaluation();
  RepeatedEvaluation(RepeatedEvaluation&&) noexcept;

  std::vector<double> operator()(const std::function<double(Expr symbol)>& value_of) const;

 private:
  struct Layout;
  std::unique_ptr<Layout> layout_;
};

}  // namespace maupertuis
