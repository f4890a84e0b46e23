#pragma once
#include "simulation/contact/contact_functions.hpp"
#include "simulation/function_kernels.hpp"

#include <maupertuis/contact_mode.hpp>
#include <maupertuis/kernel.hpp>

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace maupertuis {

/// An event function of a mode, and what a root of it means.
struct ModeWatch {
  enum class What { Until, Event, Gap, Force, Hold, Slip, Normal } what = What::Event;
  std::size_t index = 0;  // of the event, the contact, the friction
  bool lower = false;     // Hold in the plane: of its two limits the one at −μ_s N
  bool keeps_sign() const { return what != What::Until && what != What::Event; }  // must not be negative in its mode
  /// A gap or a force that comes to 0 and goes back changes nothing; a slip may come to rest there.
  bool touches_count() const { return !keeps_sign() || what == What::Slip; }
};

/// The degree to which the direction of a slip that begins is known in double.
inline constexpr int direction_degree = 20;

/// The degree in time of forces that are given at a rest which does not determine them.
inline constexpr int preload_degree = 6;

/// What the motion in a mode needs to be told besides.
struct ModeDetails {
  std::vector<double> stops;  // [contacts] the speed at which a slip in space counts as stopped, where it slides
  /// Closed contacts, friction that sticks and constraints carry given forces, and multipliers add to these: so that a
  /// statically indeterminate rest has forces that keep its conditions: Σ_k p_k (t − t_0)^k. Parameters after those of
  /// the model: t_0, then the coefficients of each, in the order of the constraints of the mode that contacts and
  /// frictions make; those of the system's own last.
  bool preloaded = false;
  /// [contacts] or empty. A slip in space begins: its friction is −μ N d with d = Σ_k d_k (t − t_0)^k instead of
  /// v_t/|v_t|. Of each such contact parameters after those of the model: t_0, then the coefficients of one component
  /// of d, then those of the other.
  std::vector<bool> begins;
  int direction_degree = maupertuis::direction_degree;
};

/// The motion in one mode as a program: its events are what is watched, its integrands the work on h_E, what friction
/// took, what D took.
struct ModeProgram {
  std::vector<ModeWatch> watches;
  Kernel kernel;
  std::optional<Kernel> slips;  // where slips begin: the motion with their components as events, two a contact
};

/// The programs that runs of one model through modes share: of its modes, each made when it is first asked for, of its
/// contacts, and of what events set. A program depends on the model and its mode alone, to the bit: modes are derived
/// in contexts of their own. Any number of threads, as long as nobody makes expressions in the context of the model.
class ModeLibrary {
 public:
  /// `wanted`: observables in λ of contacts too; its first event, if there is one, ends the run. The model and the
  /// equations outlive it.
  ModeLibrary(const Model& model, const EquationsOfMotion& equations, const WantedFunctions& wanted);

  const Model& model() const { return model_; }
  const EquationsOfMotion& equations() const { return equations_; }
  const MechanicalSystem& system() const { return system_; }  // with reactions in normal forces put in
  /// With the events of the model after those that were wanted.
  const WantedFunctions& wanted() const { return wanted_; }
  std::shared_ptr<const ContactPrograms> contacts() const { return contacts_; }
  /// h_E, then the values that events set, one after the other; of q, q̇, t.
  const FunctionKernel& sets() const { return sets_; }
  /// A by rows [m × n], φ or ψ [m], dφ/dt or ψ [m]; of q, q̇, t. Empty where no event sets a state.
  const FunctionKernel& constraints() const { return constraints_; }

  std::shared_ptr<const ModeProgram> program(const ContactMode& mode, const ModeDetails& details);

 private:
  ModeProgram derived(const ContactMode& mode, const ModeDetails& details) const;

  const Model& model_;
  const EquationsOfMotion& equations_;
  MechanicalSystem system_;
  WantedFunctions wanted_;
  std::shared_ptr<const ContactPrograms> contacts_;
  FunctionKernel sets_, constraints_;
  std::mutex guard_;
  struct Kept {
    std::shared_ptr<const ModeProgram> program;
    std::size_t asked_for = 0;  // the last time, in turns of asking
  };
  std::map<std::string, Kept> kept_;
  std::size_t asked_for_ = 0;
};

/// What tells one mode from another, and motions in it.
std::string key_of(const ContactMode& mode, const ModeDetails& details);

}  // namespace maupertuis
