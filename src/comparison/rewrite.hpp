#pragma once
#include "comparison/parametrization.hpp"

namespace maupertuis::comparison {

/// A value of the start for the new text.
struct StartLine {
  std::string name;  // θ or θ'
  double value = 0;  // SI
  Dimension dimension;
};

struct Rewritten {
  std::string text;
  std::vector<std::string> left_out;  // statements that ask for constraints that are gone
};

/// The text of the model in the independent coordinates: `coord` lines, `let` lines for the old coordinates,
/// constraints dropped or turned into releases, forces on old coordinates shared out, the start. All other lines stay
/// as they are.
Rewritten rewrite(const Model& model, const EquationsOfMotion& equations, const syntax::SyntaxTree& tree,
                  const SourceText& source, const Parametrization& parametrization,
                  const std::vector<StartLine>& start);

/// Coordinates that lines of the model drive or give a start.
std::set<std::string> driven_coordinates(const syntax::SyntaxTree& tree);

}  // namespace maupertuis::comparison
