#pragma once
#include "simulation/hybrid_met.hpp"
#include "simulation/hybrid_problem.hpp"
#include "simulation/hybrid_sizes.hpp"
#include "simulation/hybrid_state.hpp"

#include <limits>
#include <optional>
#include <vector>

namespace maupertuis::hybrid {

struct ModeMotion;

/// What the motion in a mode is given besides the parameters of the model (ModeDetails).
struct Given {
  bool is_preload = false;
  std::vector<bool> begins;                                // [contacts] or empty
  std::vector<double> values;                              // of its parameters
  double end = std::numeric_limits<double>::infinity();    // until when directions of slips that begin hold
  double preload(std::size_t constraint, double t) const;  // 0 where none is given
  friend bool operator==(const Given&, const Given&) = default;
};

/// The order of steps while something slides in space: with larger ones coefficients of its direction leave the range
/// of numbers long before it stops. Orders that differ by less than 4 stay apart, as those of companions have to.
int order_beside_stops(const TaylorOptions& options);

/// Slips in the planes of contacts in space: which of them begin at an instant, which way, and how slow ones stop.
class SpaceSlips {
 public:
  SpaceSlips(const Problem& problem, const State& here, const UsualSizes& sizes)
      : problem_(problem), here_(here), sizes_(sizes) {}
  void start();

  /// None begins yet. Slips whose beginning is over, and which nothing has stopped: however slow they are, they have
  /// just begun.
  void begin_instant(const ModeMotion& before, const Met& met);
  void begin(std::size_t contact) { begins_[contact] = true; }
  /// `towards`: an angle in the plane of contact.
  void begin(std::size_t contact, double towards) { begins_[contact] = true, towards_[contact] = towards; }
  bool begins(std::size_t contact) const { return begins_[contact]; }
  bool has_just_begun(std::size_t contact) const { return just_began_[contact]; }
  bool slides(std::size_t contact, const ContactValues& values) const;

  /// The speed at which a slip counts as stopped, well above what is rounding of it; in steps of ten so that the motion
  /// of a mode serves many of them. Companions stop it earlier, so that their difference tells what the moment to the
  /// end of the slip leaves open.
  double stop_speed(std::size_t contact) const;
  std::vector<double> stop_speeds() const;  // [contacts]
  /// Whether a slip has become so fast since its mode began that the speed at which it was to stop is rounding.
  bool outgrow_stops(const ModeMotion& motion) const;
  /// Friction that barely stops a slip takes many steps, which shrink with it: they are to be seen to end, so that it
  /// is not looked beyond twice the time at which the slips that fall would have stopped. Infinite where few steps were
  /// made.
  double latest_end(const ModeMotion& motion) const;
  /// ∂g/∂q − μ Σ_k d_k ∂v_tk/∂q̇: what a unit of the normal force does while it slides along d = v_t/|v_t|, or begins
  /// to slide along d.
  SparseRow sliding_force(std::size_t contact, const ContactValues& values) const;
  /// What a unit of the normal force of a contact that slides in this mode does to its own g̈, with its friction, and
  /// without. In Painlevé's paradox the first is not above 0. Nothing where it does not slide.
  struct OwnResponse {
    double with_friction, without;
  };
  std::optional<OwnResponse> own_response(std::size_t contact, const ContactMode& mode,
                                          const ContactValues& values) const;
  /// What a motion in this mode is given: the directions of slips that begin. Nothing where it has none.
  std::optional<Given> directions_in(const ContactMode& mode, double bound) const;

 private:
  const Problem& problem_;
  const State& here_;
  const UsualSizes& sizes_;
  std::vector<bool> begins_;      // [contacts] at this instant
  std::vector<bool> just_began_;  // [contacts] before this instant
  std::vector<double> towards_;   // [contacts] in which direction they begin, an angle in the plane of contact
};

}  // namespace maupertuis::hybrid
