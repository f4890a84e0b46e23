#pragma once
#include "kernel/packed/layout.hpp"

#include <cstddef>

/// Packs with the addresses of one workspace in them, so that a stage looks nothing up: what a pack reads at order 0, what it has to copy
/// first, where its coefficients stand.
namespace maupertuis::packed {

/// The copy of a block that is not direct, from slots of a row to its cells of the same row.
struct Copy {
  enum Kind : std::uint8_t { Range, TwoVectors, Anywhere } kind = Anywhere;
  std::int8_t lag = 0;
  bool weighted = false;
  bool of_coordinates = false;          // brought for sums alone: 0 where q_{k+2} is, as from stage 1 on
  Slot to = 0;
  Slot first = 0, second = 0;           // Range: from; TwoVectors: the first slots of two vectors that hold all of it
  const Slot* slots = nullptr;          // [lanes]
  std::array<long long, lanes> places{};  // TwoVectors: of each lane, 0 … 15
};

struct ReadyRun {
  Column::Kind kind = Column::Broadcast;
  std::uint8_t shift = 0;
  std::uint32_t count = 0;
  const Column* columns = nullptr;      // [count]
  const Slot* places = nullptr;         // [count] source + shift · stride, from the row of the result
  const double* coefficients = nullptr; // [count][lanes]
};

struct ReadyProduct {
  const double *a = nullptr, *b = nullptr;  // at order 0; equal: a square
  const double* coefficients = nullptr;
};

/// A convolution that is added up ahead.
struct ReadyConvolution {
  const double *a = nullptr, *b = nullptr;  // at order 0
  std::uint32_t number = 0;             // of its sums
};

/// Neighbours of one class.
struct ConvolutionRun {
  std::int8_t lag = 0, a_ahead = 0, b_ahead = 0;  // lag − those of the operands
  std::uint32_t first = 0, last = 0;    // ReadyConvolutions
};

/// How the convolution of a pack is found from its sum.
struct SumAhead {
  std::uint32_t number = no_sum;
  bool a_is_new = false, b_is_new = false;  // of the stage that reads it, so that the sum is without its highest order
  static constexpr std::uint32_t no_sum = ~std::uint32_t{0};
};

struct ReadyPack {
  Pack::Kind kind = Pack::Scalar;
  std::int8_t lag = 0;
  Slot out = 0, carry = 0;
  std::uint32_t first_copy = 0, last_copy = 0;  // brought before it runs, since they are not final
  std::uint32_t first_run = 0, last_run = 0, first_product = 0, last_product = 0;
  std::uint32_t first_sum = 0;          // SumAheads, as many as convolutions_of()
  const double *a = nullptr, *b = nullptr, *y = nullptr, *coefficients = nullptr;  // as in Pack; operands at order 0
  const Pack* pack = nullptr;
};

struct ReadyProgram {
  /// `rows` [orders][stride] and `coefficients` stay where they are.
  ReadyProgram(const PackedProgram& program, const double* rows, std::size_t stride, const double* coefficients);
  ReadyProgram(const ReadyProgram&) = delete;

  std::vector<ReadyPack> packs;
  std::vector<Copy> brought;            // pack by pack
  std::vector<Copy> copies;             // of all blocks that are not direct
  std::vector<ReadyRun> runs;
  std::vector<ReadyProduct> products;
  std::vector<SumAhead> sums;           // pack by pack
  std::vector<ReadyConvolution> convolutions;  // that are added up ahead
  std::vector<ConvolutionRun> convolution_runs;
  std::vector<Slot> places;             // [columns]
};

}  // namespace maupertuis::packed
