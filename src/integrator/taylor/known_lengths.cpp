#include "integrator/taylor/known_lengths.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace maupertuis::taylor {
namespace {

constexpr std::size_t bin_count = 64;
/// Eight bins an octave, numbered from a radius of 1 on.
constexpr int an_octave = 8;
int key_of(double radius) {
  int exponent = 0;
  const double mantissa = std::frexp(radius, &exponent);  // ½ … 1
  return exponent * an_octave + static_cast<int>((mantissa - 0.5) * 2 * an_octave);
}
double upper_end(int key) {
  const int place = (key % an_octave + an_octave) % an_octave;
  return std::ldexp(0.5 + 0.5 * (place + 1) / an_octave, (key - place) / an_octave);
}

std::size_t place_of(int key) { return static_cast<unsigned>(key) % bin_count; }

/// Of a limit beyond the size that was met, by the generosity of the bin: 2 beyond the largest of all coordinates,
/// below beyond its own.
constexpr double widenings[] = {1.8, 6, 3}, widening_anew = 1.1;
constexpr int beyond_all = 2;
constexpr double observed_margin = 0.1;  // of its own size
/// A sine is as small as its angle; beyond this, the angle does not matter.
constexpr double small_angle = 0.3, no_limit = 1e300;
/// A bin that goes on meeting larger motions learns of them ever more seldom.
constexpr unsigned patience = 8;

}  // namespace

KnownLengths::KnownLengths(const Program& program, std::span<const int> degrees, double ratio, bool for_several)
    : envelope_(program, degrees),
      unknowns_(program.unknowns),
      residuals_(program.residual.size()),
      constant_count_(program.constants.size()),
      padded_((program.unknowns + 7) / 8 * 8),
      ratio_(ratio),
      for_several_(for_several),
      bins_(bin_count),
      sizes_(3 * padded_) {}

bool KnownLengths::belongs_to(const double* constants) const {
  constexpr double rounding = 1e-9;  // bounds are no sharper than this
  if (constants_.size() != constant_count_) return false;
  for (std::size_t i = 0; i < constant_count_; ++i)
    if (!(std::abs(constants[i] - constants_[i]) <= rounding * std::abs(constants_[i]))) return false;
  return true;
}

void KnownLengths::adopt(const double* constants) {
  if (belongs_to(constants)) return;
  constants_.assign(constants, constants + constant_count_);
  forget();
}

void KnownLengths::forget() {
  for (Bin& bin : bins_) bin.key = no_key;
}

double KnownLengths::disk_radius(double h) const { return upper_end(key_of(ratio_ * h)); }

KnownLengths::Bin& KnownLengths::bin_of(double radius) {
  const int key = key_of(radius);
  Bin& bin = bins_[place_of(key)];
  if (bin.key != key) begin(bin, key);
  return bin;
}

/// The radius of a bin is its upper end. It begins with the limits of a neighbour.
void KnownLengths::begin(Bin& bin, int key) const {
  const std::size_t orders = static_cast<std::size_t>(now_.order) + 2, observed = envelope_.observed().size();
  bin = {.key = key,
         .radius = upper_end(key),
         .weights = std::vector<double>(3 * orders),
         .limits = std::vector<double>(4 * padded_),
         .least = std::vector<double>(observed),
         .most = std::vector<double>(observed),
         .needed = std::vector<double>(residuals_)};
  double power = 1;  // r^{k−1}
  for (std::size_t k = 1; k < orders; ++k, power *= bin.radius) {
    const double n = static_cast<double>(k);
    bin.weights[k] = power * bin.radius;
    bin.weights[orders + k] = n * power;
    bin.weights[2 * orders + k] = n * (n - 1) * (power / bin.radius);
  }
  for (const int next : {key + 1, key - 1}) {
    const Bin& other = bins_[place_of(next)];
    if (other.key != next || !other.holds) continue;
    bin.limits = other.limits, bin.least = other.least, bin.most = other.most, bin.time = other.time;
    bin.has_limits = true;
    return;
  }
}

