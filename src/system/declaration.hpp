#pragma once
#include "system/value.hpp"

#include <memory>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace maupertuis::elaboration {

/// One name of the model and what is known of it. The five energies are declarations as well, since T and V may stand
/// in formulas.
struct Declaration {
  enum class Kind {
    Parameter,
    Coordinate,
    Definition,
    Input,
    Frame,
    Point,
    Body,
    Constraint,
    Reaction,
    Contact,
    Event,
    Independent,
    Rate,
    Field,
    Space,
    Energy
  };
  Kind kind = Kind::Parameter;
  std::string name;
  Span span;
  const syntax::Statement* statement = nullptr;  // null for energies
  std::size_t item = 0;                          // of a statement that declares a list
  std::size_t component = 0;                     // of a rate: which of its group
  std::size_t index = 0;  // in MechanicalSystem::coordinates: of a coordinate, of the first of a body's own quaternion
  bool used = false;
  bool done = false;  // `value` is there
  Value value;
  std::shared_ptr<const Value> group;  // of a rate: the vector that it is a component of
};

using DeclarationId = std::size_t;

/// The names of a model. Order of the text does not matter on paper, nor here.
class SymbolTable {
 public:
  /// Collects the names of `tree`; says which are declared twice.
  SymbolTable(const syntax::SyntaxTree& tree, const SourceTexts& texts, Diagnostics& diagnostics);

  std::vector<Declaration>& declarations() { return declarations_; }
  Declaration& operator[](DeclarationId id) { return declarations_[id]; }
  std::size_t size() const { return declarations_.size(); }

  /// A declared name, or an energy by its short or long name; null if there is none.
  Declaration* find(const std::string& name);
  Declaration& energy(syntax::EnergyStatement::Which which) { return declarations_[static_cast<std::size_t>(which)]; }
  DeclarationId id(const Declaration& d) const { return static_cast<DeclarationId>(&d - declarations_.data()); }
  /// The statement that declared it was lost to an error of the grammar.
  bool is_lost(const std::string& name) const { return lost_.count(name) != 0; }
  std::vector<std::string> names() const;
  /// Takes over the names of another model.
  void adopt(const SymbolTable& other);

 private:
  void add_fields(const syntax::FieldStatement& field, const syntax::Statement& statement);
  void add(Declaration::Kind kind, const syntax::Name& name, const syntax::Statement& statement, std::size_t item,
           std::size_t component = 0);

  Diagnostics& diagnostics_;
  SourceTexts texts_;
  std::vector<Declaration> declarations_;  // the energies T V U L D first
  std::unordered_map<std::string, DeclarationId> by_name_;
  std::unordered_map<std::string, bool> lost_;
  std::unordered_set<std::string> clashing_variables_;  // of fields
};

/// "parameter", "coordinate", …
const char* word_of(Declaration::Kind kind);
/// T → "kinetic energy"
const char* name_of_energy(syntax::EnergyStatement::Which which);

/// The declarations in an order in which each comes after those it is defined from. The members of a cycle are
/// reported (E0203), poisoned and left out.
std::vector<DeclarationId> definition_order(SymbolTable& table, const syntax::SyntaxTree& tree,
                                            Diagnostics& diagnostics);

}  // namespace maupertuis::elaboration
