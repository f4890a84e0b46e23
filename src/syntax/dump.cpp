#include <maupertuis/field_statements.hpp>

#include <fmt/format.h>

/// The tree as text, a line a node: what `maup derive --emit syntax` shows. No places, so that two texts with the same
/// meaning dump alike.
namespace maupertuis::syntax {
namespace {

using Kind = Expression::Kind;

constexpr std::string_view kOperators[] = {"+", "-", "*",  "juxtaposed", "/",  "·",   "×", "^",
                                           "-", "<", "<=", ">",          ">=", "and", "or"};
constexpr std::string_view kKinds[] = {"number", "quantity", "name",  "member",          "call",
                                       "vector", "binary",   "unary", "time derivative", "piecewise"};
constexpr std::string_view kRotations[] = {"angle",      "axis and angle",        "euler", "roll, pitch, yaw",
                                           "quaternion", "quaternion coordinates"};
constexpr std::string_view kShapes[] = {"line",      "trail",  "box",   "circle", "spring", "reaction", "disc",  "hoop",
                                        "ellipsoid", "damper", "pivot", "ground", "wall",   "label",    "follow"};
constexpr std::string_view kInertias[] = {"none", "scalar", "diagonal", "full"};

std::string unit_text(const UnitExpression& unit) {
  std::string text;
  for (const UnitExpression::Factor& factor : unit.factors) {
    text += fmt::format(" {}", factor.word);
    if (factor.exponent_denominator != 1)
      text += fmt::format("^({}/{})", factor.exponent_numerator, factor.exponent_denominator);
    else if (factor.exponent_numerator != 1)
      text += fmt::format("^{}", factor.exponent_numerator);
  }
  return text.empty() ? " 1" : text;
}

class Dumper {
 public:
  std::string text;

