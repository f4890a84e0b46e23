#include "../model_text.hpp"

#include <maupertuis/constraint_analysis.hpp>

#include <array>
#include <random>

using namespace maupertuis;

namespace frobenius_test {

/// The closure by brackets against exterior algebra: dω_i ∧ ω_1 ∧ … ∧ ω_r = 0 for all i, which shares no code with it.
namespace {

using Form = std::array<Expr, 4>;  // dx, dy, dz, dt

struct Space {
  ModelText model{"dimensionless\ncoord x, y, z : number\nT = 1/2 (x'^2 + y'^2 + z'^2)\n"};
  std::array<Expr, 4> variables{model.q(0), model.q(1), model.q(2), model.system->context->time()};
  std::mt19937 random{1877};

  Expr number(int n) const { return model.system->context->number(Rational(n)); }
  int pick(int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); }

  /// A few monomials, sines and cosines.
  Expr function() {
    Expr out = number(1 + pick(3));
    for (int k = 0; k < 2; ++k) {
      const Expr u = variables[static_cast<std::size_t>(pick(4))], w = variables[static_cast<std::size_t>(pick(4))];
      switch (pick(3)) {
        case 0:
          out = out + number(1 + pick(3)) * u * w;
          break;
        case 1:
          out = out + sin(u);
          break;
        default:
          out = out + number(1 + pick(2)) * cos(u + w);
          break;
      }
    }
    return out;
  }
  Form differential(Expr f) const {
    Form out;
    for (std::size_t i = 0; i < 4; ++i) out[i] = differentiate(f, variables[i]);
    return out;
  }
  Form any() {
    Form out;
    for (Expr& a : out) a = pick(3) ? function() : number(0);
    return out;
  }
  /// The same forms as constraints of a model.
  ConstraintAnalysis analyse(const std::vector<Form>& forms) const {
    auto system = std::make_shared<MechanicalSystem>(*model.system);
    for (const Form& form : forms) {
      Constraint c;
      c.level = Constraint::Level::Velocity;
      c.value = form[0] * model.v(0) + form[1] * model.v(1) + form[2] * model.v(2) + form[3];
      c.multiplier = system->context->symbol("λ" + std::to_string(system->constraints.size()), Role::Multiplier);
      system->constraints.push_back(c);
    }
    Diagnostics diagnostics;
    const auto equations = euler_lagrange(system, diagnostics);
    REQUIRE(equations);
    return analyse_constraints(*equations);
  }
};

Form plus(const Expr& f, const Form& a, const Expr& g, const Form& b) {
  Form out;
  for (std::size_t i = 0; i < 4; ++i) out[i] = f * a[i] + g * b[i];
  return out;
}

bool zero(Expr e) { return zero_test(e).verdict == Verdict::Zero; }

/// (dω)_ij
Expr d(const Space& s, const Form& w, std::size_t i, std::size_t j) {
  return differentiate(w[j], s.variables[i]) - differentiate(w[i], s.variables[j]);
}

/// dω ∧ ω = 0
bool integrable_alone(const Space& s, const Form& w) {
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j)
      for (std::size_t k = j + 1; k < 4; ++k)
        if (!zero(w[i] * d(s, w, j, k) + w[j] * d(s, w, k, i) + w[k] * d(s, w, i, j))) return false;
  return true;
}

/// dω ∧ a ∧ b = 0, a form of top degree in four variables
bool closed_modulo(const Space& s, const Form& w, const Form& a, const Form& b) {
  const auto two = [&](std::size_t i, std::size_t j) { return a[i] * b[j] - a[j] * b[i]; };
  return zero(d(s, w, 0, 1) * two(2, 3) - d(s, w, 0, 2) * two(1, 3) + d(s, w, 0, 3) * two(1, 2) +
              d(s, w, 1, 2) * two(0, 3) - d(s, w, 1, 3) * two(0, 2) + d(s, w, 2, 3) * two(0, 1));
}

