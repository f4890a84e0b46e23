#pragma once
#include "kernel/program/program.hpp"
#include "kernel/straight_line/builder.hpp"

#include <map>
#include <vector>

/// The section Dynamics of a program at one point, as nodes of a straight line.
namespace maupertuis::dynamics {

/// Arrays of the lines, in order.
enum Array : std::uint32_t {
  TimeArray,
  PositionArray,
  VelocityArray,
  AccelerationArray,
  NumberArray,
  ResultArray,
  arrays
};

/// What a number of NumberArray is; all follow from parameters and the sides of switches.
struct NumberSource {
  enum What : std::uint8_t { OfConstant, OfChoice, OfPivot } what;
  std::uint32_t index;  // of the constant, of the edge, or of the pivot, whose usual size it is
};

/// Numbers that several lines share.
class Numbers {
 public:
  Numbers(const Program& program, std::vector<NumberSource>& sources) : program_(program), sources_(sources) {}

  straight::Value constant(straight::Builder& to, ConstantId id) {
    const Constant& constant = program_.constants[id];
    return constant.kind == Kind::Number ? to.literal(constant.value) : number(to, {NumberSource::OfConstant, id});
  }
  straight::Value choice(straight::Builder& to, std::uint32_t edge) {
    return number(to, {NumberSource::OfChoice, edge});
  }
  straight::Value usual_size(straight::Builder& to, std::uint32_t pivot) {
    return number(to, {NumberSource::OfPivot, pivot});
  }

 private:
  straight::Value number(straight::Builder& to, NumberSource source);

  const Program& program_;
  std::vector<NumberSource>& sources_;
  std::map<std::pair<NumberSource::What, std::uint32_t>, std::uint32_t> index_;
};

/// Writes every coefficient of every order that the residual needs, each made once: the recurrences of the orders
/// written out, without what vanishes (all of q̈ where it is 0, derivatives of constants).
class PointWriter {
 public:
  /// `with_accelerations`: else q̈ = 0.
  PointWriter(straight::Builder& to, Numbers& numbers, const Program& program, bool with_accelerations);

  /// Of order 0.
  straight::Value at(Slot slot) const { return at(slot, 0); }

 private:
  using Value = straight::Value;
  using Terms = std::vector<straight::Term>;

  Value at(Slot slot, int order) const {
    return order < orders_ ? value_[slot][static_cast<std::size_t>(order)] : zero_;
  }
  void put(Slot slot, int order, Value value) { value_[slot][static_cast<std::size_t>(order)] = value; }
  void write(const Run& run, int order);
  void write(const Instruction& i, int order);
  void product(Terms& terms, straight::Term term, Slot a, int i, Slot b, int j) const;
  Value sum(const Instruction& i, int k);
  Value quotient(const Instruction& i, int k);
  Value root(const Instruction& i, int k);
  Value power(const Instruction& i, int k);
  Value function(const Instruction& i, int k);
  Value select(const Instruction& i, int k);
  void pair(const Instruction& i, int k, double sign);
  void sines(const Run& run);

  straight::Builder& to_;
  Numbers& numbers_;
  const Program& program_;
  int orders_;
  Value zero_;
  std::vector<std::vector<Value>> value_;  // [slots][orders]
};

}  // namespace maupertuis::dynamics
