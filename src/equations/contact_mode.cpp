#include <maupertuis/contact_mode.hpp>
#include <maupertuis/slip_signs.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace maupertuis {
namespace {

std::string label_of_friction(const MechanicalSystem& system, std::size_t index) {
  return index < system.contacts.size() ? system.contact_label(index)
                                        : system.frictions[index - system.contacts.size()].name;
}

void add_sticking(MechanicalSystem& out, const Friction& friction, const std::string& label) {
  Context& context = *out.context;
  for (std::size_t k = 0; k < friction.slip.size(); ++k) {
    Constraint c;
    c.level = Constraint::Level::Velocity;
    c.name = friction.slip.size() == 1 ? "stick of " + label : fmt::format("stick {} of {}", k + 1, label);
    c.value = friction.slip[k];
    c.multiplier = friction.multipliers[k];
    c.reaction = context.symbol(fmt::format("reaction({})", c.name), Role::Multiplier);
    c.dimension = out.dimensionless ? Dimension{} : dimensions::length() / out.independent_dimension;
    c.span = friction.span;
    out.constraints.push_back(std::move(c));
  }
}

/// −σ μ N ∂v_t/∂q̇; in space −μ N Σ_k v_tk/|v_t| ∂v_tk/∂q̇
void add_sliding(MechanicalSystem& out, const Friction& friction, Expr normal, FrictionState state) {
  const Expr most = limit_of_friction(out, friction, friction.kinetic, normal, state == FrictionState::Forward);
  const Expr speed = friction.in_space() ? slip_speed(friction) : Expr();
  for (std::size_t i = 0; i < out.coordinates.size(); ++i) {
    ExprVector terms;
    for (const Expr& slip : friction.slip) {
      const Expr lever = differentiate(slip, out.coordinates[i].velocity);
      if (lever.is_zero()) continue;
      terms.push_back(friction.in_space()                ? -(most * slip / speed * lever)
                      : state == FrictionState::Backward ? most * lever
                                                         : -most * lever);
    }
    if (terms.empty()) continue;
    AppliedForce f;
    f.kind = AppliedForce::Kind::Generalized;
    f.target = out.coordinates[i].name;
    f.coordinate = i;
    f.components = {out.context->sum(terms)};
    f.span = friction.span;
    out.forces.push_back(std::move(f));
  }
}

}  // namespace

ContactMode open_mode(const MechanicalSystem& system) {
  ContactMode mode;
  mode.closed.assign(system.contacts.size(), false);
  mode.friction.assign(system.contacts.size(), FrictionState::None);
  mode.friction.resize(system.contacts.size() + system.frictions.size(), FrictionState::Stick);
  mode.normal_sign.assign(system.frictions.size(), 1);
  return mode;
}

Expr slip_speed(const Friction& friction) {
  ExprVector squares;
  for (const Expr& slip : friction.slip) squares.push_back(slip * slip);
  return sqrt(friction.slip[0].context().sum(squares));
}

bool has_multipliers(Expr e) {
  if (!e) return false;
  for (const Expr& s : symbols_of({&e, 1}))
    if (s.role() == Role::Multiplier) return true;
  return false;
}

Expr normal_force(const MechanicalSystem& system, const ContactMode& mode, std::size_t index) {
  if (index < system.contacts.size()) return system.contacts[index].multiplier;
  const std::size_t own = index - system.contacts.size();
  const Expr normal = system.frictions[own].normal;
  if (!normal) return normal;
  if (!has_multipliers(normal)) return apply(Kind::Abs, normal);
  return mode.normal_sign[own] < 0 ? -normal : normal;
}

const Friction& friction_of(const MechanicalSystem& system, std::size_t index) {
  const std::size_t contacts = system.contacts.size();
  return index < contacts ? system.contacts[index].friction : system.frictions[index - contacts];
}

std::string mode_text(const MechanicalSystem& system, const ContactMode& mode) {
  std::string out;
  const auto add = [&](const std::string& part) { out += (out.empty() ? "" : ", ") + part; };
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    const bool contact = i < mode.closed.size();
    if (contact && !mode.closed[i]) continue;
    const std::string label = label_of_friction(system, i);
    const FrictionState state = mode.friction[i];
    add(state == FrictionState::None    ? label
        : state == FrictionState::Stick ? label + " sticking"
        : state == FrictionState::Slide ? label + " sliding"
                                        : label + (state == FrictionState::Forward ? " sliding +" : " sliding −"));
  }
  return out;
}

std::string some_mode(const MechanicalSystem& system) {
  ContactMode mode = open_mode(system);
  if (system.contacts.empty()) return mode_text(system, mode);
  mode.closed[0] = true;
  if (system.contacts[0].friction.present()) mode.friction[0] = FrictionState::Stick;
  return mode_text(system, mode);
}

namespace {

std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> out{""};
  for (const char c : text)
    if (c == ',')
      out.emplace_back();
    else if (c != ' ' || (!out.back().empty() && out.back().back() != ' '))
      out.back() += c;
  for (std::string& part : out)
    while (!part.empty() && part.back() == ' ') part.pop_back();
  return out;
}

/// The state at the end of a part, which is cut off; None where there is no word for one.
FrictionState take_state(std::string& part) {
  const std::pair<const char*, FrictionState> words[] = {{" sticking", FrictionState::Stick},
                                                         {" sliding +", FrictionState::Forward},
                                                         {" sliding -", FrictionState::Backward},
                                                         {" sliding −", FrictionState::Backward},
                                                         {" sliding", FrictionState::Slide}};
  for (const auto& [word, state] : words)
    if (part.ends_with(word)) {
      part.resize(part.size() - std::string(word).size());
      return state;
    }
  return FrictionState::None;
}

}  // namespace

