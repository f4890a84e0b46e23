#pragma once
#include <string>
#include <vector>

namespace maupertuis {

/// "c0, c1, x": at most six of them.
std::string list_of(const std::vector<std::string>& labels);

/// What is told of contacts that are more than the motion needs. `rubs`: with friction.
std::string undetermined_contacts_sentence(const std::vector<std::string>& labels, bool rubs);

/// What is told where one friction is held and another begins to slide, and it could be the other way round.
std::string choice_sentence(const std::string& held, const std::string& slides, double t);

}  // namespace maupertuis
