#include "verification/judge.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/evaluate.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace maupertuis {

using Complex = std::complex<double>;

double number_of(const MechanicalSystem& system, Expr e, double otherwise) {
  if (!e) return otherwise;
  return evaluate(in_terms_of_motion(system, {&e, 1}).front(), parameter_bindings(system));
}

double allowed_difference(const expectation::Tolerance& tolerance, const MechanicalSystem& system, double size) {
  if (!tolerance.size) return 1e-9 * std::abs(size);
  return number_of(system, tolerance.size) * (tolerance.relative ? std::abs(size) : 1.0);
}

std::string unit_after(const expectation::DisplayUnit& unit) { return unit.name.empty() ? "" : " " + unit.name; }

namespace {

std::string complex_text(Complex z, const expectation::DisplayUnit& unit) {
  const Complex shown = z / unit.factor;
  return z.imag() == 0 ? fmt::format("{:.17g}", shown.real())
                       : fmt::format("({:.17g}, {:.17g})", shown.real(), shown.imag());
}

/// Lower halves of pairs are left out.
std::string spectrum_text(const std::vector<Complex>& values, const expectation::DisplayUnit& unit) {
  std::string out;
  for (const Complex& z : values)
    if (z.imag() >= 0) out += (out.empty() ? "" : ", ") + complex_text(z, unit);
  return out.empty() ? "none" : out + unit_after(unit);
}

std::vector<Complex> expected_spectrum(const expectation::Spectrum& e, const MechanicalSystem& system) {
  std::vector<Complex> written, out;
  for (std::size_t i = 0; i < e.real.size(); ++i)
    written.emplace_back(number_of(system, e.real[i]), number_of(system, e.imaginary[i]));
  for (const Complex& z : written) {
    out.push_back(z);
    const bool has_partner = std::find(written.begin(), written.end(), std::conj(z)) != written.end();
    if (z.imag() != 0 && !has_partner) out.push_back(std::conj(z));
  }
  return out;
}

/// Pairs of rows and columns of a square matrix, by paths that make room (Kuhn): each entry of a pair at most `most`.
class Pairing {
 public:
  Pairing(const std::vector<std::vector<double>>& entries, double most)
      : entries_(entries), most_(most), row_of_(entries.size(), none) {}

  /// The column of each row; empty where not all rows have one.
  std::vector<std::size_t> columns() {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      seen_.assign(entries_.size(), false);
      if (!place(i)) return {};
    }
    std::vector<std::size_t> out(entries_.size());
    for (std::size_t j = 0; j < row_of_.size(); ++j) out[row_of_[j]] = j;
    return out;
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  bool place(std::size_t row) {
    for (std::size_t j = 0; j < row_of_.size(); ++j) {
      if (seen_[j] || entries_[row][j] > most_) continue;
      seen_[j] = true;
      if (row_of_[j] != none && !place(row_of_[j])) continue;
      row_of_[j] = row;
      return true;
    }
    return false;
  }

  const std::vector<std::vector<double>>& entries_;
  double most_;
  std::vector<std::size_t> row_of_;  // of columns
  std::vector<bool> seen_;
};

/// Of all ways to pair them the one whose worst pair is best, errors counted in what is allowed: actual[i] belongs to
/// expected[partner[i]].
std::vector<std::size_t> partners(const std::vector<Complex>& actual, const std::vector<Complex>& expected,
                                  const std::vector<double>& allowed) {
  std::vector<std::vector<double>> errors(actual.size(), std::vector<double>(actual.size()));
  std::vector<double> levels;
  for (std::size_t i = 0; i < actual.size(); ++i)
    for (std::size_t j = 0; j < actual.size(); ++j) {
      const double error = std::abs(actual[i] - expected[j]), counted = error == 0 ? 0 : error / allowed[j];
      levels.push_back(errors[i][j] = std::isfinite(counted) ? counted : HUGE_VAL);
    }
  std::sort(levels.begin(), levels.end());
  const auto least = std::partition_point(levels.begin(), levels.end(), [&](double most) {
    return Pairing(errors, most).columns().size() < actual.size();
  });
  return least == levels.end() ? std::vector<std::size_t>() : Pairing(errors, *least).columns();
}

}  // namespace

std::string tolerance_text(const expectation::Tolerance& tolerance, const expectation::DisplayUnit& unit,
                           const MechanicalSystem& system) {
  if (!tolerance.size) return "rel 1e-09";
  const double size = number_of(system, tolerance.size);
  return tolerance.relative ? fmt::format("rel {:g}", size)
                            : fmt::format("± {:g}{}", size / unit.factor, unit_after(unit));
}

