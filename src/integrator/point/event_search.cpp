#include "integrator/point/event_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr double resolved = 1e-9;   // of a function's size: what a piece may hold beside its polynomial
constexpr double touching = 1e-14;  // … as near as a touch comes to zero
constexpr double jumping = 1e-7;  // … at neighbouring times on either side of zero: no continuous function does this

}  // namespace

EventSearch::EventSearch(const MotionFunctions& functions, std::span<const double> parameters)
    : events_(functions.events),
      work_(events_),
      search_(events_, parameters),
      path_(StepSearch::path_points * functions.inputs()),
      values_(events_.outputs()),
      looks_(events_.outputs()),
      sizes_(events_.outputs()) {
  work_.set_parameters(parameters);
}

EventSearch::Result EventSearch::first(double begin, double end, const PointAt& point) {
  begin_ = begin, end_ = end;
  Result result;
  follow(point);
  if (!visit(point, result)) return result;
  for (std::size_t i = 0; i < looks_.size(); ++i)
    if (const auto t = first_root(i, point);
        t && (!result.root || std::abs(*t - begin) < std::abs(result.root->t - begin)))
      result.root = Root{i, *t};
  return result;
}

/// The path of the step, and what the functions are at its nodes.
void EventSearch::follow(const PointAt& point) {
  const std::size_t inputs = path_.size() / StepSearch::path_points;
  std::fill(sizes_.begin(), sizes_.end(), 0.0);
  for (std::size_t j = 0; j < StepSearch::path_points; ++j) {
    const auto at = point(time_at(StepSearch::path_nodes()[j]));
    std::copy(at.begin(), at.end(), path_.begin() + static_cast<std::ptrdiff_t>(j * inputs));
    work_.evaluate(at, values_);
    for (std::size_t i = 0; i < sizes_.size(); ++i) sizes_[i] = std::max(sizes_[i], std::abs(values_[i]));
  }
  search_.set_path(path_);
}

/// Looks at the functions everywhere. False, and the reason: that cannot be done.
bool EventSearch::visit(const PointAt& point, Result& result) {
  for (auto& looks : looks_) looks.clear();
  const auto add = [&](double x, std::span<const double> values) {
    for (std::size_t i = 0; i < looks_.size(); ++i) {
      looks_[i].push_back({x, values[i]});
      sizes_[i] = std::max(sizes_[i], std::abs(values[i]));
    }
  };
  const auto small = [&](std::span<const double> tails) {
    for (std::size_t i = 0; i < tails.size(); ++i)
      if (!(tails[i] <= resolved * sizes_[i])) return false;
    return true;
  };
  add(-1, values(begin_, point));
  const auto outcome = search_.visit(small, [&](double x, double, std::span<const double> values, bool) {
    add(x, values);
    return true;
  });
  add(1, values(end_, point));
  result.outcome = outcome == StepSearch::Outcome::Seen        ? Outcome::Seen
                   : outcome == StepSearch::Outcome::NotFinite ? Outcome::NoValue
                                                               : Outcome::TooRough;
  return outcome == StepSearch::Outcome::Seen;
}

std::optional<double> EventSearch::first_root(std::size_t event, const PointAt& point) {
  const std::span<const Look> looks = looks_[event];
  for (std::size_t k = 1; k < looks.size(); ++k) {
    const double here = looks[k].value, before = looks[k - 1].value;
    std::optional<double> root;
    if (before != 0 && here * before <= 0)
      root = root_between(event, looks[k - 1], looks[k], point);
    else if (k + 1 < looks.size() && std::abs(here) < std::abs(before) && looks[k + 1].value * here > 0 &&
             std::abs(here) <= std::abs(looks[k + 1].value))
      root = touch_about(event, looks.subspan(k - 1).first<3>(), point);
    if (root) return root;
  }
  return std::nullopt;
}

/// Halves the time until nothing lies between. Nothing where the function jumps over zero.
std::optional<double> EventSearch::root_between(std::size_t event, const Look& left, const Look& right,
                                                const PointAt& point) {
  const bool rising = left.value < 0;
  double low = time_at(left.x), high = time_at(right.x), below = left.value, above = right.value;
  for (double middle; middle = low + (high - low) / 2, middle != low && middle != high;) {
    const double found = values(middle, point)[event];
    const bool is_low = found != 0 && (found < 0) == rising;
    (is_low ? low : high) = middle;
    (is_low ? below : above) = found;
  }
  const bool jumps = std::min(std::abs(below), std::abs(above)) > jumping * sizes_[event];
  return jumps ? std::nullopt : std::optional(high);
}

/// Where the function comes near zero and goes back: two roots, one, or none.
std::optional<double> EventSearch::touch_about(std::size_t event, std::span<const Look, 3> looks,
                                               const PointAt& point) {
  const Look nearest = lowest(event, looks);
  if (nearest.value * looks[0].value <= 0) return root_between(event, looks[0], nearest, point);
  if (std::abs(nearest.value) > touching * sizes_[event]) return std::nullopt;
  return time_at(nearest.x);
}

/// The least of |f| between the outer two, by the golden section; a value on the other side of zero ends the search.
EventSearch::Look EventSearch::lowest(std::size_t event, std::span<const Look, 3> looks) {
  constexpr double golden = 0.381966011250105;
  const double side = looks[0].value < 0 ? -1 : 1;
  double low = looks[0].x, high = looks[2].x;
  Look best = looks[1];
  for (int turn = 0; turn < 100 && side * best.value > 0; ++turn) {
    const bool to_high = high - best.x > best.x - low;
    const double x = best.x + golden * ((to_high ? high : low) - best.x);
    if (x == best.x) break;
    const double found = search_.values_at(x)[event];
    if (side * found < side * best.value) {
      (to_high ? low : high) = best.x;
      best = {x, found};
    } else {
      (to_high ? high : low) = x;
    }
  }
  return best;
}

std::span<const double> EventSearch::values(double t, const PointAt& point) {
  work_.evaluate(point(t), values_);
  return values_;
}

std::string reason_of(EventSearch::Outcome outcome, double begin, double end) {
  return fmt::format("the condition {} on the step from t = {} s to {} s; Taylor's steps follow it there",
                     outcome == EventSearch::Outcome::NoValue ? "has no value" : "changes too often to be followed",
                     begin, end);
}

}  // namespace maupertuis
