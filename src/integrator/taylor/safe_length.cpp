#include "integrator/taylor/safe_length.hpp"

#include "disks/whole_power.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::taylor {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Of a radius: beyond, Cauchy's estimate says little, and tails of derivatives are bounded up to here.
constexpr double most_of_radius = 0.5;
constexpr double from_disk_to_disk = 1.4142135623730951;
/// Below it a momentum is that of rest, whatever its unit.
constexpr double rest = 1e-40;
constexpr int most_disks = 400;
/// The rules alone are tried again after so many steps that needed coefficients; momenta are found anew after so many.
constexpr unsigned period = 32, period_of_momenta = 256;

/// Down to 8 bits, so that rounding of bounds does not decide on the last digits of a motion.
double rounded_down(double h) {
  int exponent = 0;
  const double mantissa = std::frexp(h, &exponent);
  return std::ldexp(std::floor(mantissa * 256) / 256, exponent);
}

/// The ratio of a disk's radius to the length of a step with which x^p is far below the tolerance: 5.8 at order 20 and
/// rounding level.
double usual_ratio(int order, double tolerance) {
  return std::clamp(std::pow(4e3 / tolerance, 1.0 / order), 2.0, 16.0);
}

/// The largest ratio that is asked about: 8, or √2 beyond the usual one at least. Smaller ones are √2 apart.
double largest_ratio(double usual) {
  double ratio = 8;
  while (ratio < from_disk_to_disk * usual) ratio *= from_disk_to_disk;
  return ratio;
}

}  // namespace

SafeLength::SafeLength(const Program& program, int order, double tolerance, std::shared_ptr<KnownLengths> shared)
    : disks_(program),
      usual_ratio_(usual_ratio(order, tolerance)),
      own_(program, disks_.degrees(), usual_ratio_, shared != nullptr),
      shared_(std::move(shared)),
      allowed_(disks_.residuals()),
      tolerance_(tolerance),
      order_(order),
      largest_ratio_(largest_ratio(usual_ratio_)),
      ratio_(largest_ratio_ / from_disk_to_disk) {
  for (double ratio = largest_ratio_; most_of_radius * ratio > 0.999; ratio /= from_disk_to_disk)
    all_ratios_.push_back(ratio);
  const auto last = static_cast<double>(ratios_.size() - 1);
  for (std::size_t i = 0; i < ratios_.size(); ++i)
    ratios_[i] = std::pow(most_of_radius * largest_ratio_, 1 - static_cast<double>(i) / last) / most_of_radius;
}

std::shared_ptr<KnownLengths> SafeLength::shared_by_motions(const Program& program, int order, double tolerance) {
  return std::make_shared<KnownLengths>(program, Disks(program).degrees(), usual_ratio(order, tolerance), true);
}

void SafeLength::forget() {
  masses_.clear();
  momenta_.clear();
  momentum_rates_.clear();
  asked_ = asked_momenta_ = 0;
  needs_coefficients_ = false;
  ratio_ = largest_ratio_ / from_disk_to_disk;
  own_.forget();
  allow();
  best_radius_ = radius_ = 0;
}

void SafeLength::set_constants(const double* constants) {
  disks_.set_constants(constants);
  if (shared_ && !shared_->has_constants()) shared_->adopt(constants);
  uses_shared_ = shared_ && shared_->belongs_to(constants);
  if (!uses_shared_) own_.adopt(constants);
}

void SafeLength::allow() {
  for (std::size_t j = 0; j < allowed_.size(); ++j) allowed_[j] = tolerance_ * momentum(j);
}

bool SafeLength::wants_momenta(std::span<const double> rates) {
  constexpr std::size_t most = 300;  // unknowns: M costs n²
  constexpr std::size_t usual = 16;
  constexpr double grown = 3;
  if (rates.size() > most) return false;
  if (masses_.empty() || ++asked_momenta_ % (period_of_momenta * (1 + rates.size() / usual)) == 0) return true;
  bool grows = false;
  for (std::size_t i = 0; i < rates.size(); ++i) grows |= rates[i] > grown * momentum_rates_[i];
  if (grows) find_momenta(rates);
  return false;
}

