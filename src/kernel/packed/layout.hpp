#pragma once
#include "kernel/program/program.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

/// The same program, laid out for vectors: instructions of one shape that do not wait for each other become a *pack* of
/// up to 8 lanes, whose results lie side by side, and whose operands do too wherever possible.
namespace maupertuis::packed {

inline constexpr std::uint32_t lanes = 8;
inline constexpr std::uint32_t no_block = ~std::uint32_t{0};
/// Up to whole vectors.
inline std::size_t padded(std::size_t count) { return (count + lanes - 1) / lanes * lanes; }

/// The coefficients of up to 8 operands at all orders, side by side in a row. A *direct* block is a range of slots; any
/// other keeps copies in cells of its own behind the slots, renewed when the coefficients of an order are final.
struct Block {
  Slot first = 0;  // of the range, or of the cells of its own
  bool direct = true;
  bool weighted = false;  // holds k u_k instead of u_k
  std::int8_t lag = 0;
  std::uint32_t width = 0;
  std::array<Slot, lanes> slots{};  // what is copied
  bool is_range = false;            // … is side by side
  /// … lies in two vectors of a row: where these begin, and of each lane its place in them, 0 … 15.
  bool in_two_vectors = false;
  std::array<Slot, 2> vectors{};
  std::array<long long, lanes> places{};
};

/// Σ over columns: coefficient of the lane · dʳ/dtʳ of an operand.
struct Column {
  enum Kind : std::uint8_t { Broadcast, Contiguous, Reversed, Gather } kind = Broadcast;
  std::uint8_t shift = 0;
  bool passes_tangent = false;        // lag of the operand + shift = lag of the pack
  Slot source = 0;                    // Broadcast, Contiguous, Reversed: of the first lane
  std::array<Slot, lanes> sources{};  // Gather
  std::uint32_t coefficients = 0;     // in PackedProgram::coefficients, `lanes` of them
};

/// Neighbouring columns of a pack that are read alike; their coefficients lie side by side.
struct ColumnRun {
  Column::Kind kind = Column::Broadcast;
  std::uint8_t shift = 0;
  bool passes_tangent = false;
  std::uint32_t first = 0, last = 0;  // columns
  Slot source = 0;                    // of the first one, as its coefficients
  std::uint32_t coefficients = 0;
  bool neighbours = false;  // Broadcast: of slots side by side
};

/// Coefficient of the lane · a · b.
struct ProductTerm {
  std::uint32_t a = 0, b = 0;  // blocks
  std::uint32_t coefficients = 0;
};

/// Σ_j a_j b_{m−j} of a pack of lag ℓ, which finds m = k + 2 − ℓ at stage k. Rolled code makes these sums for several
/// stages at once, of all that is final, and leaves what is newer to the stages.
struct Convolution {
  std::uint32_t a = 0, b = 0;            // blocks
  std::int8_t lag = 0;                   // ℓ
  std::int8_t a_ahead = 0, b_ahead = 0;  // ℓ − lag of the operand: by so many orders it is known earlier
  Slot first_a = 0, first_b = 0;         // cells of the operands
};

/// Up to eight results side by side.
///
/// A running sum s_i = s_{i−1} + x_i of many members lies in vectors in one of two ways:
///
///     one member after the other            a chain in eight parts of equal length, a lane each
///
///       vector   lanes 0 … 7                  vector   lane 0   lane 1   lane 2   …
///         0      s0   s1   s2  …  s7            0       s0       s12      s24
///         1      s8   s9   s10 …  s15           1       s1       s13      s25
///         …                                     …       …        …        …
///                                               11      s11      s23      s35
///
/// On the left (Scan) each lane adds the lanes before it, by three shuffles, and all lanes add the last sum of the
/// vector before. On the right each vector (Strand) adds its columns to the vector before, so that every lane is the
/// running sum of its own part; then (Join) each lane of all these vectors adds what the lanes before it came to in the
/// last vector: lane 2 what s11 and s23 were until then. That takes one sum across lanes in place of one a vector.
struct Pack {
  enum Kind : std::uint8_t {
    Sum,         // columns + products
    Scan,        // running sums of columns, one member after the other; `carry`: the sum before, where there is one
    ScanDown,    // the same from the last lane to the first
    Strand,      // a vector of a running sum in eight parts; `carry`: the vector before, where there is one
    Join,        // after the last of these; `carry`: the sum that the whole goes on with, where there is one
    JoinDown,    // the same where the parts follow each other from the last lane to the first
    Integral,    // y with dy = c w du: sines, cosines, exponentials, inverse functions
    Quotient,    // block a / block b
    SquareRoot,  // of block a
    Scalar,      // one instruction, by the reference rules
  } kind = Scalar;
  bool is_neighbours = false;  // from stage 1 on: a Sum of one run of neighbours, which has code of its own
  std::int8_t lag = 0;
  std::int8_t level = 0;
  std::uint32_t width = 0;  // lanes in use
  Slot out = 0;             // first of `lanes` slots, beginning at a multiple of it (not for Scalar)
  std::uint32_t first_column = 0, last_column = 0, first_product = 0, last_product = 0;  // Sum
  std::uint32_t first_run = 0, last_run = 0;                  // Sum and Scan: the columns, run by run
  std::uint32_t first_later_run = 0;                          // from stage 1 on: without what the number 1 gives
  std::uint32_t first_convolution = 0, last_convolution = 0;  // of a Sum one a product
  /// Sum: the same columns by their place in the sums, for compiled code
  std::uint32_t first_aligned = 0, last_aligned = 0;
  /// Integral: u (weighted), w; Quotient: a, b, y; SquareRoot: u, –, y
  std::uint32_t a = no_block, b = no_block, y = no_block;
  std::uint32_t coefficients = 0;  // Integral: c
  Slot carry = no_slot;            // Scan: what the first lane adds to; Strand, Join: see there; no_slot: nothing
  std::uint32_t strands = 0;       // Join: their number; `out` is the lowest of their vectors
  Slot last_strand = no_slot;      // Join: vector of the last one
  Slot pairs = no_block;           // Integral of sines: the first of their cosines
  std::uint32_t instruction = 0;   // of the first lane; those of the others follow
  std::uint32_t first_function = 0, last_function = 0;  // Integral: what gives order 0, in PackedProgram::functions
};

struct PackedProgram {
  Program program;  // renumbered, with slots between packs that nothing uses
  /// [slots of the program as it was] where they went; no_slot: written out in the sums that read them
  std::vector<Slot> number;
  std::size_t cells = 0;    // slots and cells of blocks: doubles of a row
  std::vector<Pack> packs;  // section Dynamics, in order of execution
  std::vector<Block> blocks;
  std::vector<Column> columns;
  std::vector<ColumnRun> runs;
  std::vector<ProductTerm> products;
  std::vector<Convolution> convolutions;
  std::vector<std::uint32_t> functions;  // indices of instructions
  std::vector<ConstantId> coefficients;  // of lanes that are not in use: the constant 0

  /// Weighted, and not side by side where they stand: what a solution gives for them may be put into the block's cells
  /// at once.
  bool copies_coordinates(const Block& block) const {
    return block.weighted && !block.is_range &&
           std::all_of(block.slots.begin(), block.slots.end(), [this](Slot s) { return s < program.freedoms; });
  }
};

/// Coordinates in the order in which vectors are to hold what belongs to them: the first `whole` by eights, whose lanes
/// are eight parts of a chain, one after the other or the other way round.
struct LaneOrder {
  std::vector<Slot> coordinates;
  std::size_t whole = 0;
};

/// `order`: as the coordinates are numbered, unless told. Cost about linear in the size of the program.
PackedProgram pack(const Program& program, const LaneOrder& order = {});

}  // namespace maupertuis::packed
