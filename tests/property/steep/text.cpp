#include "description.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace steep {

bool round(Shape shape) { return shape >= Shape::RoundGauss; }

namespace {

const char* const names[most] = {"x", "y", "z"};

class Writer {
 public:
  explicit Writer(const Description& d) : d_(d) {}

  std::string write(const std::string& name) {
    if (d_.pivot_moves) return pivot(name);
    std::string body;
    body += "T = " + kinetic() + "\n";
    if (const std::string v = sum(Role::Potential, "J"); !v.empty()) body += "V = " + v + "\n";
    if (const std::string p = sum(Role::Dissipation, "W"); !p.empty()) body += "D = " + p + "\n";
    for (int i = 0; i < d_.n; ++i)
      if (const std::string f = sum(Role::Force, "N", i); !f.empty())
        body += fmt::format("force {} = {}\n", names[i], f);
    return head(name) + params_ + coordinates() + body + experiment();
  }

 private:
  std::string head(const std::string& name) const {
    return fmt::format("system {} \"{}\"\n{}", name, d_.kind, d_.units ? "" : "dimensionless\n");
  }

  std::string coordinates() const {
    std::string out = "coord ";
    for (int i = 0; i < d_.n; ++i) out += (i ? ", " : "") + std::string(names[i]);
    return out + (d_.units ? " : length\n" : " : number\n");
  }

  /// A number in a formula: itself, or a parameter with its unit.
  std::string number(const Number& x, const std::string& unit) {
    if (!d_.units) return x.text[0] == '-' ? "(" + x.text + ")" : x.text;
    params_ += fmt::format("param p{} = {}{}\n", ++count_, x.text, unit.empty() ? "" : " " + unit);
    return fmt::format("p{}", count_);
  }

  std::string kinetic() {
    std::string out;
    for (int i = 0; i < d_.n; ++i)
      out += fmt::format("{}1/2*{} {}'^2", i ? " + " : "", number(d_.mass[i], "kg"), names[i]);
    if (d_.coupling == Coupling::None) return out;
    const std::string c = number(d_.coupled, "kg");
    if (d_.coupling == Coupling::Constant) return out + " + " + c + " x' y'";
    return out + " + " + c + " x' y' cos(x - y)";
  }

  std::string sum(Role role, const char* unit, int target = 0) {
    std::string out;
    for (const Term& term : d_.terms)
      if (term.role == role && (role != Role::Force || term.target == target))
        out += (out.empty() ? "" : " + ") + number(term.amplitude, unit) +
               (term.shape == Shape::One ? "" : "*" + shape(term));
    return out;
  }

  static std::string unit_of(const Term& term) {
    for (int i = 0; i < most; ++i) {
      if (term.of_q[i]) return "m";
      if (term.of_v[i]) return "m/s";
    }
    return "s";
  }

  std::string argument(const Term& term) {
    std::string w;
    const auto add = [&](int factor, const std::string& of) {
      if (factor != 0) w += (factor < 0 ? (w.empty() ? "-" : " - ") : (w.empty() ? "" : " + ")) + of;
    };
    for (int i = 0; i < d_.n; ++i) add(term.of_q[i], names[i]);
    for (int i = 0; i < d_.n; ++i) add(term.of_v[i], names[i] + std::string("'"));
    add(term.of_t, "t");
    const std::string unit = unit_of(term);
    const bool shifted = !term.offset.zero();
    if (shifted) w += " - " + number(term.offset, unit);
    if (shifted || w.size() > 2) w = "(" + w + ")";
    if (term.width_multiplies) return number(term.width, "1/(" + unit + ")") + "*" + w;
    return w + "/" + number(term.width, unit);
  }

  std::string square(const Term& term) {
    std::string out;
    const std::string unit = unit_of(term);
    for (int i = 0; i < d_.n; ++i) {
      if (!term.of_q[i] && !term.of_v[i]) continue;
      std::string one = names[i] + std::string(term.of_v[i] ? "'" : "");
      if (!term.centre[i].zero()) one = "(" + one + " - " + number(term.centre[i], unit) + ")";
      out += (out.empty() ? "" : " + ") + one + "^2";
    }
    return "(" + out + ")/" + number(term.width, unit) + "^2";
  }