void SafeLength::find_momenta(std::span<const double> rates) {
  const std::size_t n = rates.size();
  momentum_rates_.assign(rates.begin(), rates.end());
  momenta_.resize(n, 0.0);
  for (std::size_t j = 0; j < n; ++j) {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += masses_[j * n + k] * rates[k];
    momenta_[j] = std::max(momenta_[j], sum);
  }
  allow();
}

double SafeLength::momentum(std::size_t j) const { return j < momenta_.size() ? std::max(momenta_[j], rest) : rest; }

/// Whether the tails at this radius allow a step of length h.
bool SafeLength::passes(double h) {
  const double x = h / radius_;
  if (!(x <= most_of_radius)) return false;
  const double left_out = whole_power(x, order_) / (1 - x);
  for (std::size_t j = 0; j < disks_.residuals(); ++j) {
    const double tail = left_out * disks_.residual_tail(j);
    if (!(h * tail <= tolerance_ * momentum(j)) && !(tail <= tolerance_ * disks_.residual_rounding(j, radius_)))
      return false;
  }
  return true;
}

/// Whether the many disks of this step allow a length h, each term by the one that suits it.
bool SafeLength::passes_by_terms(double h) {
  disks_.find_left_out(h);
  for (std::size_t j = 0; j < disks_.residuals(); ++j) {
    const double tail = disks_.residual_left_out(j);
    if (!(h * tail <= tolerance_ * momentum(j)) && !(tail <= tolerance_ * disks_.residual_rounding(j, radius_)))
      return false;
  }
  return true;
}

bool SafeLength::passes_on(double radius, double h, Disks::Depth depth) {
  radius_ = radius;
  disks_.evaluate(radius, depth);
  return passes(h);
}

/// The largest h that the tails at this radius allow; by logarithms, since with a hundred digits quotients leave the
/// range of double.
double SafeLength::allowed() {
  double log2_x = std::log2(most_of_radius);
  for (std::size_t j = 0; j < disks_.residuals(); ++j) {
    const double tail = disks_.residual_tail(j);
    if (!(tail < infinity)) return 0;
    if (tail == 0) continue;
    const double log2_allowed = std::log2(tolerance_) + std::log2(1 - most_of_radius) - std::log2(tail);
    const double by_momentum = (log2_allowed + std::log2(momentum(j)) - std::log2(radius_)) / (order_ + 1);
    const double by_rounding = (log2_allowed + std::log2(disks_.residual_rounding(j, radius_))) / order_;
    log2_x = std::min(log2_x, std::max(by_momentum, by_rounding));
  }
  return std::exp2(log2_x) * radius_;
}

/// Whether the coefficients allow h on any of the disks from the largest radius on. This and the bound of the step
/// alone decide; all else is a short cut to them.
bool SafeLength::passes_somewhere(const SlotCoefficients& coefficients, double h) {
  disks_.begin(coefficients);
  for (const double ratio : all_ratios_)
    if (passes_on(ratio * h, h, Disks::Depth::Coefficients)) return ratio_ = ratio, needs_coefficients_ = true;
  return false;
}

/// The largest length that is allowed, from large disks to small ones, until no smaller one can allow more.
double SafeLength::search(const SlotCoefficients& coefficients, double most) {
  disks_.begin(coefficients);
  double radius = best_radius_ > 0 ? std::min(largest_ratio_ * most, 4 * best_radius_) : largest_ratio_ * most,
         best = 0;
  for (int i = 0; i < most_disks && most_of_radius * radius > best; ++i, radius /= from_disk_to_disk) {
    radius_ = radius;
    disks_.evaluate(radius);
    if (const double h = allowed(); h > best) best = h, best_radius_ = radius;
    if (best >= most) break;
  }
  return best;
}

