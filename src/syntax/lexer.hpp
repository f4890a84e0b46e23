#pragma once
#include <maupertuis/diagnostic.hpp>
#include <maupertuis/source.hpp>

#include "syntax/token.hpp"

#include <optional>

namespace maupertuis::syntax {

/// Whether a file can be a model text at all: size, UTF-8, no control characters. One message if not (E0101 … E0103).
bool check_text(const SourceText& source, Diagnostics& diagnostics);

/// Reads characters into tokens. Nothing when the text is too large or is no text (E0101, E0102, E0103); other
/// mistakes leave an unreadable token, and reading goes on.
std::optional<TokenList> lex(const SourceText& source, Diagnostics& diagnostics);

/// Groups tokens into statements: one a line, continued by an open bracket or an indented next line (E0106, E0107).
std::vector<StatementTokens> split_statements(const TokenList& list, const SourceText& source,
                                              Diagnostics& diagnostics);

}  // namespace maupertuis::syntax
