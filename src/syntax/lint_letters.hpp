#pragma once
#include "syntax/declarations.hpp"

namespace maupertuis::syntax {

/// Warns of declared names that look alike (W0106), and of names that mix alphabets with letters that look Latin
/// (W0107).
void lint_letters(const TokenList& list, const std::vector<StatementTokens>& statements, const SourceText& source,
                  Diagnostics& diagnostics);

}  // namespace maupertuis::syntax
