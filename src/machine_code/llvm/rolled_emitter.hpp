#pragma once
#include "machine_code/llvm/emission.hpp"
#include "kernel/packed/code.hpp"
#include "kernel/packed/layout.hpp"

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <vector>

/// A packed program of any size as code whose stages are turns of a loop: `stage` runs the packs of section Dynamics,
/// with their addresses written out, and `tangents` their derivatives; `ahead` adds up the products that later stages
/// share in coefficients that are final. The solution stays with the workspace, so that constraints and any number of
/// unknowns are no matter; instructions that stand alone are called back.
///
/// Rows of a large program do not fit into the first cache, and a sum over orders reads all of them. So the stages from
/// 1 on form groups of four, and what the sums of a group have in common is read once. Σ_j a_j b_{m−j} at stage s has
/// three parts:
///
///   the *interior*: operands that were final before the group began, for its four stages at once, in a loop over j;
///   what each stage of the group makes final, added to the sums of those that follow the next one, which does it
///   itself; the *ends*, a_m b_0 and a_0 b_m, where an operand is of stage s itself.
///
/// Stages up to 4 have sums so short that the three would overlap: each is added up by itself. The stages up to 0, with
/// the values of elementary functions, are written out for long runs (`first`), else the engine's. In long runs that
/// are solved by −M₀⁻¹ all stages from 1 on are one loop (`later`).
namespace maupertuis::llvm_backend {

/// Bytes of one vector of values, and of the sums that a group of stages has taken ahead.
inline constexpr std::int64_t vector_bytes = 8 * std::int64_t{packed::lanes};
inline constexpr std::int64_t sums_bytes = packed::rolled_group * vector_bytes;

class RolledEmitter {
 public:
  RolledEmitter(Emission& out, const packed::PackedProgram& program, std::size_t stride);
  /// `long_run`: `first` and `later` too, which cost more to compile than they save in a short one.
  void run(bool long_run);

 private:
  using Value = llvm::Value;
  using Block = packed::Block;
  using Column = packed::Column;
  using Pack = packed::Pack;

  /// How far the operands of a convolution are ahead of it: lag − lag of a, lag − lag of b. Loops over convolutions are
  /// of one class.
  using Class = std::array<int, 3>;  // lag, and the two differences
  /// A value in a register, and when it was made.
  struct Recent {
    Value* value;
    std::size_t time;
  };

  // --------------------------------------------------------------------------------------- stages (rolled_emitter.cpp)
  void find_convolutions();
  Value* field(std::size_t offset);  // of the arguments, an address
  /// a function of CompiledArguments* and these
  void open(const char* name, const std::vector<llvm::Type*>& others, llvm::Type* result = nullptr,
            bool exported = true);
  void open_stage(const char* name, bool exported = true);  // … the stage
  void set_stage(Value* stage);
  void stage();
  llvm::Function* part_of_stage(std::size_t first, std::size_t last);
  std::vector<std::size_t> parts_of_stage() const;
  void find_sums_of_stage();
  void begin_packs();
  void run_packs(std::size_t first, std::size_t last);
  Value* row(int ahead) { return rows_of_stage_[static_cast<std::size_t>(ahead)]; }  // of order stage + ahead
  int ahead_of(const Pack& pack) const { return 2 - pack.lag; }
  /// Coordinates of the order that is to be found count as 0.
  bool vanishes(Slot slot, int ahead) const {
    return slot < program_.unknowns && ahead == 2 && written_.value_or(0) >= 0;
  }

  // --------------------------------------------------------------------------------- stages up to 0 (rolled_first.cpp)
  void first_stages();
  Value* short_convolution(const packed::Convolution& c, bool a_ends, bool b_ends);
  void functions(const Pack& pack);
  void sines(const Pack& pack);

