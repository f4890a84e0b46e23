#include <doctest/doctest.h>

#include <maupertuis/units.hpp>

#include <cmath>
#include <string>

using namespace maupertuis;

namespace {

double value(std::string_view word) {
  const auto unit = find_unit(word);
  REQUIRE_MESSAGE(unit.has_value(), std::string(word));
  return unit->factor.to_double() * std::pow(std::acos(-1.0), unit->pi_power);
}

std::string dimension(std::string_view word) { return to_string(find_unit(word)->dimension); }

}  // namespace

TEST_CASE("unit words have their published values") {
  // SI brochure, NIST SP 811 appendix B.8, IAU 2012 B2: decimal values as printed there.
  struct Published {
    const char* word;
    double value;
    const char* dimension;
  };
  const Published published[] = {
      {"m", 1, "m"},
      {"kg", 1, "kg"},
      {"g", 1e-3, "kg"},
      {"mg", 1e-6, "kg"},
      {"t", 1000, "kg"},
      {"L", 1e-3, "m^3"},
      {"mm", 1e-3, "m"},
      {"μm", 1e-6, "m"},
      {"\u00B5m", 1e-6, "m"},
      {"um", 1e-6, "m"},
      {"km", 1e3, "m"},
      {"kN", 1e3, "N"},
      {"mH", 1e-3, "H"},
      {"kohm", 1e3, "ohm"},
      {"MΩ", 1e6, "ohm"},
      {"GHz", 1e9, "1/s"},
      {"hPa", 100, "Pa"},
      {"min", 60, "s"},
      {"h", 3600, "s"},
      {"day", 86400, "s"},
      {"year", 365.25 * 86400, "s"},
      {"inch", 0.0254, "m"},
      {"ft", 0.3048, "m"},
      {"yd", 0.9144, "m"},
      {"mi", 1609.344, "m"},
      {"nmi", 1852, "m"},
      {"au", 149597870700.0, "m"},
      {"pc", 3.085677581491367e16, "m"},
      {"ly", 9.4607304725808e15, "m"},
      {"lb", 0.45359237, "kg"},
      {"oz", 0.028349523125, "kg"},
      {"slug", 14.59390293720636, "kg"},
      {"lbf", 4.4482216152605, "N"},
      {"kgf", 9.80665, "N"},
      {"psi", 6894.757293168361, "Pa"},
      {"bar", 1e5, "Pa"},
      {"atm", 101325, "Pa"},
      {"torr", 133.32236842105263, "Pa"},
      {"hp", 745.6998715822702, "W"},
      {"mph", 0.44704, "m/s"},
      {"kn", 0.5144444444444445, "m/s"},
      {"eV", 1.602176634e-19, "J"},
      {"MeV", 1.602176634e-13, "J"},
      {"cal", 4.184, "J"},
      {"kWh", 3.6e6, "J"},
      {"BTU", 1055.05585262, "J"},
      {"erg", 1e-7, "J"},
      {"dyn", 1e-5, "N"},
      {"gauss", 1e-4, "T"},
      {"Ah", 3600, "C"},
      {"Å", 1e-10, "m"},
      {"acre", 4046.8564224, "m^2"},
      {"gal", 0.003785411784, "m^3"},
      {"cP", 1e-3, "Pa s"},
      {"deg", 0.017453292519943295, "rad"},
      {"arcmin", 2.908882086657216e-4, "rad"},
      {"arcsec", 4.84813681109536e-6, "rad"},
      {"rev", 6.283185307179586, "rad"},
      {"rpm", 0.10471975511965977, "rad/s"},
      {"mrad", 1e-3, "rad"},
  };
  for (const Published& unit : published) {
    CAPTURE(unit.word);
    CHECK(value(unit.word) == doctest::Approx(unit.value).epsilon(1e-14));
    CHECK(dimension(unit.word) == unit.dimension);
  }
}

TEST_CASE("derived SI units follow from the base units") {
  const auto dim = [](std::string_view word) { return find_unit(word)->dimension; };
  CHECK(dim("N") == dim("kg") * dim("m") / pow(dim("s"), 2));
  CHECK(dim("J") == dim("N") * dim("m"));
  CHECK(dim("W") == dim("J") / dim("s"));
  CHECK(dim("Pa") == dim("N") / pow(dim("m"), 2));
  CHECK(dim("C") == dim("A") * dim("s"));
  CHECK(dim("V") == dim("W") / dim("A"));
  CHECK(dim("ohm") == dim("V") / dim("A"));
  CHECK(dim("S") == dim("A") / dim("V"));
  CHECK(dim("F") == dim("C") / dim("V"));
  CHECK(dim("Wb") == dim("V") * dim("s"));
  CHECK(dim("T") == dim("Wb") / pow(dim("m"), 2));
  CHECK(dim("H") == dim("Wb") / dim("A"));
  CHECK(dim("lm") == dim("cd") * dim("sr"));
  CHECK(dim("lx") == dim("lm") / pow(dim("m"), 2));
  CHECK(dim("Gy") == dim("J") / dim("kg"));
  CHECK(dim("kat") == dim("mol") / dim("s"));
  CHECK(dim("sr") == pow(dim("rad"), 2));
}

