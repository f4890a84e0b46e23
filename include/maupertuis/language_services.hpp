#pragma once
#include <maupertuis/diagnostic.hpp>
#include <maupertuis/interrupt.hpp>
#include <maupertuis/source.hpp>
#include <maupertuis/text_reading.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// What an editor asks about a model text: a text in, typed answers out, whatever mistakes stand in the text.
///
/// Places are offsets and spans of bytes; positions.hpp counts them as editors do. Every service is linear in the text
/// but for the elaboration of the model, and ends by Interrupted where the document's interrupt asks it to. Nothing
/// here reads files or keeps anything outside of the Document.
namespace maupertuis {

struct Model;

namespace language {

class Roles;

/// A text and what is known about it, each part found at first use. After an edit there is a new Document.
/// Threads: one at a time uses a document; two documents share nothing.
class Document {
 public:
  explicit Document(SourceText source, const Interrupt& interrupt = {});
  ~Document();
  Document(Document&&) noexcept;

  const SourceText& source() const;
  const syntax::TextReading& reading();
  /// Elaborated and past the physics lint; null where the text has a mistake.
  const Model* model();
  /// What can be elaborated of the text while it has mistakes, without the statements in which they are: what hover
  /// says of the other names. The model itself where it has none; null where nothing is left. Cost: some elaborations,
  /// once.
  const Model* readable_part();
  /// Of syntax, names, units and the physics lint.
  const Diagnostics& diagnostics();
  const Interrupt& interrupt() const;
  /// What each word of the text is: language_services/roles.hpp, for the services.
  const Roles& roles();
  /// Whether the words of one quantity place are the names of the model that they also could be; asked of `probe` once.
  bool reads_names(Span place, const std::function<bool()>& probe);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

// ------------------------------------------------------------------------------------------------------- diagnostics

/// What `maup check` finds beyond diagnostics() by deriving the equations: it may take as long as a derivation.
Diagnostics diagnose_derivation(const SourceText& source, const Interrupt& interrupt);

/// The entry of the catalogue behind a code; null for those of the command line.
const CodeEntry* find_code(std::string_view code);

/// A change of the text: `text` takes the place of `span`.
struct TextEdit {
  Span span;
  std::string text;
};
/// The text with these changes, which do not overlap.
std::string edited(std::string_view text, std::vector<TextEdit> edits);

/// A change that mends a mistake. It was tried: the text with it has this mistake no longer, and no new one.
struct Fix {
  std::string title;  // "Write 9.81"
  std::string code;   // of the diagnostic that it mends
  Span span;          // of that diagnostic
  std::vector<TextEdit> edits;
};
/// Fixes of the diagnostics that touch `span`, after their help. Cost: a reading of the text for each.
std::vector<Fix> fixes(Document& document, Span span);
/// The fixes of one diagnostic of this document.
std::vector<Fix> fixes_of(Document& document, const Diagnostic& diagnostic);

// ------------------------------------------------------------------------------------------------------- at a place

/// Markdown about the word at `offset`: of a name its kind, unit, value and declaration with the comment beside it, of
/// a word of the language or a function one line of help, of a unit what it is in SI, of a mistake what its code means.
struct Hover {
  Span span;
  std::string markdown;
};
std::optional<Hover> hover(Document& document, std::uint32_t offset);

enum class CompletionKind : std::uint8_t { Statement, Word, Name, Function, Unit, Member, Snippet };
struct Completion {
  std::string label;
  CompletionKind kind = CompletionKind::Word;
  std::string detail;  // half a line: the form of a statement, the kind of a name
  std::string help;    // a sentence; may be empty
  std::string insert;  // what is written; with `snippet`, places to fill in are ${1:…}
  bool snippet = false;
  int rank = 0;  // the lower, the likelier
};
struct Completions {
  Span replaced;  // the part of a word before and after the place
  std::vector<Completion> items;
};
/// What can stand at `offset`; the editor filters by what was typed.
Completions complete(Document& document, std::uint32_t offset);

struct Signature {
  std::string label;                    // atan2(y, x)
  std::vector<std::string> parameters;  // y; x
  std::string help;
  std::size_t active = 0;  // the parameter that is being written
};
std::optional<Signature> signature(Document& document, std::uint32_t offset);

/// Where the name at `offset` is declared.
std::optional<Span> definition(Document& document, std::uint32_t offset);
/// Every place where the name at `offset` stands, in the order of the text.
std::vector<Span> references(Document& document, std::uint32_t offset, bool with_declaration = true);

/// The name that a rename would change; nothing where there is none.
std::optional<Span> renamed_at(Document& document, std::uint32_t offset);
struct Rename {
  std::vector<TextEdit> edits;
  std::string refusal;  // a sentence; empty where the edits are good
};
/// Another name for the one at `offset`, everywhere. Refuses words of the language, names that are taken, what is no
/// name, and what would change the meaning of another line: the text with the new name is read to see that.
Rename rename(Document& document, std::uint32_t offset, std::string_view name);

// ------------------------------------------------------------------------------------------------- of the whole text

enum class SymbolKind : std::uint8_t { System, Parameter, Coordinate, Definition, Place, Force, Event, Statement };
struct Symbol {
  std::string name, detail;
  SymbolKind kind = SymbolKind::Statement;
  Span span, name_span;
  std::vector<Symbol> children;  // of a statement that declares several names
};
std::vector<Symbol> symbols(Document& document);

/// `maup fmt`: one edit that replaces the text, none where it is in canonical layout. A text with a mistake of syntax
/// stays as it is; then this is the first of them.
struct Formatting {
  std::vector<TextEdit> edits;
  std::optional<Diagnostic> mistake;
};
Formatting formatting(Document& document);

enum class TokenKind : std::uint8_t {
  Keyword,
  Function,
  Parameter,   // of the model: constant
  Coordinate,  // and its derivatives
  Definition,
  Place,  // points, bodies, frames
  Member,
  Unit,
  Number,
  String,
  Comment,
  Operator,
  Other
};
struct SemanticToken {
  Span span;
  TokenKind kind = TokenKind::Other;
  bool declaration = false;
};
/// In the order of the text, none over another, none over the end of a line.
std::vector<SemanticToken> semantic_tokens(Document& document);

/// Statements and comments that take several lines.
std::vector<Span> folding(Document& document);

/// Every word that completion offers at the beginning of a line or behind its statement word, with one line of help:
/// for the grammars of editors and for tests.
struct WordHelp {
  std::string_view word;
  std::string_view statements;  // where it stands, words with blanks between them; empty: it begins a statement
  std::string_view form;        // "point P mass m at VECTOR [in F]"
  std::string_view help;
};
std::vector<WordHelp> words();

}  // namespace language
}  // namespace maupertuis
