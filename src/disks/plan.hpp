#pragma once
#include "kernel/program/program.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace maupertuis {

/// What of a program disks bound, and what is known of its values before any motion: which need a reach or a tail,
/// which are polynomials in t, which have all their coefficients in the rows of a step, and which are distances.
struct DiskPlan {
  /// An instruction, and the number that belongs to it.
  struct Node {
    Instruction instruction;
    double exponent;  // Op::Power
    int halves = 0;   // where it is half of a small odd number: that one
  };
  struct Term {
    double size = 0;  // |coefficient|
    std::uint32_t coefficient = 0, a = 0, b = 0, shift = 0;
  };

  /// The residual, and these slots. The program must outlive this.
  DiskPlan(const Program& program, std::span<const std::uint32_t> slots);
  /// From now on these slots alone, without the residual. Cost: that of some evaluations.
  void bound_only(std::span<const std::uint32_t> slots);
  /// [program.constants]; anew whenever parameters or sides change.
  void set_constants(const double* constants);
  /// Whether a term from first_product on is a product of two slots.
  static bool is_product(const Instruction& i, std::uint32_t term) {
    return i.op == Op::Products && term >= i.first_product;
  }
  /// The branch of Op::Select that is in force.
  Slot chosen(const Instruction& i) const {
    std::uint32_t t = i.first_term;
    while (t + 1 < i.last_term && constants[terms[t].coefficient] == 0) ++t;
    return terms[t].a;
  }

  const Program& program;
  std::vector<Node> nodes;
  std::vector<Term> terms;                           // of the program
  std::vector<std::uint32_t> needed;                 // nodes that are carried out, in order
  std::vector<std::uint32_t> derived;                // those of them that derivatives need on a larger disk
  std::vector<std::int8_t> needs_reach, needs_tail;  // [slots]
  int most_rates = 0;                                // up to this shift the reach of coordinates is needed
  bool residual_has_tails = false;
  std::vector<int> residual;            // node that makes R_j; −1: none
  std::vector<int> maker;               // [slots] node; −1: none
  std::vector<int> degree;              // [slots] of polynomials in t; very large for all else
  std::vector<bool> linear;             // [slots] in coordinates and polynomials in t
  std::vector<std::int8_t> has_series;  // [slots] all known orders are in the rows
  std::vector<std::uint32_t> alone;     // slots with a series beyond the stored ones
  std::vector<std::uint32_t> few;       // those with a series that are needed, where bound_only() left few of them
  bool only_few = false;
  std::vector<std::uint32_t> bases;  // slots: distances and the like
  std::vector<std::int8_t> is_base;  // [slots]
  const double* constants = nullptr;

 private:
  void find_degrees();
  void find_series(const std::vector<bool>& made);
  void find_needs(std::span<const std::uint32_t> slots, bool residual);
  void need_operands(const Node& node);
  void find_derived();
  void find_bases();
};

}  // namespace maupertuis
