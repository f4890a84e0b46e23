#include <doctest/doctest.h>
#include <maupertuis/field_statements.hpp>

#include "support.hpp"

using namespace maupertuis;
using namespace maupertuis::syntax;
using namespace maupertuis::syntax::test;

namespace {

// The one statement of a text.
template <typename Body>
Body only(const std::string& text) {
  Parsed parsed(text + "\n");
  REQUIRE_MESSAGE(parsed.fine(), parsed.messages());
  REQUIRE(parsed.tree.statements.size() == 1);
  REQUIRE(std::holds_alternative<Body>(parsed.tree.statements[0].body));
  return std::get<Body>(parsed.tree.statements[0].body);
}

std::string codes(const std::string& text) { return Parsed(text + "\n").codes(); }

std::string text_of(const ExpressionPtr& e) { return e ? to_string(*e) : "none"; }

}  // namespace

TEST_CASE("declarations") {
  const auto system = only<SystemStatement>("system double_pendulum \"Two rods\"");
  CHECK(system.name.text == "double_pendulum");
  CHECK(system.title == "Two rods");
  CHECK(Parsed("system a \"b\" source \"c\"\n").tree.statements.size() == 2);
  CHECK(only<SourceStatement>("source “Goldstein, § 1.4”").citation == "Goldstein, § 1.4");

  const auto param = only<ParamStatement>("param m = 1 kg, l = 60 cm");
  REQUIRE(param.items.size() == 2);
  CHECK(param.items[1].name.text == "l");
  CHECK(shape(*param.items[1].value) == "[60 cm:1]");
  CHECK(shape(*only<ParamStatement>("param k = 1e6 N/m^1.5").items[0].value) ==
        shape(*only<ParamStatement>("param k = 1e6 N/m^(3/2)").items[0].value));

  const auto coord = only<CoordStatement>("coord x, y : length, θ : angle, s : [m^2]");
  REQUIRE(coord.items.size() == 4);
  CHECK(coord.items[0].kind.text == "length");
  CHECK(coord.items[1].kind.text == "length");
  CHECK(coord.items[2].kind.text == "angle");
  CHECK(coord.items[3].unit->factors[0].exponent_numerator == 2);

  CHECK(only<LetStatement>("let a = b c, d = 2").items.size() == 2);
  const auto input = only<InputStatement>("input u : [N] = sin(t)");
  CHECK(input.unit->factors[0].word == "N");
  CHECK_FALSE(only<InputStatement>("input u = 3").unit);
}

TEST_CASE("places and masses") {
  const auto point = only<PointStatement>("point P mass 2 m at A + 3 l*(1, 0) in F");
  CHECK(text_of(point.mass) == "2 m");
  CHECK(point.in->text == "F");
  CHECK(text_of(only<PointStatement>("point P at (0, 0)").mass) == "none");

  const auto frame = only<FrameStatement>("frame F at (x, 0) rotation angle θ in G");
  CHECK(frame.rotation->kind == Rotation::Kind::Angle);
  CHECK(text_of(frame.rotation->values.at(0)) == "θ");
  CHECK(frame.in->text == "G");

  const auto axis = only<FrameStatement>("frame F at (0, 0, 0) rotation axis (0, 0, 1) angle φ");
  CHECK(axis.rotation->kind == Rotation::Kind::AxisAngle);
  CHECK(text_of(axis.rotation->axis) == "(0, 0, 1)");

  const auto body =
      only<BodyStatement>("body B mass m inertia diag(I1, I2, I3) at (0, 0, l) rotation euler zxz (φ, θ, ψ)");
  CHECK(body.inertia_kind == BodyStatement::Inertia::Diagonal);
  CHECK(body.inertia.size() == 3);
  CHECK(body.rotation->sequence == "zxz");
  CHECK(body.rotation->values.size() == 3);
  CHECK(only<BodyStatement>("body B inertia full(1, 2, 3, 0, 0, 0) rotation rpy (a, b, c)").inertia.size() == 6);
  CHECK(only<BodyStatement>("body B mass m inertia 1/12 m l^2 at (x, y) rotation angle θ").inertia_kind ==
        BodyStatement::Inertia::Scalar);
  CHECK(only<BodyStatement>("body B inertia 1 rotation quaternion").rotation->kind ==
        Rotation::Kind::QuaternionCoordinates);
  CHECK(only<BodyStatement>("body B rotation quaternion (a, b, c, d)").rotation->kind == Rotation::Kind::Quaternion);
  CHECK(codes("body B rotation euler zzx (a, b, c)") == "E0111");
  CHECK(codes("body B rotation euler zxz (a, b)") == "E0116");
}

