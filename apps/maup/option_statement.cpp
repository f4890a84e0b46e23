#include "option_statement.hpp"

namespace maupertuis::app {

std::string as_one_line(std::string statement) {
  for (char& c : statement)
    if (c == '\n' || c == '\r' || c == '#') c = ' ';
  return statement;
}

OptionStatement& OptionStatement::add(std::string_view words) {
  text_ += words;
  return *this;
}

OptionStatement& OptionStatement::add_typed(std::string_view option, std::string_view typed) {
  const auto begin = static_cast<std::uint32_t>(text_.size());
  text_ += as_one_line(std::string(typed));
  pieces_.push_back({std::string(option), begin, static_cast<std::uint32_t>(text_.size())});
  return *this;
}

}  // namespace maupertuis::app
