#include "modes_text.hpp"

#include "orbits_text.hpp"
#include "quantity.hpp"

#include <fmt/format.h>

#include <maupertuis/print.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis::app {
namespace {

const char* mode_kind_name(Mode::Kind kind) {
  switch (kind) {
    case Mode::Kind::Zero:
      return "zero";
    case Mode::Kind::Oscillation:
      return "oscillation";
    case Mode::Kind::Decay:
      return "decay";
    case Mode::Kind::Growth:
      return "growth";
  }
  return "";
}

Json matrix_json(const RealMatrix& m) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < m.rows; ++i)
    rows.push_back(std::vector<double>(m.entries.begin() + static_cast<std::ptrdiff_t>(i * m.columns),
                                       m.entries.begin() + static_cast<std::ptrdiff_t>((i + 1) * m.columns)));
  return rows;
}

Json complex_json(std::complex<double> z) { return Json::array({z.real(), z.imag()}); }

Json names_json(const MechanicalSystem& system, const std::vector<std::size_t>& chosen, const char* primes) {
  Json out = Json::array();
  for (const std::size_t i : chosen) out.push_back(system.coordinates[i].name + primes);
  return out;
}

Json mode_json(const MechanicalSystem& system, const Mode& m) {
  Json shape = Json::object();
  for (std::size_t i = 0; i < m.shape.size(); ++i) shape[system.coordinates[i].name] = complex_json(m.shape[i]);
  Json out = {{"kind", mode_kind_name(m.kind)},
              {"eigenvalue", complex_json(m.eigenvalue)},
              {"error", m.error},
              {"frequency", m.frequency()},
              {"frequency_hz", m.frequency() / (2 * std::acos(-1.0))},
              {"natural_frequency", m.natural_frequency()},
              {"damping_ratio", m.damping_ratio()},
              {"multiplicity", m.multiplicity},
              {"chain", m.chain},
              {"shape", std::move(shape)}};
  if (m.kind == Mode::Kind::Zero) {
    out["zeros"] = m.zeros;
    out["cause"] = m.cause.empty() ? Json(nullptr) : Json(m.cause);
  }
  return out;
}

Json point_json(const MechanicalSystem& system, const OperatingPoint& point) {
  Json state = Json::object(), multipliers = Json::object(), inputs = Json::object();
  for (std::size_t i = 0; i < point.q.size(); ++i) {
    state[system.coordinates[i].name] = point.q[i];
    state[system.coordinates[i].name + "'"] = point.v[i];
  }
  for (std::size_t i = 0; i < std::min(point.multipliers.size(), system.constraints.size()); ++i)
    multipliers[system.constraints[i].multiplier.name()] = point.multipliers[i];
  for (std::size_t i = 0; i < point.inputs.size(); ++i) inputs[system.inputs[i].name] = point.inputs[i];
  return {{"t", point.t}, {"state", state}, {"multipliers", multipliers}, {"inputs", inputs}};
}

Json linearization_json(const MechanicalSystem& system, const Linearization& l) {
  Json out = {{"independent", names_json(system, l.independent, "")},
              {"independent_velocities", names_json(system, l.independent_velocities, "'")}};
  const std::pair<const char*, const RealMatrix*> second[] = {{"M", &l.mass},
                                                              {"C", &l.damping},
                                                              {"G", &l.gyroscopic},
                                                              {"K", &l.stiffness},
                                                              {"N", &l.circulatory},
                                                              {"input", &l.input},
                                                              {"input_rate", &l.input_rate},
                                                              {"input_acceleration", &l.input_acceleration}};
  if (l.second_order())
    for (const auto& [name, matrix] : second) out["second_order"][name] = matrix_json(*matrix);
  else
    out["second_order"] = nullptr;
  const std::pair<const char*, const RealMatrix*> first[] = {
      {"A", &l.a}, {"B", &l.b}, {"B1", &l.b_rate}, {"B2", &l.b_acceleration}, {"C", &l.c}, {"D", &l.d}};
  for (const auto& [name, matrix] : first) out["state_space"][name] = matrix_json(*matrix);
  out["measured"] = l.measured.values.empty() ? Json(nullptr)
                                              : Json{{"values", l.measured.values},
                                                     {"C", matrix_json(l.measured.c)},
                                                     {"D", matrix_json(l.measured.d)},
                                                     {"D1", matrix_json(l.measured.d_rate)},
                                                     {"D2", matrix_json(l.measured.d_acceleration)}};
  return out;
}

/// The states are independent positions, then the rates of the model.
Json in_rates_json(const MechanicalSystem& system, const LinearizationInRates& r) {
  Json states = names_json(system, r.positions, "");
  for (const Rate& rate : system.rates) states.push_back(rate.name);
  return {{"states", states},
          {"A", matrix_json(r.a)},
          {"B", matrix_json(r.b)},
          {"B1", matrix_json(r.b_rate)},
          {"B2", matrix_json(r.b_acceleration)}};
}

const char* verdict_word(Stability s) {
  switch (s) {
    case Stability::Energetic:
    case Stability::Linear:
      return "stable";
    case Stability::Asymptotic:
      return "asymptotically stable";
    case Stability::Unstable:
      return "unstable";
    case Stability::Undecided:
      return "undecided";
  }
  return "";
}

}  // namespace