TEST_CASE("forces and energies") {
  CHECK(text_of(only<GravityStatement>("gravity (0, -g)").vector) == "(0, -g)");
  const auto spring = only<SpringStatement>("spring A - (0, 1) stiffness k/2 length l0");
  CHECK(text_of(spring.to) == "(0, 1)");
  CHECK(text_of(spring.stiffness) == "k/2");
  CHECK(text_of(only<SpringStatement>("spring A - B stiffness k").length) == "none");
  CHECK(text_of(only<DamperStatement>("damper A - B coefficient c").coefficient) == "c");
  const auto torsion = only<TorsionSpringStatement>("torsion spring on θ stiffness k rest θ0");
  CHECK(torsion.coordinate.text == "θ");
  CHECK(text_of(torsion.rest) == "θ0");

  CHECK(only<EnergyStatement>("V += k x").adds);
  CHECK(only<EnergyStatement>("generalized_potential = q").which == EnergyStatement::Which::U);
  CHECK(codes("param U = 12 V\nU = 3") == "E0120");

  const auto on_point = only<ForceStatement>("force on P = (1, 2) in F");
  CHECK(on_point.target == ForceStatement::Target::Point);
  CHECK(on_point.in->text == "F");
  CHECK(only<ForceStatement>("force on P in F = (1, 2)").in->text == "F");
  const auto torque = only<ForceStatement>("torque on B from A = (0, 0, τ)");
  CHECK(torque.target == ForceStatement::Target::TorqueOnBody);
  CHECK(torque.from->text == "A");
  CHECK(only<ForceStatement>("force θ = -c θ'").target == ForceStatement::Target::Coordinate);
  CHECK(only<ReactionStatement>("reaction rod = release l1").released.text == "l1");
}

TEST_CASE("experiments") {
  const auto start = only<StartStatement>("start exactly at 2 s, θ = 60 deg, sat.ω = (0.01, 2, 0.01) rad/s, x' = v");
  CHECK(start.exactly);
  CHECK(text_of(start.at) == "2 s");
  REQUIRE(start.items.size() == 3);
  CHECK(text_of(start.items[1].variable) == "sat.ω");
  CHECK(shape(*start.items[1].value) == "[(vector 0.01 2 0.01) rad:1 s:-1]");
  CHECK(start.items[2].variable->primes == 1);
  CHECK(only<StartStatement>("start at 2 s").items.empty());

  const auto until = only<RunStatement>("run until P.y = 2 mm within 60 s");
  CHECK(text_of(until.until_left) == "P.y");
  CHECK(text_of(until.until_right) == "2 mm");
  CHECK(text_of(until.within) == "60 s");
  CHECK(text_of(only<RunStatement>("run -10 s").duration) == "-10 s");
  CHECK(text_of(only<OutputStatement>("output every 10 ms").every) == "10 ms");
  CHECK(codes("run until x = 0") == "E0127");

  const auto draw = only<DrawStatement>(
      "draw O - A - B, trail B, box cart 0.4 m by 0.2 m, circle A r, spring A - (0, 1), reaction rod");
  REQUIRE(draw.items.size() == 6);
  CHECK(draw.items[0].path.size() == 3);
  CHECK(draw.items[1].kind == DrawItem::Kind::Trail);
  CHECK(draw.items[2].sizes.size() == 2);
  CHECK(draw.items[3].kind == DrawItem::Kind::Circle);
  CHECK(draw.items[4].kind == DrawItem::Kind::Spring);
  CHECK(draw.items[5].kind == DrawItem::Kind::Reaction);
  CHECK(text_of(draw.items[5].path.at(0)) == "reaction rod");
  CHECK(codes("draw reaction 3") == "E0111");
  CHECK(only<DrawStatement>("draw box - trail").items[0].path.size() == 2);
}