TEST_CASE("exact names beat prefixes, and only SI units take prefixes") {
  CHECK(dimension("min") == "s");  // no milli-inch
  CHECK(dimension("ft") == "m");   // no femtotonne
  CHECK(dimension("cd") == "cd");  // no centiday
  CHECK(dimension("Pa") == "Pa");  // no petayear
  CHECK(dimension("T") == "T");
  CHECK(value("dam") == 10);
  CHECK_FALSE(find_unit("kmin"));
  CHECK_FALSE(find_unit("kft"));
  CHECK_FALSE(find_unit("mdeg"));
  CHECK_FALSE(find_unit("kkg"));
  CHECK_FALSE(find_unit("mkm"));
  CHECK_FALSE(find_unit("k"));
  CHECK_FALSE(find_unit(""));
  CHECK_FALSE(find_unit("x"));
  CHECK_FALSE(find_unit("newton meters"));
}

TEST_CASE("factors are exact") {
  CHECK(find_unit("inch")->factor == Rational(254, 10000));
  CHECK(find_unit("rpm")->factor == Rational(1, 30));
  CHECK(find_unit("rpm")->pi_power == 1);
  CHECK(find_unit("deg")->factor == Rational(1, 180));
  CHECK(find_unit("kn")->factor == Rational(463, 900));
  CHECK(find_unit("Hz")->is_hertz);
  CHECK(find_unit("kHz")->is_hertz);
  CHECK_FALSE(find_unit("rpm")->is_hertz);
}

TEST_CASE("every unit word is found and named once") {
  const auto words = unit_words();
  CHECK(words.size() > 90);
  for (std::size_t i = 0; i < words.size(); ++i) {
    CAPTURE(words[i]);
    CHECK(find_unit(words[i]).has_value());
    for (std::size_t k = i + 1; k < words.size(); ++k) CHECK(words[i] != words[k]);
  }
}

TEST_CASE("the radian is tracked and treated as one") {
  const Dimension angle = dimensions::angle();
  CHECK(angle.is_one());
  CHECK_FALSE(angle == dimensions::one());
  CHECK((angle / dimensions::time()).same_as(find_unit("Hz")->dimension));
  CHECK((angle * angle / angle).angle() == Dimension::Exponent{1, 1});
}

TEST_CASE("dimensions multiply, divide and take roots") {
  using namespace dimensions;
  CHECK(force() * length() == energy());
  CHECK(energy() / time() == power());
  CHECK(pow(energy() / mass(), 1, 2) == velocity());
  CHECK(pow(pow(length(), 1, 3), 3) == length());
  CHECK(pow(length(), 2, -2) == one() / length());
  CHECK(pow(length(), 6, 4) == pow(length(), 3, 2));
  CHECK(energy() * time() == action());
  // Exponents saturate instead of wrapping around.
  CHECK_FALSE(pow(length(), 1'000'000) == one());
  CHECK_FALSE(pow(pow(length(), 32767), 65536) == one());
}

TEST_CASE("dimensions are written in the customary unit") {
  using namespace dimensions;
  CHECK(to_string(one()) == "1");
  CHECK(to_string(energy()) == "J");
  CHECK(to_string(energy() / angle()) == "N m");
  CHECK(to_string(angle() / time()) == "rad/s");
  CHECK(to_string(action()) == "kg m^2/s");
  CHECK(to_string(moment_of_inertia()) == "kg m^2");
  CHECK(to_string(energy() * angle() * angle()) == "J");
  CHECK(to_string(force() / velocity()) == "N s/m");
  CHECK(to_string(mass() / (length() * time())) == "Pa s");
  CHECK(to_string(pow(length(), 1, 2)) == "m^(1/2)");
  CHECK(to_string(one() / (length() * time())) == "1/(m s)");
  CHECK(to_string(mass() * pow(length(), 5)) == "kg m^5");
  CHECK(to_string(mass() / (charge() * length())) == "kg/(m A s)");
}

TEST_CASE("dimensions have names in physics") {
  using namespace dimensions;
  CHECK(physical_name(energy()) == "energy");
  CHECK(physical_name(length()) == "length");
  CHECK(physical_name(length() * angle()) == "length");
  CHECK(physical_name(force()) == "force");
  CHECK(physical_name(angle() / time()) == "angular velocity");
  CHECK(physical_name(one() / time()) == "frequency");
  CHECK(physical_name(one()) == "number");
  CHECK(physical_name(mass() * pow(length(), 5)) == "");
}

TEST_CASE("a word that people write for something else than SI reads is ambiguous, and no unit of the table is") {
  for (const char* word : {"PS", "Gs", "Tm", "EV", "PA", "MS", "Gal", "as"}) {
    const AmbiguousUnit* unit = find_ambiguous_unit(word);
    REQUIRE_MESSAGE(unit, word);
    CHECK(!unit->meanings.empty());
    CHECK(!unit->instead.empty());
  }
  for (const std::string& word : unit_words()) CHECK_MESSAGE(!find_ambiguous_unit(word), word);
  // Exact names beat prefixes: none of these is a prefix before another unit.
  for (const char* word : {"min", "ft", "au", "hp", "cd", "Pa", "nmi", "yd", "mol", "ms", "kg", "pS", "mS", "GW"})
    CHECK_MESSAGE(!find_ambiguous_unit(word), word);
}

TEST_CASE("a torque is an energy per angle, in N m") {
  CHECK(to_string(dimensions::torque()) == "N m");
  CHECK(to_string(dimensions::torque() * dimensions::angle()) == "J");
  CHECK(dimensions::torque().same_as(dimensions::energy()));
}
