#include "simulation/hybrid_choices.hpp"

#include <utility>

namespace maupertuis::hybrid {
namespace {

FrictionState sliding_state(double slip, double rest) {
  return slip > rest ? FrictionState::Forward : slip < -rest ? FrictionState::Backward : FrictionState::None;
}

}  // namespace

Choice Choices::of_contact(std::size_t i, const ContactValues& values, const Met& met) const {
  Choice choice{i, {}};
  const Friction& f = problem_.system.contacts[i].friction;
  const bool rubs = problem_.rubs(i, values);
  const FrictionState sliding = rubs ? sliding_state(values.slip[i], sizes_.rest_slip(i, values)) : FrictionState::None;
  if (!rubs)
    choice.options = {{true, FrictionState::None, 1}};
  else if (f.in_space() && !f.sticking)
    choice.options = {{true, slips_.slides(i, values) ? FrictionState::Slide : FrictionState::Stick, 1}};
  else if (f.sticking)
    choice.options = {{true, FrictionState::Stick, 1}};
  else if (sliding != FrictionState::None)
    choice.options = {{true, sliding, 1}};
  else
    choice.options = {
        {true, FrictionState::Stick, 1}, {true, FrictionState::Forward, 1}, {true, FrictionState::Backward, 1}};
  const Choice::Option open{false, FrictionState::None, 1};
  choice.options.insert(met.lets_go(i) ? choice.options.begin() : choice.options.end(), open);
  return choice;
}

std::vector<Choice> Choices::at(const std::vector<std::size_t>& touching, const ContactValues& values,
                                const Met& met) const {
  std::vector<Choice> out;
  for (const std::size_t i : touching)
    if (!(values.rate[i] > sizes_.rest_speed(i, values))) out.push_back(of_contact(i, values, met));
  for (Choice& c : of_coordinates(values)) out.push_back(std::move(c));
  return out;
}

std::vector<Choice> Choices::of_coordinates(const ContactValues& values) const {
  std::vector<Choice> out;
  const std::size_t contacts = problem_.system.contacts.size();
  for (std::size_t i = contacts; i < contacts + problem_.system.frictions.size(); ++i) {
    Choice choice{i, {}};
    const bool signs = has_multipliers(problem_.system.frictions[i - contacts].normal);
    const FrictionState sliding = sliding_state(values.slip[i], sizes_.rest_slip(i, values));
    for (const std::int8_t sign : {std::int8_t{1}, std::int8_t{-1}}) {
      if (sign < 0 && !signs) continue;
      if (sliding != FrictionState::None)
        choice.options.push_back({false, sliding, sign});
      else
        for (const FrictionState s : {FrictionState::Stick, FrictionState::Forward, FrictionState::Backward})
          choice.options.push_back({false, s, sign});
    }
    out.push_back(std::move(choice));
  }
  return out;
}

ContactMode Choices::mode_of(const std::vector<Choice>& list, const std::vector<std::size_t>& taken) const {
  ContactMode mode = open_mode(problem_.system);
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Choice::Option& option = list[k].options[taken[k]];
    if (list[k].contact < mode.closed.size())
      mode.closed[list[k].contact] = option.closed;
    else
      mode.normal_sign[list[k].contact - mode.closed.size()] = option.normal_sign;
    mode.friction[list[k].contact] = option.state;
  }
  return mode;
}

ContactMode Choices::mode_without_contacts(const std::vector<Choice>& list) const {
  ContactMode mode = open_mode(problem_.system);
  for (const Choice& c : list)
    if (c.contact >= mode.closed.size()) {
      mode.friction[c.contact] = c.options[0].state;
      mode.normal_sign[c.contact - mode.closed.size()] = c.options[0].normal_sign;
    }
  return mode;
}

}  // namespace maupertuis::hybrid
