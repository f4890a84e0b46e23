#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/evaluate.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

/// The equations of motion in rates (quasi-velocities) σ, after Boltzmann and Hamel:
///
///     σ = Y(q,t) q̇ + y(q,t),   q̇ = X σ + x,   Xᵀ R = 0 with q̇, q̈ replaced
///
/// a row for each velocity that the constraints leave free. Constraints are the last σ, which are 0, so that no
/// multiplier remains. A velocity that no rate names is a rate itself.
struct EquationsInRates {
  struct Row {
    std::string rate;   // ω1; θ' for a velocity that stays
    ReadableForm form;  // = 0
    Expr factor;        // the form is so many times Xᵀ R
  };
  struct Velocity {
    std::size_t coordinate = 0;
    Expr velocity;      // q'
    ReadableForm form;  // q' = form, in rates, q, t
  };
  ReadingOrder order;                       // of the rates as well
  std::vector<Expr> rates;                  // σ [r], symbols of order 1
  std::vector<Expr> definitions;            // of the rates in q, q', t [r]
  std::vector<Row> rows;                    // [r]
  std::vector<Velocity> kinematics;         // of the velocities that are no rates themselves
  Expr lagrangian;                          // L in rates, on the constraints
  std::vector<ReadableForm> momenta;        // ∂L/∂σ [r], on the constraints
  std::vector<Intermediate> intermediates;  // definitions of the model that are used
  std::vector<DerivationStep> steps;        // from the rates to the rows
  ZeroTest certificate;  // that the rows are Xᵀ R, that Y X = 1, and that X keeps to the constraints
};

struct RatesResult {
  std::optional<EquationsInRates> equations;
  std::string reason;  // why there are none; empty if there are
};

/// In the rates that the model names, or in `rates` beside it. Rates that depend on others, as they may in a mode of
/// contacts, are left out. Nothing where constraints are not linear in q̇, or the velocities are too many to be solved
/// for in formulas. Each result was compared with Lagrange's residual by the zero test: see `certificate`.
RatesResult equations_in_rates(const EquationsOfMotion& equations);
RatesResult equations_in_rates(const EquationsOfMotion& equations, const std::vector<Rate>& rates);

/// In the rates that the model names; without such in the angular velocities of its bodies, where they may be shorter
/// to read: of few bodies that no constraint holds, each with three of its own. Nothing where there are none, or where
/// the result could not be compared.
std::optional<EquationsInRates> equations_in_own_rates(const EquationsOfMotion& equations);

/// Formulas of a system in its rates, on the constraints.
class RateNotation {
 public:
  /// In the rates that the model names, else in those of its bodies, if they are as many as velocities are free.
  explicit RateNotation(const EquationsOfMotion& equations);
  ~RateNotation();

  /// Where it is shorter to read than `shown`, which is the same in q and q'; nothing otherwise.
  std::optional<ReadableForm> shorter(Expr e, const ReadableForm& shown) const;
  const ReadingOrder& order() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

/// The components on body axes of the angular velocities of the bodies that turn in space, `top.ω.x`, as rates: of
/// those that have three independent ones. `system` may be the system as written.
std::vector<Rate> body_rates(const MechanicalSystem& system);

}  // namespace maupertuis
