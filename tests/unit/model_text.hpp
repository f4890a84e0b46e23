#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <doctest/doctest.h>

#include <memory>
#include <string>

/// A model from its text, for tests: any diagnostic that is an error fails the test with its text.
struct ModelText {
  maupertuis::SourceText source;
  maupertuis::Diagnostics diagnostics;
  maupertuis::Model model;
  std::shared_ptr<const maupertuis::MechanicalSystem> system;
  maupertuis::EquationsOfMotion equations;

  explicit ModelText(std::string text) : source("test.lag", std::move(text)) {
    const auto tree = maupertuis::syntax::parse(source, diagnostics);
    auto elaborated = diagnostics.has_errors() ? std::nullopt : maupertuis::elaborate(tree, source, diagnostics);
    INFO(maupertuis::render(diagnostics, source));
    REQUIRE(elaborated);
    model = std::move(*elaborated);
    system = std::make_shared<const maupertuis::MechanicalSystem>(model.system);
    auto derived = maupertuis::euler_lagrange(system, diagnostics);
    REQUIRE(derived);
    equations = std::move(*derived);
  }

  maupertuis::Expr q(std::size_t i) const { return system->coordinates[i].q; }
  maupertuis::Expr v(std::size_t i) const { return system->coordinates[i].velocity; }
  maupertuis::Expr a(std::size_t i) const { return system->coordinates[i].acceleration; }
  maupertuis::Expr p(const std::string& name) const { return system->find_parameter(name)->symbol; }
};
