#pragma once
#include "json.hpp"
#include "lsp/open_text.hpp"

#include <maupertuis/language_services.hpp>

#include <string>

/// The results of the language services in the words of the protocol.
namespace maupertuis::app::lsp {

/// What the editor said of itself in `initialize`.
struct Client {
  language::Encoding encoding = language::Encoding::Utf16;
  bool snippets = false;         // completion items may hold places to fill in
  bool markdown = true;          // in hovers
  bool versioned_edits = false;  // documentChanges
  std::string code_link;         // the address of a code's explanation, with {code} in it; empty: none
};
Client client_of(const Json& initialize);
Json capabilities(const Client& client);

Json diagnostics_json(const Diagnostics& diagnostics, OpenText& text, const Client& client);

/// Answers of requests about one text; `params` as the protocol has them.
Json hover_json(OpenText& text, const Json& params, const Client& client);
Json completion_json(OpenText& text, const Json& params, const Client& client);
Json signature_json(OpenText& text, const Json& params, const Client& client);
Json definition_json(OpenText& text, const Json& params, const Client& client);
Json references_json(OpenText& text, const Json& params, const Client& client);
Json highlights_json(OpenText& text, const Json& params, const Client& client);
Json prepare_rename_json(OpenText& text, const Json& params, const Client& client);
/// Throws Refusal.
Json rename_json(OpenText& text, const Json& params, const Client& client);
Json symbols_json(OpenText& text, const Json& params, const Client& client);
Json formatting_json(OpenText& text, const Json& params, const Client& client);
/// The mistake that keeps a text from being laid out, for the user; empty where there is none.
std::string why_not_formatted(OpenText& text);
Json code_actions_json(OpenText& text, const Json& params, const Client& client);
Json semantic_tokens_json(OpenText& text, const Json& params, const Client& client);
Json folding_json(OpenText& text, const Json& params, const Client& client);

/// A request that is answered by an error: its code in the protocol, and a sentence for the user.
struct Refusal {
  int code;
  std::string message;
};

namespace error {
constexpr int parse = -32700, invalid_request = -32600, unknown_method = -32601, invalid_params = -32602,
              internal = -32603, not_initialized = -32002, cancelled = -32800, failed = -32803;
}

}  // namespace maupertuis::app::lsp
