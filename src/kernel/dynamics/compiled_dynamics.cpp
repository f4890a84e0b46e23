#include "kernel/dynamics/compiled_dynamics.hpp"

#include <algorithm>
#include <tuple>

namespace maupertuis::dynamics {

CompiledDynamics::CompiledDynamics(const Program& program, WrittenDynamics written, const CompileOptions& options)
    : program_(program), sources_(std::move(written.numbers)), numbers_(sources_.size()),
      scratch_(std::max(straight::scratch_size(written.accelerations), straight::scratch_size(written.forces))),
      rest_(program.unknowns, 0.0) {
  std::tie(code_, report_) = straight::compile({std::move(written.accelerations), std::move(written.forces)}, options);
}

void CompiledDynamics::set_constants(const std::vector<double>& constants, const sparse::LiftedSystem& system,
                                     const std::vector<sparse::Pivot>* pivots) {
  for (std::size_t i = 0; i < sources_.size(); ++i) switch (const NumberSource& source = sources_[i]; source.what) {
      case NumberSource::OfCoefficient: numbers_[i] = value_of(source.coefficient, constants); break;
      case NumberSource::OfChoice: numbers_[i] = sparse::constant_factor(system.edges[source.index], program_, constants.data()); break;
      case NumberSource::OfPivot: numbers_[i] = (*pivots)[source.index].size; break;
    }
}

void CompiledDynamics::renew(const std::vector<double>& constants, const std::vector<bool>& live) {
  if (live_constants_ != live) {
    live_constants_ = live;
    live_.clear();
    for (std::uint32_t i = 0; i < sources_.size(); ++i)
      if (sources_[i].what == NumberSource::OfCoefficient && live[sources_[i].coefficient.constant]) live_.push_back(i);
  }
  for (const std::uint32_t i : live_) numbers_[i] = value_of(sources_[i].coefficient, constants);
}

}  // namespace maupertuis::dynamics