  void operator()(const SystemStatement& s) { head("system", s.name.text), word("title", s.title); }
  void operator()(const SourceStatement& s) { head("source", s.citation); }
  void operator()(const NoteStatement& s) { head("note", s.text); }
  void operator()(const DimensionlessStatement&) { head("dimensionless"); }
  void operator()(const ParamStatement& s) {
    head("param");
    for (const auto& item : s.items) child(item.name.text, item.value);
  }
  void operator()(const CoordStatement& s) {
    head("coord");
    for (const auto& item : s.items) word(item.name.text, item.unit ? "unit" + unit_text(*item.unit) : item.kind.text);
  }
  void operator()(const LetStatement& s) {
    head("let");
    for (const auto& item : s.items) child(item.name.text, item.value);
  }
  void operator()(const RatesStatement& s) {
    head("rates");
    for (const auto& group : s.groups) {
      std::string names;
      for (const Name& n : group.names) names += (names.empty() ? "" : ", ") + n.text;
      child(names, group.value);
    }
  }
  void operator()(const InputStatement& s) {
    head("input", s.name.text), word("unit", s.unit ? unit_text(*s.unit) : ""), child("value", s.value);
  }
  void operator()(const FrameStatement& s) {
    head("frame", s.name.text), child("at", s.at), rotation(s.rotation), name("in", s.in);
  }
  void operator()(const PointStatement& s) {
    head("point", s.name.text), child("mass", s.mass), child("at", s.at), name("in", s.in);
  }
  void operator()(const BodyStatement& s) {
    head("body", s.name.text), child("mass", s.mass);
    children(fmt::format("inertia {}", kInertias[static_cast<int>(s.inertia_kind)]), s.inertia);
    child("at", s.at), rotation(s.rotation), name("in", s.in);
  }
  void operator()(const GravityStatement& s) { head("gravity"), child("vector", s.vector); }
  void operator()(const SpringStatement& s) {
    head("spring"), child("from", s.from), child("to", s.to), child("stiffness", s.stiffness),
        child("length", s.length);
  }
  void operator()(const DamperStatement& s) {
    head("damper"), child("from", s.from), child("to", s.to), child("coefficient", s.coefficient);
  }
  void operator()(const TorsionSpringStatement& s) {
    head("torsion spring", s.coordinate.text), child("stiffness", s.stiffness), child("rest", s.rest);
  }
  void operator()(const EnergyStatement& s) {
    head("energy", fmt::format("{}{}", "TVULD"[static_cast<int>(s.which)], s.adds ? " +=" : "")),
        child("value", s.value);
  }
  void operator()(const ForceStatement& s) {
    constexpr std::string_view targets[] = {"force on", "torque on", "force along"};
    head(targets[static_cast<int>(s.target)], s.on.text), name("from", s.from), name("in", s.in),
        child("value", s.value);
  }
  void operator()(const StartStatement& s) {
    head("start", s.exactly ? "exactly" : ""), child("at", s.at), assignments(s.items);
  }
  void operator()(const RunStatement& s) {
    head("run"), child("duration", s.duration), child("until", s.until_left), child("equals", s.until_right),
        child("within", s.within);
  }
  void operator()(const OutputStatement& s) { head("output"), child("every", s.every); }
  void operator()(const MethodStatement& s) {
    head("method", s.word.text), word("order", s.order ? std::to_string(s.order) : ""), child("step", s.step);
  }
  void operator()(const PrecisionStatement& s) { head("precision", s.word.text); }
  void operator()(const DrawStatement& s) {
    head("draw");
    for (const DrawItem& item : s.items) {
      word(kShapes[static_cast<int>(item.kind)], "");
      ++depth_;
      children("path", item.path), children("sizes", item.sizes), child("direction", item.direction),
          word("text", item.text);
      --depth_;
    }
  }
  void operator()(const ReactionStatement& s) { head("reaction", s.name.text), word("released", s.released.text); }
  void operator()(const ExpectStatement& s) {
    expectation_ = s.claim ? "claim" : "expect";
    std::visit(*this, s.kind);
  }
  void operator()(const expectation::ValueAt& x) {
    head(expectation_, x.time ? "value at" : "value"), child("subject", x.subject), child("time", x.time),
        expected(x.expected);
  }
  void operator()(const expectation::ValueAtUntil& x) {
    head(expectation_, "value at until"), child("subject", x.subject), expected(x.expected);
  }
  void operator()(const expectation::UntilAt& x) { head(expectation_, "until at"), expected(x.expected); }
  void operator()(const expectation::EnergyConserved& x) {
    head(expectation_, "energy conserved"), tolerance(x.tolerance);
  }
  void operator()(const expectation::ConservedAlongRun& x) {
    head(expectation_, "conserved"), child("subject", x.subject), tolerance(x.tolerance);
  }
  void operator()(const expectation::Conserved& x) {
    head(expectation_, "conserved"), child("subject", x.subject);
    for (const Equation& level : x.where) child("where", level.left), child("equals", level.right);
  }
  void operator()(const expectation::NotConserved& x) {
    head(expectation_, "not conserved"), child("subject", x.subject);
  }
  void operator()(const expectation::Integral& x) { head(expectation_, "integral"), child("subject", x.subject); }
  void operator()(const expectation::Equation& x) {
    head(expectation_, "equation"), child("left", x.left), child("right", x.right);
  }
  void operator()(const expectation::Hamiltonian& x) { head(expectation_, "hamiltonian"), child("value", x.value); }
  void operator()(const expectation::Routhian& x) {
    head(expectation_, "routhian"), children("coordinate", x.coordinates), child("value", x.value);
  }
  void operator()(const expectation::Bracket& x) {
    head(expectation_, "bracket"), child("a", x.a), child("b", x.b), child("value", x.value);
  }
  void operator()(const expectation::Freedoms& x) { head(expectation_, "freedoms"), child("value", x.number); }
  void operator()(const expectation::ConstraintClass& x) {
    head(expectation_, "constraint class"), word("name", x.constraint.text), word("word", x.word.text);
  }
  void operator()(const expectation::Frequencies& x) {
    head(expectation_, "frequencies"), word("squared", x.squared ? "yes" : ""), assignments(x.at),
        children("values", x.values), tolerance(x.tolerance);
  }
  void operator()(const expectation::Eigenvalues& x) {
    head(expectation_, "eigenvalues"), assignments(x.at), spectrum(x.expected);
  }
  void operator()(const expectation::Matrix& x) {
    head(expectation_, "matrix"), word("name", x.letter.text), children("row", x.rows), children("column", x.columns),
        assignments(x.at);
    word("width", std::to_string(x.width)), children("values", x.entries), tolerance(x.tolerance);
  }
  void operator()(const expectation::Equilibrium& x) {
    head(expectation_, "equilibrium"), word("word", x.word.text);
    for (const expectation::Place& place : x.at) assignments({place.value}), tolerance(place.tolerance);
  }
  void operator()(const expectation::Stable& x) {
    head(expectation_, "stable"), word("word", x.word.text), word("above", x.above ? "yes" : ""),
        child("subject", x.parameter);
    expected(x.critical), assignments(x.at);
  }
  void operator()(const expectation::Multipliers& x) {
    head(expectation_, "multipliers"), child("time", x.over), spectrum(x.expected);
  }
  void operator()(const expectation::Trace& x) {
    head(expectation_, "trace"), child("time", x.over), expected(x.expected);
  }
  void operator()(const expectation::Period& x) {
    head(expectation_, "period"), child("time", x.over), expected(x.expected);
  }
  void operator()(const expectation::Action& x) {
    head(expectation_, "action"), number("path", x.path), expected(x.expected);
  }
  void operator()(const expectation::ActionAlong& x) {
    head(expectation_, "action"), children("along", x.q), child("from", x.from), child("to", x.to),
        expected(x.expected);
  }
  void operator()(const expectation::MorseIndex& x) {
    head(expectation_, "morse index"), number("path", x.path), child("value", x.index);
  }
  void operator()(const expectation::PathAt& x) {
    head(expectation_, "path at"), number("path", x.path), child("subject", x.subject), child("time", x.time),
        expected(x.expected);
  }
  void operator()(const expectation::Event& x) {
    head(expectation_, "event at"), word("name", x.name.text), word("change", x.change.text),
        number("occurrence", x.occurrence), expected(x.time);
  }
  void operator()(const expectation::EventCount& x) {
    head(expectation_, "event count"), word("name", x.name.text), word("change", x.change.text),
        child("value", x.number);
  }
  void operator()(const expectation::PhaseConstraints& x) {
    head(expectation_, "phase constraints");
    for (const auto& generation : x.generations) children("generation", generation);
  }
  void operator()(const expectation::ClassCount& x) { head(expectation_, x.what), child("value", x.number); }
  void operator()(const expectation::OfField& x) {
    std::visit([this](const auto& said) { expected_field(said); }, x.said->body);
  }
  void operator()(const expectation::Error& x) { head(expectation_, "error"), word("name", x.code.text); }
  void operator()(const ConstraintStatement& s) {
    head(s.integral ? "integral constraint" : "constraint", s.name ? s.name->text : ""), child("left", s.left),
        child("right", s.right);
  }
  void operator()(const GaugeStatement& s) { head("gauge"), child("left", s.left), child("right", s.right); }
  void operator()(const SweepStatement& s) {
    head("sweep"), child("variable", s.variable), child("from", s.from), child("to", s.to), child("steps", s.steps);
  }
  void operator()(const IndependentStatement& s) {
    head("independent", s.name.text), word("kind", s.unit ? "unit" + unit_text(*s.unit) : s.kind.text);
  }
  void operator()(const PathStatement& s) {
    head("path");
    for (const auto& [label, end] : {std::pair{"from", &s.from}, std::pair{"to", &s.to}}) {
      for (std::size_t i = 0; i < end->configuration.size(); ++i) {
        const ExpressionPtr& component = end->configuration[i];
        if (!end->names.empty()) child("of", end->names[i]);
        component ? child(label, component) : word(label, "free");
      }
      child("at", end->at);
    }
  }
  void operator()(const ContactStatement& s) {
    head("contact", s.name ? s.name->text : ""), child("left", s.left), word("at most", s.at_most ? "yes" : ""),
        child("right", s.right), child("restitution", s.restitution), child("friction", s.friction),
        child("static", s.static_friction), child("slip", s.slip), word("sticking", s.sticking ? "yes" : "");
  }
  void operator()(const FrictionStatement& s) {
    head("friction"), child("coordinate", s.coordinate), child("coefficient", s.coefficient),
        child("static", s.static_friction), child("normal", s.normal), child("limit", s.limit);
  }
  void operator()(const EventStatement& s) {
    static constexpr const char* directions[] = {"falling", "", "rising"};
    static constexpr const char* actions[] = {"record", "stop", "set"};
    head("event", s.name.text), child("left", s.left), child("right", s.right),
        word("direction", directions[s.direction + 1]), word("action", actions[static_cast<int>(s.action)]),
        assignments(s.sets);
  }
  void operator()(const ImpactStatement& s) { head("impact", s.simultaneous ? "simultaneous" : "sequential"); }
  void operator()(const FieldStatement& s) {
    head(s.what);
    std::visit([this](const auto& said) { field(said); }, s.said->body);
  }

