#include "fields/coupled_errors.hpp"

#include "fields/field_sides.hpp"
#include "fields/start_fit.hpp"

#include <maupertuis/repeated_evaluation.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

namespace maupertuis {
namespace {

constexpr int more_orders = 2;  // of the elements of a sharper run
constexpr double gain_of_kinks = 2;

/// At the place of a question and beside it.
double largest_difference(const CoupledRun& one, const CoupledRun& other, std::size_t question) {
  double out = std::abs(one.answers[question] - other.answers[question]);
  const std::vector<double>&a = one.near[question], &b = other.near[question];
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) out = std::max(out, std::abs(a[k] - b[k]));
  return out;
}

/// The error of each answer from runs on two coarser meshes: what halving the elements gains is measured, not believed,
/// since a start or a load with a kink lets no high order come about. Beside a break, of the start or under a load that
/// moves through elements, differences may be small by chance: that of the coarser meshes counts too, less what two
/// halvings gain there at least (`gain_at_breaks` each; 0: no breaks). Of meshes of lower orders less is believed of a
/// gain, and the difference of the coarser two counts likewise.
std::vector<double> errors_of(const CoupledRun& fine, const std::optional<CoupledRun>& half,
                              const std::optional<CoupledRun>& quarter, double gain_at_breaks, bool lower_orders) {
  constexpr double least = 1.5, of_halvings = 33, of_orders = 5;  // of a gain that two differences show
  const double most = lower_orders ? of_orders : of_halvings;
  std::vector<double> out;
  for (std::size_t i = 0; i < fine.answers.size(); ++i) {
    if (!half) {
      out.push_back(std::numeric_limits<double>::infinity());
      continue;
    }
    const double first = largest_difference(fine, *half, i);
    const double second = quarter ? largest_difference(*half, *quarter, i) : 0;
    const double gain = first > 0 ? std::clamp(second / first, least, most) - 1 : 1;
    if (gain_at_breaks > 0)
      out.push_back(std::max(first, second / (gain_at_breaks * gain_at_breaks)));
    else
      out.push_back(std::max(first / gain, lower_orders ? second / (most * most) : 0));
  }
  return out;
}

/// The error of each answer from a run that is off by up to a fifth of it itself: by the difference to it, and as at
/// single places both may agree by chance, a sixteenth of what it is beside it.
std::vector<double> errors_by_sharper_run(const CoupledRun& fine, const CoupledRun& sharp) {
  constexpr double own = 5.0 / 4, by_chance = 1.0 / 16;
  std::vector<double> out;
  for (std::size_t i = 0; i < fine.answers.size(); ++i)
    out.push_back(own * std::abs(fine.answers[i] - sharp.answers[i]) + by_chance * largest_difference(fine, sharp, i));
  return out;
}

/// The same where a derivative jumps, which runs along the field: errors fall by the n-th power of the width of
/// elements, as half of them show, and by no less than that of the order, `less` from one to the other.
std::vector<double> errors_by_sharper_run(const CoupledRun& fine, const CoupledRun& sharp, const CoupledRun& half,
                                          double less) {
  constexpr double lowest = 1, highest = 8, by_chance = 1.0 / 4;
  std::vector<double> out;
  for (std::size_t i = 0; i < fine.answers.size(); ++i) {
    const double narrow = largest_difference(fine, sharp, i), wide = largest_difference(half, sharp, i);
    const double n = narrow > 0 ? std::clamp(std::log2(wide / narrow), lowest, highest) : highest;
    const double at_place = std::abs(fine.answers[i] - sharp.answers[i]);
    out.push_back((at_place + by_chance * narrow) / (1 - std::pow(less, n)));
  }
  return out;
}

/// Whether an element of one mesh is one of the other as well: there both may agree about what is wrong.
bool share_elements(const SemiDiscrete& fine, const SemiDiscrete& coarse) {
  const std::vector<double>&a = fine.borders(), &b = coarse.borders();
  const double near = 1e-9 * (a.back() - a.front());
  const auto is_border_of_fine = [&](double x) {
    const auto at = std::lower_bound(a.begin(), a.end(), x - near);
    return at != a.end() && *at <= x + near ? at - a.begin() : -1;
  };
  for (std::size_t i = 1; i < b.size(); ++i) {
    const auto left = is_border_of_fine(b[i - 1]), right = is_border_of_fine(b[i]);
    if (left >= 0 && right == left + 1) return true;
  }
  return false;
}

/// A coarser mesh: of a `by`th of the cells, or, where places leave an element as it is then, of a lower order. Nothing
/// where the order cannot be lowered.
std::optional<SemiDiscrete> coarser_mesh(const SemiDiscrete& fine, const CoupledProblem& p, int by) {
  constexpr int first_halving = 2, least_order = 2;
  Diagnostics unheard;
  const auto with = [&](int cells, int order) {
    return SemiDiscrete::make(p.model, p.equations, cells, order, unheard);
  };
  const auto half = with(std::max(p.cells / first_halving, 1), p.order);
  if (!half || !share_elements(fine, *half))
    return by == first_halving ? half : with(std::max(p.cells / by, 1), p.order);
  auto lower = with(p.cells, std::max(p.order - by, least_order));
  return lower && lower->order() < fine.order() ? std::move(lower) : std::nullopt;
}

/// The run on elements of an order higher by two; nothing where they would be too many unknowns.
std::optional<CoupledRun> sharper_run(const SemiDiscrete& fine, const CoupledProblem& p,
                                      const FieldRunOptions& options) {
  Diagnostics unheard;
  const auto mesh = SemiDiscrete::make(p.model, p.equations, p.cells, fine.order() + more_orders, unheard);
  return mesh ? run_once(*mesh, p.questions, p.width, options, unheard) : std::nullopt;
}

/// What answers feel of rounding beside their own size, as felt_rounding of fields without bodies; by the states that a
/// run is asked about, its start and its end.
class FeltRounding {
 public:
  FeltRounding(const CoupledRun& run, const SemiDiscrete& mesh, const FieldEquations& equations)
      : run_(run), mesh_(mesh), equations_(equations), width_(mesh.borders().back() - mesh.borders().front()) {
    for (std::size_t i = 1; i < mesh.borders().size(); ++i)
      width_ = std::min(width_, mesh.borders()[i] - mesh.borders()[i - 1]);
    std::vector<const State*> states{&run.result.start, &run.result.final};
    for (const State& s : run.result.at) states.push_back(&s);
    for (const State* s : states)
      if (!s->q.empty()) states_.push_back(mesh.bindings_at(*s));
  }

