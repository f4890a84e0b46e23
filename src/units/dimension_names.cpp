#include <maupertuis/units.hpp>

#include <array>
#include <string>
#include <string_view>

/// How a dimension is written and called in messages.
namespace maupertuis {
namespace {

struct Named {
  std::array<int, 8> exponents;  // m kg s A K mol cd rad
  std::string_view unit;
  std::string_view name;
};

// The same quantity stands with and without the radian where both occur: a torque is an energy per angle.
constexpr Named kNamed[] = {
    //  m  kg   s  A  K mol cd rad
    {{0, 0, 0, 0, 0, 0, 0, 0}, "1", "number"},
    {{0, 0, 0, 0, 0, 0, 0, 1}, "rad", "angle"},
    {{1, 0, 0, 0, 0, 0, 0, 0}, "m", "length"},
    {{2, 0, 0, 0, 0, 0, 0, 0}, "m^2", "area"},
    {{3, 0, 0, 0, 0, 0, 0, 0}, "m^3", "volume"},
    {{0, 1, 0, 0, 0, 0, 0, 0}, "kg", "mass"},
    {{0, 0, 1, 0, 0, 0, 0, 0}, "s", "time"},
    {{0, 0, 0, 1, 0, 0, 0, 0}, "A", "electric current"},
    {{0, 0, 0, 0, 1, 0, 0, 0}, "K", "temperature"},
    {{0, 0, 0, 0, 0, 1, 0, 0}, "mol", "amount of substance"},
    {{0, 0, 0, 0, 0, 0, 1, 0}, "cd", "luminous intensity"},
    {{0, 0, -1, 0, 0, 0, 0, 0}, "1/s", "frequency"},
    {{0, 0, -2, 0, 0, 0, 0, 0}, "1/s^2", ""},
    {{-1, 0, 0, 0, 0, 0, 0, 0}, "1/m", "wave number"},
    {{0, 0, -1, 0, 0, 0, 0, 1}, "rad/s", "angular velocity"},
    {{0, 0, -2, 0, 0, 0, 0, 1}, "rad/s^2", "angular acceleration"},
    {{1, 0, -1, 0, 0, 0, 0, 0}, "m/s", "velocity"},
    {{1, 0, -2, 0, 0, 0, 0, 0}, "m/s^2", "acceleration"},
    {{1, 1, -1, 0, 0, 0, 0, 0}, "kg m/s", "momentum"},
    {{1, 1, -2, 0, 0, 0, 0, 0}, "N", "force"},
    {{0, 1, -2, 0, 0, 0, 0, 0}, "N/m", "stiffness"},
    {{0, 1, -1, 0, 0, 0, 0, 0}, "N s/m", "damping coefficient"},
    {{2, 1, -2, 0, 0, 0, 0, 0}, "J", "energy"},
    {{2, 1, -2, 0, 0, 0, 0, -1}, "N m", "torque"},
    {{2, 1, -2, 0, 0, 0, 0, -2}, "N m/rad", "torsional stiffness"},
    {{2, 1, -1, 0, 0, 0, 0, -2}, "N m s/rad", "torsional damping coefficient"},
    {{2, 1, -3, 0, 0, 0, 0, 0}, "W", "power"},
    {{2, 1, 0, 0, 0, 0, 0, 0}, "kg m^2", "moment of inertia"},
    {{2, 1, 0, 0, 0, 0, 0, -2}, "kg m^2", "moment of inertia"},
    {{2, 1, -1, 0, 0, 0, 0, 0}, "kg m^2/s", "action"},
    {{2, 1, -1, 0, 0, 0, 0, -1}, "kg m^2/s", "angular momentum"},
    {{1, 1, 0, 0, 0, 0, 0, 0}, "kg m", ""},
    {{-1, 1, -2, 0, 0, 0, 0, 0}, "Pa", "pressure"},
    {{-1, 1, -1, 0, 0, 0, 0, 0}, "Pa s", "viscosity"},
    {{-1, 1, 0, 0, 0, 0, 0, 0}, "kg/m", "mass per length"},
    {{-3, 1, 0, 0, 0, 0, 0, 0}, "kg/m^3", "density"},
    {{2, 0, -1, 0, 0, 0, 0, 0}, "m^2/s", ""},
    {{3, -1, -2, 0, 0, 0, 0, 0}, "m^3/(kg s^2)", ""},
    {{0, 0, 1, 1, 0, 0, 0, 0}, "C", "electric charge"},
    {{2, 1, -3, -1, 0, 0, 0, 0}, "V", "voltage"},
    {{1, 1, -3, -1, 0, 0, 0, 0}, "V/m", "electric field"},
    {{2, 1, -3, -2, 0, 0, 0, 0}, "ohm", "resistance"},
    {{-2, -1, 3, 2, 0, 0, 0, 0}, "S", "conductance"},
    {{-2, -1, 4, 2, 0, 0, 0, 0}, "F", "capacitance"},
    {{2, 1, -2, -2, 0, 0, 0, 0}, "H", "inductance"},
    {{2, 1, -2, -1, 0, 0, 0, 0}, "Wb", "magnetic flux"},
    {{0, 1, -2, -1, 0, 0, 0, 0}, "T", "magnetic field"},
};

const Named* find(const Dimension& dimension) {
  for (const Named& named : kNamed) {
    bool same = true;
    for (int i = 0; i < Dimension::Count && same; ++i) {
      same = dimension.exponents[i].denominator == 1 && dimension.exponents[i].numerator == named.exponents[i];
    }
    if (same) return &named;
  }
  return nullptr;
}

// The radian is treated as 1: l θ is a length, 1/2 m l^2 θ'^2 an energy.
const Named* find_without_angle(Dimension dimension) {
  dimension.exponents[Dimension::Angle] = {};
  return find(dimension);
}

std::string factor(std::string_view unit, int numerator, int denominator) {
  std::string text(unit);
  if (denominator != 1) return text + "^(" + std::to_string(numerator) + "/" + std::to_string(denominator) + ")";
  if (numerator != 1) text += "^" + std::to_string(numerator);
  return text;
}

std::string in_base_units(Dimension dimension) {
  if (!dimension.is_one()) dimension.exponents[Dimension::Angle] = {};
  constexpr std::pair<Dimension::Base, std::string_view> order[] = {
      {Dimension::Mass, "kg"},       {Dimension::Length, "m"},   {Dimension::Current, "A"},
      {Dimension::Temperature, "K"}, {Dimension::Amount, "mol"}, {Dimension::Luminosity, "cd"},
      {Dimension::Angle, "rad"},     {Dimension::Time, "s"}};
  std::string above, below;
  int factors_below = 0;
  for (const auto& [base, unit] : order) {
    const Dimension::Exponent e = dimension.exponents[base];
    if (e.numerator == 0) continue;
    std::string& side = e.numerator > 0 ? above : below;
    if (!side.empty()) side += " ";
    side += factor(unit, e.numerator > 0 ? e.numerator : -e.numerator, e.denominator);
    factors_below += e.numerator < 0;
  }
  if (above.empty()) above = "1";
  if (below.empty()) return above;
  return above + "/" + (factors_below > 1 ? "(" + below + ")" : below);
}

}  // namespace

std::string to_string(const Dimension& dimension) {
  const Named* named = find(dimension);
  if (!named && !dimension.is_one()) named = find_without_angle(dimension);
  return named ? std::string(named->unit) : in_base_units(dimension);
}

std::string physical_name(const Dimension& dimension) {
  if (const Named* named = find(dimension)) return std::string(named->name);
  const Named* named = find_without_angle(dimension);
  return named ? std::string(named->name) : std::string();
}

}  // namespace maupertuis