 private:
  void head(std::string_view kind, std::string_view what = {}) {
    text += what.empty() ? fmt::format("{}\n", kind) : fmt::format("{} {}\n", kind, what);
  }

  void field(const FieldDeclaration& s) {
    for (const auto& item : s.items) word("name", item.name.text), word("kind", item.kind.text);
    for (const auto& range : s.ranges)
      word("on", range.variable.text), child("from", range.from), child("to", range.to);
    children("cells", s.cells), child("order", s.order);
    if (s.periodic) word("boundary", "periodic");
    for (const Name& x : s.around) word("around", x.text);
    equations(s.boundary);
  }
  void field(const DensityText& s) { child(s.adds ? "adds" : "value", s.value); }
  void field(const BoundaryText& s) {
    if (!s.side.text.empty()) word("side", s.side.text);
    equations(s.conditions);
  }
  void field(const FieldForce& s) { child("on", s.on), child("value", s.value); }
  void expected_field(const FieldExpectation::Natural& x) { head(expectation_, "natural"), equations(x.conditions); }
  void expected_field(const FieldExpectation::Solution& x) { head(expectation_, "solution"), equations(x.fields); }
  void expected_field(const FieldExpectation::Total& x) {
    head(expectation_, "total"), child("density", x.density), child("time", x.time), expected(x.expected);
    if (x.at_equilibrium) word("at", "equilibrium");
  }
  void expected_field(const FieldExpectation::Current& x) {
    head(expectation_, "current"), child("density", x.density), children("flux", x.fluxes);
  }
  void expected_field(const FieldExpectation::Dispersion& x) {
    head(expectation_, "dispersion"), child("left", x.left), child("right", x.right);
  }
  void expected_field(const FieldExpectation::Frequencies& x) {
    head(expectation_, "frequencies of"), word("field", x.field.text), children("value", x.values),
        tolerance(x.tolerance);
  }
  void equations(const std::vector<Equation>& list) {
    for (const Equation& one : list) child("left", one.left), child("right", one.right);
  }

