#include "kernel/program/program.hpp"

#include <maupertuis/kinds.hpp>

#include <fmt/format.h>

namespace maupertuis {

std::string_view op_name(Op op) {
  switch (op) {
    case Op::One:
      return "one";
    case Op::Time:
      return "time";
    case Op::Coordinate:
      return "coordinate";
    case Op::Companion:
      return "companion";
    case Op::Linear:
      return "linear";
    case Op::Products:
      return "products";
    case Op::Square:
      return "square";
    case Op::Quotient:
      return "quotient";
    case Op::SquareRoot:
      return "sqrt";
    case Op::Power:
      return "power";
    case Op::SinCos:
      return "sincos";
    case Op::SinhCosh:
      return "sinhcosh";
    case Op::Function:
      return "function";
    case Op::Derivative:
      return "d/dt";
    case Op::Select:
      return "select";
  }
  return "unknown";
}

std::logic_error unknown_op(Op op, std::string_view who) {
  return std::logic_error(
      fmt::format("{} met the instruction `{}`, for which it has no rule; please report", who, op_name(op)));
}

namespace {

std::string_view function_name(Kind kind) {
  if (kind == Kind::Sum) return "sum";
  if (kind == Kind::Product) return "product";
  if (kind == Kind::Power) return "power";
  return name_of(kind);
}

class Printer {
 public:
  explicit Printer(const Program& program) : program_(program) {}

  std::string run() {
    out_ +=
        fmt::format("program: {} freedoms, {} parameters, {} slots, {} constants, {} instructions\n", program_.freedoms,
                    program_.parameters, program_.slots, program_.constants.size(), program_.instructions.size());
    out_ += "\nconstants\n";
    for (ConstantId id = 0; id < program_.constants.size(); ++id) constant_line(id);
    out_ += "\nslots\n";
    for (std::size_t i = 0; i < program_.freedoms; ++i)
      out_ += fmt::format("  s{} = {}\n", i, program_.coordinate_names[i]);
    if (program_.one != no_slot) out_ += fmt::format("  s{} = 1\n", program_.one);
    if (program_.time != no_slot) out_ += fmt::format("  s{} = t\n", program_.time);
    constexpr std::array titles{"dynamics", "along the motion", "at points"};
    for (std::size_t section = 0; section < SectionCount; ++section) {
      if (program_.runs[section].empty()) continue;
      out_ += fmt::format("\n{}\n", titles[section]);
      for (const Run& run : program_.runs[section])
        for (std::uint32_t i = run.first; i < run.last; ++i) instruction_line(program_.instructions[i]);
    }
    out_ += "\noutputs\n";
    outputs("residual", program_.residual);
    outputs("switches", program_.switch_slots);
    outputs("events", program_.events);
    outputs("integrands", program_.integrands);
    outputs("observables", program_.observables);
    return std::move(out_);
  }

 private:
  void constant_line(ConstantId id) {
    const Constant& constant = program_.constants[id];
    std::string text;
    if (constant.kind == Kind::Number)
      text = fmt::format("{}", constant.value);
    else if (constant.kind == Kind::Symbol)
      text = program_.parameter_names[constant.index];
    else if (constant.kind == Kind::Sign && constant.arguments == 0)
      text = fmt::format("side of switch {}", constant.index);
    else {
      text = function_name(constant.kind);
      for (std::uint32_t i = 0; i < constant.arguments; ++i)
        text += fmt::format(" c{}", program_.constant_arguments[constant.first_argument + i]);
    }
    out_ += fmt::format("  c{} = {}\n", id, text);
  }

  void instruction_line(const Instruction& instruction) {
    out_ += fmt::format("  s{}", instruction.out);
    if (instruction.second != no_slot) out_ += fmt::format(", s{}", instruction.second);
    const bool is_function = instruction.op == Op::Function;
    out_ += fmt::format(" = {}", is_function ? function_name(instruction.function) : op_name(instruction.op));
    if (instruction.a != no_slot) out_ += fmt::format(" s{}", instruction.a);
    if (instruction.b != no_slot) out_ += fmt::format(" s{}", instruction.b);
    if (instruction.op == Op::Power) out_ += fmt::format(" c{}", instruction.constant);
    if (is_function) out_ += "  with d =";
    for (std::uint32_t i = instruction.first_term; i < instruction.last_term; ++i) {
      const Term& term = program_.terms[i];
      constexpr std::array derivatives{"", "d/dt ", "d²/dt² "};
      out_ += fmt::format("{} c{}·{}s{}", i > instruction.first_term ? " +" : "", term.coefficient,
                          derivatives[term.shift], term.a);
      if (term.b != no_slot) out_ += fmt::format("·{}s{}", is_function ? "d " : "", term.b);
    }
    out_ += fmt::format("    [lag {}]\n", instruction.lag);
  }

  void outputs(std::string_view name, const std::vector<Slot>& slots) {
    if (slots.empty()) return;
    out_ += fmt::format("  {} =", name);
    for (const Slot slot : slots) out_ += fmt::format(" s{}", slot);
    out_ += '\n';
  }

  const Program& program_;
  std::string out_;
};

}  // namespace

std::string print(const Program& program) { return Printer(program).run(); }

}  // namespace maupertuis