  double of(std::size_t answer, const FieldQuestion& question) {
    double out = std::abs(run_.answers[answer]);
    if (question.total) return out;
    const std::vector<Expr> asked = symbols_of({&question.value, 1});
    for (const PlaceValue& place : equations_.model->places) {
      if (std::find(asked.begin(), asked.end(), place.symbol) == asked.end()) continue;
      const FieldJet jet = *equations_.system().jet_of(place.jet);
      const std::size_t varied = equations_.varied_index(jet.field);
      if (varied == equations_.varied.size()) continue;  // it is given
      out += weight_of(place, question) * largest(varied, jet.time > 0 ? 1 : 0) *
             std::pow(mesh_.order() * mesh_.order() / width_, jet.order() - jet.time);
    }
    return out;
  }

 private:
  /// The largest of some expressions in all states; what has no value does not count.
  double largest_of(std::span<const Expr> values) const {
    const RepeatedEvaluation evaluation(values);
    double out = 0;
    for (const Bindings& state : states_)
      for (const double v : evaluation([&](Expr symbol) { return state.at(symbol); }))
        if (std::isfinite(v)) out = std::max(out, std::abs(v));
    return out;
  }

  /// By how much a question changes with the value at a place.
  double weight_of(const PlaceValue& place, const FieldQuestion& question) const {
    const Expr slope = differentiate(question.value, place.symbol);
    if (slope.is_number()) return std::abs(slope.number().to_double());
    Diagnostics unheard;
    const Expr value = mesh_.discretised({slope, false, question.time}, unheard);
    return value ? largest_of({&value, 1}) : 1;
  }

  /// |u| or |u'| of a field, at the ends and quarters of elements.
  double largest(std::size_t varied, int by_time) {
    const auto [known, is_new] = largest_.try_emplace({varied, by_time}, 0);
    if (!is_new) return known->second;
    constexpr double parts[] = {0, 0.25, 0.5, 0.75, 1};
    std::vector<Expr> values;
    for (std::size_t e = 0; e + 1 < mesh_.borders().size(); ++e)
      for (const double part : parts)
        values.push_back(mesh_.value_at(varied, by_time, 0,
                                        mesh_.borders()[e] + part * (mesh_.borders()[e + 1] - mesh_.borders()[e])));
    return known->second = largest_of(values);
  }

  const CoupledRun& run_;
  const SemiDiscrete& mesh_;
  const FieldEquations& equations_;
  double width_;  // of the narrowest element
  std::vector<Bindings> states_;
  std::map<std::pair<std::size_t, int>, double> largest_;  // by field and order in time
};

/// How many happenings of a run another mesh has too: the same ones, in the same order, and after about the same time
/// since the one before. Where a mesh rattles at a contact these times are those of its elements.
std::size_t alike(const std::vector<Happening>& a, const std::vector<Happening>& b, double begin) {
  constexpr double about = 0.25;
  double before_a = begin, before_b = begin;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (i == b.size() || a[i].name != b[i].name || a[i].kind != b[i].kind) return i;
    const double since = a[i].t - std::exchange(before_a, a[i].t), other = b[i].t - std::exchange(before_b, b[i].t);
    if (std::abs(since - other) > about * std::abs(since) + 1e-12 * std::abs(a[i].t)) return i;
  }
  return a.size();
}

