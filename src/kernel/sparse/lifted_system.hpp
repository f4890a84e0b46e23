#pragma once
#include "kernel/sparse/tangent_graph.hpp"

#include <cstddef>
#include <optional>
#include <span>

namespace maupertuis::sparse {

/// M₀ x = b with the tangents of the slots in between as further unknowns z:
///
///     −z_s + Σ f z_operand = 0      a row for each slot s between q̈ and the residual
///            Σ f z_operand = b_i    a row for each residual
///
/// About as many entries as the program has terms, where M₀, the Schur complement, may be full. Unknowns are called by
/// their slots: those of q̈ and λ are the first ones, as in the program.
struct LiftedSystem {
  struct Entry {
    std::uint32_t row, column;
  };

  std::size_t size = 0;                        // rows and columns
  std::vector<Slot> slot_of_column;            // [size]
  std::vector<std::uint32_t> row_of_residual;  // [unknowns]
  std::vector<std::uint32_t> own_column;       // [rows] of the slot that the row gives; of q̈_i in the row of R_i
  std::vector<bool> wanted;                    // [size] columns: q̈, λ, and slots whose tangents the caller wants
  std::vector<Entry> entries;                  // each place once
  std::vector<std::uint32_t> minus_one;        // entries of the value −1
  std::vector<std::uint32_t> plus_one;         // entries of the value 1
  std::vector<Edge> edges;                     // whose factors add up to the others, sorted by rule
  std::vector<std::uint32_t> entry_of_edge;    // [edges]
  std::vector<double> literal;                 // [entries] of those that no parameter and no state changes; else NaN
  std::vector<std::uint32_t> rows_of_slots;    // in an order in which the tangents follow from q̈
};

/// `stored`: [slots] whose tangents are wanted.
/// Nothing where a residual does not depend on q̈ at all: then M₀ is singular.
std::optional<LiftedSystem> lift(const Program& program, const std::vector<bool>& stored);

/// The values of the entries, computed as often as what they depend on changes.
class Assembly {
 public:
  /// `number`: [slots] where the values of slots are found.
  Assembly(const LiftedSystem& system, const Program& program, std::span<const Slot> number);

  /// values: [entries], of which those that do not change along a motion are set.
  void set_constants(const double* constants, std::span<double> values);
  /// now: values at order 0; values: the same as before.
  void operator()(const double* now, std::span<double> values) const;

 private:
  struct Multiple {
    Slot slot;
    std::uint32_t entry;
    double factor, base;  // base: of the first for its entry: what it is added to
  };

  const Program& program_;
  std::vector<Edge> constant_, others_;
  std::vector<std::uint32_t> entry_of_constant_, entry_of_other_;
  std::vector<Multiple> first_, more_;  // factor · value of a slot: of each entry the first, and others
  std::vector<Edge> edges_of_first_, edges_of_more_;
  std::vector<double> minus_and_plus_;          // [entries]
  std::vector<double> base_;                    // [entries] what does not change along a motion
  std::vector<std::uint32_t> of_others_alone_;  // entries without multiples
  const double* constants_ = nullptr;
};

}  // namespace maupertuis::sparse