std::optional<ContactMode> read_mode(const MechanicalSystem& system, const std::string& text, std::string& trouble) {
  ContactMode mode = open_mode(system);
  std::vector<bool> told(mode.friction.size(), false);
  for (std::string part : parts_of(text)) {
    if (part.empty() || part == "free") continue;
    const FrictionState state = take_state(part);
    std::size_t i = 0;
    while (i < told.size() && label_of_friction(system, i) != part) ++i;
    if (i == told.size()) {
      trouble = fmt::format("The model has no contact or friction `{}`.", part);
      return std::nullopt;
    }
    const bool contact = i < mode.closed.size();
    const Friction& friction = friction_of(system, i);
    if (state == FrictionState::None && friction.present() && !friction.sticking) {
      trouble =
          friction.in_space()
              ? fmt::format("Say what friction does there: `{0} sticking` or `{0} sliding`.", part)
              : fmt::format("Say what friction does there: `{0} sticking`, `{0} sliding +` or `{0} sliding -`.", part);
      return std::nullopt;
    }
    if (state != FrictionState::None && (!friction.present() || (friction.sticking && state != FrictionState::Stick))) {
      trouble = friction.present() ? fmt::format("`{}` never slides while it is closed.", part)
                                   : fmt::format("`{}` has no friction.", part);
      return std::nullopt;
    }
    if (friction.present() && state != FrictionState::None && state != FrictionState::Stick &&
        (state == FrictionState::Slide) != friction.in_space()) {
      trouble = friction.in_space() ? fmt::format("`{0}` slides in a plane: write `{0} sliding`.", part)
                                    : fmt::format("Say which way: `{0} sliding +` or `{0} sliding -`.", part);
      return std::nullopt;
    }
    if (contact) mode.closed[i] = true;
    mode.friction[i] = friction.sticking ? FrictionState::Stick : state;
    told[i] = true;
  }
  for (std::size_t i = mode.closed.size(); i < told.size(); ++i)
    if (!told[i]) {
      const std::string& name = label_of_friction(system, i);
      trouble =
          fmt::format("Say what friction does along {0}: `{0} sticking`, `{0} sliding +` or `{0} sliding -`.", name);
      return std::nullopt;
    }
  return mode;
}

namespace {

/// What contact or friction i may do, apart from the rest.
std::vector<ContactMode> with_each_state(const MechanicalSystem& system, const ContactMode& from, std::size_t i) {
  const bool contact = i < system.contacts.size();
  const Friction& friction = friction_of(system, i);
  std::vector<ContactMode> out;
  const auto add = [&](bool closed, FrictionState state) {
    out.push_back(from);
    if (contact) out.back().closed[i] = closed;
    out.back().friction[i] = state;
  };
  if (contact) add(false, FrictionState::None);
  if (contact && !friction.present()) add(true, FrictionState::None);
  if (!friction.present()) return out;
  add(contact, FrictionState::Stick);
  if (friction.sticking) return out;
  if (friction.in_space()) {
    add(contact, FrictionState::Slide);
    return out;
  }
  add(contact, FrictionState::Forward);
  add(contact, FrictionState::Backward);
  return out;
}

}  // namespace

double number_of_modes(const MechanicalSystem& system) {
  double out = 1;
  const ContactMode mode = open_mode(system);
  for (std::size_t i = 0; i < mode.friction.size(); ++i)
    out *= static_cast<double>(with_each_state(system, mode, i).size());
  return out;
}

std::vector<ContactMode> modes_to_show(const MechanicalSystem& system, const ContactMode& from, std::size_t most) {
  const bool all = number_of_modes(system) <= static_cast<double>(most);
  std::vector<ContactMode> out{from};
  for (std::size_t done = 0; done < (all ? out.size() : 1); ++done) {
    const ContactMode before = out[done];
    for (std::size_t i = 0; i < before.friction.size(); ++i)
      for (ContactMode& mode : with_each_state(system, before, i))
        if (std::find(out.begin(), out.end(), mode) == out.end()) out.push_back(std::move(mode));
  }
  return out;
}

MechanicalSystem system_in_mode(const MechanicalSystem& system, const ContactMode& mode) {
  MechanicalSystem out = system;
  out.contacts.clear();
  out.frictions.clear();
  for (std::size_t i = 0; i < system.contacts.size(); ++i)
    if (mode.closed[i]) {
      Constraint c = as_constraint(system.contacts[i]);
      if (c.name.empty()) c.name = system.contact_label(i);
      out.constraints.push_back(std::move(c));
    }
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    if (mode.friction[i] == FrictionState::None) continue;
    const Friction& friction = friction_of(system, i);
    if (mode.friction[i] == FrictionState::Stick)
      add_sticking(out, friction, label_of_friction(system, i));
    else
      add_sliding(out, friction, normal_force(system, mode, i), mode.friction[i]);
  }
  if (system.written) out.written = std::make_shared<const MechanicalSystem>(system_in_mode(*system.written, mode));
  return out;
}

void check_one_mode(const MechanicalSystem& system, std::string_view who) {
  if (!system.has_modes()) return;
  const std::string what = system.contacts.empty() ? fmt::format("friction ({})", system.frictions.front().name)
                           : system.contacts[0].name.empty()
                               ? std::string("contacts")
                               : fmt::format("contacts ({})", system.contacts.front().name);
  throw std::invalid_argument(fmt::format(
      "{}: the model has {}, and these equations are those of its motion without; take simulate, "
      "advance_ensemble(model, equations, …), MotionThroughModes or TangentFlow(model, equations, …), or the "
      "equations of one mode (system_in_mode, Study::fix_mode)",
      who, what));
}

}  // namespace maupertuis