/// How far off moments are: twice the difference to half the cells, since an impact leaves a jump of the velocity to
/// the field. Infinite where half the cells do not have them.
void estimate_moments(std::vector<Happening>& fine, const std::optional<CoupledRun>& half,
                      const std::optional<CoupledRun>& quarter, double begin) {
  const std::size_t known = half ? alike(fine, half->result.happenings, begin) : 0;
  const std::size_t twice = quarter ? alike(fine, quarter->result.happenings, begin) : 0;
  for (std::size_t i = 0; i < fine.size(); ++i) {
    Happening& h = fine[i];
    h.error = std::numeric_limits<double>::infinity();
    if (i >= known) continue;
    const double first = half->result.happenings[i].t;
    const double second = i < twice ? quarter->result.happenings[i].t : first;
    h.error = 2 * std::max(std::abs(first - h.t), std::abs(second - first) / 4) + 2.2e-16 * std::abs(h.t);
  }
}

/// Whether contacts or friction made forces or velocities jump.
bool jumps(const CoupledRun& run) {
  return std::any_of(run.result.happenings.begin(), run.result.happenings.end(),
                     [](const Happening& h) { return h.kind != Happening::Kind::Event; });
}

/// The runs beside that on the first mesh: a sharper one, or coarser ones, or, where a derivative jumps in from an end,
/// the sharper one and that on half the cells.
struct OtherRuns {
  std::optional<CoupledRun> sharp, half, quarter;
  bool lower_orders = false;  // of `half` and `quarter`, in the place of fewer cells
  bool jumps_at_ends = false;
};

OtherRuns other_runs(const CoupledRun& fine, const SemiDiscrete& mesh, const CoupledProblem& p, double gain) {
  FieldRunOptions quiet = p.options;
  quiet.trajectory = false, quiet.progress = {}, quiet.announce = {};
  OtherRuns out;
  out.jumps_at_ends = gain > 0 && !jumps(fine) && !p.breaks && mesh.departures().empty();
  if (gain == 0 || out.jumps_at_ends) out.sharp = sharper_run(mesh, p, quiet);
  const auto coarser = [&](int by) {
    Diagnostics unheard;
    const auto other = coarser_mesh(mesh, p, by);
    out.lower_orders = other && other->order() < mesh.order();
    return other ? run_once(*other, p.questions, p.width, quiet, unheard) : std::nullopt;
  };
  if (!out.sharp || out.jumps_at_ends) out.half = coarser(2);
  if (out.jumps_at_ends && (!out.half || out.lower_orders)) out.sharp.reset();
  if (!out.sharp) out.quarter = coarser(4);
  return out;
}

}  // namespace

double gain_at_breaks(const FieldEquations& equations, const SemiDiscrete& mesh, bool start_breaks,
                      const std::optional<SwitchingBreak>& switching, double begin, double end) {
  constexpr double of_loads_on_beams = 8;
  if (start_breaks) return gain_of_kinks;
  if (!mesh.departures().empty()) return mesh.bends() ? of_loads_on_beams : gain_of_kinks;
  double spacing = 0;
  for (std::size_t i = 1; i < mesh.borders().size(); ++i)
    spacing = std::max(spacing, (mesh.borders()[i] - mesh.borders()[i - 1]) / mesh.order());
  std::optional<int> jump = fit_of_sides(equations, begin, end, spacing).jump;
  if (switching && !mesh.bends()) jump = std::min(jump.value_or(switching->order), switching->order);
  if (!jump) return 0;
  if (mesh.bends()) return std::pow(2.0, *jump);
  return *jump <= 1 ? gain_of_kinks : std::pow(2.0, *jump + 1);
}

std::vector<double> coupled_errors(const CoupledRun& fine, const SemiDiscrete& mesh, const CoupledProblem& p,
                                   std::vector<Happening>& happenings, bool goes_well) {
  const double gain = jumps(fine) ? gain_of_kinks : p.gain_of_start;
  OtherRuns other;
  if (p.options.errors && goes_well && (!p.questions.empty() || !happenings.empty()))
    other = other_runs(fine, mesh, p, gain);
  if (p.options.errors)
    estimate_moments(happenings, other.sharp ? other.sharp : other.half, other.quarter, p.options.begin);
  const double less = mesh.order() / static_cast<double>(mesh.order() + more_orders);
  std::vector<double> out = !other.sharp          ? errors_of(fine, other.half, other.quarter, gain, other.lower_orders)
                            : other.jumps_at_ends ? errors_by_sharper_run(fine, *other.sharp, *other.half, less)
                                                  : errors_by_sharper_run(fine, *other.sharp);
  if (!other.sharp && gain > 0 && !p.breaks)
    for (double& e : out) e *= 2;
  const double rounding = 2.2e-16 * std::sqrt(static_cast<double>(fine.result.statistics.steps) + 1);
  FeltRounding felt(fine, mesh, p.equations);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] += rounding * std::max(felt.of(i, p.questions[i]), 1e-300);
  return out;
}

}  // namespace maupertuis
