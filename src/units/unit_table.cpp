#include "units/unit_table.hpp"

/// The unit words. Values: the SI brochure (9th edition, 2019), NIST SP 811 appendix B, IAU resolution B2 (2012);
/// all are exact by definition but u and Da (CODATA 2018).
namespace maupertuis {
namespace {

using E = std::array<std::int8_t, 8>;

//                       m  kg   s   A  K  mol cd rad
constexpr E kNone{{0, 0, 0, 0, 0, 0, 0, 0}};
constexpr E kLength{{1, 0, 0, 0, 0, 0, 0, 0}};
constexpr E kArea{{2, 0, 0, 0, 0, 0, 0, 0}};
constexpr E kVolume{{3, 0, 0, 0, 0, 0, 0, 0}};
constexpr E kMass{{0, 1, 0, 0, 0, 0, 0, 0}};
constexpr E kTime{{0, 0, 1, 0, 0, 0, 0, 0}};
constexpr E kRate{{0, 0, -1, 0, 0, 0, 0, 0}};
constexpr E kCurrent{{0, 0, 0, 1, 0, 0, 0, 0}};
constexpr E kHeat{{0, 0, 0, 0, 1, 0, 0, 0}};
constexpr E kAmount{{0, 0, 0, 0, 0, 1, 0, 0}};
constexpr E kLight{{0, 0, 0, 0, 0, 0, 1, 0}};
constexpr E kAngle{{0, 0, 0, 0, 0, 0, 0, 1}};
constexpr E kSolid{{0, 0, 0, 0, 0, 0, 0, 2}};
constexpr E kAngleRate{{0, 0, -1, 0, 0, 0, 0, 1}};
constexpr E kSpeed{{1, 0, -1, 0, 0, 0, 0, 0}};
constexpr E kGravity{{1, 0, -2, 0, 0, 0, 0, 0}};
constexpr E kForce{{1, 1, -2, 0, 0, 0, 0, 0}};
constexpr E kPressure{{-1, 1, -2, 0, 0, 0, 0, 0}};
constexpr E kEnergy{{2, 1, -2, 0, 0, 0, 0, 0}};
constexpr E kPower{{2, 1, -3, 0, 0, 0, 0, 0}};
constexpr E kViscosity{{-1, 1, -1, 0, 0, 0, 0, 0}};
constexpr E kKinematic{{2, 0, -1, 0, 0, 0, 0, 0}};
constexpr E kCharge{{0, 0, 1, 1, 0, 0, 0, 0}};
constexpr E kVoltage{{2, 1, -3, -1, 0, 0, 0, 0}};
constexpr E kCapacity{{-2, -1, 4, 2, 0, 0, 0, 0}};
constexpr E kOhm{{2, 1, -3, -2, 0, 0, 0, 0}};
constexpr E kSiemens{{-2, -1, 3, 2, 0, 0, 0, 0}};
constexpr E kFlux{{2, 1, -2, -1, 0, 0, 0, 0}};
constexpr E kTesla{{0, 1, -2, -1, 0, 0, 0, 0}};
constexpr E kHenry{{2, 1, -2, -2, 0, 0, 0, 0}};
constexpr E kDose{{2, 0, -2, 0, 0, 0, 0, 0}};
constexpr E kCatalysis{{0, 0, -1, 0, 0, 1, 0, 0}};
constexpr E kLumen{{0, 0, 0, 0, 0, 0, 1, 2}};
constexpr E kLux{{-2, 0, 0, 0, 0, 0, 1, 2}};

constexpr UnitEntry kUnits[] = {
    // SI, with prefixes
    {"m", kLength, "1", 0, true},
    {"g", kMass, "1/1000", 0, true},
    {"s", kTime, "1", 0, true},
    {"A", kCurrent, "1", 0, true},
    {"K", kHeat, "1", 0, true},
    {"mol", kAmount, "1", 0, true},
    {"cd", kLight, "1", 0, true},
    {"rad", kAngle, "1", 0, true},
    {"sr", kSolid, "1", 0, true},
    {"Hz", kRate, "1", 0, true},
    {"N", kForce, "1", 0, true},
    {"Pa", kPressure, "1", 0, true},
    {"J", kEnergy, "1", 0, true},
    {"W", kPower, "1", 0, true},
    {"C", kCharge, "1", 0, true},
    {"V", kVoltage, "1", 0, true},
    {"F", kCapacity, "1", 0, true},
    {"ohm", kOhm, "1", 0, true},
    {"Ω", kOhm, "1", 0, true},
    {"S", kSiemens, "1", 0, true},
    {"Wb", kFlux, "1", 0, true},
    {"T", kTesla, "1", 0, true},
    {"H", kHenry, "1", 0, true},
    {"lm", kLumen, "1", 0, true},
    {"lx", kLux, "1", 0, true},
    {"Bq", kRate, "1", 0, true},
    {"Gy", kDose, "1", 0, true},
    {"Sv", kDose, "1", 0, true},
    {"kat", kCatalysis, "1", 0, true},
    // angles
    {"deg", kAngle, "1/180", 1},
    {"degree", kAngle, "1/180", 1},
    {"arcmin", kAngle, "1/10800", 1},
    {"arcsec", kAngle, "1/648000", 1},
    {"grad", kAngle, "1/200", 1},
    {"gon", kAngle, "1/200", 1},
    {"rev", kAngle, "2", 1},
    {"turn", kAngle, "2", 1},
    {"rpm", kAngleRate, "1/30", 1},
    {"rps", kAngleRate, "2", 1},
    // time
    {"min", kTime, "60"},
    {"h", kTime, "3600"},
    {"hr", kTime, "3600"},
    {"hour", kTime, "3600"},
    {"d", kTime, "86400"},
    {"day", kTime, "86400"},
    {"week", kTime, "604800"},
    {"yr", kTime, "31557600"},
    {"year", kTime, "31557600"},
    // length, area, volume
    {"inch", kLength, "0.0254"},
    {"ft", kLength, "0.3048"},
    {"foot", kLength, "0.3048"},
    {"yd", kLength, "0.9144"},
    {"yard", kLength, "0.9144"},
    {"mi", kLength, "1609.344"},
    {"mile", kLength, "1609.344"},
    {"nmi", kLength, "1852"},
    {"thou", kLength, "0.0000254"},
    {"micron", kLength, "1e-6"},
    {"angstrom", kLength, "1e-10"},
    {"Å", kLength, "1e-10"},
    {"au", kLength, "149597870700"},
    {"ly", kLength, "9460730472580800"},
    {"pc", kLength, "96939420213600000", -1},
    {"ha", kArea, "10000"},
    {"acre", kArea, "4046.8564224"},
    {"barn", kArea, "1e-28"},
    {"L", kVolume, "1/1000"},
    {"liter", kVolume, "1/1000"},
    {"litre", kVolume, "1/1000"},
    {"mL", kVolume, "1e-6"},
    {"cL", kVolume, "1e-5"},
    {"dL", kVolume, "1e-4"},
    {"gal", kVolume, "0.003785411784"},
    // mass
    {"t", kMass, "1000"},
    {"tonne", kMass, "1000"},
    {"lb", kMass, "0.45359237"},
    {"lbm", kMass, "0.45359237"},
    {"oz", kMass, "0.028349523125"},
    {"slug", kMass, "4.4482216152605/0.3048"},
    {"u", kMass, "1.66053906660e-27"},
    {"Da", kMass, "1.66053906660e-27"},
    // speed, acceleration
    {"mph", kSpeed, "0.44704"},
    {"kph", kSpeed, "5/18"},
    {"kmh", kSpeed, "5/18"},
    {"kn", kSpeed, "1852/3600"},
    {"knot", kSpeed, "1852/3600"},
    {"gee", kGravity, "9.80665"},
    // force, pressure
    {"lbf", kForce, "4.4482216152605"},
    {"kgf", kForce, "9.80665"},
    {"dyn", kForce, "1e-5"},
    {"bar", kPressure, "100000"},
    {"mbar", kPressure, "100"},
    {"atm", kPressure, "101325"},
    {"torr", kPressure, "101325/760"},
    {"Torr", kPressure, "101325/760"},
    {"mmHg", kPressure, "133.322387415"},
    {"psi", kPressure, "4.4482216152605/0.00064516"},
    {"ψ", kPressure, "4.4482216152605/0.00064516"},  // as a text spells psi
    {"ksi", kPressure, "4448.2216152605/0.00064516"},
    // energy, power, viscosity
    {"eV", kEnergy, "1.602176634e-19"},
    {"meV", kEnergy, "1.602176634e-22"},
    {"keV", kEnergy, "1.602176634e-16"},
    {"MeV", kEnergy, "1.602176634e-13"},
    {"GeV", kEnergy, "1.602176634e-10"},
    {"TeV", kEnergy, "1.602176634e-7"},
    {"erg", kEnergy, "1e-7"},
    {"cal", kEnergy, "4.184"},
    {"kcal", kEnergy, "4184"},
    {"BTU", kEnergy, "1055.05585262"},
    {"Wh", kEnergy, "3600"},
    {"kWh", kEnergy, "3600000"},
    {"MWh", kEnergy, "3600000000"},
    {"hp", kPower, "745.69987158227022"},
    {"P", kViscosity, "0.1"},
    {"cP", kViscosity, "0.001"},
    {"St", kKinematic, "0.0001"},
    {"cSt", kKinematic, "0.000001"},
    // electricity and magnetism
    {"Ah", kCharge, "3600"},
    {"mAh", kCharge, "3.6"},
    {"gauss", kTesla, "1e-4"},
    {"G", kTesla, "1e-4"},
    {"Mx", kFlux, "1e-8"},
    {"Ci", kRate, "37000000000"},
    // ratios
    {"percent", kNone, "1/100"},
};

constexpr PrefixEntry kPrefixes[] = {
    {"da", 1},  {"h", 2},   {"k", 3},   {"M", 6},   {"G", 9},   {"T", 12},  {"P", 15},  {"E", 18}, {"Z", 21},
    {"Y", 24},  {"R", 27},  {"Q", 30},  {"d", -1},  {"c", -2},  {"m", -3},  {"μ", -6},  {"u", -6}, {"n", -9},
    {"p", -12}, {"f", -15}, {"a", -18}, {"z", -21}, {"y", -24}, {"r", -27}, {"q", -30},
};

/// Words with a prefix that are written for something else, and words of other systems that differ from one of these by
/// a capital letter. Exact names beat prefixes: min is the minute, ft the foot, au the astronomical unit, hp the
/// mechanical horsepower (550 ft lbf/s).
constexpr AmbiguousUnit kAmbiguous[] = {
    {"PS", "a petasiemens (1e15 S) or a metric horsepower (735.49875 W)",
     "735.49875 W for the horsepower, 1e15 S for the conductance"},
    {"PA", "a petaampere (1e15 A) or, in capitals, a pascal", "Pa for the pressure, 1e15 A for the current"},
    {"EV", "an exavolt (1e18 V) or, in capitals, an electronvolt", "eV for the energy, 1e18 V for the voltage"},
    {"Gs", "a gigasecond (1e9 s) or a gauss (1e-4 T)", "G for the magnetic field, 1e9 s for the time"},
    {"Gal", "a gal of geodesy (1 cm/s^2) or a gallon", "cm/s^2 for the acceleration, gal for the volume"},
    {"Tm", "a terametre (1e12 m) or a tesla metre", "T m for the product, 1e12 m for the length"},
    {"MS", "a megasiemens (1e6 S) or, in capitals, a millisecond", "ms for the time, 1e6 S for the conductance"},
    {"Ms", "a megasecond (1e6 s) or a millisecond", "ms for the millisecond, 1e6 s for the megasecond"},
    {"as", "an attosecond (1e-18 s) or a second of arc", "arcsec for the angle, 1e-18 s for the time"},
    {"mas", "a thousandth of a second of arc, or a mistyped ms", "1e-3 arcsec for the angle, ms for the time"},
    {"CV", "a metric horsepower (735.49875 W) or a coulomb volt",
     "735.49875 W for the horsepower, C V for the product"},
    {"ton", "a tonne, or a short or a long ton", "t for 1000 kg, 2000 lb or 2240 lb for the others"},
};

}  // namespace

std::span<const AmbiguousUnit> ambiguous_units() { return kAmbiguous; }
std::span<const UnitEntry> unit_table() { return kUnits; }
std::span<const PrefixEntry> prefix_table() { return kPrefixes; }

}  // namespace maupertuis
