#pragma once
#include <string>
#include <vector>

namespace maupertuis {

/// The smallest and the largest finite value of some series.
struct Range {
  double low = 0, high = 0;
  bool empty = true;
  void include(double value);  // values that are not finite are left out
};

struct Tick {
  double position = 0;  // 0 at the beginning of the axis, 1 at its end
  std::string label;    // in units of 10^exponent, from the offset
};

/// A linear axis: which stretch of numbers it shows, and how it names them.
///
///     value = offset + 10^exponent · label
///
/// The offset is 0 unless the values agree in so many digits that labels would repeat them.
class Axis {
 public:
  struct Options {
    double length = 100;        // px
    double tick_distance = 60;  // px, at least
    double padding = 0;         // of the range, at each end
    bool degrees = false;       // ticks at 15, 30, 45, 90, … where steps are that large
  };
  Axis(const Range& range, const Options& options);
  /// The same, with exactly `span` from end to end about the middle of the range.
  static Axis with_span(const Range& range, double span, const Options& options);

  /// 0 … 1 along the axis; NaN for a value that is not finite.
  double position(double value) const { return (value - offset_ - low_) / (high_ - low_); }
  double span() const { return high_ - low_; }
  const std::vector<Tick>& ticks() const { return ticks_; }
  double offset() const { return offset_; }
  std::string offset_label() const;  // with as many digits as it takes
  int exponent() const { return exponent_; }

 private:
  Axis() = default;
  void choose_offset(double low, double high);
  void choose_ticks(const Options& options);

  double offset_ = 0;
  int offset_digits_ = 0;      // significant ones
  double low_ = 0, high_ = 1;  // ends, from the offset
  int exponent_ = 0;
  std::vector<Tick> ticks_;
};

}  // namespace maupertuis
