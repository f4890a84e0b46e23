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
  DerivationStep& formula(Layout left, Expr value, std::string rule) {
    ReadableForm form = readable(expand_time_derivatives(value), equations_.order);
    return as_is(std::move(left), std::move(form), std::move(rule));
  }

  /// left = form, as it stands.
  DerivationStep& as_is(Layout left, ReadableForm form, std::string rule) {
    DerivationStep step;
    step.section = section_;
    step.rule = std::move(rule);
    step.left = std::move(left);
    step.right = form.value;
    step.intermediates = std::move(form.intermediates);
    steps_.push_back(std::move(step));
    return steps_.back();
  }

  Layout symbol(Expr e) const { return lay_out(e, equations_.order); }
  /// A name with dots, or primes where the independent variable is not t.
  Layout name(const std::string& text, int dots = 0) const {
    return layouts::name(text, dots, system_.independent != "t");
  }
  /// A quantity of a point or body: plain text puts a dot between the two, print the name below.
  Layout component(const std::string& owner, const std::string& quantity, int dots = 0,
                   const std::string& axis = {}) const {
    std::vector<Layout> below{layouts::name(owner)};
    if (!axis.empty()) below.push_back(layouts::name(axis));
    const std::string tail = axis.empty() ? "" : "." + axis;
    return layouts::labelled(owner + "." + quantity + tail + std::string(static_cast<std::size_t>(dots), '\''),
                             layouts::indexed(name(quantity, dots), std::move(below)));
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

inline std::string plural(std::size_t n, const char* word) {
  return std::to_string(n) + " " + word + (n == 1 ? "" : "s");
}

}  // namespace maupertuis
