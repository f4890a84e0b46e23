#pragma once
#include <maupertuis/certificate.hpp>
#include <maupertuis/simulation.hpp>

#include <string>
#include <vector>

namespace maupertuis {

/// What became of one `expect` or `claim` line.
struct ExpectationResult {
  std::uint32_t line = 0;
  std::string text;  // as written
  bool claim = false;
  bool passed = false;
  std::string actual;  // what came out, in the unit that the line uses
  std::string expected;
  std::string tolerance;
  std::string uncertainty;     // of what came out, where its error is known; "no digit is certain"; empty otherwise
  bool beyond_digits = false;  // the tolerance is smaller than that: more is asked for than is known
  std::string message;         // one sentence when it failed, or what was proved and on what ground
  std::string where;           // "r > 0": an equation that passed holds there alone; empty: everywhere
  std::string pitfall;         // the known mistake whose signature the difference has; empty if none
};

struct Verification {
  std::vector<ExpectationResult> results;  // in the order of the text
  std::size_t passed() const;
  std::size_t failed() const { return results.size() - passed(); }
};

/// What an expectation of a value is worth, where the value may be off by `error` (docs/design/certain_digits.md).
///
/// It holds if |actual − expected| ≤ tolerance. Where error > tolerance more digits are asked for than are known
/// (beyond_digits): then it holds only while error ≤ 100 tolerance, since stated errors may be a hundred times too
/// large; beyond that a value within the tolerance is luck. An infinite error holds nothing. A value known to the last
/// bits of double is known as well as can be, whatever the tolerance.
struct ValueVerdict {
  bool passed = false, beyond_digits = false;
  bool may_hold = false;  // it does not pass, but the right value may lie within the tolerance all the same
};
ValueVerdict value_verdict(double actual, double expected, double tolerance, double error);

/// Carries out the `expect` and `claim` lines of a model: identities by the zero test, values by runs that land exactly
/// on the times asked. A run that ends early fails the lines that need it, with its reason. Of lines that hold with
/// other values of parameters (`… with s = -1`) those of one such text, which `model` was elaborated with.
Verification verify(const Model& model, const EquationsOfMotion& equations, const SourceText& source,
                    const SimulationOptions& options, Diagnostics& diagnostics, const std::string& with = {});

/// What happened of one name along a run, in order, as `expect event NAME CHANGE` counts it: without a word for the
/// change a contact's impacts and changes, where one that is hit and stays closed counts once.
std::vector<const Happening*> happenings_named(const std::vector<Happening>& all, const std::string& name,
                                               const std::string& change);
/// The name and the change, as they are written.
std::string happening_called(const std::string& name, const std::string& change);

/// For a model whose text expects an error (`expect error E0412`): compares with what was found.
/// Returns nothing if the text has no such line.
std::optional<Verification> verify_errors(const syntax::SyntaxTree& tree, const SourceText& source,
                                          const Diagnostics& found);

}  // namespace maupertuis
