#include "integrator/taylor/turns.hpp"

#include <cmath>

namespace maupertuis::taylor {
namespace {

/// 2π = high + low, exact to 2⁻¹⁰⁷.
constexpr double high = Turns::limit, low = 2.4492935982947064e-16;

/// q + 2π count.
Compensated turned(Compensated q, double count) {
  const double product = count * high;
  q.add(product);
  q.add(std::fma(count, high, -product) + count * low);
  return q;
}

}  // namespace

bool Turns::wind(std::span<Compensated> q) {
  bool far = false;  // hardly ever
  for (const Compensated& angle : q) far |= std::abs(angle.hi) > high;
  if (!far) return false;
  bool any = false;
  for (std::size_t i = 0; i < q.size(); ++i) any |= wind(i, q[i]);
  return any;
}

bool Turns::wind(std::size_t i, Compensated& q) {
  if (!(std::abs(q.hi) > high) || !winding_->coordinates[i]) return false;
  const double count = std::nearbyint(q.hi / high);
  q = turned(q, -count);
  counts_[i] += count;
  ++changes_;
  return true;
}

double Turns::unwound(std::size_t i, const Compensated& q) const {
  return counts_[i] == 0 ? q.hi : turned(q, counts_[i]).hi;
}

void Turns::add_to(std::span<double> observables) const {
  for (std::size_t k = 0; k < observables.size(); ++k) {
    double turns = 0;
    for (const TurnGain& gain : winding_->observables[k]) turns += gain.turns * counts_[gain.coordinate];
    if (turns != 0) observables[k] = turned({observables[k], 0}, turns).hi;
  }
}

}  // namespace maupertuis::taylor
