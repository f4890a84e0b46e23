#pragma once
#include <array>
#include <string>
#include <vector>

/// A steep model as data: from it the text that maup reads is written, and the right-hand side of the reference, each
/// by rules of its own.
namespace steep {

/// f(u), in the words of the model language:
enum class Shape {
  One,           // 1
  Harmonic,      // 1/2 u^2
  Cosine,        // 1 - cos(u)
  Exp,           // exp(u)
  Gauss,         // exp(-u^2)
  Sech2,         // 1/cosh(u)^2
  TanhStep,      // 1/2 (1 + tanh(u))
  Logistic,      // 1/(1 + exp(-u))
  Lorentz,       // 1/(1 + u^2)
  Comb,          // exp(κ (cos(u) - 1))                       extra: κ
  Power,         // u^n                                       extra: n, even
  LennardJones,  // 4 (1/u^12 - 1/u^6)
  LogCosh,       // log(cosh(u))
  Root,          // sqrt(u^2 + 1)
  Tanh,          // tanh(u)
  Stribeck,      // (1 + c exp(-(u/10)^2)) tanh(u)            extra: c
  Coulomb,       // u/sqrt(u^2 + 1)
  Ramp,          // max(u, 0)
  RampSquare,    // max(u, 0)^2
  Abs,           // abs(u)
  Jump,          // step(u)
  Saturation,    // min(max(u, -1), 1)
  Window,        // piecewise(u < 0 : 0, u < 1 : 1, else : 0)
  Square,        // sign(sin(u))
  Pwm,           // piecewise(sin(u) > c : 1, else : 0)       extra: c
  Clip,          // min(max(3 sin(u), -1), 1)
  Rectified,     // abs(sin(u))
  Gate,          // step(exp(-u^2) - 0.5)
  Nested,        // piecewise(u < 2 : piecewise(sin(3 u) > 0 : 1, else : -1), u < 5 : 2 sign(cos(5 u)), else : 0.3)
  // of the square ρ of a distance or speed in two coordinates:
  RoundGauss,  // exp(-ρ)
  Plummer,     // -1/sqrt(ρ + 1)
  RoundRoot,   // sqrt(ρ + 1)
  RoundPen,    // piecewise(ρ < 1 : 0, else : (sqrt(ρ) - 1)^2)
  Core,        // ρ^(-n)                                      extra: n, a multiple of 1/2
};

enum class Role { Potential, Dissipation, Force };

/// A number as it is written.
struct Number {
  std::string text = "0";
  bool zero() const { return text == "0"; }
};

constexpr int most = 3;  // coordinates

/// amplitude · f(u) with u = (w − offset)/width, or (w − offset)·width, where w = Σ of_q q + Σ of_v v + of_t t. For
/// shapes of ρ: ρ = Σ over the coordinates with of_q (or of_v) of (q − centre)²/width².
struct Term {
  Shape shape = Shape::One;
  Role role = Role::Potential;
  Number amplitude{"1"}, offset, width{"1"}, extra;
  std::array<int, most> of_q{}, of_v{};
  int of_t = 0;
  bool width_multiplies = false;
  std::array<Number, most> centre{};
  int target = 0;  // Force: on this coordinate
};

bool round(Shape shape);

enum class Coupling {
  None,
  Constant,  // c x' y'
  Swinging,  // c x' y' cos(x - y)
};

/// A hanging pendulum whose pivot is at a tanh((t − t0)/w), instead of masses and terms.
struct MovingPivot {
  Number mass, length, gravity, way, time, width;
};

struct Description {
  std::string kind;  // the class: walls, pulses, layers, switches
  bool units = false;
  int n = 1;
  std::array<Number, most> mass{Number{"1"}, Number{"1"}, Number{"1"}}, q{}, v{};
  Coupling coupling = Coupling::None;
  Number coupled;
  std::vector<Term> terms;
  bool pivot_moves = false;
  MovingPivot pivot;
  Number duration{"1"};
};

/// The text of the model.
std::string text_of(const Description& d, const std::string& name);
/// A random one: the same for the same number; from `first_core` on bodies that meet cores.
inline constexpr unsigned long long first_core = 1'000'000'000'000;
Description random_description(unsigned long long number);

}  // namespace steep
