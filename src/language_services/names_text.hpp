#pragma once
#include <maupertuis/language_services.hpp>

#include "language_services/roles.hpp"

#include <string>

namespace maupertuis::language {

/// "0.5", "1e-07": a number as a reader wants it, six digits.
std::string short_number(double value);
/// "500 g, mass, 0.5 kg": what is known of a declared name from the model, and else nothing.
std::string facts_of(const Declared& declared, Document& document);
/// The item that declares the name, on one line: `m = 500 g`.
std::string item_of(const Declared& declared, Document& document);
/// What stands as a comment behind the declaration; empty without one.
std::string comment_of(const Declared& declared, Document& document);

}  // namespace maupertuis::language
