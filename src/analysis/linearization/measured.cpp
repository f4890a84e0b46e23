#include "analysis/linearization/measured.hpp"

#include <maupertuis/modes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis {
namespace {

constexpr double wide = 1e-8, narrow = 1e-10;  // steps to either side, in typical sizes
constexpr double rounding = 1e-9;              // changes below this part of a number may be rounding

void add(std::vector<double>& to, const Matrix& column, Index first) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += column(first + static_cast<Index>(i), 0);
}

/// Values and slopes of the outputs next to the point, along one column of the response.
class Beside {
 public:
  Beside(PointEquations::Impl& e, const OperatingPoint& point, const Response& response, Index column)
      : e_(e), point_(point), motion_(response.motion.col(column)), answer_(response.answer.col(column)) {
    input_ = column - response.states;
    const std::vector<double> sizes = typical_sizes(*e.system, {});
    const double largest = motion_.lpNorm<Eigen::Infinity>();
    size_ = 1;
    for (std::size_t i = 0; i < e.n && largest > 0; ++i)
      if (std::abs(motion_(static_cast<Index>(i), 0)) == largest)
        size_ = std::max(sizes[i], std::abs(point.q[i])) / largest;
  }

  struct Values {
    Vector value, slope;
  };
  Values at(double step) const {
    OperatingPoint there = point_;
    const Matrix by = step * size_ * motion_, answer = step * size_ * answer_;
    const auto n = static_cast<Index>(e_.n);
    add(there.q, by, 0);
    add(there.v, by, n);
    add(there.a, answer, 0);
    add(there.multipliers, answer, n);
    if (input_ >= 0) move_input(there, static_cast<std::size_t>(input_), step * size_);
    const RowsAtPoint y = e_.at(e_.outputs, there);
    Vector slope = y.by_q * motion_.topRows(n) + y.by_v * motion_.bottomRows(n) + y.by_a * answer_.topRows(n) +
                   y.by_multipliers * answer_.bottomRows(y.by_multipliers.cols());
    if (input_ >= 0) slope += y.by_inputs.col(input_);
    return {y.value, slope};
  }

 private:
  /// u, u' or u'' of one.
  void move_input(OperatingPoint& there, std::size_t i, double by) const {
    there.input_rates.resize(2 * e_.k);
    (i < e_.k ? there.inputs[i] : there.input_rates[i - e_.k]) += by;
  }

  PointEquations::Impl& e_;
  const OperatingPoint& point_;
  Matrix motion_, answer_;
  Index input_ = 0;
  double size_ = 1;
};

/// What differs between the two sides, and does not shrink with the distance: a jump.
bool jumps(double left, double right, double near_left, double near_right) {
  const double far = std::abs(right - left), near = std::abs(near_right - near_left);
  return near > 0.5 * far && near > rounding * std::max(std::abs(near_left), std::abs(near_right));
}

/// Which outputs have no derivative along a column.
std::vector<bool> rough_rows(const PointEquations::Impl& e, const Beside& beside) {
  const Beside::Values left = beside.at(-wide), right = beside.at(wide), near_left = beside.at(-narrow),
                       near_right = beside.at(narrow);
  std::vector<bool> out;
  for (std::size_t k = 0; k < e.output_switches.size(); ++k) {
    const auto i = static_cast<Index>(k);
    const bool outside = !std::isfinite(near_left.value(i)) || !std::isfinite(near_right.value(i));
    const bool jump = jumps(left.value(i), right.value(i), near_left.value(i), near_right.value(i)) ||
                      jumps(left.slope(i), right.slope(i), near_left.slope(i), near_right.slope(i));
    out.push_back(outside || (e.output_switches[k] && jump));
  }
  return out;
}

