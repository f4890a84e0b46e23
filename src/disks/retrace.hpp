#pragma once
#include "kernel/reference/reference.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace maupertuis {

/// Values of a program along a motion that is known: the coordinates (and the multipliers) are polynomials in s, and
/// some slots are expanded about any s, by the interpreter's rules and without solving for anything. So a function that
/// varies faster than the motion is followed in pieces, while the step stays as long as it is.
template <class T>
class Retrace {
 public:
  /// `slots`: those that are wanted; what they do not need is not carried out. The program must outlive this.
  Retrace(const Program& program, int order, std::span<const Slot> slots)
      : program_(program),
        order_(order),
        memory_(program, order + 2 + (-2 - program.first_stage), program.slots),
        polynomials_((order + 2) * program.unknowns) {
    producer_.assign(program.slots, nullptr);
    for (const Instruction& i : program.instructions) producer_[i.out] = &i;
    for (const Section section : {Dynamics, Along})
      for (const Run& run : program.runs[section])
        for (std::uint32_t i = run.first; i < run.last; ++i) all_.push_back(i);
    wanted_.resize(program.slots);
    taken_.resize(program.instructions.size());
    want(slots);
    every_ = needed_;
  }

  /// From now on only these slots are carried out, and what they need. Cost: two looks at each instruction.
  void want(std::span<const Slot> slots) {
    std::fill(wanted_.begin(), wanted_.end(), false);
    std::fill(taken_.begin(), taken_.end(), false);
    for (const Slot slot : slots) wanted_[slot] = true;
    while (take_makers()) {
    }
    needed_.clear();
    for (const std::uint32_t index : all_)
      if (taken_[index]) needed_.push_back(index);
    moved_.clear();
    for (std::uint32_t i = 0; i < program_.unknowns; ++i)
      if (wanted_[i]) moved_.push_back(i);
  }

  /// [program.constants]
  void set_constants(const T* constants) {
    std::copy_n(constants, memory_.constants.size(), memory_.constants.begin());
  }
  /// Other sides of the switch functions, of the same parameters.
  void set_sides(std::span<const std::int8_t> sides) {
    std::vector<T> parameters(program_.parameters, T(0));
    for (std::size_t i = 0; i < program_.constants.size(); ++i)
      if (program_.constants[i].kind == Kind::Symbol) parameters[program_.constants[i].index] = memory_.constants[i];
    reference::compute_constants(memory_, std::span<const T>(parameters), sides);
  }
  /// q_p(s) = Σ_k row(k)[i] s^k for k ≤ order + 1, beginning at t + rest.
  template <class Row>
  void set_motion(const T& t, const T& rest, Row&& row) {
    t_ = t, rest_ = rest;
    for (int k = 0; k <= order_ + 1; ++k)
      std::copy_n(row(k), program_.unknowns, polynomials_.data() + static_cast<std::size_t>(k) * program_.unknowns);
  }
  /// All orders about s.
  void expand_about(const T& s) { run(needed_, s, order_, order_ + 1); }
  /// Values at s alone; without rates where nothing but coordinates is differentiated.
  void evaluate(const T& s, bool with_rates = true) { run(needed_, s, 1, 2, with_rates ? never : 0); }
  /// Values at s where coordinates are moved by a share of the sizes of their polynomials' terms there, all one way or
  /// by turns: what rounding of the motion makes of a value.
  void evaluate_beside(const T& s, const T& share, bool by_turns) {
    share_ = share, by_turns_ = by_turns;
    run(needed_, s, 1, 2, never);
    share_ = T(0);
  }
  /// Of all slots of the constructor, wanted now or not: orders up to `most`, those of the coordinates all.
  void values_about(const T& s, int most) { run(every_, s, std::min(most + 1, order_), order_ + 1, most); }

  int order() const { return order_; }
  const T* row(int k) const { return memory_.row(k); }
  const T* constants() const { return memory_.constants.data(); }
  std::size_t stride() const { return memory_.stride; }
  T scale(Slot slot) const { return reference::term_size(memory_, producer_[slot], slot); }