  std::string shape(const Term& term) {
    const std::string u = round(term.shape) ? square(term) : argument(term);
    switch (term.shape) {
      case Shape::One:
        return "";
      case Shape::Harmonic:
        return fmt::format("1/2 ({})^2", u);
      case Shape::Cosine:
        return fmt::format("(1 - cos({}))", u);
      case Shape::Exp:
        return fmt::format("exp({})", u);
      case Shape::Gauss:
        return fmt::format("exp(-({})^2)", u);
      case Shape::Sech2:
        return fmt::format("1/cosh({})^2", u);
      case Shape::TanhStep:
        return fmt::format("1/2 (1 + tanh({}))", u);
      case Shape::Logistic:
        return fmt::format("1/(1 + exp(-({})))", u);
      case Shape::Lorentz:
        return fmt::format("1/(1 + ({})^2)", u);
      case Shape::Comb:
        return fmt::format("exp({} (cos({}) - 1))", term.extra.text, u);
      case Shape::Power:
        return fmt::format("({})^{}", u, term.extra.text);
      case Shape::LennardJones:
        return fmt::format("4 (1/({0})^12 - 1/({0})^6)", u);
      case Shape::LogCosh:
        return fmt::format("log(cosh({}))", u);
      case Shape::Root:
        return fmt::format("sqrt(({})^2 + 1)", u);
      case Shape::Tanh:
        return fmt::format("tanh({})", u);
      case Shape::Stribeck:
        return fmt::format("(1 + {1} exp(-({0}/10)^2)) tanh({0})", u, term.extra.text);
      case Shape::Coulomb:
        return fmt::format("({0})/sqrt(({0})^2 + 1)", u);
      case Shape::Ramp:
        return fmt::format("max({}, 0)", u);
      case Shape::RampSquare:
        return fmt::format("max({}, 0)^2", u);
      case Shape::Abs:
        return fmt::format("abs({})", u);
      case Shape::Jump:
        return fmt::format("step({})", u);
      case Shape::Saturation:
        return fmt::format("min(max({}, -1), 1)", u);
      case Shape::Window:
        return fmt::format("piecewise({0} < 0 : 0, {0} < 1 : 1, else : 0)", u);
      case Shape::Square:
        return fmt::format("sign(sin({}))", u);
      case Shape::Pwm:
        return fmt::format("piecewise(sin({}) > {} : 1, else : 0)", u, term.extra.text);
      case Shape::Clip:
        return fmt::format("min(max(3 sin({}), -1), 1)", u);
      case Shape::Rectified:
        return fmt::format("abs(sin({}))", u);
      case Shape::Gate:
        return fmt::format("step(exp(-({})^2) - 0.5)", u);
      case Shape::Nested:
        return fmt::format(
            "piecewise({0} < 2 : piecewise(sin(3 ({0})) > 0 : 1, else : -1), {0} < 5 : 2 sign(cos(5 ({0}))), else : "
            "0.3)",
            u);
      case Shape::RoundGauss:
        return fmt::format("exp(-{})", u);
      case Shape::Plummer:
        return fmt::format("(-1/sqrt({} + 1))", u);
      case Shape::RoundRoot:
        return fmt::format("sqrt({} + 1)", u);
      case Shape::RoundPen:
        return fmt::format("piecewise({0} < 1 : 0, else : (sqrt({0}) - 1)^2)", u);
      case Shape::Core:
        return fmt::format("({})^(-{})", u, term.extra.text);
    }
    throw std::logic_error("a shape without words");
  }

  std::string experiment() const {
    std::string start;
    for (int i = 0; i < d_.n; ++i) {
      if (!d_.q[i].zero())
        start += fmt::format("{}{} = {}{}", start.empty() ? "" : ", ", names[i], d_.q[i].text, d_.units ? " m" : "");
      if (!d_.v[i].zero())
        start += fmt::format("{}{}' = {}{}", start.empty() ? "" : ", ", names[i], d_.v[i].text, d_.units ? " m/s" : "");
    }
    return (start.empty() ? "" : "start " + start + "\n") + "run " + d_.duration.text + (d_.units ? " s\n" : "\n");
  }

  std::string pivot(const std::string& name) const {
    const MovingPivot& p = d_.pivot;
    return fmt::format(
               "system {} \"{}\"\nparam m = {} kg, l = {} m, g = {} m/s^2, a = {} m, t0 = {} s, w = {} s\ncoord x : "
               "angle\n"
               "let X = a tanh((t - t0)/w)\npoint P mass m at (X + l sin x, -l cos x)\ngravity (0, -g)\n",
               name, d_.kind, p.mass.text, p.length.text, p.gravity.text, p.way.text, p.time.text, p.width.text) +
           fmt::format("start x = {} rad\nrun {} s\n", d_.q[0].text, d_.duration.text);
  }

  const Description& d_;
  std::string params_;
  int count_ = 0;
};

}  // namespace

std::string text_of(const Description& d, const std::string& name) { return Writer(d).write(name); }

}  // namespace steep