namespace {

/// The only expectation of a line, of this kind.
template <class Kind>
Kind expected(const std::string& line) {
  const auto statement = only<ExpectStatement>(line);
  INFO(line);
  REQUIRE(std::holds_alternative<Kind>(statement.kind));
  return std::get<Kind>(statement.kind);
}

}  // namespace

TEST_CASE("expectations about neighbours of a point or a periodic motion") {
  using namespace expectation;
  const auto place =
      expected<Equilibrium>("expect equilibrium at x = 0.8369151 m ± 1e-7, y = 0 rel 1e-3, z = 1 is stable");
  REQUIRE(place.at.size() == 3);
  CHECK(text_of(place.at[0].tolerance.size) == "1e-7");
  CHECK_FALSE(place.at[0].tolerance.relative);
  CHECK(place.at[1].tolerance.relative);
  CHECK_FALSE(place.at[2].tolerance.size);
  CHECK(place.word.text == "stable");
  const auto values =
      expected<Eigenvalues>("expect eigenvalues at θ = 0 : -5.6 1/s, (-0.2, 1.3) 1/s, 0 rel 1e-9").expected;
  REQUIRE(values.real.size() == 3);
  CHECK_FALSE(values.imaginary[0]);
  CHECK(shape(*values.imaginary[1]) == "[1.3 s:-1]");
  const auto matrix = expected<Matrix>("expect M at q1 = 0, q2 = 1 : ((2, 1), (1, 3)) kg m^2 ± 1e-9");
  CHECK(matrix.letter.text == "M");
  CHECK(matrix.width == 2);
  CHECK(matrix.entries.size() == 4);
  CHECK(text_of(matrix.entries[3]) == "3 kg m^2");
  const auto entry = expected<Matrix>("expect A in θ' by θ at θ = 0 : 31.18 1/s^2 ± 1e-2");
  CHECK(entry.width == 1);
  CHECK(text_of(entry.rows[0]) == "θ'");
  CHECK(text_of(entry.columns[0]) == "θ");
  expected<ValueAt>("expect M at 3 s = 2 kg ± 1e-9");
  CHECK(codes("expect M at x = 0 : ((1, 2), (3)) ± 1e-9") == "E0111");
  CHECK(codes("expect eigenvalues at x = 0 : (1, 2, 3) ± 1e-9") == "E0111");
  const auto stable = expected<Stable>("expect stable for Ω < 5.72 rad/s ± 1e-2 at θ = 0");
  CHECK_FALSE(stable.above);
  CHECK(stable.at.size() == 1);
  CHECK(text_of(stable.critical.tolerance.size) == "1e-2");
  CHECK(expected<Stable>("expect unstable for Ω > 5.72 rad/s ± 1e-2").above);
  CHECK(expected<Multipliers>("expect multipliers over 2 s : (0.9, 0.1), 1 rel 1e-9").expected.real.size() == 2);
  CHECK(text_of(expected<Trace>("expect trace over 2 s = 2 ± 1e-9").over) == "2 s");
  CHECK_FALSE(expected<Period>("expect period = 2 s ± 1e-9").over);
  CHECK(text_of(expected<UntilAt>("expect until at 2 s ± 1e-9").expected.value) == "2 s");
  CHECK(text_of(expected<ValueAtUntil>("expect x at until = 2 m ± 1e-9").subject) == "x");
  CHECK(expected<Action>("expect action of path 2 = 2 ± 1e-9").path == 2);
  CHECK(expected<MorseIndex>("expect index of path 2 = 1").path == 2);
  CHECK(expected<PathAt>("expect path 2 x at 1 = 1 ± 1e-9").path == 2);
  CHECK(codes("expect action of path 1.5 = 2 ± 1e-9") == "E0111");
  const auto level = expected<Conserved>("expect conserved x' y where p_φ = 0, y' = 1");
  REQUIRE(level.where.size() == 2);
  CHECK(text_of(level.where[1].left) == "y'");
  CHECK(codes("expect conserved x where y = 0 rel 1e-9") == "E0111");
}