  // ------------------------------------------------------------------------------------------ packs (rolled_packs.cpp)
  /// packs for which a value stays in a register; then it is read from its row
  static constexpr std::size_t longest_memory = 6;
  void pack(std::size_t index);
  void find_passing(bool residual_too);
  void keep(const Pack& pack, Value* value);
  void keep(const Pack& pack, Value* value, Value* row);
  Value* columns(const Pack& pack);
  Value* column_values(const Column& column, Value* row, bool is_here);
  Value* splat_of(Slot slot, Value* row, bool is_here);
  Value* in_register(Slot first) const;
  Value* values_of(const Block& block, Value* row);
  Value* coefficients(std::uint32_t first) { return load(at(coefficients_, 8 * std::int64_t{first})); }
  Value* plus_scaled(Value* sum, std::uint32_t coefficients, Value* x);
  Value* running_sum(Value* v, bool down);
  Value* carried(const Pack& pack, Value* sum, Value* row);
  void strand(const Pack& pack, Value* columns);
  void join(const Pack& pack, bool down, Value* row);
  Value* products(std::size_t index, Value* result);
  Value* convolution(std::size_t number, bool a_ends, bool b_ends);
  Value* end(std::uint32_t newest, std::uint32_t first, int lag, Value* sum);
  Value* newest(std::uint32_t block, int ahead);
  Value* first(std::uint32_t block) { return load(slot_at(rows_, p_.blocks[block].first)); }
  void integral(std::size_t index);
  void quotient(std::size_t index);
  void square_root(std::size_t index);
  void call_rule(std::uint32_t instruction, int ahead);
  bool vanishes(const Block& block, int ahead) const;

  // ------------------------------------------------------------------------------------ tangents (rolled_tangents.cpp)
  void tangents();
  void tangent(const Pack& pack, Value* row);
  Value* tangent_columns(const Pack& pack, Value* row);
  Value* tangent_products(const Pack& pack, Value* row, Value* result);
  Value* change(const Pack& pack, std::uint32_t block, Value* row);
  Value* at_point(std::uint32_t block) { return values_of(p_.blocks[block], rows_); }

  // ------------------------------------------------------------------------------------ solution (rolled_solution.cpp)
  void solution();
  void solve_by(Value* inverse, Value* tangent_row);
  void correction();
  std::vector<Value*> product_with_inverse(Value* inverse);
  Value* over_divisor(Value* x);
  void correct_copies(Value* tangents);
  void set_correction_factors(int sign);
  void correct(Value* tangent_row);
  void correct(Slot slot, int lag, Value* tangent);
  std::vector<int> corrected_lags() const;
  std::vector<bool> needed_for_corrections(const std::vector<int>& lag) const;

  // ------------------------------------------------------------------------------------------ ahead (rolled_ahead.cpp)
  void ahead();
  static constexpr std::size_t blocks_of_part = 48;
  void renew_blocks(std::size_t first, std::size_t last);
  llvm::Function* part_of_blocks(std::size_t first, std::size_t last);
  void renew_copies();
  void renew(const Block& block);
  void each_convolution(
      const std::function<void(const Class&, Value* a, Value* b, Value* sums)>& body,
      const std::function<bool(const Class&)>& takes_part = [](const Class&) { return true; });
  void loop_over(const Class& key, const std::vector<std::size_t>& members, Value* first, Value* end,
                 const std::function<void(const Class&, Value* a, Value* b, Value* sums)>& body);
  llvm::GlobalVariable* offsets(const std::vector<std::size_t>& members);
  llvm::GlobalVariable* table(const std::vector<std::uint32_t>& values);
  void add_up_alone(int stage);
  static bool adds_late(const Class& c);
  Value* late_terms(const packed::Convolution& c, Value* sum);
  void begin_group();
  /// Of the stages s + 1 … s + 4, where s has that phase; `left_out`: 1 where stage s itself is not final yet.
  struct Group {
    int left_out, phase;
  };
  void add_up_group(const Class& c, const Group& group, Value* a, Value* b, Value* sums);
  void pass_on(int passed);
  void pass_on(const Class& c, int passed, int behind, Value* a, Value* b, Value* sums);
  /// The distance from which on a stage does not add what it reads itself.
  static int nearest(const Class& c) { return adds_late(c) ? 2 : 1; }

  // ------------------------------------------------------------------------------------------ later (rolled_later.cpp)
  bool has_later() const;
  void later();
  void later_stage(Value* stage, Value* end, Value* inverse, Value* tangent_row);

  // -------------------------------------------------------------------------------------- filling (rolled_filling.cpp)
  void choose_slots();
  void gap();
  void fill_next();
  void each_of(const Class& key, const std::vector<std::size_t>& members,
               const std::function<void(const Class&, Value* a, Value* b, Value* sums)>& body);
  void add_up_first();
  Value* sum_of_next(const Class& c, Value* a, Value* b);
  static Class class_of(const packed::Convolution& c) { return {c.lag, c.a_ahead, c.b_ahead}; }

