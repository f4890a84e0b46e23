#include "analysis/orbits/messages.hpp"

#include <maupertuis/constraint_manifold.hpp>

#include <fmt/format.h>

#include <cmath>

namespace maupertuis::orbits {

bool refuse_no_time(const std::string& what, Diagnostics& diagnostics) {
  diagnostics.error("E1406", {}, fmt::format("{} is a positive, finite time", what), "Nothing happens in no time.",
                    "Give one such as 10 s.");
  return false;
}

bool refuse_end(double t, const std::string& reason, Diagnostics& diagnostics) {
  diagnostics.error("E1408", {}, fmt::format("the motion ends at t = {:.9g} s", t), reason,
                    "Choose another start, or a shorter time.");
  return false;
}

bool refuse_jump(const TangentStop& stop, Diagnostics& diagnostics) {
  diagnostics.error(
      "E1403", {}, fmt::format("the motion has no derivative by its start beyond t = {:.9g} s", stop.t), stop.reason,
      stop.help.empty() ? "Replace the jump by a smooth function, such as tanh(x/w) for sign(x)." : stop.help);
  return false;
}

bool refuse_vanishing(double t, std::size_t left, Diagnostics& diagnostics) {
  diagnostics.error(
      "E1413", {}, fmt::format("directions vanish at t = {:.9g} s", t),
      fmt::format(
          "Where a contact closes or friction sticks, neighbours come into the same state: {} of their directions "
          "are left, and the exponents of the others are −∞.",
          left),
      left > 0 ? fmt::format("Ask for the largest alone: --exponents {}.", left)
               : "No neighbour parts from this motion: there is no exponent to ask for.");
  return false;
}

std::optional<double> length_of_run(const Model& model, std::optional<double> asked, Diagnostics& diagnostics) {
  const Experiment& experiment = model.experiment;
  const Expr written = experiment.duration ? experiment.duration : experiment.within;
  std::optional<double> length = asked;
  if (!length && written)
    length = evaluate(in_terms_of_motion(model.system, {&written, 1}).front(), parameter_bindings(model.system));
  if (length && *length > 0 && std::isfinite(*length)) return length;
  if (length)
    refuse_no_time("the duration", diagnostics);
  else
    diagnostics.error("E1406", {}, "it is not said how long the motion is followed",
                      "The model has no `run`, which would say it.",
                      "Write `run 10 s` into the model, or give --duration 10s.");
  return std::nullopt;
}

}  // namespace maupertuis::orbits
