#include "integrator/taylor/known_lengths.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace maupertuis::taylor {
namespace {

constexpr std::size_t bin_count = 64;
/// Eight bins an octave: the three leading bits of the mantissa.
constexpr int dropped_bits = 49;
/// Of a limit beyond the size that was met; of what is observed, of its own size.
constexpr double widening = 1.8, widening_anew = 1.1, margin = 0.1;
/// A sine is as small as its angle; beyond this, the angle does not matter.
constexpr double small_angle = 0.3, no_limit = 1e300;
/// A bin that goes on meeting larger motions learns of them ever more seldom.
constexpr unsigned patience = 8;

}  // namespace

KnownLengths::KnownLengths(const Program& program, std::span<const int> degrees, double ratio)
    : envelope_(program, degrees), unknowns_(program.unknowns), residuals_(program.residual.size()), padded_((program.unknowns + 7) / 8 * 8), ratio_(ratio),
      bins_(bin_count), sizes_(3 * padded_) {}

void KnownLengths::forget() {
  for (Bin& bin : bins_) bin.key = ~std::uint64_t{0};
}

KnownLengths::Bin& KnownLengths::bin_of(double radius) {
  const std::uint64_t key = std::bit_cast<std::uint64_t>(radius) >> dropped_bits;
  Bin& bin = bins_[key % bin_count];
  if (bin.key != key) begin(bin, key);
  return bin;
}

/// The radius of a bin is its upper end. It begins with the limits of a neighbour.
void KnownLengths::begin(Bin& bin, std::uint64_t key) const {
  const std::size_t orders = static_cast<std::size_t>(order_) + 2, observed = envelope_.observed().size();
  bin = {.key = key, .radius = std::bit_cast<double>((key + 1) << dropped_bits), .weights = std::vector<double>(3 * orders),
         .limits = std::vector<double>(4 * padded_), .least = std::vector<double>(observed), .most = std::vector<double>(observed)};
  double power = 1;  // r^{k−1}
  for (std::size_t k = 1; k < orders; ++k, power *= bin.radius) {
    const double n = static_cast<double>(k);
    bin.weights[k] = power * bin.radius;
    bin.weights[orders + k] = n * power;
    bin.weights[2 * orders + k] = n * (n - 1) * (power / bin.radius);
  }
  for (const std::uint64_t next : {key + 1, key - 1}) {
    const Bin& other = bins_[next % bin_count];
    if (other.key != next || !other.holds) continue;
    bin.limits = other.limits, bin.least = other.least, bin.most = other.most, bin.time = other.time;
    bin.has_limits = true;
    return;
  }
}

KnownLengths::Answer KnownLengths::ask(const SlotCoefficients& coefficients, double time, double h) {
  if (coefficients.unit != 1) return Answer::GivenUp;
  order_ = coefficients.order;
  centre_ = coefficients.rows;
  step_ = coefficients.step;
  time_ = std::abs(time);
  Bin& bin = bin_of(ratio_ * h);
  bin_ = &bin;
  ++bin.visits;
  const bool may_learn = bin.visits > bin.next_try;
  if (!bin.holds && !may_learn) return Answer::GivenUp;
  const bool is_alone = step_ == 1;
  polynomial_sizes(is_alone ? coefficients.rows : side_by_side(coefficients), is_alone ? coefficients.stride : padded_, unknowns_, order_ + 1, bin.weights.data(),
                   sizes_.data());
  return bin.holds && is_within(bin) ? Answer::Safe : may_learn ? Answer::Unknown : Answer::GivenUp;
}

/// The coordinates of a motion that stands in a lane among others.
const double* KnownLengths::side_by_side(const SlotCoefficients& coefficients) {
  const std::size_t orders = static_cast<std::size_t>(order_) + 2;
  gathered_.resize(orders * padded_);
  for (std::size_t k = 0; k < orders; ++k) {
    const double* const row = coefficients.rows + k * coefficients.stride;
    double* const to = gathered_.data() + k * padded_;
    for (std::size_t i = 0; i < unknowns_; ++i) to[i] = row[i * step_];
  }
  return gathered_.data();
}

void KnownLengths::bound(const double* constants, bool anew) {
  Bin& bin = *bin_;
  widen(bin, anew || !bin.has_limits, anew ? widening_anew : widening);
  const auto row = [&](std::size_t i) { return std::span(bin.limits).subspan(i * padded_, unknowns_); };
  envelope_.evaluate(constants, {row(0), row(1), row(2), row(3), bin.least, bin.most, bin.time}, bin.radius, order_);
}

bool KnownLengths::accept(std::span<const double> allowed) {
  const double x = 1 / ratio_, left_out = length() * std::pow(x, order_) / (1 - x);
  bool holds = true;
  for (std::size_t j = 0; j < residuals_; ++j) holds = holds && left_out * envelope_.residual_tail(j) <= allowed[j];
  bin_->holds = holds;
  if (holds) bin_->next_try = bin_->visits + ++bin_->learned / patience;
  return holds;
}

void KnownLengths::give_up() { bin_->next_try = 2 * bin_->visits + 8; }

bool KnownLengths::is_within(const Bin& bin) const {
  const double *const limit = bin.limits.data(), *const size = sizes_.data();
  bool within = !envelope_.needs_time() || time_ <= bin.time;
  for (std::size_t i = 0; i < unknowns_; ++i) {
    within &= std::abs(centre(i)) <= limit[i];
    for (std::size_t row = 0; row < 3; ++row) within &= size[row * padded_ + i] <= limit[(row + 1) * padded_ + i];
  }
  const std::span<const Slot> observed = envelope_.observed();
  for (std::size_t i = 0; i < observed.size(); ++i) within &= bin.least[i] <= centre(observed[i]) && centre(observed[i]) <= bin.most[i];
  return within;
}

void KnownLengths::widen(Bin& bin, bool anew, double widened) const {
  const auto raise = [&](double& limit, double size) {
    if (anew || !(size <= limit)) limit = widened * size;
  };
  bin.has_limits = true;
  raise(bin.time, time_);
  for (std::size_t i = 0; i < unknowns_; ++i) {
    const double size = std::abs(centre(i));
    raise(bin.limits[i], envelope_.needs_centre(i) ? size : size < small_angle ? 2 * size : no_limit);
  }
  for (std::size_t i = 0; i < 3 * padded_; ++i) raise(bin.limits[padded_ + i], sizes_[i]);
  const std::span<const Slot> observed = envelope_.observed();
  for (std::size_t i = 0; i < observed.size(); ++i) {
    const double value = centre(observed[i]), beside = margin * std::abs(value);
    if (anew || !(bin.least[i] <= value)) bin.least[i] = value - beside;
    if (anew || !(value <= bin.most[i])) bin.most[i] = value + beside;
  }
}

}  // namespace maupertuis::taylor