TEST_CASE("words of expectations are ordinary names where the model declares them") {
  for (const char* word : {"period", "trace"}) {
    Parsed parsed("param " + std::string(word) + " = 1\nexpect " + word + " = 1 ± 1e-9\n");
    REQUIRE_MESSAGE(parsed.fine(), parsed.messages());
    CHECK(std::holds_alternative<expectation::ValueAt>(std::get<ExpectStatement>(parsed.tree.statements[1].body).kind));
  }
}

TEST_CASE("method and precision") {
  CHECK(only<MethodStatement>("method stiff").word.text == "stiff");
  const auto method = only<MethodStatement>("method variational order 4 step 10 ms");
  CHECK(method.order == 4);
  CHECK(text_of(method.step) == "10 ms");
  CHECK(only<PrecisionStatement>("precision quad").word.text == "quad");
  CHECK(only<PrecisionStatement>("precision 100").word.text == "100");
  CHECK(codes("method taylor order 2.5") != "");
}

TEST_CASE("expectations") {
  using namespace expectation;
  const auto at = expected<ValueAt>("expect θ at 10 s = 0.123456789012 rad ± 1e-11");
  CHECK(text_of(at.time) == "10 s");
  CHECK(text_of(at.expected.value) == "0.123456789012 rad");
  CHECK(text_of(at.expected.tolerance.size) == "1e-11");
  CHECK_FALSE(at.expected.tolerance.relative);
  CHECK(expected<ValueAt>("expect θ'' at 10 s = 1 rad/s^2 rel 1e-10").expected.tolerance.relative);
  CHECK(expected<ValueAt>("expect θ at 10 s = 1 rad +/- 1e-3").expected.tolerance.size);
  CHECK(text_of(expected<ValueAt>("expect reaction rod at 3 s = 12.3 N ± 1e-9").subject) == "reaction rod");
  CHECK(expected<EnergyConserved>("expect energy conserved rel 1e-13").tolerance.relative);
  CHECK(text_of(expected<ConservedAlongRun>("expect conserved m x' + 1 rel 1e-13").tolerance.size) == "1e-13");
  CHECK(expected<Conserved>("expect conserved x'").where.empty());
  CHECK(text_of(expected<NotConserved>("expect x' + 1 not conserved").subject) == "x' + 1");
  const auto equation = expected<expectation::Equation>("expect equation m l^2 θ'' + m g l sin θ = 0");
  CHECK(text_of(equation.left) == "m l^2 θ'' + m g l sin θ");
  CHECK(text_of(expected<Freedoms>("expect freedoms = 2").number) == "2");
  const auto kind = expected<ConstraintClass>("expect constraint roll is nonholonomic");
  CHECK(kind.constraint.text == "roll");
  CHECK(kind.word.text == "nonholonomic");
  CHECK(text_of(expected<Integral>("expect integral (m1 + m2) x'").subject) == "(m1 + m2) x'");
  const auto frequencies = expected<Frequencies>("expect frequencies at θ1 = 0, θ2 = 0 : 0.5 Hz, 1.2 Hz rel 1e-9");
  CHECK(frequencies.at.size() == 2);
  CHECK(frequencies.values.size() == 2);
  CHECK(text_of(expected<Hamiltonian>("expect hamiltonian = p^2").value) == "p^2");
  CHECK(expected<Routhian>("expect routhian of φ, ψ = p_φ^2").coordinates.size() == 2);
  CHECK(text_of(expected<Bracket>("expect bracket (x, p_x) = 1").b) == "p_x");
  const auto event = expected<Event>("expect event hit 3 at 0.4515236409857 s ± 1e-11");
  CHECK(event.name.text == "hit");
  CHECK(event.occurrence == 3);
  CHECK(expected<Error>("expect error E0412").code.text == "E0412");
  CHECK(only<ExpectStatement>("claim θ'' = -g/l sin θ").claim);
  CHECK(text_of(expected<expectation::Equation>("claim θ'' = -g/l sin θ").left) == "θ''");
  CHECK_FALSE(expected<ValueAt>("expect m1 + m2 = 3 kg ± 1e-9").time);
  CHECK(codes("expect θ at 10 s = 1 rad") == "E0127");
}

