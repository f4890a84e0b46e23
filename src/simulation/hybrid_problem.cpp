#include "simulation/hybrid_problem.hpp"

#include <algorithm>
#include <utility>

namespace maupertuis::hybrid {

Problem::Problem(std::shared_ptr<ModeLibrary> programs, std::vector<double> values, const TaylorOptions& steps)
    : library(std::move(programs)),
      model(library->model()),
      equations(library->equations()),
      system(library->system()),
      parameters(std::move(values)),
      options(steps) {
  parameters.resize(system.parameters.size());
  for (const Contact& c : system.contacts) {
    in_space = in_space || c.friction.in_space();
    keeps_friction.push_back(c.friction.present() && is_of_parameters(c.friction.kinetic) &&
                             is_of_parameters(c.friction.static_));
  }
}

bool Problem::rubs(std::size_t contact, const ContactValues& values) const {
  const Friction& f = system.contacts[contact].friction;
  return f.present() &&
         (f.sticking || !keeps_friction[contact] || values.fixed[contact] != 0 || values.kinetic[contact] != 0);
}

std::string Problem::label_of(std::size_t place) const {
  const std::size_t contacts = system.contacts.size();
  return place < contacts ? system.contact_label(place) : system.frictions[place - contacts].name;
}

std::vector<std::string> Problem::labels_of(std::vector<std::size_t> places) const {
  std::sort(places.begin(), places.end());
  std::vector<std::string> out;
  for (const std::size_t i : places) out.push_back(label_of(i));
  return out;
}

bool Problem::interrupted() const { return options.interrupt && options.interrupt->load(std::memory_order_relaxed); }

}  // namespace maupertuis::hybrid