KnownLengths::Answer KnownLengths::ask(const SlotCoefficients& coefficients, double time, double h,
                                       std::span<const double> allowed, const double* sizes) {
  now_ = coefficients;
  given_ = sizes;
  has_sizes_ = false;
  bin_ = nullptr;
  if (coefficients.unit != 1 || (coefficients.step != 1 && !sizes)) return Answer::GivenUp;
  time_ = std::abs(time);
  Bin& bin = bin_of(ratio_ * h);
  ++bin.visits;
  bin_ = &bin;
  has_sizes_ = false;
  const bool may_learn = bin.visits > bin.next_try;
  if (!bin.holds && !may_learn) return Answer::GivenUp;
  find_sizes();
  const bool is_safe = bin.holds && is_within(bin) && meets(bin, allowed);
  return is_safe ? Answer::Safe : may_learn ? Answer::Unknown : Answer::GivenUp;
}

bool KnownLengths::meets(const Bin& bin, std::span<const double> allowed) const {
  bool meets = true;
  for (std::size_t j = 0; j < residuals_; ++j) meets &= bin.needed[j] <= allowed[j];
  return meets;
}

void KnownLengths::find_sizes() {
  if (std::exchange(has_sizes_, true)) return;
  if (!given_)
    return polynomial_sizes(now_.rows, now_.stride, unknowns_, now_.order + 1, bin_->weights.data(), sizes_.data());
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t i = 0; i < unknowns_; ++i) sizes_[row * padded_ + i] = given_[(row * unknowns_ + i) * now_.step];
}

void KnownLengths::bound(Limits limits) {
  Bin& bin = *bin_;
  find_sizes();
  widen(bin, bin.has_limits ? limits : std::max(limits, Limits::Anew));
  const auto row = [&](std::size_t i) { return std::span(bin.limits).subspan(i * padded_, unknowns_); };
  envelope_.evaluate(constants_.data(), {row(0), row(1), row(2), row(3), bin.least, bin.most, bin.time}, bin.radius,
                     now_.order);
}

bool KnownLengths::accept(std::span<const double> allowed, std::span<const double> by_rounding) {
  const double x = 1 / ratio_, left_out = length() * std::pow(x, now_.order) / (1 - x);
  bool holds = true, rounds = false;
  for (std::size_t j = 0; j < residuals_; ++j) {
    const double needed = left_out * envelope_.residual_tail(j);
    const bool by_momentum = needed <= allowed[j];
    bin_->needed[j] = by_momentum ? needed : 0;
    rounds = rounds || !by_momentum;
    holds = holds && (by_momentum || (!by_rounding.empty() && needed <= by_rounding[j]));
  }
  bin_->holds = holds && !(rounds && for_several_);
  if (!bin_->holds && bin_->generosity > 0) --bin_->generosity;
  if (bin_->holds) bin_->next_try = bin_->visits + ++bin_->learned / patience;
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
  for (std::size_t i = 0; i < observed.size(); ++i)
    within &= bin.least[i] <= centre(observed[i]) && centre(observed[i]) <= bin.most[i];
  return within;
}

void KnownLengths::widen(Bin& bin, Limits limits) const {
  const bool anew = limits != Limits::Widened;
  const double widened = limits == Limits::Widened ? widenings[bin.generosity]
                         : limits == Limits::Anew  ? widening_anew
                                                   : 1.0;
  const double margin = limits == Limits::Exact ? 0.0 : observed_margin;
  const auto raise = [&](double& limit, double size) {
    if (anew || !(size <= limit)) limit = widened * size;
  };
  bin.has_limits = true;
  raise(bin.time, envelope_.needs_time() ? time_ : no_limit);
  for (std::size_t i = 0; i < unknowns_; ++i) {
    const double size = std::abs(centre(i));
    raise(bin.limits[i], envelope_.needs_centre(i) ? size
                         : size < small_angle      ? (widened > 1 ? 2 * size : size)
                                                   : no_limit);
  }
  for (std::size_t row = 0; row < 3; ++row) {
    const double* const size = sizes_.data() + row * padded_;
    const double largest =
        limits == Limits::Widened && bin.generosity == beyond_all ? *std::max_element(size, size + unknowns_) : 0.0;
    for (std::size_t i = 0; i < unknowns_; ++i) raise(bin.limits[(row + 1) * padded_ + i], std::max(size[i], largest));
  }
  const std::span<const Slot> observed = envelope_.observed();
  for (std::size_t i = 0; i < observed.size(); ++i) {
    const double value = centre(observed[i]), beside = margin * std::abs(value);
    if (anew || !(bin.least[i] <= value)) bin.least[i] = value - beside;
    if (anew || !(value <= bin.most[i])) bin.most[i] = value + beside;
  }
}

}  // namespace maupertuis::taylor
