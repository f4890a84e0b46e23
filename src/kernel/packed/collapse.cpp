#include "kernel/packed/collapse.hpp"

#include <algorithm>
#include <map>

namespace maupertuis::packed {
namespace {

bool is_sum(const Step& step) { return step.head.op == Op::Linear || step.head.op == Op::Products; }

ConstantId literal(Program& program, double value) {
  program.constants.push_back({.kind = Kind::Number, .value = value});
  return static_cast<ConstantId>(program.constants.size() - 1);
}

class Collapse {
 public:
  Collapse(Program& program, std::vector<Step>& steps, std::size_t longest)
      : program_(program), steps_(steps), longest_(longest), sum_of_(program.slots, nullptr) {}

  void run() {
    for (Step& step : steps_) {
      if (!is_sum(step)) continue;
      if (step.chain >= 0) {
        join_terms(step);
        continue;
      }
      write_out(step);
      if (step.products.empty()) sum_of_[step.head.out] = &step;
    }
    drop_unread();
  }

  /// The coefficient of a product goes to those of a factor that is a sum and read nowhere else.
  void scale_factors() {
    const std::vector<bool> elsewhere = read_elsewhere();
    std::vector<std::uint32_t> readers(program_.slots, 0);
    for (const Step& step : steps_) for_operands(step, [&](Slot slot, int) { ++readers[slot]; });
    std::vector<Step*> sum_at(program_.slots, nullptr);
    for (Step& step : steps_)
      if (step.head.op == Op::Linear && step.chain < 0 && readers[step.head.out] == 1 && !elsewhere[step.head.out])
        sum_at[step.head.out] = &step;
    const ConstantId one = literal(program_, 1);
    for (Step& step : steps_) {
      if (!is_sum(step)) continue;
      for (Term& product : step.products) {
        Step* const factor = sum_at[product.a] ? sum_at[product.a] : sum_at[product.b];
        if (!factor || is_one(product.coefficient)) continue;
        for (Term& term : factor->linear) term.coefficient = multiply(product.coefficient, term.coefficient);
        product.coefficient = one;
      }
    }
  }

 private:
  /// Of a running sum what is added: one term an operand.
  void join_terms(Step& step) {
    Terms terms;
    for (std::size_t t = 1; t < step.linear.size(); ++t) add(terms, step.linear[t]);
    step.linear.resize(1);
    for (const auto& [place, coefficient] : terms)
      step.linear.push_back({coefficient, place.first, no_slot, place.second});
  }

  /// The smallest sums first, as long as there is room.
  void write_out(Step& step) {
    std::vector<const Term*> by_size;
    for (const Term& term : step.linear) by_size.push_back(&term);
    const auto size = [&](const Term* term) { return can_enter(*term) ? sum_of_[term->a]->linear.size() : 0; };
    std::stable_sort(by_size.begin(), by_size.end(), [&](const Term* x, const Term* y) { return size(x) < size(y); });
    Terms terms;
    std::size_t left = by_size.size();
    for (const Term* term : by_size) {
      --left;
      if (size(term) > 0 && terms.size() + size(term) + left <= longest_)
        for (const Term& inner : sum_of_[term->a]->linear)
          add(terms, {multiply(term->coefficient, inner.coefficient), inner.a, no_slot, inner.shift + term->shift});
      else
        add(terms, *term);
    }
    step.linear.clear();
    for (const auto& [place, coefficient] : terms)
      step.linear.push_back({coefficient, place.first, no_slot, place.second});
  }

  using Terms = std::map<std::pair<Slot, std::uint32_t>, ConstantId>;

  bool can_enter(const Term& term) const {
    const Step* const sum = sum_of_[term.a];
    if (!sum) return false;
    return std::all_of(sum->linear.begin(), sum->linear.end(),
                       [&](const Term& inner) { return inner.shift + term.shift <= Term::most_shift; });
  }

  void add(Terms& terms, const Term& term) {
    if (term.shift > 0 && term.a == program_.one) return;
    const auto [place, fresh] = terms.try_emplace({term.a, term.shift}, term.coefficient);
    if (!fresh) place->second = apply(Kind::Sum, place->second, term.coefficient);
  }

