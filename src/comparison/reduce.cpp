#include "comparison/rewrite.hpp"
#include "linear_algebra/dense.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// Proposal, closed form, text, proof.
namespace maupertuis {
namespace {

using comparison::NewCoordinate;
using comparison::Parametrization;
using comparison::StartLine;

std::string listed(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

class Reducer {
 public:
  Reducer(const Model& model, const EquationsOfMotion& equations, const syntax::SyntaxTree& tree,
          const SourceText& source, Diagnostics& diagnostics)
      : model_(model),
        system_(model.system),
        equations_(equations),
        tree_(tree),
        source_(source),
        diagnostics_(diagnostics) {}

  Reduction carry_out() {
    if (!has_holonomic()) return out_;
    const auto start = consistent_start(model_, equations_, diagnostics_);
    if (!start) return out_;
    start_ = start->state;
    propose();
    const Parametrization p =
        comparison::parametrize(model_, equations_, start_, comparison::driven_coordinates(tree_));
    if (p.unsolved) {
      refuse(*p.unsolved);
      return out_;
    }
    if (p.values.size() == system_.coordinates.size() && p.fresh.empty()) {
      diagnostics_.error("E0830", {}, fmt::format("{} has no freedom", system_.name),
                         "Its constraints determine every coordinate, so that none is independent.", "");
      return out_;
    }
    for (const auto& solved : p.solved) out_.steps.push_back(solved.sentence);
    for (const std::size_t k : p.repeated)
      out_.steps.push_back(fmt::format("{} repeats the others", system_.constraint_label(k)));
    const auto rewritten = comparison::rewrite(model_, equations_, tree_, source_, p, start_lines(p));
    constexpr std::size_t told = 5;
    for (std::size_t i = 0; i < rewritten.left_out.size(); ++i) {
      if (i == told && rewritten.left_out.size() > told + 1) {
        out_.steps.push_back(
            fmt::format("and {} lines more that ask for constraints that are gone", rewritten.left_out.size() - told));
        break;
      }
      out_.steps.push_back(fmt::format("left out, since its constraint is gone: `{}`", rewritten.left_out[i]));
    }
    prove(rewritten.text);
    return out_;
  }

 private:
  bool has_holonomic() {
    for (const Constraint& c : system_.constraints)
      if (c.level == Constraint::Level::Position && c.body.empty()) return true;
    diagnostics_.error(
        "E0830", {}, fmt::format("{} has no constraint between positions", system_.name),
        system_.constrained()
            ? "A constraint between velocities, and the norm of a quaternion, leave all coordinates in use."
            : "Its coordinates are independent already.",
        "");
    return false;
  }

  void propose() {
    const std::vector<std::size_t> dependent = comparison::dependent_coordinates(equations_, start_);
    for (std::size_t i = 0; i < system_.coordinates.size(); ++i) {
      const bool is = std::find(dependent.begin(), dependent.end(), i) != dependent.end();
      (is ? out_.dependent : out_.independent).push_back(system_.coordinates[i].name);
    }
  }

  void refuse(std::size_t k) {
    diagnostics_.error(
        "E0831", system_.constraints[k].span,
        fmt::format("{} has no closed form that is known here", system_.constraint_label(k)),
        "It is neither linear in one of its coordinates nor a circle, a sphere or an ellipsoid in two or three of "
        "them.",
        out_.independent.empty()
            ? "The constraints determine every coordinate near the start; the constrained model runs as it is."
            : fmt::format("Near the start {} can be chosen as independent, {} as dependent; the constrained model runs "
                          "as it is.",
                          listed(out_.independent), listed(out_.dependent)));
  }

  /// Positions of new angles, velocities by least squares from the old ones, and what the constraints moved elsewhere.
  std::vector<StartLine> start_lines(const Parametrization& p) const {
    Bindings at = parameter_bindings(system_);
    at[system_.context->time()] = start_.t;
    ExprVector independent, old;
    for (std::size_t i = 0; i < system_.coordinates.size(); ++i) {
      const Coordinate& c = system_.coordinates[i];
      const auto value = p.values.find(c.q);
      old.push_back(value == p.values.end() ? c.q : value->second);
      if (value == p.values.end()) independent.push_back(c.q);
      at[c.q] = start_.q[i];
    }
    for (const NewCoordinate& c : p.fresh) independent.push_back(c.q), at[c.q] = c.start;
    old = in_terms_of_motion(system_, old);
    ExprVector entries;
    for (const Expr& f : old) {
      for (const Expr& slope : gradient(f, independent)) entries.push_back(slope);
      entries.push_back(differentiate(f, system_.context->time()));
    }
    const std::vector<double> numbers = evaluate(entries, at);
    const auto n = static_cast<Eigen::Index>(old.size()), m = static_cast<Eigen::Index>(independent.size());
    Eigen::MatrixXd j(n, m);
    Eigen::VectorXd right(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto row = static_cast<std::size_t>(i * (m + 1));
      for (Eigen::Index k = 0; k < m; ++k) j(i, k) = numbers[row + static_cast<std::size_t>(k)];
      right[i] = start_.v[static_cast<std::size_t>(i)] - numbers[row + static_cast<std::size_t>(m)];
    }
    const Eigen::VectorXd velocities = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(j).solve(right);
    const double rounding = 1e-15 * (velocities.size() ? velocities.cwiseAbs().maxCoeff() : 0);

    std::vector<StartLine> out;
    const auto add = [&](const std::string& name, const Dimension& dimension, double q, double v, bool write_q,
                         bool write_v) {
      if (write_q) out.push_back({name, q, dimension});
      if (write_v && std::abs(v) > rounding) out.push_back({name + "'", v, dimension / system_.independent_dimension});
    };
    for (Eigen::Index k = 0; k < m; ++k) {
      const Expr q = independent[static_cast<std::size_t>(k)];
      const double v = velocities[k];
      if (const Coordinate* c = system_.find_coordinate(q.name()); c && c->q == q)
        add(c->name, c->dimension, at.at(q), v, !written(q.name(), 0) && at.at(q) != 0, !written(q.name(), 1));
      else
        add(q.name(), fresh_dimension(p, q), at.at(q), v, true, true);
    }
    return out;
  }

  static Dimension fresh_dimension(const Parametrization& p, Expr q) {
    const auto found = std::find_if(p.fresh.begin(), p.fresh.end(), [&](const NewCoordinate& c) { return c.q == q; });
    return found->dimension;
  }

  bool written(const std::string& name, int order) const {
    for (const StartValue& s : model_.experiment.start)
      if (system_.coordinates[s.coordinate].name == name && s.order == order) return true;
    return false;
  }

  /// What a coordinate that is now constant leaves behind: z' is 0, and the language takes no derivative of a constant.
  static std::string with_rests(std::string text) {
    constexpr int depth = 8;  // of derivatives inside derivatives
    for (int turn = 0; turn < depth; ++turn) {
      Diagnostics found;
      const SourceText source("", text);
      const syntax::SyntaxTree tree = syntax::parse(source, found);
      if (found.has_errors()) return text;
      elaborate(tree, source, found);
      found.sort_by_place();
      bool changed = false;
      const auto items = found.items();
      for (std::size_t i = items.size(); i-- > 0;) {
        if (items[i].code != "E0217" || !items[i].span) continue;
        text.replace(items[i].span->begin, items[i].span->end - items[i].span->begin, "0");
        changed = true;
      }
      if (!changed) break;
    }
    return text;
  }

  void prove(const std::string& raw) {
    Diagnostics found;
    SourceText text(system_.name, with_rests(raw));
    const syntax::SyntaxTree first = syntax::parse(text, found);
    if (!found.has_errors()) text = SourceText(system_.name, syntax::format(first, text));
    const syntax::SyntaxTree tree = syntax::parse(text, found);
    const auto reduced = found.has_errors() ? std::nullopt : elaborate(tree, text, found);
    if (reduced) lint(*reduced, text, found);
    if (!reduced || found.has_errors()) {
      refuse_line(found, text);
      return;
    }
    const auto map = read_map(model_, text, SourceText("map", ""), found);
    if (!map) throw std::logic_error("the reduced model lost a coordinate; please report");
    const auto equations = euler_lagrange(std::shared_ptr<const MechanicalSystem>(map->b, &map->b->system), found);
    if (equations) out_.proof = compare(model_, equations_, *map, *equations, {}, found);
    if (out_.proof && out_.proof->verdict == Sameness::Same) {
      out_.text = std::string(text.text());
      return;
    }
    diagnostics_.error("E0833", {}, "the reduced model could not be proved to be the same motion",
                       out_.proof ? fmt::format("The comparison says: {}.", out_.proof->reason)
                                  : "Its equations could not be derived.",
                       "Nothing is written; the constrained model runs as it is.");
  }

  void refuse_line(const Diagnostics& found, const SourceText& text) {
    for (const Diagnostic& d : found.items()) {
      if (d.severity != Severity::Error) continue;
      const std::string line = d.span ? std::string(text.line(text.locate(d.span->begin).line)) : std::string();
      diagnostics_.error(
          "E0832", {},
          fmt::format("a line cannot be carried over{}: {}", line.empty() ? "" : fmt::format(" (`{}`)", line),
                      d.message),
          d.reason,
          "Leave it out, or write it without the coordinates that become dependent: " + listed(out_.dependent) + ".");
    }
  }

  const Model& model_;
  const MechanicalSystem& system_;
  const EquationsOfMotion& equations_;
  const syntax::SyntaxTree& tree_;
  const SourceText& source_;
  Diagnostics& diagnostics_;
  MotionState start_;
  Reduction out_;
};

}  // namespace

Reduction reduce(const Model& model, const EquationsOfMotion& equations, const syntax::SyntaxTree& tree,
                 const SourceText& source, Diagnostics& diagnostics) {
  return Reducer(model, equations, tree, source, diagnostics).carry_out();
}

}  // namespace maupertuis