 private:
  /// Backwards from what is wanted. What a function's differential needs may stand behind it, hence the turns.
  bool take_makers() {
    bool changed = false;
    for (auto at = all_.rbegin(); at != all_.rend(); ++at) {
      const Instruction& i = program_.instructions[*at];
      if (taken_[*at] || !(wanted_[i.out] || (i.second != no_slot && wanted_[i.second]))) continue;
      taken_[*at] = changed = true;
      for (const Slot slot : {i.a, i.b})
        if (slot != no_slot) wanted_[slot] = true;
      for (std::uint32_t t = i.first_term; t < i.last_term; ++t)
        for (const Slot slot : {program_.terms[t].a, program_.terms[t].b})
          if (slot != no_slot) wanted_[slot] = true;
    }
    return changed;
  }

  static constexpr int never = std::numeric_limits<int>::max();
  void run(std::span<const std::uint32_t> instructions, const T& s, int stages, int last_of_coordinates,
           int most = never) {
    reference::set_leaves(memory_, T(t_ + (rest_ + s)), order_ + 2 + (-2 - program_.first_stage));
    shift(s, last_of_coordinates);
    if (most == 0) {  // each of them once: what stands before it is known
      for (const std::uint32_t index : instructions) reference::run_instruction(memory_, index, 0);
      return;
    }
    for (int stage = program_.first_stage; stage < stages; ++stage)
      for (const std::uint32_t index : instructions) {
        const int order = stage + 2 - program_.instructions[index].lag;
        if (order >= 0 && order <= most) reference::run_instruction(memory_, index, order);
      }
  }

  /// The polynomials about s, by repeated synthetic division, up to order `last`; those that nothing wanted is made of
  /// are left as they are.
  void shift(const T& s, int last) {
    const std::size_t n = program_.unknowns;
    const int degree = order_ + 1;
    if (s == T(0)) {
      for (int k = 0; k <= std::min(last, degree); ++k)
        std::copy_n(polynomials_.data() + static_cast<std::size_t>(k) * n, n, memory_.row(k));
      move_beside(s);
      return;
    }
    std::vector<T>& c = shifted_;
    c.resize(static_cast<std::size_t>(degree) + 1);
    for (const std::uint32_t i : moved_) {
      for (int k = 0; k <= degree; ++k)
        c[static_cast<std::size_t>(k)] = polynomials_[static_cast<std::size_t>(k) * n + i];
      for (int done = 0; done <= std::min(last, degree); ++done)
        for (int k = degree; k-- > done;) c[static_cast<std::size_t>(k)] += s * c[static_cast<std::size_t>(k) + 1];
      for (int k = 0; k <= std::min(last, degree); ++k) memory_.row(k)[i] = c[static_cast<std::size_t>(k)];
    }
    move_beside(s);
  }

  void move_beside(const T& s) {
    using std::abs;
    if (share_ == T(0)) return;
    for (const std::uint32_t i : moved_) {
      T size = T(0);
      for (int k = order_ + 2; k-- > 0;)
        size = size * abs(s) + abs(polynomials_[static_cast<std::size_t>(k) * program_.unknowns + i]);
      memory_.row(0)[i] += (by_turns_ && i % 2 != 0 ? -share_ : share_) * size;
    }
  }

  const Program& program_;
  T share_ = T(0);  // of evaluate_beside
  bool by_turns_ = false;
  int order_;
  reference::MemoryOf<T> memory_;
  std::vector<T> polynomials_;  // [order + 2][unknowns]
  std::vector<T> shifted_;      // scratch
  T t_ = T(0), rest_ = T(0);
  std::vector<std::uint32_t> all_, every_, needed_;  // instructions in order: all, for all slots, for those wanted
  std::vector<std::uint32_t> moved_;                 // coordinates that those wanted are made of
  std::vector<bool> wanted_, taken_;                 // [slots], [instructions]
  std::vector<const Instruction*> producer_;         // [slots]
};

}  // namespace maupertuis