  bool is_one(ConstantId id) const {
    return program_.constants[id].kind == Kind::Number && program_.constants[id].value == 1;
  }

  ConstantId multiply(ConstantId x, ConstantId y) { return is_one(x) ? y : is_one(y) ? x : apply(Kind::Product, x, y); }

  ConstantId apply(Kind kind, ConstantId x, ConstantId y) {
    const auto [place, fresh] = made_.try_emplace({kind, x, y}, 0);
    if (!fresh) return place->second;
    const auto first = static_cast<std::uint32_t>(program_.constant_arguments.size());
    program_.constant_arguments.insert(program_.constant_arguments.end(), {x, y});
    program_.constants.push_back({.kind = kind, .first_argument = first, .arguments = 2});
    return place->second = static_cast<ConstantId>(program_.constants.size() - 1);
  }

  /// What is read besides by the operands of steps.
  std::vector<bool> read_elsewhere() const {
    std::vector<bool> read(program_.slots, false);
    const auto reads = [&](Slot slot) {
      if (slot != no_slot) read[slot] = true;
    };
    for (const auto* slots : {&program_.residual, &program_.constraint_values, &program_.constraint_rates,
                              &program_.switch_slots, &program_.events, &program_.observables, &program_.integrands})
      for (const Slot slot : *slots) reads(slot);
    for (const Section section : {Along, AtPoint})
      for (const Run& run : program_.runs[section])
        for (std::uint32_t i = run.first; i < run.last; ++i) {
          const Instruction& instruction = program_.instructions[i];
          reads(instruction.a), reads(instruction.b);
          for (std::uint32_t t = instruction.first_term; t < instruction.last_term; ++t)
            reads(program_.terms[t].a), reads(program_.terms[t].b);
        }
    // A Function reads the factors of its differential, which may come after it.
    for (const Step& step : steps_)
      if (step.head.op == Op::Function)
        for (const Term& term : step.products) reads(term.a);
    return read;
  }

  void drop_unread() {
    std::vector<bool> read = read_elsewhere();
    std::vector<Step> kept;
    for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
      const bool needed = !is_sum(*step) || read[step->head.out];
      if (!needed) continue;
      for_operands(*step, [&](Slot slot, int) { read[slot] = true; });
      kept.push_back(std::move(*step));
    }
    std::reverse(kept.begin(), kept.end());
    steps_ = std::move(kept);
  }

  Program& program_;
  std::vector<Step>& steps_;
  std::size_t longest_;
  std::vector<const Step*> sum_of_;  // [slots]
  std::map<std::tuple<Kind, ConstantId, ConstantId>, ConstantId> made_;
};

}  // namespace

std::vector<Step> dynamics_of(const Program& program) {
  std::vector<Step> steps;
  for (const Run& run : program.runs[Dynamics])
    for (std::uint32_t i = run.first; i < run.last; ++i) {
      Step step{program.instructions[i], {}, {}, -1};
      for (std::uint32_t t = step.head.first_term; t < step.head.last_term; ++t) {
        const Term& term = program.terms[t];
        (term.b == no_slot ? step.linear : step.products).push_back(term);
      }
      steps.push_back(std::move(step));
    }
  return steps;
}

void write_derivatives(Program& program, std::vector<Step>& steps) {
  const ConstantId one = literal(program, 1);
  for (Step& step : steps) {
    if (step.head.op != Op::Derivative) continue;
    step.linear = {{one, step.head.a, no_slot, 1}};
    step.head.op = Op::Linear;
    step.head.a = no_slot;
  }
}

void collapse_sums(Program& program, std::vector<Step>& steps, std::size_t longest) {
  Collapse(program, steps, longest).run();
}

void scale_factors(Program& program, std::vector<Step>& steps) { Collapse(program, steps, 0).scale_factors(); }

namespace {

class Chains {
 public:
  Chains(const Program& program, std::vector<Step>& steps)
      : program_(program),
        steps_(steps),
        sum_of_(program.slots, none),
        next_(steps.size(), none),
        before_(steps.size(), none) {}

