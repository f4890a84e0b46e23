#pragma once
#include <maupertuis/field_run.hpp>
#include <maupertuis/fields.hpp>

#include "fields/field_rest.hpp"
#include "fields/resolution.hpp"
#include "fields/resting_fields.hpp"
#include "linear_algebra/dense.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// What modes of fields have in common, of one and of two space variables: ℒ to second order about rest, M c̈ + G ċ + K
/// c = 0, and its frequencies.
namespace maupertuis {

/// E0644; false.
bool refuse_modes_of(const FieldEquations& equations, Diagnostics& diagnostics, const std::string& why);

/// A second derivative of ℒ at rest, by two jets, as a function of place.
struct DensityEntry {
  std::size_t a = 0, b = 0;
  int da = 0, db = 0;  // derivatives by x
  int ta = 0, tb = 0;  // by t
  Expr value;
  int ya = 0, yb = 0;  // by y
};

struct DensityEntries {
  std::vector<DensityEntry> list;
  bool linear = true;  // constant second derivatives: the same about every rest
  FieldRest rest;
  /// What they are about, where that matters: "u = 0".
  std::string about(const FieldEquations& equations) const { return linear ? "" : rest.text(equations); }
  bool have_inertia() const;
};

/// By t itself, not by the fields.
bool changes_in_time(const FieldSystem& system, Expr e);
/// With given fields by their formulas; an empty handle where one has none.
Expr density_of(const FieldEquations& equations);
/// With force densities that have a potential. E0644 where one holds velocities or derivatives in space. About
/// `computed`, where there is one, else about the rest of the model that has a formula.
bool entries_of(const FieldEquations& equations, DensityEntries& out, Diagnostics& diagnostics,
                std::shared_ptr<const RestingFields> computed = nullptr);
/// The same, about a rest: one that has a formula, or one that Newton's method finds, which is then in `computed`.
/// E0644 where that counts, and there is none.
bool entries_at_rest(const FieldEquations& equations, DensityEntries& out, std::optional<ComputedRest>& computed,
                     Diagnostics& diagnostics);
/// Frequencies about a rest that was computed are off by what it is off by: `of`(rest) are those about one of fewer
/// functions, which come in `entries`.
void add_errors_of_rest(const FieldEquations& equations, const ComputedRest& computed, FieldModes& modes,
                        const std::function<FieldModes(const DensityEntries&)>& of);

/// M c̈ + G ċ + K c = 0 in the free unknowns, those that constraints tie together replaced.
struct SmallMotions {
  Eigen::MatrixXd mass, gyroscopic, stiffness;
  Eigen::MatrixXd from_free;  // all unknowns from the free ones
};

/// Why solve_conservative or solve_gyroscopic has no answer, in a sentence.
std::string no_small_motions(const SmallMotions& motions);
/// M c = μ (K + σ M) c, μ = 1/(ω² + σ): the lowest frequencies are the largest μ, which keep their digits.
bool solve_conservative(const SmallMotions& motions, std::size_t count, std::vector<double>& out,
                        std::vector<Eigen::VectorXd>& shapes);
/// (μ² + iμ Ĝ − M̂) y = 0 with μ = 1/ω, K = L Lᵀ, c = L⁻ᵀ y.
bool solve_gyroscopic(const SmallMotions& motions, std::size_t count, std::vector<double>& out);

/// How much of a function of a line lies between the points of quadrature, beside its size: its mean by them against
/// that of many places. `points`: place and weight.
double unseen_along(const std::function<double(double)>& f, double from, double length,
                    const std::vector<std::pair<double, double>>& points);
/// By how much a function of a line and the polynomials through the nodes of its elements differ, in the mean: beside
/// its own mean, or `beside_itself`, each place beside the value there. Squares of frequencies are Rayleigh's
/// quotients, so that a stiffness or a mass that is off by a part everywhere makes them wrong by that part at most.
double unfollowed_along(const std::function<double(double)>& f, const std::vector<double>& borders, int degree,
                        bool beside_itself);

/// What is not known of the coefficients, in parts of them.
struct UnseenParts {
  double between = 0;     // the points of quadrature
  double unfollowed = 0;  // by polynomials of the degree of the modes
};
/// They count as errors, what lies between points four times; false, and E0647, where they are much.
bool add_unseen(const FieldEquations& equations, const UnseenParts& unseen, FieldModes& modes,
                Diagnostics& diagnostics);

/// False and E0647 for a bump or a jump in what acts that lies between the points of quadrature, `points` of them in an
/// element along each direction, so that neither frequencies of two sizes nor samples of coefficients see it.
bool sees_what_acts(const FieldEquations& equations, const Borders& elements, const std::vector<int>& points,
                    Diagnostics& diagnostics);

/// Errors of frequencies that are computed on one size of functions after the other.
class FrequencyErrors {
 public:
  /// The frequencies of the next size, of which the first `counted` decide; `rows` of the matrices. True where they are
  /// those of the size before, but for rounding.
  bool settle(const std::vector<double>& frequencies, std::size_t counted, Eigen::Index rows);
  /// By how much each is off: the last change, several times it where changes fall slowly, and rounding.
  std::vector<double> errors() const;

 private:
  std::vector<double> before_, changes_, rounding_;
  double off_before_ = 0, missing_ = 1;
};

}  // namespace maupertuis