Json modes_document(const MechanicalSystem& system, const ModalStudy& study) {
  Json document = json_document("modes");
  document["system"] = system.name;
  document["starts"] = study.starts;
  document["outside"] = study.outside;
  document["translations"] = Json::array();
  for (const Translation& t : study.translations)
    document["translations"].push_back({{"direction", t.direction}, {"conserved", t.conserved}});
  document["points"] = Json::array();
  for (const ModalEntry& e : study.entries) {
    Json entry = point_json(system, e.linearization.point);
    entry["at_rest"] = e.equilibrium.at_rest;
    const RealMatrix& turning = e.equilibrium.point.turning;
    entry["turning"] = turning.rows > 0 ? matrix_json(turning) : Json(nullptr);
    entry["side"] = e.side.empty() ? Json(nullptr) : Json(e.side);
    entry["residual"] = e.equilibrium.residual;
    entry["family"] = e.equilibrium.family;
    entry["family_along"] = names_json(system, e.equilibrium.family_along, "");
    const StabilityReport& s = e.analysis.stability;
    entry["stability"] = {{"verdict", verdict_word(s.verdict)},
                          {"reason", s.reason},
                          {"growth_rate", s.growth_rate},
                          {"hessian", s.hessian}};
    entry["linearization"] = linearization_json(system, e.linearization);
    if (e.in_rates) entry["linearization"]["in_rates"] = in_rates_json(system, *e.in_rates);
    entry["eigenvalues"] = Json::array();
    for (const std::complex<double>& z : e.analysis.eigenvalues) entry["eigenvalues"].push_back(complex_json(z));
    entry["modes"] = Json::array();
    for (const Mode& m : e.analysis.modes) entry["modes"].push_back(mode_json(system, m));
    entry["eigenvalue_residual"] = e.analysis.residual;
    document["points"].push_back(std::move(entry));
  }
  return document;
}

Json symbolic_json(const SymbolicLinearization& s, const ReadingOrder& order) {
  const auto matrix = [&](const ExprMatrix& m) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < m.rows; ++i) {
      Json row = Json::array();
      for (std::size_t j = 0; j < m.columns; ++j) row.push_back(to_plain(m.at(i, j), order));
      rows.push_back(std::move(row));
    }
    return rows;
  };
  Json equilibrium = Json::object();
  for (const auto& [left, right] : s.equilibrium) equilibrium[to_plain(left, order)] = to_plain(right.value, order);
  return {{"equilibrium", equilibrium},
          {"M", matrix(s.mass)},
          {"C", matrix(s.damping)},
          {"K", matrix(s.stiffness)},
          {"B", matrix(s.input)},
          {"B1", matrix(s.input_rate)},
          {"B2", matrix(s.input_acceleration)},
          {"omega_squared", s.square ? Json(to_plain(s.square, order)) : Json(nullptr)}};
}

Json regulator_json(const Regulator& r) {
  Json poles = Json::array();
  for (const std::complex<double>& z : r.poles) poles.push_back(complex_json(z));
  return {{"gain", matrix_json(r.gain)}, {"cost", matrix_json(r.cost)}, {"poles", poles}, {"residual", r.residual}};
}

Json locus_document(const MechanicalSystem& system, const Locus& locus) {
  Json document = json_document("modes");
  document["system"] = system.name;
  document["parameter"] = system.parameters[locus.parameter].name;
  document["without_points"] = values_without_points(locus);
  document["branches"] = Json::array();
  for (const LocusBranch& b : locus.branches) {
    Json branch = Json::array();
    for (const LocusPoint& x : b.points) {
      Json point = point_json(system, x.equilibrium.point);
      point["value"] = x.parameter;
      point["verdict"] = verdict_word(x.stability.verdict);
      point["eigenvalues"] = Json::array();
      for (const std::complex<double>& z : x.eigenvalues) point["eigenvalues"].push_back(complex_json(z));
      branch.push_back(std::move(point));
    }
    document["branches"].push_back(std::move(branch));
  }
  document["changes"] = Json::array();
  for (const StabilityChange& c : locus.changes)
    document["changes"].push_back({{"value", c.parameter},
                                   {"branch", c.branch},
                                   {"before", verdict_word(c.before)},
                                   {"after", verdict_word(c.after)}});
  document["folds"] = Json::array();
  for (const Fold& f : locus.folds) {
    Json fold = point_json(system, f.equilibrium.point);
    fold["value"] = f.parameter;
    fold["branches"] = f.branches;
    document["folds"].push_back(std::move(fold));
  }
  return document;
}

// ------------------------------------------------------------------------------------------- rest with contacts

Json resting_document(const RestingMode& mode) {
  const MechanicalSystem& system = *mode.equations->system;
  Json out = modes_document(system, mode.study);
  Json points = out["points"];
  for (std::size_t i = 0; i < mode.study.entries.size(); ++i) {
    points[i]["forces_determined"] = !mode.forces_are_open[i];
    points[i]["static_friction"] = Json::array();
    for (const StaticHold& h : mode.holds[i])
      points[i]["static_friction"].push_back({{"friction", h.friction},
                                              {"force", h.force},
                                              {"limit", std::isinf(h.limit) ? Json(nullptr) : Json(h.limit)}});
    const auto end = [](double x) { return std::isinf(x) ? Json(nullptr) : Json(x); };
    const auto& range = mode.ranges[i];
    points[i]["held"] = range ? Json({{"coordinate", system.coordinates[range->coordinate].name},
                                      {"from", end(range->from)},
                                      {"to", end(range->to)}})
                              : Json(nullptr);
  }
  return {{"mode", mode.text}, {"without_friction", mode.frictionless}, {"points", std::move(points)}};
}

}  // namespace maupertuis::app
