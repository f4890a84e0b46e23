#include "disks/residual_terms.hpp"

#include <cmath>
#include <map>
#include <tuple>

namespace maupertuis {

ResidualTerms::ResidualTerms(const Program& program) : program_(program), maker_(program.slots, -1) {
  for (const Run& run : program.runs[Dynamics])
    for (std::uint32_t i = run.first; i < run.last; ++i) maker_[program.instructions[i].out] = static_cast<int>(i);
  for (const Slot slot : program.residual) {
    if (slot != no_slot) add_parts(slot, 0);
    ends_.push_back(parts_.size());
  }
  std::map<std::tuple<Slot, Slot, std::uint32_t>, std::size_t> places;
  std::vector<Term> distinct;
  for (Part& part : parts_) {
    const Term& term = terms_[part.term];
    const auto [place, is_new] = places.try_emplace({term.a, term.b, term.shift}, distinct.size());
    if (is_new) distinct.push_back(term);
    part.term = place->second;
  }
  terms_ = std::move(distinct);
}

/// Sums of sums, as far as those are written out that a pack reads.
void ResidualTerms::add_parts(Slot slot, int depth) {
  constexpr int deepest = 2;
  const auto add = [this](Term term) {
    factors_.insert(factors_.end(), path_.begin(), path_.end());
    parts_.push_back({terms_.size(), factors_.size(), 1});
    terms_.push_back(term);
  };
  const Instruction* const i =
      maker_[slot] < 0 ? nullptr : &program_.instructions[static_cast<std::size_t>(maker_[slot])];
  if (!i || depth > deepest || (i->op != Op::Linear && i->op != Op::Products)) return add({slot, no_slot, 0});
  for (std::uint32_t t = i->first_term; t < i->last_term; ++t) {
    const maupertuis::Term& term = program_.terms[t];
    path_.push_back(term.coefficient);
    if (term.b == no_slot && term.shift == 0)
      add_parts(term.a, depth + 1);
    else
      add({term.a, term.b, term.shift});
    path_.pop_back();
  }
}

void ResidualTerms::set_constants(const double* constants) {
  std::size_t factor = 0;
  for (Part& part : parts_) {
    part.size = 1;
    for (; factor < part.factors_end; ++factor) part.size *= std::abs(constants[factors_[factor]]);
  }
}

void ResidualTerms::add_up(std::span<const double> bounds, std::span<double> rows) const {
  std::size_t at = 0;
  for (std::size_t j = 0; j < ends_.size(); ++j) {
    double sum = 0;
    for (; at < ends_[j]; ++at)
      if (parts_[at].size != 0) sum += parts_[at].size * bounds[parts_[at].term];
    rows[j] = sum;
  }
}

}  // namespace maupertuis