TEST_CASE("constraints") {
  const auto roll = only<ConstraintStatement>("constraint x' = R φ' cos ψ name roll");
  CHECK(text_of(roll.left) == "x'");
  CHECK(text_of(roll.right) == "R φ' cos ψ");
  CHECK(roll.name->text == "roll");
  CHECK_FALSE(only<ConstraintStatement>("constraint x^2 + y^2 = l^2").name);
  CHECK(codes("constraint x^2 + y^2") == "E0111");
  CHECK(codes("constraint x = y name") == "E0111");
  CHECK(codes("constraint x = y name mass") == "E0112");
  CHECK(formatted("constraint   -x=y   name   rod\n") == "constraint -x = y name rod\n");
  // What a broken line would have declared is known, so that its use is no second mistake.
  CHECK(Parsed("constraint x + = y name rod\n").tree.lost_names.at(0).text == "rod");
  CHECK(Parsed("reaction rod = relaese l\n").tree.lost_names.at(0).text == "rod");
}

TEST_CASE("contacts, friction, events and impacts are read whole") {
  const char* const texts[] = {
      "contact r >= R restitution 0",
      "contact y <= 0 restitution e friction μ static μs slip x' name floor",
      "contact y >= 0 slip x' - R φ' sticking",
      "friction x coefficient μ static μs normal m g",
      "friction x coefficient μ normal reaction(floor)",
      "friction θ limit τ0",
      "friction θ limit τ0 static τ1",
      "impact simultaneous",
      "event hit when x = 0 rising : record",
      "event hit when x - 2 = 3 m falling : stop",
      "event hit when x = 0 : set x' = -e x', y' = y'",
  };
  for (const char* text : texts) {
    CAPTURE(text);
    Parsed parsed(std::string(text) + "\n");
    CHECK_MESSAGE(parsed.fine(), parsed.messages());
    REQUIRE(parsed.tree.statements.size() == 1);
    CHECK(formatted(std::string(text) + "\n") == std::string(text) + "\n");
  }
  const auto floor = only<ContactStatement>("contact y <= 0 restitution e friction μ static μs slip x' name floor");
  CHECK(floor.at_most);
  CHECK(text_of(floor.restitution) == "e");
  CHECK(text_of(floor.friction) == "μ");
  CHECK(text_of(floor.static_friction) == "μs");
  CHECK(text_of(floor.slip) == "x'");
  CHECK(floor.name->text == "floor");
  CHECK(only<ContactStatement>("contact y >= 0 slip x' sticking").sticking);
  const auto hit = only<EventStatement>("event hit when x - 2 = 3 m falling : stop");
  CHECK(hit.direction == -1);
  CHECK(hit.action == EventStatement::Action::Stop);
  CHECK(only<EventStatement>("event hit when x = 0 rising : set x' = -x', y' = y'").sets.size() == 2);
  CHECK(only<ImpactStatement>("impact simultaneous").simultaneous);
  CHECK_FALSE(only<ImpactStatement>("impact sequential").simultaneous);
  CHECK(codes("contact x = 3") == "E0111");
  CHECK(codes("contact x >= 3 restitution 1 restitution 1") == "E0127");
  CHECK(codes("friction x coefficient 0.3") == "E0127");
  CHECK(codes("event hit when x = 0 : jump") == "E0111");
}