  void find(std::size_t least, ConstantId zero) {
    for (std::size_t i = 0; i < steps_.size(); ++i)
      if (is_linear(steps_[i])) sum_of_[steps_[i].head.out] = i;
    // What is carried on itself comes first: the next joint of a chain, and not the centre of a rod, which is a sum of
    // the joint before as well.
    const std::vector<bool> is_carried_on = carried_on();
    for (const bool is_first : {true, false})
      for (std::size_t i = 0; i < steps_.size(); ++i)
        if (is_linear(steps_[i]) && is_carried_on[i] == is_first) link(i);
    int number = 0;
    for (std::size_t i = 0; i < steps_.size(); ++i)
      if (next_[i] != none && before_[i] == none) number += mark(i, number, least, zero);
  }

 private:
  static bool is_linear(const Step& step) {
    return step.head.op == Op::Linear && step.products.empty() && !step.linear.empty();
  }
  bool is_one(ConstantId id) const {
    return program_.constants[id].kind == Kind::Number && program_.constants[id].value == 1;
  }

  /// Whether sum i may carry on what stands in one of its terms.
  bool may_carry_on(std::size_t i, const Term& term) const {
    const std::size_t before = sum_of_[term.a];
    return before != none && before < i && term.shift == 0 && is_one(term.coefficient) &&
           steps_[before].head.lag == steps_[i].head.lag && steps_[i].linear.size() <= most_terms;
  }

  std::vector<bool> carried_on() const {
    std::vector<bool> out(steps_.size(), false);
    for (std::size_t i = 0; i < steps_.size(); ++i)
      if (is_linear(steps_[i]))
        for (const Term& term : steps_[i].linear)
          if (may_carry_on(i, term)) out[sum_of_[term.a]] = true;
    return out;
  }

  /// The one sum that this one carries on.
  void link(std::size_t i) {
    Step& step = steps_[i];
    for (Term& term : step.linear) {
      const std::size_t before = sum_of_[term.a];
      if (!may_carry_on(i, term) || next_[before] != none) continue;
      std::swap(term, step.linear.front());
      before_[i] = before, next_[before] = i;
      return;
    }
  }

  /// Members from the first on, as long as what is added does not depend on the members before. The first one adds to
  /// nothing: to the leaf 1 times 0, if there is one.
  bool mark(std::size_t first, int number, std::size_t least, ConstantId zero) {
    std::vector<std::size_t> members{first};
    std::vector<bool> depends(program_.slots, false);
    depends[steps_[first].head.out] = true;
    std::size_t at = first + 1;
    for (std::size_t i = next_[first]; i != none; i = next_[i]) {
      for (; at < i; ++at) spread(at, depends);
      if (adds_dependent(steps_[i], depends)) break;
      members.push_back(i);
      depends[steps_[i].head.out] = true;
      ++at;
    }
    if (members.size() <= least || program_.one == no_slot) return false;
    steps_[first].linear.insert(steps_[first].linear.begin(), {zero, program_.one});
    for (const std::size_t i : members) steps_[i].chain = number;
    return true;
  }

  void spread(std::size_t i, std::vector<bool>& depends) const {
    const Step& step = steps_[i];
    bool any = false;
    for_operands(step, [&](Slot slot, int) { any = any || depends[slot]; });
    if (!any) return;
    depends[step.head.out] = true;
    if (step.head.second != no_slot) depends[step.head.second] = true;
  }
  static bool adds_dependent(const Step& step, const std::vector<bool>& depends) {
    return std::any_of(step.linear.begin() + 1, step.linear.end(), [&](const Term& term) { return depends[term.a]; });
  }

  static constexpr std::size_t none = ~std::size_t{0}, most_terms = 6;
  const Program& program_;
  std::vector<Step>& steps_;
  std::vector<std::size_t> sum_of_, next_, before_;
};

}  // namespace

void find_chains(Program& program, std::vector<Step>& steps, std::size_t least) {
  Chains(program, steps).find(least, literal(program, 0));
}

bool has_no_choices(const Program& program) {
  return std::none_of(program.instructions.begin(), program.instructions.end(),
                      [](const Instruction& i) { return i.op == Op::Select; });
}

}  // namespace maupertuis::packed
