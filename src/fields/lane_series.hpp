#pragma once
#include <maupertuis/expression.hpp>

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace maupertuis {

/// Taylor series in t of the same expressions at many places at once: one program, run over all lanes order by order.
/// Each instruction holds its coefficients as [order × lanes], so that the innermost loop goes over lanes.
class LaneSeries {
 public:
  /// Nothing, and `trouble`, where a function stands in `roots` that has no series here. `constants` are numbers in all
  /// lanes and at all times.
  static std::optional<LaneSeries> make(const std::vector<Expr>& roots, const std::vector<Expr>& inputs,
                                        const std::unordered_map<Expr, double, ExprHash>& constants,
                                        std::string& trouble);
  void resize(std::size_t lanes, std::size_t orders);

  /// Coefficient `order` of input i, [lanes]: to be filled before `advance(order)`.
  double* input(std::size_t i, std::size_t order) { return at(inputs_[i], order); }
  bool uses_input(std::size_t i) const { return inputs_[i] != none; }
  /// Computes coefficient `order` of every instruction; those below are there.
  void advance(std::size_t order);
  const double* root(std::size_t i, std::size_t order) const { return at(roots_[i], order); }
  /// Whether a root does not change in time, whatever the inputs: no input stands in it, or constant ones alone.
  bool constant_root(std::size_t i) const { return code_[roots_[i]].constant; }

 private:
  enum class Op { Input, Constant, Add, Multiply, Scale, Power, Exp, Log, Sin, Cos, Sinh, Cosh };
  struct Instruction {
    Op op = Op::Constant;
    std::size_t a = 0, b = 0;  // operands; of Sin: its Cos, and the other way round, in b
    double number = 0;         // Constant, Scale, the exponent of Power
    bool constant = false;     // in time
  };
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  double* at(std::size_t i, std::size_t order) { return data_.data() + (i * orders_ + order) * lanes_; }
  const double* at(std::size_t i, std::size_t order) const { return data_.data() + (i * orders_ + order) * lanes_; }
  void first(std::size_t i);
  void higher(std::size_t i, std::size_t k);

  friend struct LaneCompiler;
  std::vector<Instruction> code_;
  std::vector<std::size_t> inputs_, roots_;
  std::vector<double> data_, factors_;
  std::size_t lanes_ = 0, orders_ = 0;
};

}  // namespace maupertuis
