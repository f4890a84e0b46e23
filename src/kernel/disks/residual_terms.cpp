#include "kernel/disks/residual_terms.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {

ResidualTerms::ResidualTerms(const Program& program) : program_(program), maker_(program.slots, -1) {
  for (const Run& run : program.runs[Dynamics])
    for (std::uint32_t i = run.first; i < run.last; ++i) maker_[program.instructions[i].out] = static_cast<int>(i);
  for (const Slot slot : program.residual) {
    if (slot != no_slot) add_terms(slot, 0);
    ends_.push_back(terms_.size());
  }
  sizes_.assign(terms_.size(), 1.0);
  left_out_.assign(ends_.size(), 0.0);
}

/// Sums of sums, as far as those are written out that a pack reads.
void ResidualTerms::add_terms(Slot slot, int depth) {
  constexpr int deepest = 2;
  const auto add = [this](Term term) {
    terms_.push_back(term);
    factors_.insert(factors_.end(), path_.begin(), path_.end());
    factors_end_.push_back(factors_.size());
  };
  const Instruction* const i =
      maker_[slot] < 0 ? nullptr : &program_.instructions[static_cast<std::size_t>(maker_[slot])];
  if (!i || depth > deepest || (i->op != Op::Linear && i->op != Op::Products)) return add({slot, no_slot, 0});
  for (std::uint32_t t = i->first_term; t < i->last_term; ++t) {
    const maupertuis::Term& term = program_.terms[t];
    path_.push_back(term.coefficient);
    if (term.b == no_slot && term.shift == 0)
      add_terms(term.a, depth + 1);
    else
      add({term.a, term.b, term.shift});
    path_.pop_back();
  }
}

void ResidualTerms::set_constants(const double* constants) {
  std::size_t factor = 0;
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    double size = 1;
    for (; factor < factors_end_[t]; ++factor) size *= std::abs(constants[factors_[factor]]);
    sizes_[t] = size;
  }
}

void ResidualTerms::find_left_out(double h, int order, std::uint32_t without) {
  constexpr double most_of_radius = 0.5 * (1 + 1e-12);  // radii are products of roots of 2
  weights_.clear();
  for (std::size_t disk = 0; disk < radii_.size(); ++disk) {
    const double x = h / radii_[disk];
    const bool counts = x <= most_of_radius && (without >> disk & 1) == 0;
    weights_.push_back(counts ? std::pow(x, order) / (1 - x) : infinity);
  }
  std::size_t t = 0;
  for (std::size_t j = 0; j < ends_.size(); ++j) {
    double sum = 0;
    for (; t < ends_[j]; ++t) {
      double least = infinity;
      for (std::size_t disk = 0; disk < weights_.size(); ++disk) {
        // Nothing on a disk that ends too near says nothing of what lies farther on.
        const double tail = tails_[disk * terms_.size() + t];
        if (weights_[disk] < infinity) least = std::min(least, tail == 0 ? 0.0 : weights_[disk] * tail);
      }
      sum += least;
    }
    left_out_[j] = sum;
  }
}

}  // namespace maupertuis
