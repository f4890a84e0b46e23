#include "analysis/action/starts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace maupertuis::action {
namespace {

constexpr int bend_waves = 3, random_waves = 4, random_starts = 24;

/// Where a free component begins: as the other end, or as the model starts.
Vector end_value(const Problem& problem, const std::vector<std::optional<double>>& at,
                 const std::vector<std::optional<double>>& other) {
  Vector out = Vector::Zero(problem.n());
  for (const StartValue& s : problem.model.experiment.start)
    if (s.order == 0) out[static_cast<Index>(s.coordinate)] = problem.number(s.value);
  for (Index i = 0; i < out.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (at[k])
      out[i] = *at[k];
    else if (other[k])
      out[i] = *other[k];
  }
  return out;
}

/// How far a bend reaches: the way itself, or a typical size.
Vector reach(const Problem& problem, const Vector& from, const Vector& to) {
  return (to - from).cwiseAbs().cwiseMax(problem.typical);
}

/// Where L is infinite at the other end, which free components begin as, the whole line would lie there: they begin
/// some way off it, on the side on which L has a value.
Vector off_the_other_end(Problem& problem, Vector at, const std::vector<std::optional<double>>& fixed, double t) {
  const Vector none = Vector::Zero(problem.functional.integrals()), rest = Vector::Zero(problem.n());
  Density density;
  for (const double side : {1.0, -1.0}) {
    Vector off = at;
    for (Index i = 0; i < at.size(); ++i)
      if (!fixed[static_cast<std::size_t>(i)]) off[i] += side * problem.typical[i];
    problem.functional.evaluate(t, off.data(), rest.data(), none, 0, density);
    if (density.finite) return off;
  }
  return at;
}

}  // namespace

std::vector<Start> starts_between(Problem& problem, const ActionEnds& ends) {
  const SingularEnds singular = problem.singular_ends(ends);
  Vector from = end_value(problem, ends.from, ends.to), to = end_value(problem, ends.to, ends.from);
  if (singular.start) to = off_the_other_end(problem, to, ends.to, ends.end);
  if (singular.end) from = off_the_other_end(problem, from, ends.from, ends.start);
  const Vector size = reach(problem, from, to);
  const auto line_on = [&](const Mesh& mesh) {
    Trial out{mesh, Matrix(problem.n(), mesh.nodes()), Vector::Zero(problem.functional.integrals()),
              Vector::Zero(problem.n())};
    for (Index k = 0; k < mesh.nodes(); ++k) {
      // Next to an end where L is infinite paths are steep: as t^(2/3), which is as good a guess as any.
      const double part = (mesh.time(k) - ends.start) / (ends.end - ends.start);
      out.q.col(k) = from + (to - from) * (singular.start ? std::cbrt(part * part)
                                           : singular.end ? 1 - std::cbrt((1 - part) * (1 - part))
                                                          : part);
    }
    out.q.col(mesh.nodes() - 1) = to;
    return out;
  };
  const Trial rough = line_on(even_mesh(problem.rule, ends.start, ends.end, 2, false, singular.pace()));
  const Trial line =
      line_on(even_mesh(problem.rule, ends.start, ends.end, problem.first_elements(rough), false, singular.pace()));
  std::vector<Start> out{{"the straight line", line}};
  const OrderOfCoordinates& orders = problem.functional.orders();
  const auto bend = [&](Trial& trial, Index i, int k, double by) {
    const double turn = k * std::numbers::pi / (ends.end - ends.start);
    for (Index node = 1; node + 1 < trial.q.cols(); ++node) {
      const double angle = turn * (trial.mesh.time(node) - ends.start);
      trial.q(i, node) += by * size[i] * std::sin(angle);
      for (std::size_t r = 0; r < orders.bases.size(); ++r)
        if (orders.bases[r] == i) trial.q(orders.rates_of_others[r], node) += by * size[i] * turn * std::cos(angle);
    }
  };
  const auto bends = [&](Index i) {  // v and p of L with q'' follow from q
    const std::vector<Index>&v = orders.rates_of_others, &p = orders.momenta;
    return std::count(v.begin(), v.end(), i) + std::count(p.begin(), p.end(), i) == 0;
  };
  for (int k = 1; k <= bend_waves; ++k)
    for (const double by : {0.5, -0.5, 1.5, -1.5})
      for (Index i = 0; i < problem.n(); ++i) {
        if (!bends(i)) continue;
        Start s{fmt::format("the line bent by {:g} sin({}π τ) in {}", by * size[i], k == 1 ? "" : std::to_string(k),
                            problem.equations.system->coordinates[static_cast<std::size_t>(i)].name),
                line};
        bend(s.trial, i, k, by);
        out.push_back(std::move(s));
      }
  // Each also the other way round: the mirror image of a path is one where L is the same in a mirror.
  for (const double side : {1.0, -1.0}) {
    std::mt19937_64 random(20240607);
    for (int r = 0; r < random_starts; ++r) {
      Start s{fmt::format("the line bent at random (number {}{})", r + 1, side < 0 ? ", the other way" : ""), line};
      for (Index i = 0; i < problem.n(); ++i)
        for (int k = 1; k <= random_waves && bends(i); ++k)
          bend(s.trial, i, k, side * 3 * (2 * std::generate_canonical<double, 53>(random) - 1) / k);
      out.push_back(std::move(s));
    }
  }
  return out;
}

}  // namespace maupertuis::action
