#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <string>
#include <utility>
#include <vector>

namespace maupertuis {

/// Writes the lines; `section` stays until the next one is opened.
class StepWriter {
 public:
  explicit StepWriter(const EquationsOfMotion& equations) : equations_(equations), system_(*equations.system) {}

  std::vector<DerivationStep> take() { return std::move(steps_); }
  void open(std::string section) { section_ = std::move(section); }

  void sentence(std::string rule, std::string text) {
    DerivationStep step;
    step.section = section_;
    step.rule = std::move(rule);
    step.sentence = std::move(text);
    steps_.push_back(std::move(step));
  }

  /// left = readable(value). The value may hold d/dt nodes, which are carried out.
  DerivationStep& formula(std::string left, std::string left_latex, Expr value, std::string rule) {
    ReadableForm form = readable(expand_time_derivatives(value), equations_.order);
    return as_is(std::move(left), std::move(left_latex), std::move(form), std::move(rule));
  }

  /// left = form, as it stands.
  DerivationStep& as_is(std::string left, std::string left_latex, ReadableForm form, std::string rule) {
    DerivationStep step;
    step.section = section_;
    step.rule = std::move(rule);
    step.left = std::move(left);
    step.left_latex = std::move(left_latex);
    step.right = form.value;
    step.intermediates = std::move(form.intermediates);
    steps_.push_back(std::move(step));
    return steps_.back();
  }

  const EquationsOfMotion& equations() const { return equations_; }
  const MechanicalSystem& system() const { return system_; }
  Context& context() const { return *system_.context; }

 private:
  const EquationsOfMotion& equations_;
  const MechanicalSystem& system_;
  std::string section_;
  std::vector<DerivationStep> steps_;
};

inline std::string latex_name(const std::string& name) { return name.size() > 1 ? "\\mathrm{" + name + "}" : name; }

inline std::string plural(std::size_t n, const char* word) {
  return std::to_string(n) + " " + word + (n == 1 ? "" : "s");
}

}  // namespace maupertuis
