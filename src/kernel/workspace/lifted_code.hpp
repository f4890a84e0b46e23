#pragma once
#include "kernel/reference/reference.hpp"
#include "kernel/straight_line/compile.hpp"

#include <optional>
#include <vector>

namespace maupertuis::workspace {

/// Machine code of a lifted solution, as it belongs to pivots that were chosen.
class LiftedCode {
 public:
  /// From now on code is wanted.
  void ask(const CompileOptions& options) { options_ = options; }
  const std::optional<CompileOptions>& options() const { return options_; }
  const std::optional<CompileReport>& report() const { return report_; }

  /// Line 0 is the solution; the factors and −M₀⁻¹ at the places that are set beside it (0: there is none).
  bool compile(const std::vector<straight::StraightLine>& lines);
  void drop();

  explicit operator bool() const { return bool{code_}; }
  template <class... Arrays>
  void run(std::size_t line, Arrays... arrays) {
    code_(line, arrays..., scratch_.data());
  }
  /// What the line that ran last says of its numbers.
  bool is_sound() const { return straight::sound(scratch_.data()); }

  std::size_t factor_line = 0, columns_line = 0;
  /// The code finds half of the symmetric −M₀⁻¹, in blocks of 8 × 8. [eights of columns] the eights of rows that it
  /// finds there; their mirror images are copied.
  std::vector<std::vector<std::size_t>> mirrored;

 private:
  std::optional<CompileOptions> options_;
  std::optional<CompileReport> report_;
  straight::Code code_;
  std::vector<double> scratch_;
};

}  // namespace maupertuis::workspace
