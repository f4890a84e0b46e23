#pragma once
#include "simulation/contact/impact.hpp"
#include "simulation/hybrid_joint_forces.hpp"
#include "simulation/hybrid_journal.hpp"
#include "simulation/hybrid_space.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace maupertuis::hybrid {

/// An impact that was carried out.
struct Impact {
  ImpactProblem problem;
  ImpactResult result;
  Eigen::VectorXd v_before;
  bool ends_bounces = false;
};

/// What contacts that are hit do to the velocities, and where infinitely many bounces end.
class Impacts {
 public:
  Impacts(const Problem& problem, State& here, UsualSizes& sizes, const Choices& choices, JointForces& forces,
          SpaceFriction& space, Carried& carried, Journal& journal)
      : problem_(problem),
        here_(here),
        sizes_(sizes),
        choices_(choices),
        forces_(forces),
        space_(space),
        carried_(carried),
        journal_(journal) {}
  void start() { bounces_.assign(problem_.system.contacts.size(), {}); }

  struct Outcome {
    std::optional<std::string> trouble;  // why no impulses are found, where that is so
    std::optional<Impact> impact;        // none where nothing closes
  };
  /// What closing contacts do to the velocities. Those of a cycle of bounces that ends here touch too.
  Outcome hit(std::vector<std::size_t>& touching);
  /// A contact that opens so slowly that it would be pressed again before its gap can be told from zero is closed: its
  /// speed is taken out. v²/(2 |g̈|) is the height of such a flight, g̈ being what its own force takes back.
  void close_lowest_flights(const std::vector<std::size_t>& touching, const Met& met, double bound);
  /// What is set down anew bounces anew. `values`: at the state that is set.
  void begin_anew(const std::vector<double>& q, const std::vector<double>& v, const ContactValues& values);

  /// Of the last impact, where it was the end of infinitely many.
  const std::optional<EndOfBounces>& bounces_ended() const { return end_of_bounces_; }
  bool has_bounced(std::size_t contact) const { return !bounces_[contact].last.empty(); }

 private:
  struct Bounces {
    std::vector<std::pair<double, double>> last;  // (t, speed) of the last impacts
    double fastest = 0;                           // impact of the series that goes on, not rounding of other speeds
    double before = 0;                            // the speed of the impact before
  };

  bool closes(std::size_t contact, const ContactValues& values) const;
  bool is_slow(std::size_t contact, const ContactValues& values) const;
  struct LowFlights {
    std::vector<std::size_t> contacts;
    double duration = 0;  // of all that would follow
  };
  LowFlights pressed_through_flights(const std::vector<std::size_t>& touching, const Met& met,
                                     const ContactValues& values, double bound);
  ImpactProblem problem_of(const std::vector<std::size_t>& touching, const ContactValues& values) const;
  void note_bounce(std::size_t contact, double speed, double restitution);
  std::optional<double> accumulation(std::size_t contact, double speed);
  std::optional<double> accumulation_among(std::vector<std::size_t>& touching, const ContactValues& values);
  bool slips_may_stop_before(double end, const std::vector<std::size_t>& touching, const ContactValues& values) const;
  double height_of_flight(std::size_t contact, double speed, const ContactValues& values) const;
  bool is_lost_in_rounding(const std::vector<std::size_t>& touching, const ContactValues& values) const;
  void press_all(ImpactResult& result, const std::vector<std::size_t>& touching, const ContactValues& values) const;
  std::optional<std::string> trouble_of(const ImpactResult& result, const std::vector<std::size_t>& touching,
                                        const ContactValues& values) const;
  void carry_out(const ImpactResult& result, const std::vector<std::size_t>& touching, std::size_t contacts, bool last);
  bool bounces(std::size_t contact) const { return here_.values().restitution[contact] > 0; }
  void tell_order(const ImpactProblem& problem, const ImpactResult& first, const Eigen::VectorXd& v);
  void book_energy(const ImpactResult& result);
  void record_impulses(const ImpactResult& result, bool last);
  void end_series(const std::vector<std::size_t>& touching);

  const Problem& problem_;
  State& here_;
  UsualSizes& sizes_;
  const Choices& choices_;
  JointForces& forces_;
  SpaceFriction& space_;
  Carried& carried_;
  Journal& journal_;
  std::vector<Bounces> bounces_;    // [contacts]
  std::vector<std::size_t> cycle_;  // contacts that bounce together towards an end of their bounces
  std::optional<EndOfBounces> end_of_bounces_;
};

}  // namespace maupertuis::hybrid
