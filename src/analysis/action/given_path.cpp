#include "analysis/action/given_equations.hpp"

#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// S along formulas q(t): Gauss's rule on pieces, cut until bounds on disks say that nothing is left out.
namespace maupertuis {
namespace {

using namespace action;

constexpr Index even_elements = 24;
constexpr double shortest_element_of_neighbours = 1e-6;  // of the whole
constexpr std::size_t most_elements_of_neighbours = 600;

/// ∫ L dt and ∫ G dt along a path.
class PathIntegrals {
 public:
  PathIntegrals(Problem& problem, PathFunctions& path, const Piece& whole, const ActionOptions& options)
      : problem_(problem), path_(path), whole_(whole), options_(options) {}

  /// False with E1206 or E1212.
  bool fill(GivenPath& out, Diagnostics& diagnostics) {
    const auto action = along(problem_.equations.lagrangian_expanded, "L", diagnostics);
    if (!action) return false;
    out.action = action->value;
    out.action_error = action->left_out;
    for (const Piece& p : action->pieces) out.action_error += rounding(p);
    for (const IntegralConstraint& c : problem_.model.system.integral_constraints) {
      const auto found = along(c.integrand, "the integrand of a constraint", diagnostics);
      if (!found) return false;
      out.integrals.push_back(found->value);
    }
    return true;
  }

 private:
  std::optional<Integral> along(Expr density, std::string_view what, Diagnostics& diagnostics) {
    const Rule& rule = *problem_.rule;
    const Integral found = integrate(problem_.model.system, path_.on_path({&density, 1}).front(), whole_, rule.points,
                                     rule.weights, options_.interrupt);
    if (interrupted(options_, diagnostics)) return std::nullopt;
    if (found.told == Integral::Told::Known) return found;
    const std::string where = place(found.at, problem_.model.system);
    if (found.told == Integral::Told::NotFinite)
      diagnose_infinite_lagrangian("path", diagnostics);
    else if (found.told == Integral::Told::Diverges)
      diagnostics.error("E1212", {},
                        fmt::format("S of this path is infinite, or converges too slowly to be told, near {}", where),
                        fmt::format("There {} grows so fast that its integral diverges, or nearly so.", what),
                        "Give a path that is less steep there, or ends that leave the place out.");
    else
      diagnostics.error("E1212", {}, fmt::format("S of this path is not known: near {} too much happens", where),
                        fmt::format("Along the path {} changes in more places than can be looked at one by one.", what),
                        "Give a shorter or smoother path; S of paths that follow one another adds up.");
    return std::nullopt;
  }

  /// A bound on the rounding in ∫ L over a piece: that of t, of q and q' from their formulas, of the terms of L, of the
  /// weights.
  double rounding(const Piece& piece) {
    const Rule& rule = *problem_.rule;
    const Vector none = Vector::Zero(problem_.functional.integrals());
    double sum = 0;
    for (Index g = 0; g < rule.points.size(); ++g) {
      const double t = piece.from + piece.width() * (1 + rule.points[g]) / 2,
                   latest = std::abs(piece.from) + std::abs(piece.to);
      path_.at(t);
      const Sensitivity by = problem_.functional.sensitivity(t, path_.q(), path_.v(), none);
      double here = by.terms + by.by_time * latest;
      for (Index i = 0; i < problem_.n(); ++i)
        here += by.by_q[i] * (path_.q_terms()[i] + std::abs(path_.v()[i]) * latest) +
                by.by_v[i] * (path_.v_terms()[i] + std::abs(path_.a()[i]) * latest);
      if (std::isfinite(here)) sum += piece.width() / 2 * rule.weights[g] * here;
    }
    return rounding_unit * sum;
  }

