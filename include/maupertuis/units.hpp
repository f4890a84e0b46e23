#pragma once
#include <maupertuis/rational.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace maupertuis {

/// Exponents of the SI base units, and of the radian, which is tracked and treated as 1 in comparisons.
struct Dimension {
  enum Base : std::uint8_t { Length, Mass, Time, Current, Temperature, Amount, Luminosity, Angle, Count };
  struct Exponent {
    std::int16_t numerator = 0, denominator = 1;
    friend bool operator==(Exponent, Exponent) = default;
  };
  std::array<Exponent, Count> exponents{};

  bool is_one() const;                         // all zero but perhaps the angle
  bool same_as(const Dimension& other) const;  // equal, the angle left aside
  Exponent angle() const { return exponents[Angle]; }

  friend Dimension operator*(const Dimension& a, const Dimension& b);
  friend Dimension operator/(const Dimension& a, const Dimension& b);
  friend bool operator==(const Dimension& a, const Dimension& b) = default;

  static Dimension base(Base which);
};
Dimension pow(const Dimension& dimension, std::int64_t numerator, std::int64_t denominator = 1);

/// A unit: its dimension and its value in SI base units, exactly: factor · π^pi_power.
struct Unit {
  Dimension dimension;
  Rational factor = 1;
  int pi_power = 0;       // deg = π/180 rad, rpm = 2π/60 rad/s
  bool is_hertz = false;  // Hz stands in it to the first power: an angle rate in Hz is an error
};

/// One unit word with or without an SI prefix: "mm", "kg", "deg", "min". Exact names beat prefixes.
std::optional<Unit> find_unit(std::string_view word);
/// A word that SI reads in one way and people in another: PS is a petasiemens, and a horsepower in German. Nobody
/// should find out by a factor of 10^12, so that it is no unit of a model.
struct AmbiguousUnit {
  std::string_view word;
  std::string_view meanings;  // "a petasiemens (1e15 S) or a metric horsepower (735.49875 W)"
  std::string_view instead;   // "735.49875 W for the horsepower, 1e15 S for the conductance"
};
const AmbiguousUnit* find_ambiguous_unit(std::string_view word);

/// All words that find_unit knows without prefixes, for did-you-mean.
std::vector<std::string> unit_words();

/// The dimension in the customary unit: "N m", "kg m^2/s", "rad/s", "1" where it has none.
std::string to_string(const Dimension& dimension);
/// What a physicist calls it, if there is a word: "energy", "length", "force", "angular velocity"; else empty.
std::string physical_name(const Dimension& dimension);

namespace dimensions {
Dimension one();
Dimension angle();
Dimension length();
Dimension mass();
Dimension time();
Dimension charge();
Dimension velocity();
Dimension acceleration();
Dimension force();
Dimension torque();
Dimension energy();
Dimension power();
Dimension moment_of_inertia();
Dimension action();
}  // namespace dimensions

}  // namespace maupertuis
