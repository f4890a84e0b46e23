#pragma once
#include "kernel/packed/layout.hpp"

#include <array>
#include <cstddef>
#include <vector>

/// Packs with the addresses of one workspace in them, so that a stage looks nothing up: what a pack reads at order 0, what it has to copy
/// first, where its coefficients stand. Lists are pairs of pointers, first and last.
namespace maupertuis::packed {

/// The copy of a block that is not direct, from slots of a row to its cells of the same row.
struct Copy {
  enum Kind : std::uint8_t { Range, TwoVectors, Anywhere } kind = Anywhere;
  std::int8_t lag = 0;
  bool weighted = false;
  Slot to = 0;
  Slot first = 0, second = 0;           // Range: from; TwoVectors: the first slots of two vectors that hold all of it
  const Slot* slots = nullptr;          // [lanes]
  std::array<long long, lanes> places{};  // TwoVectors: of each lane, 0 … 15
};

struct ReadyRun {
  Column::Kind kind = Column::Broadcast;
  std::uint8_t shift = 0;
  bool neighbours = false;              // Broadcast: of slots side by side
  std::uint32_t count = 0;
  const Column* columns = nullptr;      // [count]
  const Slot* places = nullptr;         // [count] source + shift · stride, from the row of the result
  const double* coefficients = nullptr; // [count][lanes]
};

/// A product that a sum made ahead is without: at order k, operand[k · stride] · factor.
struct EndTerm {
  const double *operand = nullptr, *factor = nullptr;
};

/// Σ_j a_j b_{m−j} of a pack.
struct ReadyProduct {
  const double *a = nullptr, *b = nullptr;  // at order 0; equal: a square
  const double* coefficients = nullptr;
  const double* sum = nullptr;          // [rolled_group][lanes] made ahead; null: by itself, as operands of t alone may be ahead of q̈
  const EndTerm *ends = nullptr, *new_ends = nullptr, *last_end = nullptr;  // of what the stage before has found, in late stages; of what this one has
};

/// A convolution that is added up ahead.
struct ReadyConvolution {
  const double *a = nullptr, *b = nullptr;  // at order 0
  double* sums = nullptr;
};

/// Neighbours of one class.
struct ConvolutionRun {
  std::uint8_t kind = 0;                // see kind_of()
  const ReadyConvolution *first = nullptr, *last = nullptr;
};

/// Number of the class of convolutions of lag ℓ whose operands are D_a and D_b ≤ ℓ ahead: ℓ minus their lags.
constexpr int kind_of(int lag, int a_ahead, int b_ahead) { return (lag == 0 ? 0 : lag == 1 ? 1 : 5) + a_ahead * (lag + 1) + b_ahead; }

/// How a pack runs in stages that have sums made ahead: by its kind, but what needs little has code of its own.
enum Way : std::uint8_t {
  Neighbours = Pack::Scalar + 1,        // one run of neighbours
  Products,                             // products by their sums
  IntegralBySum,
};

struct ReadyPack {
  Pack::Kind kind = Pack::Scalar;
  std::uint8_t way = Pack::Scalar;      // Pack::Kind or Way
  std::int8_t lag = 0;
  Slot out = 0, carry = 0;
  const Copy *copies = nullptr, *last_copy = nullptr;  // brought before it runs, since they are not final
  const Copy* last_copy_ahead = nullptr;               // of those the ones that are not 0, where sums are made ahead
  const ReadyRun *runs = nullptr, *last_run = nullptr;
  const ReadyRun* later_runs = nullptr;                // without what is 0 from stage 1 on
  const ReadyProduct *products = nullptr, *last_product = nullptr;  // of a sum; of others the one they have, without coefficients
  const double *a = nullptr, *b = nullptr, *y = nullptr, *coefficients = nullptr;  // as in Pack; operands at order 0
  const Pack* pack = nullptr;
};

/// 1/k to twice the digits of a double: a rounded reciprocal alone errs the same way in every step.
struct Reciprocal {
  double leading = 0, rest = 0;
};

/// What a pack needs to know of order k.
struct Order {
  double* row = nullptr;
  std::ptrdiff_t offset = 0;            // of the row from that of order 0
  std::array<double, 3> shift_factors{};  // 1, k + 1, (k + 1)(k + 2)
  Reciprocal reciprocal;                // of k; of 0: none
  int number = 0;                       // k
};
std::vector<Order> orders_of(double* rows, std::size_t stride, int count);

/// Where a workspace has its numbers; they stay there.
struct Numbers {
  const double* rows = nullptr;         // [orders][stride]
  std::size_t stride = 0;
  const double* coefficients = nullptr; // values of PackedProgram::coefficients
  double* sums = nullptr;               // [convolutions][rolled_group][lanes] of Engine::add_up_ahead; null: stages add up for themselves
};

struct ReadyProgram {
  ReadyProgram(const PackedProgram& program, const Numbers& numbers);
  ReadyProgram(const ReadyProgram&) = delete;

  std::vector<ReadyPack> packs;
  std::vector<Copy> brought;            // pack by pack
  std::vector<Copy> copies;             // of all blocks that are not direct
  std::vector<ReadyRun> runs;
  std::vector<ReadyProduct> products;   // pack by pack
  std::vector<EndTerm> ends;
  std::vector<ReadyConvolution> convolutions;  // that are added up ahead
  std::vector<ConvolutionRun> convolution_runs;
  std::vector<Slot> places;             // [columns]
};

}  // namespace maupertuis::packed
