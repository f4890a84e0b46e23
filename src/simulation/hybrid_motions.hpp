#pragma once
#include "simulation/hybrid_carried.hpp"
#include "simulation/hybrid_slips.hpp"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace maupertuis::hybrid {

/// A motion in one mode.
struct ModeMotion {
  ContactMode mode;
  std::shared_ptr<const ModeProgram> program;
  const std::vector<Watch>& watches() const { return program->watches; }
  Given given;
  std::vector<double> stops;  // [contacts] as in ModeDetails; empty without friction in space
  std::unique_ptr<TaylorStepper> stepper;
  std::size_t asked_for = 0;  // the last time, in turns of asking
};

/// The motions of modes, each made when it is first asked for, and which of them goes on.
class ModeMotions {
 public:
  ModeMotions(const Problem& problem, const State& here, const SpaceSlips& slips)
      : problem_(problem), here_(here), slips_(slips) {}

  bool has_begun() const { return now_ != nullptr; }
  ModeMotion& now() const { return *now_; }
  TaylorStepper& stepper() const { return *now_->stepper; }
  void go_on_in(const ContactMode& mode, const Given& given = {}) { now_ = &in(mode, given); }

  /// The motion that goes on, in its last step and in a moment that was passed over before that.
  bool covers(double t) const;
  void state(double t, std::span<double> q, std::span<double> v) const;
  /// With what is given of multipliers; of integrals those of its mode alone.
  Sample sample(double t) const;
  Sample step_start() const;
  PassedMoment& passed_moment() { return passed_moment_; }

  /// It stays until others are asked for. Of what is given there is another motion each time.
  ModeMotion& in(const ContactMode& mode, const Given& given = {});
  /// What the motion in a mode does from here; nothing where there is none.
  std::optional<Outlook> outlook_in(const ContactMode& mode, double bound);
  /// A motion of a mode that did not fit makes room.
  void forget(const ContactMode& mode);
  /// In the context of the model; they stay as long as this.
  const EquationsOfMotion& equations_in(const ContactMode& mode);
  /// From here on gaps that are touched are told too: directions have to know of them.
  void tell_touches();

 private:
  std::unique_ptr<ModeMotion> made(const ContactMode& mode, const Given& given, const ModeDetails& details) const;
  void treat_events(ModeMotion& motion) const;
  void forget_oldest();
  double covered(double t) const { return passed_moment_.covered(t, stepper().step_start().t); }
  Sample with_given(Sample sample) const;

  const Problem& problem_;
  const State& here_;
  const SpaceSlips& slips_;
  std::map<std::string, std::unique_ptr<ModeMotion>> modes_;
  std::map<std::string, std::unique_ptr<EquationsOfMotion>> equations_;  // that neighbours have asked for
  ModeMotion* now_ = nullptr;
  PassedMoment passed_moment_;
  std::size_t asked_for_ = 0;  // modes so far
  bool tells_touches_ = false;
};

}  // namespace maupertuis::hybrid