/// Whether an envelope of this step and no other allows it.
bool SafeLength::is_safe_alone(const SlotCoefficients& coefficients) {
  if (!known().has_asked()) return false;
  known().bound(KnownLengths::Limits::Exact);
  return known().accept(allowed_, allowed_by_rounding(coefficients));
}

/// By what was learned of motions of these sizes: first by the momenta, then by the rounding of R here.
bool SafeLength::is_known(const SlotCoefficients& coefficients, double time, double h, const double* sizes) {
  using enum KnownLengths::Answer;
  using enum KnownLengths::Limits;
  const KnownLengths::Answer answer = known().ask(coefficients, time, h, allowed_, sizes);
  if (answer != Unknown) return answer == Safe;
  known().bound(Widened);
  if (known().accept(allowed_)) return true;
  const std::span<const double> by_rounding = allowed_by_rounding(coefficients);
  if (known().accept(allowed_, by_rounding)) return true;
  known().bound(Anew);
  if (known().accept(allowed_, by_rounding)) return true;
  known().give_up();
  return false;
}

std::span<const double> SafeLength::allowed_by_rounding(const SlotCoefficients& coefficients) {
  disks_.begin(coefficients);
  allowed_by_rounding_.resize(allowed_.size());
  for (std::size_t j = 0; j < allowed_.size(); ++j)
    allowed_by_rounding_[j] = known().length() * tolerance_ * disks_.residual_rounding(j, known().radius());
  return allowed_by_rounding_;
}

/// Between a length that passes and one that may not, by all disks that were asked; to a fiftieth.
double SafeLength::passing_length(double passes_at, double most) {
  constexpr double near = 1.02;
  for (double low = passes_at > 0 ? passes_at : most / 1024, high = most; high > near * low;) {
    const double middle = std::sqrt(low * high);
    if (passes_by_terms(middle))
      passes_at = low = middle;
    else
      high = middle;
  }
  return passes_at;
}

/// Limits of the sizes of many bodies would be left again and again, and some disks say as much of a step. Where they
/// do not allow h, they mostly allow a little less. 0: far less, or they say nothing, as where a square is beyond the
/// range of numbers.
double SafeLength::within_bases(const SlotCoefficients& coefficients, double h) {
  constexpr double little_less = 0.9, less = 0.5;
  std::array<double, Disks::many> radii;
  for (std::size_t i = 0; i < radii.size(); ++i) radii[i] = ratios_[i] * h;
  radius_ = radii.front();
  disks_.begin_many(coefficients, radii);
  while (disks_.ask_more())
    if (passes_by_terms(h)) return h;
  if (passes_by_terms(little_less * h)) return passing_length(little_less * h, h);
  const double length = passing_length(0, little_less * h);
  return length > less * h ? length : 0;
}

double SafeLength::within(const SlotCoefficients& coefficients, double time, double wanted, double most,
                          const double* sizes) {
  if (!is_needed()) return wanted;
  const double h = std::min(wanted, most);
  if (!(h > 0)) return wanted;
  if (disks_.has_bases())
    if (const double length = within_bases(coefficients, h); length > 0)
      return length < h ? rounded_down(length) : wanted;
  if (is_known(coefficients, time, h, sizes)) return wanted;
  // What was right in the last step is asked first: the whole length by the rules, or with the coefficients where those
  // have to help.
  using enum Disks::Depth;
  disks_.begin(coefficients);
  const double radius = ratio_ * h;
  const bool by_rules = !needs_coefficients_ || ++asked_ % period == 0;
  if (by_rules) {
    if (disks_.needs_larger_disk()) disks_.evaluate(from_disk_to_disk * radius, Derivatives);
    if (passes_on(radius, h, Rules)) return needs_coefficients_ = false, wanted;
    disks_.begin(coefficients);
  }
  if (passes_on(from_disk_to_disk * radius, h, Coefficients) || passes_on(radius, h, Coefficients))
    return needs_coefficients_ = true, wanted;
  if (passes_somewhere(coefficients, h)) return wanted;
  if (is_safe_alone(coefficients)) return wanted;
  return rounded_down(search(coefficients, h));
}

}  // namespace maupertuis::taylor
