#include "verification/judge.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/evaluate.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {

using Complex = std::complex<double>;

double number_of(const MechanicalSystem& system, Expr e, double otherwise) {
  if (!e) return otherwise;
  return evaluate(in_terms_of_motion(system, {&e, 1}).front(), parameter_bindings(system));
}

double allowed_difference(const Expectation& e, const MechanicalSystem& system, double size) {
  if (!e.tolerance) return 1e-9 * std::abs(size);
  return number_of(system, e.tolerance) * (e.relative ? std::abs(size) : 1.0);
}

namespace {

std::string unit_after(const Expectation& e) { return e.display_unit.empty() ? "" : " " + e.display_unit; }

std::string complex_text(Complex z, const Expectation& e) {
  const Complex shown = z / e.display_factor;
  return z.imag() == 0 ? fmt::format("{:.17g}", shown.real()) : fmt::format("({:.17g}, {:.17g})", shown.real(), shown.imag());
}

/// Lower halves of pairs are left out.
std::string spectrum_text(const std::vector<Complex>& values, const Expectation& e) {
  std::string out;
  for (const Complex& z : values)
    if (z.imag() >= 0) out += (out.empty() ? "" : ", ") + complex_text(z, e);
  return out.empty() ? "none" : out + unit_after(e);
}

std::vector<Complex> expected_spectrum(const Expectation& e, const MechanicalSystem& system) {
  std::vector<Complex> written, out;
  for (std::size_t i = 0; i < e.values.size(); ++i) written.emplace_back(number_of(system, e.values[i]), number_of(system, e.imaginary[i]));
  for (const Complex& z : written) {
    out.push_back(z);
    const bool has_partner = std::find(written.begin(), written.end(), std::conj(z)) != written.end();
    if (z.imag() != 0 && !has_partner) out.push_back(std::conj(z));
  }
  return out;
}

/// Of all pairs that are left the nearest first: actual[i] belongs to expected[partner[i]].
std::vector<std::size_t> partners(const std::vector<Complex>& actual, const std::vector<Complex>& expected) {
  struct Pair {
    double distance;
    std::size_t actual, expected;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < actual.size(); ++i)
    for (std::size_t j = 0; j < expected.size(); ++j) pairs.push_back({std::abs(actual[i] - expected[j]), i, j});
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  std::vector<std::size_t> out(actual.size(), expected.size());
  std::vector<bool> taken(expected.size(), false);
  for (const Pair& p : pairs) {
    if (out[p.actual] != expected.size() || taken[p.expected]) continue;
    out[p.actual] = p.expected;
    taken[p.expected] = true;
  }
  return out;
}

}  // namespace

std::string tolerance_text(const Expectation& e, const MechanicalSystem& system) {
  if (!e.tolerance) return "rel 1e-09";
  const double tolerance = number_of(system, e.tolerance);
  return e.relative ? fmt::format("rel {:g}", tolerance) : fmt::format("± {:g}{}", tolerance / e.display_factor, unit_after(e));
}

void judge_number(const Expectation& e, const MechanicalSystem& system, double actual, ExpectationResult& result) {
  const double expected = number_of(system, e.value), error = std::abs(actual - expected);
  result.actual = fmt::format("{:.17g}{}", actual / e.display_factor, unit_after(e));
  result.expected = fmt::format("{:.17g}{}", expected / e.display_factor, unit_after(e));
  result.tolerance = tolerance_text(e, system);
  result.passed = error <= allowed_difference(e, system, expected);
  result.message = fmt::format("off by {:.2g}{}", error / e.display_factor, unit_after(e));
}

std::size_t spectrum_size(const Expectation& e, const MechanicalSystem& system) { return expected_spectrum(e, system).size(); }

void judge_spectrum(const Expectation& e, const MechanicalSystem& system, const std::vector<Complex>& actual, ExpectationResult& result) {
  const std::vector<Complex> expected = expected_spectrum(e, system);
  result.actual = spectrum_text(actual, e);
  result.expected = spectrum_text(expected, e);
  result.tolerance = tolerance_text(e, system);
  if (actual.size() != expected.size()) {
    result.message = fmt::format("{} values are expected, a complex one for itself and its conjugate, and there are {}.", expected.size(), actual.size());
    return;
  }
  const std::vector<std::size_t> partner = partners(actual, expected);
  double largest = 0;
  result.passed = true;
  for (std::size_t i = 0; i < actual.size() && result.passed; ++i) {
    // Infinite or no number: no pair was nearest.
    const Complex z = partner[i] < expected.size() ? expected[partner[i]] : Complex(std::nan(""), 0);
    const double error = std::abs(actual[i] - z);
    largest = std::max(largest, error);
    result.passed = error <= allowed_difference(e, system, std::abs(z));
    result.message = fmt::format("{} is off by {:.2g}{}.", complex_text(z, e), error / e.display_factor, unit_after(e));
  }
  if (result.passed) result.message = fmt::format("off by at most {:.2g}{}", largest / e.display_factor, unit_after(e));
}

void judge_entries(const Expectation& e, const MechanicalSystem& system, const std::vector<double>& actual, ExpectationResult& result) {
  const auto text = [&](const std::vector<double>& values) {
    std::string out;
    for (std::size_t k = 0; k < values.size(); ++k)
      out += fmt::format("{}{:.17g}", k == 0 ? "((" : k % e.width == 0 ? "), (" : ", ", values[k] / e.display_factor);
    return out + "))" + unit_after(e);
  };
  std::vector<double> expected;
  for (const Expr& value : e.values) expected.push_back(number_of(system, value));
  result.actual = text(actual);
  result.expected = text(expected);
  result.tolerance = tolerance_text(e, system);
  double largest = 0;
  result.passed = actual.size() == expected.size();
  for (std::size_t k = 0; k < expected.size() && result.passed; ++k) {
    const double error = std::abs(actual[k] - expected[k]);
    largest = std::max(largest, error);
    result.passed = error <= allowed_difference(e, system, expected[k]);
    result.message = fmt::format("The entry in row {}, column {} is off by {:.2g}{}.", k / e.width + 1, k % e.width + 1, error / e.display_factor, unit_after(e));
  }
  if (result.passed) result.message = fmt::format("off by at most {:.2g}{}", largest / e.display_factor, unit_after(e));
}

}  // namespace maupertuis
