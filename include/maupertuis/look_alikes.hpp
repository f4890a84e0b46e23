#pragma once
#include <string>
#include <string_view>

/// Texts that are not what they seem: letters of other alphabets, and characters that are not shown.
namespace maupertuis {

/// The text with every letter that looks exactly as a Latin one (Cyrillic а, Greek Α) replaced by that: names that are
/// the same in this form look the same. After the confusables of Unicode's TR 39, without those that a formula tells
/// apart, as ν and v, ρ and p.
std::string latin_look(std::string_view text);

/// A letter of another alphabet that stands among Latin letters and looks as one of them: "`а` (U+0430) is a Cyrillic
/// letter"; empty if there is none.
std::string foreign_letter(std::string_view name);

/// The text with control bytes (all but line ends and tabs) and with the characters that turn the direction of writing
/// spelled out: \x1b, \u202e. A terminal that is shown it does nothing else than show it.
std::string visible(std::string_view text);

}  // namespace maupertuis
