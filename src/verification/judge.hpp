#pragma once
#include <maupertuis/verification.hpp>

#include <complex>
#include <span>
#include <vector>

/// Numbers that came out against numbers that are expected. NaN agrees with nothing.
namespace maupertuis {

/// What an expression of parameters is, in SI; `otherwise` for an empty handle.
double number_of(const MechanicalSystem& system, Expr e, double otherwise = 0);

/// The largest difference that passes where `size` is expected: the tolerance, or that part of |size|. Without a
/// tolerance the digits as written count: 1e-9 of the size.
double allowed_difference(const expectation::Tolerance& tolerance, const MechanicalSystem& system, double size);

/// "rel 1e-09", "± 1e-09 rad": what is shown beside the expected value.
std::string tolerance_text(const expectation::Tolerance& tolerance, const expectation::DisplayUnit& unit,
                           const MechanicalSystem& system);

/// " rad", or nothing in SI.
std::string unit_after(const expectation::DisplayUnit& unit);

/// The sentence of a claim about a time that the run did not reach; `reason`: why it ended, with a full stop or not.
std::string ended_before(const std::string& reason);

/// False, and why, where a value that is expected does not exist with the values of the parameters.
bool expected_exists(std::span<const double> expected, ExpectationResult& result);
/// Fills everything but the message, which says by how much it is off.
void judge_number(const expectation::Number& expected, const MechanicalSystem& system, double actual,
                  ExpectationResult& result);

/// As sets, with the conjugates.
void judge_spectrum(const expectation::Spectrum& expected, const MechanicalSystem& system,
                    const std::vector<std::complex<double>>& actual, ExpectationResult& result);
/// How many values it stands for.
std::size_t spectrum_size(const expectation::Spectrum& expected, const MechanicalSystem& system);

/// Entry by entry, by rows.
void judge_entries(const expectation::Matrix& expected, const MechanicalSystem& system,
                   const std::vector<double>& actual, ExpectationResult& result);

}  // namespace maupertuis
