#pragma once
#include <maupertuis/expression.hpp>

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace maupertuis {

/// Taylor series in t of the same expressions at many places at once: one program, run over all lanes order by order.
/// Each instruction holds its coefficients as [order × lanes], so that the innermost loop goes over lanes. Meshes that
/// go through the cache piece by piece have several blocks of lanes, each with a past of its own.
class LaneSeries {
 public:
  /// Nothing, and `trouble`, where a function stands in `roots` that has no series here. `constants` are numbers in all
  /// lanes and at all times.
  static std::optional<LaneSeries> make(const std::vector<Expr>& roots, const std::vector<Expr>& inputs,
                                        const std::unordered_map<Expr, double, ExprHash>& constants,
                                        std::string& trouble);
  /// What of the past is read from outside: those inputs and the first `roots` roots; of all others the coefficient
  /// that was computed last alone, so that a large mesh does not fill the memory. Before `resize`.
  void keep(const std::vector<std::size_t>& inputs, std::size_t roots);
  void resize(std::size_t lanes, std::size_t orders, std::size_t blocks = 1);
  /// The block that all of the following is about.
  void select(std::size_t block) { block_ = block * block_size_; }
  /// Bytes that a mesh of so many lanes takes.
  double bytes(double lanes, std::size_t orders) const;

  /// Coefficient `order` of input i, [lanes]: to be filled before `advance(order)`.
  double* input(std::size_t i, std::size_t order) { return at(inputs_[i], order); }
  bool uses_input(std::size_t i) const { return inputs_[i] != none; }
  /// Computes coefficient `order` of every instruction; those below are there.
  void advance(std::size_t order);
  const double* root(std::size_t i, std::size_t order) const { return at(roots_[i], order); }
  /// The number that a root is in all lanes and at all times.
  std::optional<double> number_root(std::size_t i) const {
    const Instruction& r = code_[roots_[i]];
    return r.op == Op::Constant ? std::optional(r.number) : std::nullopt;
  }

 private:
  enum class Op {
    Input,
    Constant,
    Add,
    Multiply,
    Scale,
    Power,
    Exp,
    Log,
    Sin,
    Cos,
    Sinh,
    Cosh,
    Tanh,
    SlopeOfTanh,
    Sech
  };
  struct Instruction {
    Op op = Op::Constant;
    std::size_t a = 0,
                b = 0;      // operands; of Sin: its Cos, and the other way round, in b; of Sech its product with tanh
    double number = 0;      // Constant, Scale, the exponent of Power
    bool constant = false;  // in time
    bool kept = true;       // with its past
    std::size_t place = 0;  // of its coefficients, in the block or among what all blocks share
  };
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::size_t place(std::size_t i, std::size_t order) const {
    const Instruction& x = code_[i];
    if (!x.kept) return x.place;
    return (x.op == Op::Constant ? 0 : block_) + x.place + order * lanes_;
  }
  double* at(std::size_t i, std::size_t order) { return data_.data() + place(i, order); }
  const double* at(std::size_t i, std::size_t order) const { return data_.data() + place(i, order); }
  bool own_past(std::size_t i) const { return code_[i].kept && code_[i].op != Op::Constant; }
  void first(std::size_t i);
  void higher(std::size_t i, std::size_t k);

  friend struct LaneCompiler;
  std::vector<Instruction> code_;
  std::vector<std::size_t> inputs_, roots_;
  std::vector<double> data_, factors_;
  std::size_t lanes_ = 0, orders_ = 0, block_ = 0, block_size_ = 0;
};

}  // namespace maupertuis
