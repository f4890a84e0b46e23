#pragma once
#include "syntax/expression_parser.hpp"

#include <functional>

namespace maupertuis::syntax {

struct FieldDeclaration;  // field_statements.hpp

/// Reads one statement. Throws Abandoned after a mistake was reported.
class StatementParser : private ExpressionParser {
 public:
  StatementParser(const ParseContext& context, const StatementTokens& statement)
      : ExpressionParser(context, statement) {}

  /// One statement; `system x "…" source "…"` is two.
  std::vector<Statement> run();

  // What stands alone beside a model, behind a token that stands for the words left out: parts.cpp.
  ExpressionPtr formula_alone();
  ExpressionPtr quantity_alone();
  Equation equation_alone();
  std::vector<Assignment> assignments_alone();
  ParamStatement parameters_alone();
  StartStatement start_alone();
  RunStatement run_alone();
  SweepStatement sweep_alone();
  PathStatement path_alone();

 private:
  using Handler = StatementBody (StatementParser::*)();
  struct Entry {
    std::string_view word;
    Handler handler;
  };
  static std::span<const Entry> table();
  [[noreturn]] void unknown_statement();
  std::string help_for_equation() const;
  [[noreturn]] void coordinate_without_kind(const Name& name);
  [[noreturn]] void coordinate_without_colon(const Name& name);
  void kind_of(const Name& name, const char* what, Name& kind, std::optional<UnitExpression>& unit);
  Statement complete(StatementBody body, std::size_t first) const;

  StatementBody system_statement();
  StatementBody source_statement();
  StatementBody note_statement();
  StatementBody dimensionless_statement();
  StatementBody param_statement();
  StatementBody coord_statement();
  StatementBody let_statement();
  StatementBody input_statement();
  StatementBody frame_statement();
  StatementBody point_statement();
  StatementBody body_statement();
  StatementBody gravity_statement();
  void refuse_coordinate(const char* what, const char* part_of, const char* instead);
  StatementBody spring_statement();
  StatementBody damper_statement();
  StatementBody torsion_statement();
  StatementBody energy_statement();
  StatementBody force_statement();
  StatementBody torque_statement();
  StatementBody reaction_statement();
  StatementBody start_statement();
  StatementBody run_statement();
  StatementBody output_statement();
  StatementBody method_statement();
  StatementBody precision_statement();
  StatementBody draw_statement();
  StatementBody expect_statement();
  StatementBody claim_statement();
  StatementBody sweep_statement();
  // variational_statements.cpp
  StatementBody constraint_statement();
  StatementBody gauge_statement();
  bool opens_degenerate() const;
  expectation::Kind expect_degenerate();
  StatementBody independent_statement();
  StatementBody path_statement();
  // contact_statements.cpp
  StatementBody contact_statement();
  StatementBody friction_statement();
  StatementBody event_statement();
  StatementBody impact_statement();
  // rates_statement.cpp
  StatementBody rates_statement();
  // field_statements.cpp
  StatementBody field_statement();
  StatementBody density_statement();
  StatementBody boundary_statement();
  StatementBody field_force_statement();
  void field_items(FieldDeclaration& field);
  Equation boundary_condition();
  ExpressionPtr before(std::string_view word, const std::function<ExpressionPtr()>& read);
  bool opens_field_expectation() const;
  std::vector<Equation> equations_of_list();
  expectation::Kind expect_of_field();

  // parts
  Rotation rotation();
  std::vector<ExpressionPtr> bracketed_values(std::size_t count, std::string_view form);
  void inertia(BodyStatement& body);
  template <class Part>
  Part ended(Part part);
  /// `at_places`: also of the value of a field at a place, u(l/2) = 1 m.
  StartStatement::Item assignment(bool at_places = false);
  RunStatement run_length();
  SweepStatement sweep_values();
  PathStatement path_ends();
  PathStatement::End path_end();
  bool opens_named_components() const;
  void named_components(PathStatement::End& end);
  ExpressionPtr component();
  std::vector<ExpressionPtr> components();
  std::vector<ExpressionPtr> with_unit_after(std::vector<ExpressionPtr> numbers);
  bool opens_components() const;
  static ExpressionPtr with_unit_of(ExpressionPtr from, const Expression& to);
  DrawItem draw_item();
  void draw_line(DrawItem& item);
  void draw_solid(DrawItem& item);
  Tolerance tolerance(bool required);
  std::optional<int> whole_number();
  expectation::Kind expected(bool claim);
  expectation::Number expected_number();
  expectation::Kind expect_equation();
  expectation::Kind expect_class();
  expectation::Kind expect_until();
  expectation::Kind expect_value(bool claim);
  expectation::Kind expect_conserved();
  expectation::Kind expect_frequencies();
  expectation::Kind expect_equilibrium();
  expectation::Kind expect_event();
  expectation::Kind expect_phase_space();
  expectation::Kind expect_action();
  expectation::Kind expect_path();
  expectation::Kind expect_index();
  int path_number();
  // linear_expectations.cpp
  bool opens_matrix() const;
  bool opens_return_map() const;
  expectation::Point expected_point();
  expectation::Spectrum expected_spectrum();
  expectation::Kind expect_eigenvalues();
  expectation::Kind expect_return_map();
  expectation::Kind expect_matrix();
  void matrix_row(expectation::Matrix& matrix);
  expectation::Kind expect_stable();
  std::vector<ExpressionPtr> matrix_variables();
  ExpressionPtr clause_quantity(std::string_view clause, const ExpressionPtr& already);
  [[noreturn]] void missing_clause(std::string_view clause, std::string_view statement, std::string_view example);
  Span statement_span() const;
  void refuse_unit_behind_formula();
  void refuse_spelled_tolerance();

  /// item {"," item}; after a mistake in one item the others are still read, so that all mistakes are told.
  template <typename Item>
  void list(Item item) {
    bool failed = false;
    do {
      const std::size_t first = index_;
      try {
        item();
        refuse_decimal_comma();
        refuse_missing_comma();
        if (!at_end() && !peek().is(",")) expect_end();
      } catch (const Abandoned&) {
        failed = true;
        skip_item(first);
      }
    } while (accept(","));
    if (failed) throw Abandoned{};
  }
  void skip_item(std::size_t first);
  void refuse_missing_comma();
  void refuse_time_in_brackets();
  [[noreturn]] void refuse_half(bool claim, const std::string& subject);
};

}  // namespace maupertuis::syntax
