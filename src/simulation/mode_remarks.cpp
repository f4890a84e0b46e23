#include "simulation/mode_remarks.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {

std::string list_of(const std::vector<std::string>& labels) {
  constexpr std::size_t shown = 6;
  std::string out;
  for (std::size_t k = 0; k < std::min(shown, labels.size()); ++k) out += (k == 0 ? "" : ", ") + labels[k];
  return labels.size() > shown ? out + ", …" : out;
}

std::string undetermined_contacts_sentence(const std::vector<std::string>& labels, bool rubs) {
  return fmt::format(
      "The contacts {} are more than the motion needs, so that it does not determine their forces (statically "
      "indeterminate). One distribution that carries it is shown{}.",
      list_of(labels),
      rubs ? ", and friction follows that one: with another the motion may be another"
           : "; the motion is the same for all");
}

std::string choice_sentence(const std::string& held, const std::string& slides, double t) {
  return fmt::format(
      "Static friction leaves a choice at t = {:.9g}: {} is held and {} begins to slide; the motion in which the "
      "latter "
      "is held and the former slides keeps all conditions too.",
      t, held, slides);
}

}  // namespace maupertuis
