#include "kernel/workspace/lifted_code.hpp"

#include <algorithm>
#include <tuple>

namespace maupertuis::workspace {

bool LiftedCode::compile(const std::vector<straight::StraightLine>& lines) {
  for (const straight::StraightLine& line : lines)
    scratch_.resize(std::max(scratch_.size(), straight::scratch_size(line)));
  std::tie(code_, report_) = straight::compile(lines, *options_);
  if (!code_) factor_line = columns_line = 0;
  return bool{code_};
}

void LiftedCode::drop() {
  code_ = {};
  report_.reset();
  factor_line = columns_line = 0;
}

}  // namespace maupertuis::workspace