bool all_integrable(const ConstraintAnalysis& found) {
  for (const ConstraintReport& c : found.constraints)
    if (c.constraint_class != ConstraintClass::Integrable) return false;
  return true;
}

}  // namespace

TEST_CASE("one form: brackets agree with ω ∧ dω = 0") {
  Space s;
  int integrable = 0, others = 0;
  for (int round = 0; round < 40; ++round) {
    const Form w = round % 2 ? s.any() : plus(s.function(), s.differential(s.function()), s.number(0), s.any());
    if (zero(w[0]) && zero(w[1]) && zero(w[2])) continue;
    const bool expected = integrable_alone(s, w);
    CAPTURE(round);
    const ConstraintAnalysis found = s.analyse({w});
    REQUIRE(found.clashing.empty());
    CHECK(all_integrable(found) == expected);
    CHECK(found.configuration_freedoms == (expected ? 2 : 3));
    CHECK(found.instantaneous_freedoms == 2);
    ++(expected ? integrable : others);
  }
  CHECK(integrable > 10);
  CHECK(others > 10);
}

TEST_CASE("two forms: brackets agree with dω ∧ ω₁ ∧ ω₂ = 0") {
  Space s;
  int integrable = 0, others = 0;
  for (int round = 0; round < 30; ++round) {
    Form a = s.differential(s.function()), b = s.differential(s.function());
    const Form u = plus(s.function(), a, s.function(), b), w = plus(s.function(), a, s.function(), b);
    a = round % 3 == 0 ? s.any() : u;
    b = w;
    const ConstraintAnalysis found = s.analyse({a, b});
    if (found.rank < 2 || !found.clashing.empty()) continue;
    const bool expected = closed_modulo(s, a, a, b) && closed_modulo(s, b, a, b);
    CAPTURE(round);
    CHECK(all_integrable(found) == expected);
    if (expected) CHECK(found.configuration_freedoms == 1);
    ++(expected ? integrable : others);
  }
  CHECK(integrable > 5);
  CHECK(others > 5);
}

TEST_CASE(
    "hundreds of velocity constraints that share nothing are looked at one by one, and put back in their places") {
  // Wheels that roll along a line (each integrable), knife edges (none is), and pairs of which a combination is: x' = z
  // w' and x' = z w' + y'.
  std::string text = "dimensionless\n";
  const int count = 100;
  for (int i = 0; i < count; ++i) {
    const std::string n = std::to_string(i);
    text += "coord s" + n + ", φ" + n + ", u" + n + ", v" + n + ", α" + n + ", x" + n + ", y" + n + ", z" + n + ", w" +
            n + " : number\n";
    for (const char* name : {"s", "φ", "u", "v", "α", "x", "y", "z", "w"}) text += "T += 1/2 " + (name + n) + "'^2\n";
    text += "constraint s" + n + "' = 2 φ" + n + "'\n";
    text += "constraint u" + n + "' sin α" + n + " = v" + n + "' cos α" + n + "\n";
    text += "constraint x" + n + "' = z" + n + " w" + n + "'\n";
    text += "constraint x" + n + "' = z" + n + " w" + n + "' + y" + n + "'\n";
  }
  const ModelText model(text.c_str());
  Diagnostics diagnostics;
  const auto equations = euler_lagrange(model.system, diagnostics);
  REQUIRE(equations);
  const ConstraintAnalysis analysis = analyse_constraints(*equations);
  CHECK(analysis.integrable_rank == 2 * count);
  CHECK(analysis.combinations.size() == count);
  for (std::size_t i = 0; i < count; ++i) {
    CHECK(analysis.constraints[4 * i].constraint_class == ConstraintClass::Integrable);
    for (std::size_t k = 1; k < 4; ++k)
      CHECK(analysis.constraints[4 * i + k].constraint_class == ConstraintClass::Nonholonomic);
    CHECK(analysis.combinations[i].constraints == std::vector<std::size_t>{4 * i + 2, 4 * i + 3});
  }
}

}  // namespace frobenius_test
