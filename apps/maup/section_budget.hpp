#pragma once
#include "console.hpp"

#include <maupertuis/diagnostic.hpp>
#include <maupertuis/interrupt_scope.hpp>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace maupertuis::app {

/// The time that a page may take, shared among its sections in the order in which they are computed: none takes more
/// than half of what is left, and one that does not come within it is left out with a warning (W0813).
class SectionBudget {
 public:
  /// The names that --sections takes, in the order of the page.
  static const std::vector<std::string>& names();

  /// `seconds`: none is no bound. `chosen`: empty is all. `console` shows progress where it is a terminal.
  SectionBudget(std::optional<double> seconds, std::vector<std::string> chosen, const Console& console);
  SectionBudget(const SectionBudget&) = delete;
  SectionBudget& operator=(const SectionBudget&) = delete;

  bool wanted(std::string_view section) const;
  /// Does the work of a section that is wanted, which looks at the interrupt it is given, as does all work on
  /// `context`. False where it is not wanted, or did not come in time: then nothing of it is to be shown. Ctrl-C is
  /// passed on as Interrupted.
  bool carry_out(std::string_view section, Context& context, const std::function<void(const Interrupt&)>& work);
  /// The same for what the page cannot be without, whatever is chosen.
  bool attempt(std::string_view section, Context& context, const std::function<void(const Interrupt&)>& work);
  /// For work of which a part is worth showing: the section is not left out.
  void carry_out_in_part(std::string_view section, const std::function<void(const Interrupt&)>& work);

  /// Notes that a section, if it is wanted, cannot be had: what it is made from did not come.
  void leave_out(std::string_view section);

  const std::vector<std::string>& written() const { return written_; }
  const std::vector<std::string>& left_out() const { return left_out_; }
  /// W0813 for each section that did not come.
  Diagnostics warnings() const;

 private:
  std::optional<double> begin(std::string_view section);
  void note(std::string_view section, bool came);

  std::chrono::steady_clock::time_point end_;
  std::optional<double> seconds_;
  std::vector<std::string> chosen_, written_, left_out_;
  const Console& console_;
};

}  // namespace maupertuis::app