TEST_CASE("statements of fields are read whole") {
  const char* const texts[] = {
      "field u(x) : angle on x = -20 m .. 20 m cells 800 boundary u_x = 0",
      "field a(x), b(x) : number on x = 0 .. 2 cells 8 order 7 boundary periodic",
      "density = 1/2 u'^2 - 1/2 c^2 u_x^2",
      "density += 1/2 u_tx^2",
      "dissipation density = 1/2 b u'^2",
      "boundary left : u = 0, u_x = 0",
      "force density u = f",
      "expect natural T u_x = 0",
      "expect solution u = sin(x - t)",
      "expect total u'^2 at 2 s = 3 J ± 1e-9",
      "expect current u' flux -u_x",
      "expect dispersion ω^2 = c^2 k^2",
      "expect frequencies of u : 1 rad/s, 2 rad/s rel 1e-9",
  };
  for (const char* text : texts) {
    CAPTURE(text);
    Parsed parsed(std::string(text) + "\n");
    CHECK_MESSAGE(parsed.fine(), parsed.messages());
    REQUIRE(parsed.tree.statements.size() == 1);
    CHECK(formatted(std::string(text) + "\n") == std::string(text) + "\n");
  }
  CHECK(codes("sweep x = 0 .. 3") == "E0127");
  const auto field = only<FieldStatement>("field a(x, y), b(x, y) : angle");
  const auto& declared = std::get<FieldDeclaration>(field.said->body);
  CHECK(declared.items.size() == 2);
  CHECK(declared.items[1].variables.size() == 2);
  CHECK(declared.items[0].kind.text == "angle");
}

TEST_CASE("lines continue in brackets and by indentation") {
  CHECK(only<LetStatement>("let a = (1 +\n2)").items.size() == 1);
  CHECK(text_of(only<LetStatement>("let a = 1\n  + 2").items[0].value) == "1 + 2");
  CHECK(text_of(only<LetStatement>("let a = 1 # one\n\n# two\n  + 2").items[0].value) == "1 + 2");
  CHECK(Parsed("  param m = 1\n  coord x : number\n").tree.statements.size() == 2);
  CHECK(Parsed("  param m = 1,\n    n = 2\n  coord x : number\n").tree.statements.size() == 2);
  CHECK(Parsed("param m = 1\r\ncoord x : number\r\n").fine());
  CHECK(Parsed("\xEF\xBB\xBFparam m = 1\ncoord x : number\n").tree.statements.size() == 2);
  CHECK(Parsed("param\tm = 1,\n\tn = 2").fine());
  CHECK(Parsed("L = \n  T - V\n").fine());
  CHECK(Parsed("contact y >= 0 restitution e\n  friction μ slip x'\n").fine());
  CHECK(codes("param m = 1\n  coord x : number") == "E0107");
  CHECK(codes("V = x\n  T = y") == "E0107");
}

TEST_CASE("statement words are free inside lines, clause words are not") {
  CHECK(Parsed("param m = 1\nlet path = m, source = path\n").fine());
  CHECK(codes("param mass = 1 kg") == "E0112");
  CHECK(codes("coord at : length") == "E0112");
  CHECK(codes("let t = 3") == "E0112");
  CHECK(codes("let sin = 3") == "E0112");
  CHECK(codes("let pi = 3") == "E0112");
}
