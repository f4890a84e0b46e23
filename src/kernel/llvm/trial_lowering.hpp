#pragma once
#include "kernel/llvm/trial_line.hpp"
#include "kernel/packed/layout.hpp"

#include <bit>
#include <cmath>
#include <set>
#include <tuple>

namespace maupertuis::grouped {

inline std::uint32_t width_of(std::size_t count) { return static_cast<std::uint32_t>(std::bit_ceil(count)); }

class Lowering {
 public:
  Lowering(const packed::PackedProgram& program, std::size_t stride, int order);
  Line run();

 private:
  using Pack = packed::Pack;
  using Column = packed::Column;
  using Block = packed::Block;
  using Slots = std::vector<Slot>;
  using Directions = std::vector<int>;
  /// By direction; −1: of each lane its own, in `direction`.
  struct Tangent {
    Directions direction;
    std::map<int, Node> of, a, b;  // ∂/∂q̈ of the leading order, and one order behind
  };
  enum Part { Leading, A, B };

  std::size_t index_of(const Pack& pack) const { return static_cast<std::size_t>(&pack - p_.packs.data()); }
  std::size_t cell(int order, Slot slot) const { return static_cast<std::size_t>(order) * stride_ + slot; }
  int current(Slot slot) const { return stage_ + 2 - p_.program.lags[slot]; }
  bool passes(Slot slot, int shift, int lag) const { return p_.program.tangent_lags[slot] + shift == lag; }
  bool is_moved(const Pack& pack) const { return p_.program.tangent_lags[pack.out] != Program::unmoved; }
  bool is_corrected(Slot slot) const {
    return !follows_ && slot < p_.program.stored_end[2] && p_.program.tangent_lags[slot] != Program::unmoved;
  }
  bool looks_ahead(int stage) const { return stage >= 2 && look_ahead_; }

  void find_awaited();
  Slots read_at_once(const Pack& pack) const;
  bool can_look_ahead() const;
  void begin(int stage);

  Number at(Slot slot, int order);
  Node gather(const Slots& slots, int order, std::uint32_t w);
  static Slots slots_of(const Block& b) { return {b.slots.begin(), b.slots.begin() + b.width}; }
  static Slots sources_of(const Column& c, std::uint32_t width) {
    if (c.kind == Column::Broadcast) return Slots(width, c.source);
    return {c.sources.begin(), c.sources.begin() + width};
  }
  Node coefficients(std::uint32_t first, std::uint32_t w);
  Node number(double x, Node like) { return line_.literal(x, line_.width(like)); }
  Node scaled(Node x, double factor) { return line_.product(x, number(factor, x)); }
  Node over(Node x, double d, Node c);
  Node over(Node x, double d) { return over(x, d, number(1, x)); }
  Node dot(const std::vector<Term>& terms);
  Node operand(std::uint32_t block, int order, std::uint32_t w);
  Node at_zero(std::uint32_t block, std::uint32_t w) { return gather(slots_of(p_.blocks[block]), 0, w); }
  Node range(Slot first, int order, std::uint32_t w);
  template <class F, class G>
  Node convolution(F&& a, G&& b, int first, int k);

  void keep(Slot out, std::uint32_t width, Node v);
  void dynamics(const Pack& pack);
  Node sum(const Pack& pack, std::uint32_t w);
  void shifted(const Pack& pack, std::uint8_t shift, std::uint32_t w, Node& result);
  Node rates(const Slots& slots, std::uint8_t shift, std::uint32_t w);
  Node products(const Pack& pack, std::uint32_t w, Node result);
  std::uint32_t merged_width(const Pack& pack) const;
  Node self(std::uint32_t block, int first, std::uint32_t w);
  void integral(const Pack& pack, std::uint32_t w);
  void functions(const Pack& pack, std::uint32_t w);

  Number tangent_at(Part part, Slot slot, int d);
  Node tangents_of(Part part, const Slots& slots, const Directions& d, std::uint32_t w);
  void tangent(const Pack& pack);
  void second_tangents(const Pack& pack);
  struct Source { Slots slots; Node factor; };
  std::vector<Source> sources(const Pack& pack);
  void factor();
  std::vector<Node> inverse(std::vector<Node> rows);
  void solve();
  void correct();
  void correct(const Pack& pack);
  Node acceleration(Node of, const Tangent& t, int d, std::uint32_t w);

  const packed::PackedProgram& p_;
  std::size_t stride_;
  int order_, stage_ = 0, k_ = 0;
  std::uint32_t n_, wide_;
  Line line_;
  std::vector<const Pack*> pack_of_;
  std::vector<bool> awaited_;
  bool follows_ = false, look_ahead_ = false;
  std::map<std::pair<Slot, int>, Number> final_, early_;
  std::map<std::tuple<std::uint32_t, int, bool>, Node> operands_;
  std::map<std::pair<Slot, int>, Node> rates_;
  std::map<Slot, Number> seconds_;
  std::vector<Tangent> tangents_;
  std::vector<Node> inverse_columns_, ahead_a_, ahead_b_;
  std::map<int, Node> accelerations_, coordinates_;
  Node check_ = none;
};

}  // namespace maupertuis::grouped