  void word(std::string_view label, std::string_view what) {
    if (what.empty() && depth_ == 1 && label != "line" && label != "trail") return;
    text += fmt::format("{:{}}{}{}{}\n", "", 2 * depth_, label, what.empty() ? "" : " ", what);
  }

  void name(std::string_view label, const std::optional<Name>& name) {
    if (name) word(label, name->text);
  }

  void number(std::string_view label, int value) { word(label, value ? std::to_string(value) : ""); }
  void tolerance(const Tolerance& t) { child(t.relative ? "relative tolerance" : "tolerance", t.size); }
  void expected(const expectation::Number& n) { child("value", n.value), tolerance(n.tolerance); }
  void spectrum(const expectation::Spectrum& s) {
    for (std::size_t i = 0; i < s.real.size(); ++i) child("values", s.real[i]), child("imaginary", s.imaginary[i]);
    tolerance(s.tolerance);
  }

  void child(std::string_view label, const ExpressionPtr& expression) {
    if (!expression) return;
    text += fmt::format("{:{}}{}:\n", "", 2 * depth_, label);
    ++depth_;
    print(*expression);
    --depth_;
  }

  void children(std::string_view label, const std::vector<ExpressionPtr>& expressions) {
    for (const ExpressionPtr& expression : expressions) child(label, expression);
  }

  void assignments(const std::vector<StartStatement::Item>& items) {
    for (const auto& item : items) child("variable", item.variable), child("value", item.value);
  }

  void rotation(const std::optional<Rotation>& rotation) {
    if (!rotation) return;
    word("rotation", fmt::format("{} {}", kRotations[static_cast<int>(rotation->kind)], rotation->sequence));
    child("axis", rotation->axis);
    children("value", rotation->values);
  }

  void print(const Expression& e) {
    std::string line(kKinds[static_cast<int>(e.kind)]);
    if (e.kind == Kind::Binary) line = fmt::format("binary {}", kOperators[static_cast<int>(e.op)]);
    if (e.kind == Kind::Unary) line = "negate";
    if (!e.text.empty()) line += fmt::format(" {}", e.text);
    line.append(static_cast<std::size_t>(e.primes), '\'');
    if (e.bare) line += " bare";
    if (e.unit) line += fmt::format("{}{}", e.unit_bracketed ? " in brackets" : "", unit_text(*e.unit));
    text += fmt::format("{:{}}{}\n", "", 2 * depth_, line);
    ++depth_;
    for (const ExpressionPtr& argument : e.arguments) print(*argument);
    --depth_;
  }

  std::size_t depth_ = 1;
  std::string_view expectation_;  // "expect" or "claim"
};

}  // namespace

std::string dump(const SyntaxTree& tree) {
  Dumper dumper;
  for (const Statement& statement : tree.statements) std::visit(dumper, statement.body);
  return std::move(dumper.text);
}

}  // namespace maupertuis::syntax
