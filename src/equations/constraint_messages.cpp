#include <maupertuis/constraint_analysis.hpp>
#include <maupertuis/print.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

class Messages {
 public:
  Messages(const ConstraintAnalysis& analysis, const EquationsOfMotion& equations, const MotionState* start,
           Diagnostics& diagnostics)
      : analysis_(analysis),
        equations_(equations),
        system_(*equations.system),
        start_(start),
        diagnostics_(diagnostics) {}

  void write() {
    if (!analysis_.clashing.empty()) return clash();
    for (std::size_t i = 0; i < analysis_.constraints.size(); ++i) {
      const ConstraintReport& report = analysis_.constraints[i];
      // A velocity constraint that adds nothing has lost nothing either.
      if (report.redundant)
        redundant(i, report);
      else if (report.constraint_class == ConstraintClass::Integrable)
        disguised(i, report);
      else if (report.constraint_class == ConstraintClass::Nonlinear)
        nonlinear(i);
    }
    for (const IntegrableCombination& found : analysis_.combinations) combination(found);
    of_the_whole();
  }

 private:
  Span span(std::size_t i) const { return system_.constraints[i].span; }

  /// `rod`, or: constraint 2.
  std::string label(std::size_t i) const {
    const std::string plain = system_.constraint_label(i);
    return system_.constraints[i].name.empty() ? plain : "`" + plain + "`";
  }

  std::string labels(const std::vector<std::size_t>& of) const {
    std::string out;
    for (std::size_t k = 0; k < of.size(); ++k)
      out += (k == 0 ? "" : k + 1 == of.size() ? " and " : ", ") + label(of[k]);
    return out;
  }

  std::string text(Expr e) const { return to_plain(e, equations_.order); }

  void clash() {
    if (diagnostics_.has_errors()) return;  // the start said so
    diagnostics_.error("E0601", span(analysis_.clashing.back()),
                       fmt::format("no motion satisfies {}", labels(analysis_.clashing)),
                       "These constraints can hold together at one instant only, so that the motion could not go on.",
                       "Check how they depend on t, or leave one of them out.");
  }

  bool told_of(Span place) const {
    const auto items = diagnostics_.items();
    return std::any_of(items.begin(), items.end(), [&](const Diagnostic& d) {
      return d.code == "W0425" && d.span && d.span->begin == place.begin;
    });
  }

  void redundant(std::size_t i, const ConstraintReport& report) {
    if (told_of(span(i))) return;  // written twice
    if (report.depends_on.empty()) {
      diagnostics_.warning(
          "W0602", span(i), fmt::format("the gradient of {} vanishes wherever it holds", label(i)),
          "It has no direction in which a force could keep it, so that its multiplier is not determined.",
          "Write it in another form: x = y instead of (x - y)^2 = 0.");
      return;
    }
    std::vector<std::size_t> all = report.depends_on;
    all.push_back(i);
    diagnostics_.warning(
        "W0602", span(i), fmt::format("{} is redundant: it follows from {}", label(i), labels(report.depends_on)),
        fmt::format("The motion stays the same, but how {} share the forces is not determined{}.", labels(all),
                    system_.frictions.empty() && system_.contacts.empty() ? "" : ", nor friction that depends on them"),
        "Leave one of them out where their forces matter.");
  }

  /// F = 0, or F and its value at the start.
  std::string line_to_write(const FirstIntegral& integral) const {
    const Expr moving = in_terms_of_motion(system_, {&integral.value, 1}).front();
    double value = 0;
    if (start_) {
      Bindings b = parameter_bindings(system_);
      b[system_.context->time()] = start_->t;
      for (std::size_t i = 0; i < start_->q.size(); ++i) b[system_.coordinates[i].q] = start_->q[i];
      value = evaluate(moving, b);
    }
    if (std::abs(value) < 1e-12) return fmt::format("Write `constraint {} = 0` instead.", text(integral.value));
    if (!std::isfinite(value))
      return fmt::format("Write it as `constraint {} = …`, in a form that the start allows.", text(integral.value));
    return fmt::format("Write `constraint {} = …` instead; the value at the start is {:g} in SI units.",
                       text(integral.value), value);
  }

  void disguised(std::size_t i, const ConstraintReport& report) {
    const std::string name = label(i);
    if (!report.integral.found()) {
      diagnostics_.warning(
          "W0603", span(i), fmt::format("{} is holonomic in disguise", name),
          "It can be integrated to a relation between the coordinates, which the velocities alone do not hold exactly.",
          "Write that relation instead.");
      return;
    }
    const Expr value = report.integral.value;
    if (value.is_symbol() && value.role() == Role::Coordinate) {
      diagnostics_.note("N0605", span(i), fmt::format("{} fixes the coordinate `{}`", name, value.name()),
                        "A velocity that is always 0 leaves the coordinate at its start value: it is a parameter.",
                        fmt::format("Make `{}` a parameter, or give its value as a constraint.", value.name()));
      return;
    }
    diagnostics_.warning(
        "W0603", span(i), fmt::format("{} is holonomic in disguise: {} = const", name, text(value)),
        "Given for the velocities it loses the level of the positions: the constant is whatever the start makes it.",
        line_to_write(report.integral));
  }

  void nonlinear(std::size_t i) {
    diagnostics_.note(
        "N0607", span(i), fmt::format("{} is not linear in the velocities", label(i)),
        "Its force follows Chetaev's rule, ∂ψ/∂q' times λ, which is a choice beyond d'Alembert's principle.", "");
  }

  void combination(const IntegrableCombination& found) {
    const std::string which =
        found.integral.found() ? fmt::format(": {} = const", text(found.integral.value)) : std::string();
    diagnostics_.note("N0609", span(found.constraints.back()),
                      fmt::format("a combination of {} is integrable{}", labels(found.constraints), which),
                      "Each of them alone is non-holonomic, but together they keep the coordinates on a surface.",
                      found.integral.found() ? "That relation can be a constraint in the place of one of them." : "");
  }

  void of_the_whole() {
    if (analysis_.constraints.empty()) return;
    if (analysis_.singular_start())
      diagnostics_.warning(
          "W0604", span(0),
          fmt::format("the constraints are singular at the start: rank {} instead of {}", analysis_.start_rank,
                      analysis_.rank),
          "There they leave more directions free than elsewhere, so that the motion may not be determined.",
          "Start from a configuration beside it.");
    if (analysis_.rank_varies)
      diagnostics_.note(
          "N0608", span(0), "the rank of the constraints is not the same everywhere",
          "At some configurations they leave more directions free; the freedoms are those of general ones.", "");
    if (analysis_.instantaneous_freedoms == 0)
      diagnostics_.note("N0606", span(0), "the constraints leave no freedom",
                        "They prescribe the motion alone; masses and forces decide only the forces of constraint.", "");
  }

  const ConstraintAnalysis& analysis_;
  const EquationsOfMotion& equations_;
  const MechanicalSystem& system_;
  const MotionState* start_;
  Diagnostics& diagnostics_;
};

}  // namespace

void report_constraints(const ConstraintAnalysis& analysis, const EquationsOfMotion& equations,
                        const MotionState* start, Diagnostics& diagnostics) {
  Messages(analysis, equations, start, diagnostics).write();
}

}  // namespace maupertuis
