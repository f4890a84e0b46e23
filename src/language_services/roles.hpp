#pragma once
#include <maupertuis/text_reading.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace maupertuis::language {

/// What a word of a text is.
enum class WordRole : std::uint8_t {
  StatementWord,  // at the beginning of a statement
  Word,           // of the language, behind a statement word
  Function,
  Predefined,  // t, pi, O
  Unit,
  Member,       // behind a point
  Name,         // of something that is declared
  Declaration,  // the name where it is declared
  Unknown,      // a name that nothing declares
  Other         // numbers, texts, signs
};

enum class NameKind : std::uint8_t {
  System,
  Parameter,
  Coordinate,
  Definition,
  Rate,
  Input,
  Frame,
  Point,
  Body,
  Constraint,
  Contact,
  Event,
  Reaction,
  Field,
  Space,
  Independent
};
/// "parameter", "coordinate", …
std::string_view word_of(NameKind kind);

struct Declared {
  std::string name;
  NameKind kind = NameKind::Parameter;
  Span span;
  std::size_t token = 0, statement = 0;
};

constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

/// What each token of a reading is. Names are one name space, but for those of events, which stand behind the word
/// `event` alone. Of names declared twice the first counts.
class Roles {
 public:
  explicit Roles(const syntax::TextReading& reading);

  WordRole of(std::size_t token) const { return roles_[token].role; }
  /// What a Name or Declaration stands for; null for any other token.
  const Declared* declared(std::size_t token) const;
  /// What stands around the declared name in a name made from it: p_ of p_θ, _x of u_x.
  std::string_view before(std::size_t token) const;
  std::string_view after(std::size_t token) const;
  /// A word of a quantity place that is a name of the model and a unit: `m` of `2 m`. Its role says Unit.
  bool ambiguous(std::size_t token) const { return roles_[token].ambiguous; }

  const std::vector<Declared>& names() const { return names_; }
  const Declared* find(std::string_view name) const;
  bool dimensionless() const { return dimensionless_; }

  /// The token that covers the offset, or ends there where none begins there; nowhere if there is none.
  std::size_t token_at(std::uint32_t offset) const;
  /// The statement of a token.
  std::size_t statement_of(std::size_t token) const { return roles_[token].statement; }

 private:
  struct Entry {
    WordRole role = WordRole::Other;
    bool ambiguous = false;
    std::size_t statement = 0, name = nowhere;
    std::uint16_t before = 0, after = 0;  // bytes of the token's text around the declared name
  };
  void declare(std::size_t statement);
  void classify(std::size_t token, std::size_t first);
  bool is_event(std::size_t token, std::size_t first) const;
  bool follows_quantity(std::size_t token, std::size_t first) const;
  std::size_t name_index(std::string_view name) const;
  bool is_made_from_name(std::size_t token);

  const syntax::TextReading& reading_;
  std::vector<Entry> roles_;
  std::vector<Declared> names_;
  std::unordered_map<std::string, std::size_t> by_name_, events_;
  bool dimensionless_ = false;
};

}  // namespace maupertuis::language