std::string ended_before(const std::string& reason) {
  return "The run ended before: " + reason + (reason.ends_with('.') ? "" : ".");
}

bool expected_exists(std::span<const double> expected, ExpectationResult& result) {
  if (std::all_of(expected.begin(), expected.end(), [](double x) { return std::isfinite(x); })) return true;
  result.expected = "no value";
  result.message = "What is expected has no value with these parameters.";
  return false;
}

void judge_number(const expectation::Number& e, const MechanicalSystem& system, double actual,
                  ExpectationResult& result) {
  const double expected = number_of(system, e.value), error = std::abs(actual - expected);
  if (!expected_exists({&expected, 1}, result)) return;
  result.actual = fmt::format("{:.17g}{}", actual / e.unit.factor, unit_after(e.unit));
  result.expected = fmt::format("{:.17g}{}", expected / e.unit.factor, unit_after(e.unit));
  result.tolerance = tolerance_text(e.tolerance, e.unit, system);
  if (!std::isfinite(actual)) {
    result.actual = "no value";
    result.message = "It is infinite or undefined there.";
    return;
  }
  result.passed = error <= allowed_difference(e.tolerance, system, expected);
  result.message = fmt::format("off by {:.2g}{}", error / e.unit.factor, unit_after(e.unit));
}

std::size_t spectrum_size(const expectation::Spectrum& e, const MechanicalSystem& system) {
  return expected_spectrum(e, system).size();
}

void judge_spectrum(const expectation::Spectrum& e, const MechanicalSystem& system, const std::vector<Complex>& actual,
                    ExpectationResult& result) {
  const std::vector<Complex> expected = expected_spectrum(e, system);
  for (const Complex& z : expected)
    if (!expected_exists(std::array{z.real(), z.imag()}, result)) return;
  result.actual = spectrum_text(actual, e.unit);
  result.expected = spectrum_text(expected, e.unit);
  result.tolerance = tolerance_text(e.tolerance, e.unit, system);
  if (actual.size() != expected.size()) {
    result.message =
        fmt::format("{} values are expected, a complex one for itself and its conjugate, and there are {}.",
                    expected.size(), actual.size());
    return;
  }
  std::vector<double> allowed;
  for (const Complex& z : expected) allowed.push_back(allowed_difference(e.tolerance, system, std::abs(z)));
  const std::vector<std::size_t> partner = partners(actual, expected, allowed);
  double largest = 0;
  result.passed = true;
  for (std::size_t i = 0; i < actual.size() && result.passed; ++i) {
    const Complex z = expected[partner[i]];
    const double error = std::abs(actual[i] - z);
    largest = std::max(largest, error);
    result.passed = error <= allowed[partner[i]];
    result.message =
        fmt::format("{} is off by {:.2g}{}.", complex_text(z, e.unit), error / e.unit.factor, unit_after(e.unit));
  }
  if (result.passed)
    result.message = fmt::format("off by at most {:.2g}{}", largest / e.unit.factor, unit_after(e.unit));
}

void judge_entries(const expectation::Matrix& e, const MechanicalSystem& system, const std::vector<double>& actual,
                   ExpectationResult& result) {
  const std::size_t width = e.columns.size();
  const auto text = [&](const std::vector<double>& values) {
    std::string out;
    for (std::size_t k = 0; k < values.size(); ++k)
      out += fmt::format("{}{:.17g}", k == 0 ? "((" : k % width == 0 ? "), (" : ", ", values[k] / e.unit.factor);
    return out + "))" + unit_after(e.unit);
  };
  std::vector<double> expected;
  for (const Expr& value : e.entries) expected.push_back(number_of(system, value));
  result.actual = text(actual);
  result.expected = text(expected);
  result.tolerance = tolerance_text(e.tolerance, e.unit, system);
  double largest = 0;
  result.passed = actual.size() == expected.size();
  for (std::size_t k = 0; k < expected.size() && result.passed; ++k) {
    const double error = std::abs(actual[k] - expected[k]);
    largest = std::max(largest, error);
    result.passed = error <= allowed_difference(e.tolerance, system, expected[k]);
    result.message = fmt::format("The entry in row {}, column {} is off by {:.2g}{}.", k / width + 1, k % width + 1,
                                 error / e.unit.factor, unit_after(e.unit));
  }
  if (result.passed)
    result.message = fmt::format("off by at most {:.2g}{}", largest / e.unit.factor, unit_after(e.unit));
}

}  // namespace maupertuis