/// Outputs that do not stay the same when everything turns as the motion does, q → Ξ q + d: seen at random points.
/// Beside the motion their coefficients are not constant, even where they are along it.
std::vector<Index> changing_rows(PointEquations::Impl& e, const OperatingPoint& point) {
  const Matrix turning = to_eigen(point.turning);
  const Vector sizes = to_eigen(typical_sizes(*e.system, {}));
  const double fastest = to_eigen(point.v).cwiseQuotient(sizes).lpNorm<Eigen::Infinity>();
  Vector shift = to_eigen(point.v) - turning * to_eigen(point.q);
  constexpr double of_velocities = 1e-12;  // rounding of a steady motion that was solved for
  for (Index i = 0; i < shift.size(); ++i)
    if (std::abs(shift[i]) <= of_velocities * fastest * sizes[i]) shift[i] = 0;
  std::vector<Index> out;
  for (const std::uint64_t seed : {4001, 4002}) {
    const OperatingPoint there = random_point(e, seed);
    const RowsAtPoint y = e.at(e.outputs, there);
    const Vector q = turning * to_eigen(there.q) + shift, v = turning * to_eigen(there.v),
                 a = turning * to_eigen(there.a);
    const Vector change = y.by_q * q + y.by_v * v + y.by_a * a;
    const Vector size =
        y.by_q.cwiseAbs() * q.cwiseAbs() + y.by_v.cwiseAbs() * v.cwiseAbs() + y.by_a.cwiseAbs() * a.cwiseAbs();
    for (Index i = 0; i < change.size(); ++i)
      if (!(std::abs(change[i]) <= rounding * size[i])) out.push_back(i);
  }
  return out;
}

}  // namespace

MeasuredOutputs measured_outputs(PointEquations::Impl& e, const OperatingPoint& point, const Response& response) {
  const RowsAtPoint y = e.at(e.outputs, point);
  const Index n = y.by_q.cols(), k = y.by_inputs.cols();
  Matrix by = y.by_q * response.motion.topRows(n) + y.by_v * response.motion.bottomRows(n) +
              y.by_a * response.answer.topRows(n) +
              y.by_multipliers * response.answer.bottomRows(y.by_multipliers.cols());
  by.rightCols(k) += y.by_inputs;
  for (Index column = 0; column < by.cols() && by.rows() > 0; ++column) {
    const std::vector<bool> rough = rough_rows(e, Beside(e, point, response, column));
    for (std::size_t i = 0; i < rough.size(); ++i)
      if (rough[i]) by.row(static_cast<Index>(i)).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  if (point.turning.rows > 0)
    for (const Index i : changing_rows(e, point)) by.row(i).setConstant(std::numeric_limits<double>::quiet_NaN());
  const auto [d, d_rate, d_acceleration] = thirds(by.rightCols(k));
  return {to_list(y.value), to_real(by.leftCols(response.states)), d, d_rate, d_acceleration};
}

// -------------------------------------------------------------------------------------------------------------
// refusals

namespace {

bool finite_row(const RealMatrix& m, std::size_t row) {
  for (std::size_t j = 0; j < m.columns; ++j)
    if (!std::isfinite(m.at(row, j))) return false;
  return true;
}

}  // namespace

bool check_measured(const MechanicalSystem& system, const ModalStudy& study, std::span<const OutputName> outputs,
                    Diagnostics& diagnostics) {
  bool good = true;
  for (std::size_t i = 0; i < outputs.size(); ++i)
    for (const ModalEntry& e : study.entries) {
      const MeasuredOutputs& y = e.linearization.measured;
      const bool value = std::isfinite(y.values[i]);
      if (value && finite_row(y.c, i) && finite_row(y.d, i)) continue;
      good = false;
      if (value && e.equilibrium.point.turning.rows > 0) {
        diagnostics.error(
            "E1306", outputs[i].span, fmt::format("y = {} changes along the steady motion", outputs[i].text),
            "Seen in the frame that turns with the motion the coefficients are constant; what is measured "
            "in another frame, or has a kink there, has none.",
            "Measure what stays the same all along the motion: a rate of the body, an angle with its axis.");
        break;
      }
      diagnostics.error("E1306", outputs[i].span,
                        fmt::format("y = {} has no {} at {}", outputs[i].text, value ? "derivative" : "value",
                                    point_text(system, e.equilibrium, study.translations)),
                        value
                            ? "To first order y = y0 + C x, where C is the derivative of y at the point; neighbours of "
                              "the point have no such slope in common, or no y at all."
                            : "A measurement is a number: at the point itself the formula gives none, neither a limit "
                              "nor an infinite value is one.",
                        "Measure something that is smooth there, or take another point with --at.");
      break;  // one mistake, one message
    }
  return good;
}

}  // namespace maupertuis
