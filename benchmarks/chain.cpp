#include "chain.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace bench {

using namespace maupertuis;

std::string chain_text(int links) {
  std::string names, points, start;
  for (int i = 1; i <= links; ++i) {
    names += fmt::format("{}θ{}", i > 1 ? ", " : "", i);
    points += fmt::format("point P{0} mass m at {1}l (sin θ{0}, -cos θ{0})\n", i, i > 1 ? fmt::format("P{} + ", i - 1) : "");
    start += fmt::format("{}θ{} = {:.6f} rad", i > 1 ? ", " : "", i, 2.0 + 0.5 * (i - 1) / std::max(1, links - 1));
  }
  return fmt::format(
      "system chain\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord {} : angle\n{}gravity (0, -g)\nstart {}\nrun 1 s\n",
      names, points, start);
}

std::shared_ptr<const Model> read(const std::string& text) {
  const SourceText source("benchmark", text);
  Diagnostics diagnostics;
  const syntax::SyntaxTree tree = syntax::parse(source, diagnostics);
  auto model = elaborate(tree, source, diagnostics);
  if (!model || diagnostics.has_errors()) throw std::runtime_error(render(diagnostics, source));
  return std::make_shared<const Model>(std::move(*model));
}

EquationsOfMotion derive(const std::shared_ptr<const Model>& model) {
  Diagnostics diagnostics;
  auto equations = euler_lagrange({model, &model->system}, diagnostics);
  if (!equations) throw std::runtime_error(render(diagnostics, SourceText("benchmark", "")));
  return std::move(*equations);
}

}  // namespace bench
