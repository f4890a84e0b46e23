#pragma once
#include <maupertuis/certificate.hpp>
#include <maupertuis/field_system.hpp>
#include <maupertuis/layout.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

/// fields : FieldModel → FieldEquations → Certificate, FieldCurrents, dispersion. docs/theory/fields.md.
namespace maupertuis {

/// What follows at an end x_i = const from the variation of a field: p + (what acts there) = 0, m = 0.
struct NaturalCondition {
  std::size_t field = 0, along = 0;  // space variable
  bool moment = false;               // m, the factor of δφ_x; else p, the factor of δφ
  Expr value;
};

/// What holds at a place where bodies take hold of a field, or where its density goes over from one formula to another.
struct InterfaceCondition {
  std::size_t field = 0;
  bool moment = false;  // of φ_x: m; else of φ: p
  Expr place;
  std::optional<BoundaryCondition::Side> end;  // nothing: inside, p or m on both sides
  std::optional<std::size_t> coordinate;       // of `bodies`; nothing: the border of a density
  /// R − p on the right, R + p on the left, R + p(x+) − p(x−) inside, with R of the bodies there: vanishes. In the
  /// coordinates of `bodies` and symbols of jets at the place: u_x(l), u_x(a+), u_x(a-).
  Expr value;
};

/// The field equations of a density, each a residual as in mechanics:
///
///     ∂_μ (∂ℒ/∂φ_μ) − ∂_μ∂_ν (∂ℒ/∂φ_μν) − ∂ℒ/∂φ + ∂𝒟/∂φ' − f = 0
///
/// and B^μ of δℒ(η) − E·η = ∂_μ B^μ, E = δℒ/δφ, written out in the jets of fields η that have the names of the fields
/// with a δ.
struct FieldEquations {
  std::shared_ptr<const FieldModel> model;
  std::vector<std::size_t> varied;        // fields that are not given
  std::vector<Expr> euler;                // E_a = δℒ/δφ_a                                    [varied]
  std::vector<Expr> residuals;            // [varied]
  std::vector<NaturalCondition> natural;  // of all space variables; p before m
  std::vector<Expr> boundary_terms;       // B^μ: space variables, then t
  FieldSystem with_variations;            // the fields and, behind them, their variations η
  ReadingOrder order;
  /// Lagrange's equations of the coordinates and bodies beside the fields, the values of fields at places among the
  /// coordinates; null where there are none. See coupled_fields.hpp.
  std::shared_ptr<const EquationsOfMotion> bodies;
  std::vector<StartValue> body_start;  // of the coordinates, where the model gives one
  std::vector<InterfaceCondition> interfaces;

  const FieldSystem& system() const { return model->system; }
  /// Of a field among those that are varied; their number where it is given.
  std::size_t varied_index(std::size_t field) const;
  std::size_t variation_of(std::size_t varied_index) const { return system().fields.size() + varied_index; }
};

/// Derives them. N0640 where no derivative in time stands in them; error E0641 where short waves grow without bound
/// (elliptic in time).
std::optional<FieldEquations> field_equations(std::shared_ptr<const FieldModel> model, Diagnostics& diagnostics);

/// A natural condition as it holds at the ends of its variable: with the forces that act there, written or by a slope
/// that is given, and not where the field is given or bodies hold it.
struct NaturalAtEnds {
  std::size_t natural = 0;  // index in FieldEquations::natural
  Expr value;               // vanishes: p + F at the last end, p − F at the first, m likewise
  bool first = false, last = false;
};

/// One entry for each natural condition and force; with neither end where the condition holds nowhere, and where there
/// is no end: the variable goes round, or has no domain.
std::vector<NaturalAtEnds> natural_at_ends(const FieldEquations& equations);

/// Checks the equations and B against ℒ along random polynomial fields over prime fields.
Certificate certify(const FieldEquations& equations, std::uint64_t seed = 0x6d617570);

/// A conservation law ∂_t density + ∂_i flux_i = Σ Q_a E_a, identically.
struct FieldCurrent {
  std::string name;  // "energy", "momentum along x", "angular momentum about z", "boost along x", "charge", …
  std::string meaning;
  std::vector<Expr> characteristic;  // Q_a                                        [varied]
  Expr density;
  std::vector<Expr> fluxes;  // [space variables]
  bool certified = false;    // by the zero test
  Expr source;               // Σ Q_a E_a on motions with friction and forces; an empty handle: 0, it is conserved
};

struct FieldCurrents {
  std::vector<FieldCurrent> currents;
  std::string basis;  // what symmetries were looked for among
};
FieldCurrents field_currents(const FieldEquations& equations);

/// Whether ∂_t density + ∂_i flux_i vanishes on solutions, decided by its characteristic: the difference is written as
/// Q·E with Q of the second derivatives in time; `trouble` says why it is not.
bool is_current(const FieldEquations& equations, Expr density, const std::vector<Expr>& fluxes, std::string& trouble);

/// A complex expression.
struct ComplexExpr {
  Expr re, im;
};
/// The determinant of the equations linearized about φ = 0 for waves exp(i(k·x − ω t)), in the symbols of the model.
/// Nothing, and `trouble`, where φ = 0 is no solution or the coefficients depend on x or t.
std::optional<ComplexExpr> dispersion(const FieldEquations& equations, std::string& trouble);
/// re + i im for a reader, with a symbol i. Friction makes a relation complex.
Expr with_imaginary_unit(const ComplexExpr& relation);

/// δℒ/δψ* of a complex field ψ, re + i im, in ψ and its derivatives and a symbol named abs(ψ).
struct ComplexEquation {
  std::string field;  // ψ
  Expr re, im;
};
/// Of all complex fields; none where one of them does not read well so: it is no polynomial, or holds more of ψ* than
/// |ψ|².
std::vector<ComplexEquation> complex_equations(const FieldEquations& equations);

/// e with derivatives of fields typeset with ∂, and named u_tx in plain text.
Layout field_layout(const FieldSystem& system, Layout layout);
/// u_tx with subscripts: what stands below a fraction bar, ∂ℒ/∂u_tx.
Layout jet_with_subscripts(const FieldSystem& system, const FieldJet& jet);
ReadableForm readable_residual(const FieldEquations& equations, std::size_t varied_index);

}  // namespace maupertuis
