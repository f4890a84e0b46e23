#include "plot/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace maupertuis {
namespace {

constexpr double largest = 1e305;  // leaves room for sums and padding

int decade(double value) { return static_cast<int>(std::floor(std::log10(value))); }

// The smallest of 1, 2, 5 times a power of ten, or of the customary steps of degrees, that is not below `wanted`.
double nice_step(double wanted, bool degrees) {
  if (degrees)
    for (const double step : {10., 15., 30., 45., 90., 180., 360.})
      if (wanted > 5 && step >= wanted) return step;
  const double power = std::pow(10.0, decade(wanted));
  for (const double factor : {1., 2., 5.})
    if (factor * power >= wanted * (1 - 1e-12)) return factor * power;
  return 10 * power;
}

std::string with_minus(std::string number) {
  if (!number.empty() && number[0] == '-') number.replace(0, 1, "−");
  return number;
}

// A series that is constant up to rounding gets room around it.
void widen(double& low, double& high) {
  const double size = std::max(std::abs(low), std::abs(high));
  if (high - low > 8 * std::numeric_limits<double>::epsilon() * size && high - low > 1e-300) return;
  const double middle = low + (high - low) / 2;
  const double room = size > 1e-290 ? 0.1 * std::abs(middle) : 1;
  low = middle - room;
  high = middle + room;
}

}  // namespace

void Range::include(double value) {
  if (!std::isfinite(value)) return;
  value = std::clamp(value, -largest, largest);
  low = empty ? value : std::min(low, value);
  high = empty ? value : std::max(high, value);
  empty = false;
}

Axis::Axis(const Range& range, const Options& options) {
  double low = range.empty ? 0 : range.low, high = range.empty ? 1 : range.high;
  widen(low, high);
  const double room = options.padding * (high - low);
  choose_offset(low, high);
  low_ = low - offset_ - room;
  high_ = high - offset_ + room;
  choose_ticks(options);
}

Axis Axis::with_span(const Range& range, double span, const Options& options) {
  double low = range.empty ? 0 : range.low, high = range.empty ? 1 : range.high;
  widen(low, high);
  const double middle = low + (high - low) / 2;
  Axis axis;
  axis.choose_offset(middle - span / 2, middle + span / 2);
  axis.low_ = middle - axis.offset_ - span / 2;
  axis.high_ = middle - axis.offset_ + span / 2;
  axis.choose_ticks(options);
  return axis;
}

// Where values agree in more than four digits, those digits go into an offset with as few as separate it from the rest.
// The offset is the double nearest to its decimal form, so that what the label says is what was subtracted.
void Axis::choose_offset(double low, double high) {
  const double size = std::max(std::abs(low), std::abs(high));
  if (high - low >= 1e-4 * size) return;
  const double middle = low + (high - low) / 2;
  offset_digits_ = std::clamp(decade(std::abs(middle)) - decade(high - low), 1, 17);
  offset_ = std::strtod(fmt::format("{:.{}e}", middle, offset_digits_ - 1).c_str(), nullptr);
}

void Axis::choose_ticks(const Options& options) {
  // Two ticks at least: one alone says nothing of the scale.
  double step = 0, first = 0, last = -1;
  for (double wanted = span() * std::min(1.0, options.tick_distance / options.length); last - first < 1; wanted /= 2) {
    step = nice_step(wanted, options.degrees);
    first = std::ceil(low_ / step - 1e-9);
    last = std::floor(high_ / step + 1e-9);
  }
  const int magnitude = decade(step * std::max(std::abs(first), std::abs(last)) * (1 + 1e-9));
  exponent_ = magnitude >= 5 || magnitude <= -4 ? magnitude : 0;

  const double unit = std::pow(10.0, exponent_);
  const int decimals = std::max(0, exponent_ - decade(step * (1 + 1e-12)));
  for (double k = first; k <= last; ++k) {
    const double shown = k == 0 ? 0 : k * step / unit;
    ticks_.push_back({(k * step - low_) / span(), with_minus(fmt::format("{:.{}f}", shown, decimals))});
  }
}

std::string Axis::offset_label() const {
  return with_minus(fmt::format("{:.{}g}", offset_, std::max(offset_digits_, 7)));
}

}  // namespace maupertuis