  // ------------------------------------------------------------------------------------------------------------ values
  Value* load(Value* address) { return out_.b.CreateAlignedLoad(vector_, address, llvm::Align(8)); }
  void save(Value* value, Value* address) { out_.b.CreateAlignedStore(value, address, llvm::Align(8)); }
  Value* load_one(Value* address) { return out_.b.CreateAlignedLoad(out_.b.getDoubleTy(), address, llvm::Align(8)); }
  Value* at(Value* address, std::int64_t bytes) { return out_.at(address, bytes); }
  Value* slot_at(Value* row, Slot slot) { return at(row, 8 * std::int64_t{slot}); }
  /// Of a slot that may be passing.
  Value* place(Value* row, Slot slot) {
    return slot_at(passing_row_ && passing_[slot / packed::lanes] ? passing_row_ : row, slot);
  }
  Value* splat(Value* scalar) { return out_.splat(scalar, vector_); }
  /// A whole number, from a 64-bit integer, in all lanes.
  Value* real(Value* integer) { return splat(out_.b.CreateSIToFP(integer, out_.b.getDoubleTy())); }
  Value* stage_plus(int n) {
    return n == 0 ? stage_ : out_.b.CreateNSWAdd(stage_, out_.b.getInt64(static_cast<std::uint64_t>(n)));
  }
  /// x y + sum; a null sum is zero.
  Value* plus(Value* sum, Value* x, Value* y) { return sum ? out_.fma(x, y, sum) : out_.multiply(x, y); }
  Value* gather(Value* row, const std::array<Slot, packed::lanes>& slots, bool is_here = false);
  Value* row_of(Value* order);

  Emission& out_;
  const packed::PackedProgram& p_;
  const Program& program_;
  std::int64_t row_bytes_;
  llvm::Type* vector_;                // of packed::lanes doubles
  std::vector<std::size_t> sums_of_;  // [convolutions] places
  std::map<Class, std::vector<std::size_t>> classes_;
  std::vector<std::size_t> phase_;  // [convolutions] of `later`; else 0

  Value *arguments_ = nullptr, *rows_ = nullptr, *coefficients_ = nullptr, *sums_ = nullptr, *stage_ = nullptr;
  std::optional<int> written_;         // the stage, if it is known when the code is made
  std::vector<Value*> rows_of_stage_;  // from its own on, as many as functions of t alone are ahead
  std::array<Value*, packed::rolled_group> sums_of_stage_{};  // by phase
  /// (k + 1)(k + 2), 1 over it, and what rounding took from that
  Value *divisor_ = nullptr, *reciprocal_ = nullptr, *lack_ = nullptr;
  std::array<Value*, 3> correction_factors_{};  // by lag
  /// The last running sum: that of its own lanes, and what these add to (null: nothing).
  struct Scan {
    Slot out;
    std::size_t time;
    Value *sum, *carry;
  };

  std::map<Slot, Recent> recent_;  // by first slot
  std::map<Slot, Value*> final_;   // what a solution has corrected, by first slot or cell
  Scan scan_{no_slot, 0, nullptr, nullptr};
  std::vector<bool> passing_;     // [slots / 8] vectors that are read in the stage that makes them alone
  Value* passing_row_ = nullptr;  // where these stand; null where the rows are not those of orders
  struct Strand {
    Slot out;
    Value* sum;
  };
  std::vector<Strand> strands_;  // of a running sum in eight parts, in its order, before it is ended
  std::size_t time_ = 0;
  /// Of `later`: where sums for later stages stand.
  struct Filling {
    std::vector<std::map<Class, std::vector<std::size_t>>> slots;  // convolutions
    std::vector<std::size_t> last;                                 // [slots] the last convolution
    std::size_t gaps = 0, passed = 0, next = 0;  // places between packs, those behind us; the next slot
    std::size_t read = 0;                        // convolutions whose sums the stage has read
  };
  std::optional<Filling> filling_;
  Value* has_next_ = nullptr;  // whether another stage follows
};

}  // namespace maupertuis::llvm_backend
