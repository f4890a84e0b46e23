#include "kernel/disks/least_modulus.hpp"
#include "kernel/disks/node.hpp"

#include <algorithm>
#include <cmath>

/// Distances: how near to 0 the known coefficients of w = r² take it, where bounds of x_i − x_j alone would let any two
/// bodies meet. Of what the rows leave out of w there is little: w is a sum of products u v of linear functions of q,
/// and where i + j > K, i or j is at least half of that, so that Σ_{k>K} |w_k| r^k ≤ U_u |v| + |u| U_v with the upper
/// halves U of the series of u and v.
namespace maupertuis {

/// What is divided by or raised to a power, has all its known orders in the rows and is of degree 2 at most in q.
void Disks::find_bases() {
  constexpr int more = 3;
  std::vector<int> degree(program_.slots, more);
  std::fill_n(degree.begin(), program_.unknowns, 1);
  if (program_.one != no_slot) degree[program_.one] = 0;
  is_base_.assign(program_.slots, 0);
  std::vector<bool> is_kept_from_zero(program_.slots, false);
  for (const Node& node : nodes_) {
    const Instruction& i = node.instruction;
    if (i.op == Op::Quotient) is_kept_from_zero[i.b] = true;
    if (i.op == Op::Power || i.op == Op::SquareRoot) is_kept_from_zero[i.a] = true;
    const bool is_sum = i.op == Op::Linear || i.op == Op::Products;
    int highest = is_sum ? 0 : i.op == Op::Square ? 2 * degree[i.a] : more;
    for (std::uint32_t t = i.first_term; is_sum && t < i.last_term; ++t) {
      const Term& term = terms_[t];
      const bool is_product = i.op == Op::Products && t >= i.first_product;
      highest = std::max(highest, term.shift > 0 ? more : degree[term.a] + (is_product ? degree[term.b] : 0));
    }
    degree[i.out] = std::min(highest, more);
  }
  // A product keeps from 0 what its factors keep from 0: w of 1/w⁶.
  for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) {
    const Instruction& i = node->instruction;
    if (!is_kept_from_zero[i.out]) continue;
    if (i.op == Op::Square) is_kept_from_zero[i.a] = true;
    if (i.op == Op::Products && i.first_product == i.first_term && i.last_term - i.first_term == 1)
      is_kept_from_zero[terms_[i.first_term].a] = is_kept_from_zero[terms_[i.first_term].b] = true;
  }
  for (const Node& node : nodes_) {
    const Instruction& i = node.instruction;
    if (!is_kept_from_zero[i.out] || !has_series_[i.out] || degree[i.out] == 0 || degree[i.out] == more) continue;
    is_base_[i.out] = 1;
    bases_.push_back(i.out);
  }
}

/// Of its terms up to the second, less all others.
double Disks::low_of_base(std::uint32_t slot) const {
  double rest = 0;
  for (int k = 3; k <= last_order(slot); ++k)
    rest += std::abs(coefficient(k, slot)) * powers_[static_cast<std::size_t>(k)];
  const double least =
      least_modulus(coefficient(0, slot), coefficient(1, slot), coefficient(2, slot), radius_ / now_.unit);
  return least > rest ? least - rest - beyond(slot) : 0;
}

/// What the rows leave out of a base; of a linear function, the upper half of its orders, which is more.
double Disks::beyond(std::uint32_t slot) const {
  if (slot < program_.unknowns) return upper_[slot];
  if (maker_[slot] < 0) return 0;
  const auto of_product = [this](std::uint32_t a, std::uint32_t b) {
    return beyond(a) * high_[b] + high_[a] * beyond(b);
  };
  const Instruction& i = nodes_[static_cast<std::size_t>(maker_[slot])].instruction;
  if (i.op == Op::Square) return of_product(i.a, i.a);
  double sum = 0;
  for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
    const Term& term = terms_[t];
    const bool is_product = i.op == Op::Products && t >= i.first_product;
    sum += term.size * (is_product ? of_product(term.a, term.b) : beyond(term.a));
  }
  return sum;
}

}  // namespace maupertuis
