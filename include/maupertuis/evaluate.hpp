#pragma once
#include <maupertuis/expression.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace maupertuis {

using Bindings = std::unordered_map<Expr, double, ExprHash>;

/// Values of expressions in double; NaN where undefined (log of a negative number). Every symbol must be bound.
/// Precondition: no TimeDerivative nodes.
std::vector<double> evaluate(std::span<const Expr> roots, const Bindings& bindings);
double evaluate(Expr e, const Bindings& bindings);

enum class Verdict { Zero, Nonzero, Undecided };

/// What the zero test found and on what ground (docs/theory/zero_test.md).
struct ZeroTest {
  Verdict verdict = Verdict::Undecided;
  int points = 0;          // random points at which the expression vanished modulo both primes
  double error_bound = 1;  // probability that a nonzero expression passes; 1: none claimed
  Bindings witness;        // Nonzero: a real point where interval arithmetic excludes 0 (may be empty)
  double witness_value = 0;
  std::string reason;  // Undecided: why
};

struct ZeroTestOptions {
  int points = 3;  // per prime
  std::uint64_t seed = 0x6d617570;
  bool hold_parameters = false;  // of points on relations: only the unknowns and the time vary
};

/// Decides e = 0 as a function of all its symbols (decision 4 of ARCHITECTURE.md). TimeDerivative nodes are expanded.
ZeroTest zero_test(Expr e, const ZeroTestOptions& options = {});
/// Whether e is 0 as a function of its symbols: proved, not only undecided.
bool vanishes_identically(Expr e);
/// All of them at once, with shared evaluation: the first that is not zero decides.
ZeroTest zero_test(std::span<const Expr> differences, const ZeroTestOptions& options = {});

/// Decides whether the differences vanish where all `relations` = 0 hold: at random real points near `center` (which
/// binds every symbol), brought onto the relations by Newton's method over the `unknowns` and refined there to 100
/// digits. Zero says that at each of `points` points every difference is below 1e-60 of the sizes of its terms:
/// evidence, not a proof, so that the error bound stays 1. Undecided where no point was found. Symbols that are no
/// unknowns vary by a hundredth. Precondition: no TimeDerivative nodes. Cost: the symbolic rows of the relations, and
/// some hundred evaluations.
ZeroTest zero_test_where(std::span<const Expr> differences, std::span<const Expr> relations,
                         std::span<const Expr> unknowns, const Bindings& center, const ZeroTestOptions& options = {});

/// The same for many differences, of which each costs some evaluations: the points are drawn once, when they are first
/// needed. For one thread at a time.
class ZeroTestWhere {
 public:
  ZeroTestWhere(std::span<const Expr> relations, std::span<const Expr> unknowns, const Bindings& center,
                const ZeroTestOptions& options = {});
  ~ZeroTestWhere();
  ZeroTestWhere(ZeroTestWhere&&) noexcept;
  ZeroTestWhere& operator=(ZeroTestWhere&&) noexcept;

  ZeroTest operator()(std::span<const Expr> differences);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The points of zero_test_where, for many questions: random points near `center` on relations, to 100 digits, where
/// the rank of the relations is as large as it gets, and where all of `defined` have values. Cost: the symbolic rows of
/// the relations, and some hundred evaluations of them.
class PointsWhere {
 public:
  PointsWhere(std::span<const Expr> relations, std::span<const Expr> unknowns, const Bindings& center,
              const ZeroTestOptions& options = {}, std::span<const Expr> defined = {});
  ~PointsWhere();
  PointsWhere(PointsWhere&&) noexcept;

  /// Rounded to double; fewer than asked for, or none, where they were not found.
  const std::vector<Bindings>& points() const;
  /// Zero: at each point below 1e-60 of the sizes of its terms, evidence and no proof. Undecided: defined at none.
  Verdict vanishes(Expr e) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace maupertuis
