#pragma once
#include <doctest/doctest.h>

#include <maupertuis/evaluate.hpp>
#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/transform.hpp>

#include <string>

namespace maupertuis::test {

/// What is said beside a model.
struct Said {
  OverrideKind kind;
  std::string label, text;
};
using Beside = std::vector<Said>;

/// A model text, elaborated and linted.
struct Elaborated {
  SourceText source;
  ExperimentOverrides overrides;
  Diagnostics diagnostics;
  std::optional<Model> model;

  explicit Elaborated(std::string text, const Beside& beside = {}) : source("test.lag", std::move(text)) {
    const syntax::SyntaxTree tree = syntax::parse(source, diagnostics);
    for (const Said& said : beside) overrides.add(said.kind, said.label, said.text);
    overrides.read(tree, diagnostics);
    model = elaborate(tree, source, diagnostics, overrides);
    if (model) lint(*model, source, diagnostics);
  }
  const MechanicalSystem& system() const {
    REQUIRE_MESSAGE(model.has_value(), messages());
    return model->system;
  }
  const Experiment& experiment() const {
    REQUIRE_MESSAGE(model.has_value(), messages());
    return model->experiment;
  }
  /// Expectation number i, of this kind.
  template <class Kind>
  const Kind& expected(std::size_t i) const {
    const Kind* kind = std::get_if<Kind>(&experiment().expectations.at(i).kind);
    REQUIRE(kind);
    return *kind;
  }
  /// Nothing but notes, which tell of no mistake.
  bool fine() const {
    for (const Diagnostic& d : diagnostics.items())
      if (d.severity != Severity::Note) return false;
    return model.has_value();
  }
  std::string messages() const { return render(diagnostics, {source, overrides.texts()}); }
  std::string codes() const {
    std::string all;
    for (const Diagnostic& d : diagnostics.items()) all += (all.empty() ? "" : " ") + d.code;
    return all;
  }
  std::string first_message() const { return diagnostics.empty() ? "" : diagnostics.items()[0].message; }

  /// The parameters at their values; q and q' as given, in the order of the coordinates; t.
  Bindings at(const std::vector<double>& q, const std::vector<double>& v, double t = 0) const {
    Bindings b;
    const MechanicalSystem& s = system();
    for (const Parameter& p : s.parameters) b[p.symbol] = p.si_value;
    for (std::size_t i = 0; i < s.coordinates.size(); ++i) {
      b[s.coordinates[i].q] = q[i];
      b[s.coordinates[i].velocity] = v[i];
    }
    b[s.context->time()] = t;
    return b;
  }
};

inline double value(Expr e, const Bindings& b) { return evaluate(expand_time_derivatives(e), b); }

}  // namespace maupertuis::test
