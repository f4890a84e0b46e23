#pragma once
#include <maupertuis/evaluate.hpp>

#include "symbolic/evaluate/leaves.hpp"
#include "symbolic/evaluate/tape.hpp"

#include <functional>
#include <optional>

namespace maupertuis::evaluation {

struct Witness {
  Bindings point;
  double value = 0;
  std::size_t root = 0;  // which difference
};

/// A real point at which interval arithmetic proves one of the roots to differ from 0; `points` are tried.
std::optional<Witness> find_witness(const Tape& tape, int points, std::uint64_t seed);
/// The same with 100 digits, for values that cancel in double.
std::optional<Witness> find_precise_witness(const Tape& tape, int points, std::uint64_t seed);

/// The same at points in all branches of the switches that are found, first in double, then with 100 digits.
std::optional<Witness> find_witness_in_branches(std::span<const Expr> roots, std::uint64_t seed);

/// The same of a formula at points on the sides on which it is in force, if such points are found.
std::optional<Witness> find_witness_on_sides(Expr formula, const std::vector<Side>& sides, std::uint64_t seed);

/// Looks for points on these sides, as interval arithmetic shows, with values for `symbols` too, until one is accepted.
bool any_point_on_sides(const std::vector<Side>& sides, std::span<const Expr> symbols, std::uint64_t seed,
                        const std::function<bool(const Bindings&)>& accept);

/// A random real point for the symbols of a tape: mostly of order one, now and then large or small.
Bindings random_real_point(const Tape& tape, int trial, std::uint64_t seed);

}  // namespace maupertuis::evaluation
