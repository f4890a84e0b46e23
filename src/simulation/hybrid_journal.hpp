#pragma once
#include "simulation/hybrid_problem.hpp"
#include "simulation/hybrid_sizes.hpp"
#include "simulation/hybrid_state.hpp"

#include <maupertuis/simulation.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace maupertuis {

class IndependentRows;

/// What a run through modes tells besides the motion.
struct HybridRecord {
  /// An event whose function is no number where some steps begin, or where the run ends.
  struct WithoutValue {
    std::size_t event = 0, times = 0, of = 0;
    double first = 0;  // s
  };
  std::vector<WithoutValue> without_value;
  std::string first_mode;
  std::vector<Happening> happenings;
  EnergyBooks books;                      // friction and dampers: at the end of the run
  std::vector<std::string> remarks;       // a sentence each, each once
  std::optional<std::string> stopped_by;  // the event that stopped the run
  std::optional<Span> ended_by;           // the statement for which the motion cannot go on
};

}  // namespace maupertuis

namespace maupertuis::hybrid {

/// Where infinitely many bounces have ended.
struct EndOfBounces {
  double t = 0;
};

/// What is told of the modes that a motion goes through, and how much of it.
class Journal {
 public:
  Journal(const Problem& problem, const State& here, const UsualSizes& sizes)
      : problem_(problem), here_(here), sizes_(sizes) {}
  void start();

  void note_without_value(const HybridRecord::WithoutValue& event) { record_.without_value.push_back(event); }
  const HybridRecord& record() const { return record_; }
  EnergyBooks& books() { return record_.books; }
  std::vector<Happening> take_happenings() { return std::move(record_.happenings); }
  std::size_t size() const { return record_.happenings.size(); }

  /// What happens here and now. The reference stays until the next one.
  Happening& add(Happening::Kind kind, const std::string& name, double impulse = 0, double speed = 0,
                 const std::string& remark = {});
  /// A sentence, told once; of many the first ones.
  void remark(const std::string& sentence);
  void stop_by(const std::string& event);
  void end_by(std::optional<Span> statement) { record_.ended_by = statement; }
  /// The first mode of the run.
  void begin_in(const ContactMode& before, const ContactMode& mode, std::span<const double> accelerations);
  /// What contacts and frictions do as one mode follows another. `end`: of the bounces that close contacts here.
  void change_mode(const ContactMode& before, const ContactMode& after, std::span<const double> accelerations,
                   const std::optional<EndOfBounces>& end);
  /// What was told from `first` on is known to `error`.
  void note_errors(std::size_t first, double error);
  /// Of a rest whose forces were not determined, in what was told from `first` on.
  void note_end_of_rest(std::size_t first);
  /// A limit of friction below zero is none: the force would drive what it is to brake.
  void tell_limits(const ContactValues& values);
  /// Forgets what would be after the end of the run: an end of bounces that is told may lie beyond it.
  void end_at(double t, bool forwards);
  /// More events and changes than are followed end the run: the reason. So do those whose rate, steady or that of
  /// events which grows, shows that there would be more up to its end, if nothing may stop it before: the fewer there
  /// were, the more have to be foreseen. Impacts whose rate grows may come to their end: those are counted.
  std::optional<std::string> too_many(double t, double bound);

 private:
  struct Rate {
    std::size_t count = 0;
    double length = 0;   // in which the last `count` of them followed each other
    double to_come = 0;  // up to the end of the run
  };
  bool may_stop() const;
  std::optional<Rate> rate_so_far(double bound, double t) const;
  std::vector<bool> idle_in(const ContactMode& before, const ContactMode& mode,
                            std::span<const double> accelerations) const;
  IndependentRows rows_that_carry(const ContactMode& mode, const ContactValues& values) const;
  void change_contact(std::size_t i, const ContactMode& before, const ContactMode& after, const std::vector<bool>& idle,
                      const std::optional<EndOfBounces>& end);
  void tell_mode(const std::string& mode, std::size_t first);

  const Problem& problem_;
  const State& here_;
  const UsualSizes& sizes_;
  HybridRecord record_;
  std::size_t left_out_remarks_ = 0;
  std::size_t next_look_ = 0;  // so many happenings until their rate is looked at again
  std::vector<bool> idle_;     // [contacts] open in the mode, but others keep them closed
};

}  // namespace maupertuis::hybrid