  Problem& problem_;
  PathFunctions& path_;
  Piece whole_;
  const ActionOptions& options_;
};

/// Elements for neighbours: even ones, and shorter ones where the path turns fast. Even ones alone where that takes too
/// many.
Mesh mesh_of(const Problem& problem, const Piece& whole, const std::vector<Piece>& pieces) {
  const double least = shortest_element_of_neighbours * whole.width();
  std::vector<double> places;
  for (Index e = 1; e < even_elements; ++e)
    places.push_back(whole.from + whole.width() * static_cast<double>(e) / static_cast<double>(even_elements));
  for (const Piece& p : pieces) places.push_back(p.from);
  std::sort(places.begin(), places.end());
  std::vector<double> breaks{whole.from};
  for (const double t : places)
    if (t - breaks.back() > least && whole.to - t > least) breaks.push_back(t);
  Mesh out = even_mesh(problem.rule, whole.from, whole.to, even_elements);
  if (breaks.size() > most_elements_of_neighbours) return out;
  breaks.push_back(whole.to);
  out.begins.clear(), out.lengths.clear();
  for (std::size_t e = 0; e + 1 < breaks.size(); ++e) {
    out.begins.push_back((breaks[e] - whole.from) / whole.width());
    out.lengths.push_back((breaks[e + 1] - breaks[e]) / whole.width());
  }
  return out;
}

Trial trial_of(const Problem& problem, PathFunctions& path, const Mesh& mesh) {
  Trial out{mesh, Matrix(problem.n(), mesh.nodes()), Vector::Zero(problem.functional.integrals()),
            Vector::Zero(problem.n())};
  for (Index k = 0; k < mesh.nodes(); ++k) {
    path.at(mesh.time(k));
    out.q.col(k) = Eigen::Map<const Vector>(path.q(), problem.n());
  }
  return out;
}

bool meets_ends(const Problem& problem, PathFunctions& path, double start, double end, const ActionEnds& ends,
                Diagnostics& diagnostics) {
  const MechanicalSystem& system = problem.model.system;
  const auto span = problem.model.experiment.path ? std::optional(problem.model.experiment.path->span) : std::nullopt;
  const auto refuse = [&](const std::string& what, double given, double wanted) {
    diagnostics.error(
        "E1205", span,
        fmt::format("the path misses its {}: {:.9g} instead of {:.9g}, by {:.3g}", what, given, wanted, given - wanted),
        "Paths are compared between the same ends; one that begins or ends elsewhere is no neighbour of the others.",
        "Change the formula, or the ends (`path from …`, --ends).");
    return false;
  };
  const double whole = std::abs(ends.end - ends.start);
  if (std::abs(start - ends.start) > 1e-9 * whole) return refuse("start of " + system.independent, start, ends.start);
  if (std::abs(end - ends.end) > 1e-9 * whole) return refuse("end of " + system.independent, end, ends.end);
  for (const bool first : {true, false}) {
    path.at(first ? start : end);
    const auto& wanted = first ? ends.from : ends.to;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (!wanted[i]) continue;
      const double size = std::max(std::abs(*wanted[i]), problem.typical[static_cast<Index>(i)]);
      if (!(std::abs(path.q()[i] - *wanted[i]) <= 1e-9 * size))
        return refuse(fmt::format("{} in {}", first ? "beginning" : "end", system.coordinates[i].name), path.q()[i],
                      *wanted[i]);
    }
  }
  return true;
}

}  // namespace

std::optional<GivenPath> action_of_path(const Model& model, const EquationsOfMotion& equations,
                                        std::span<const Expr> formulas, double start, double end,
                                        const std::optional<ActionEnds>& ends, const ActionOptions& options,
                                        Diagnostics& diagnostics) {
  if (!has_action(equations, diagnostics)) return std::nullopt;
  Problem problem(model, equations);
  if (!check_order(start, end, model.system, {}, diagnostics)) return std::nullopt;
  PathFunctions path(model.system, formulas);
  if (ends && !meets_ends(problem, path, start, end, *ends, diagnostics)) return std::nullopt;
  GivenPath out;
  out.start = start;
  out.end = end;
  GivenEquations look(problem, path, {start, end});
  if (!look.is_path(options, diagnostics)) return std::nullopt;
  if (!PathIntegrals(problem, path, {start, end}, options).fill(out, diagnostics)) return std::nullopt;
  look.judge(out);
  const Trial trial = trial_of(problem, path, mesh_of(problem, {start, end}, look.pieces()));
  out.path = to_path(trial);
  const auto n = static_cast<std::size_t>(problem.n());
  if (options.variations)
    out.variations = test_variations(problem, trial, {std::vector<bool>(n, true), std::vector<bool>(n, true)},
                                     problem.least(nullptr));
  return out;
}

}  // namespace maupertuis
