// What is written is read back by readers that know only the published formats.
#include <maupertuis/trajectory.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

using maupertuis::Trajectory;

namespace {

Trajectory sample() {
  Trajectory trajectory;
  trajectory.columns = {{"θ1", "rad"}, {"θ1'", "rad/s"}, {"odd, \"name\"", ""}};
  trajectory.times = {0, 0.1};
  trajectory.values = {1.0 / 3, -0.0, 1e-308, 5e300, std::nan(""), -std::numeric_limits<double>::infinity()};
  trajectory.metadata = {{"system", "double \"pendulum\"\n"}};
  return trajectory;
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

// Records of RFC 4180, section 2.
std::vector<std::vector<std::string>> read_csv(const std::string& text) {
  std::vector<std::vector<std::string>> records;
  std::vector<std::string> record{""};
  bool inside = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (inside && c == '"' && i + 1 < text.size() && text[i + 1] == '"')
      record.back() += text[++i];
    else if (c == '"')
      inside = !inside;
    else if (!inside && c == ',')
      record.emplace_back();
    else if (!inside && c == '\r') {
      REQUIRE(text.at(++i) == '\n');
      records.push_back(record);
      record = {""};
    } else
      record.back() += c;
  }
  REQUIRE(record == std::vector<std::string>{""});
  return records;
}

// The parts of a .npy file by its specification.
struct Npy {
  int major;
  std::string header;
  std::vector<double> data;
};
Npy read_npy(const std::string& bytes) {
  REQUIRE(bytes.compare(0, 6, "\x93NUMPY") == 0);
  std::uint32_t length = 0;
  for (int i = 3; i >= 0; --i) length = length << 8 | static_cast<unsigned char>(bytes.at(8 + i));
  Npy result{bytes[6], bytes.substr(12, length), {}};
  CHECK((12 + length) % 64 == 0);
  CHECK(result.header.back() == '\n');
  for (std::size_t at = 12 + length; at < bytes.size(); at += 8) {
    std::uint64_t bits = 0;
    for (int i = 7; i >= 0; --i) bits = bits << 8 | static_cast<unsigned char>(bytes.at(at + i));
    double value;
    std::memcpy(&value, &bits, sizeof value);
    result.data.push_back(value);
  }
  return result;
}

Trajectory with_one_column(const std::vector<double>& values) {
  Trajectory trajectory;
  trajectory.columns = {{"x", "m"}};
  trajectory.values = values;
  for (std::size_t i = 0; i < values.size(); ++i) trajectory.times.push_back(static_cast<double>(i));
  return trajectory;
}

}  // namespace

TEST_CASE("csv: header with units, quoting, line ends") {
  CHECK(to_csv(sample()) ==
        "t [s],θ1 [rad],θ1' [rad/s],\"odd, \"\"name\"\"\"\r\n"
        "0,0.33333333333333331,-0,9.9999999999999991e-309\r\n"
        "0.10000000000000001,5.0000000000000003e+300,nan,-inf\r\n");
  const auto records = read_csv(to_csv(sample()));
  REQUIRE(records.size() == 3);
  CHECK(records[0][3] == "odd, \"name\"");
}

TEST_CASE("csv: a run without rows is a header") {
  Trajectory empty;
  empty.columns = {{"x", "m"}};
  CHECK(to_csv(empty) == "t [s],x [m]\r\n");
}

TEST_CASE("json: schema, columns, rows, metadata") {
  const auto json = nlohmann::json::parse(to_json(sample()));
  CHECK(json["schema"] == "maupertuis-trajectory-1");
  CHECK(json["metadata"]["system"] == "double \"pendulum\"\n");
  CHECK(json["columns"].size() == 4);
  CHECK(json["columns"][0]["name"] == "t");
  CHECK(json["columns"][2]["name"] == "θ1'");
  CHECK(json["columns"][2]["unit"] == "rad/s");
  CHECK(json["rows"][0][1].get<double>() == 1.0 / 3);
  CHECK(std::signbit(json["rows"][0][2].get<double>()));
  CHECK(json["rows"][1][2].is_null());
  CHECK(json["rows"][1][3].is_null());
}

TEST_CASE("json: control characters and empty runs stay JSON") {
  Trajectory empty;
  empty.metadata = {{"note", std::string("tab\tbell\x07", 9)}};
  const auto json = nlohmann::json::parse(to_json(empty));
  CHECK(json["rows"].empty());
  CHECK(json["metadata"]["note"] == "tab\tbell\x07");
}

TEST_CASE("npy: structured records, little-endian, aligned, units as titles") {
  const Npy npy = read_npy(to_npy(sample()));
  CHECK(npy.major == 3);
  CHECK(npy.header.substr(0, npy.header.find_last_not_of(" \n") + 1) ==
        "{'descr': [(('t [s]','t'),'<f8'),(('θ1 [rad]','θ1'),'<f8'),(('θ1\\' [rad/s]','θ1\\''),'<f8'),"
        "('odd, \"name\"','<f8'),], 'fortran_order': False, 'shape': (2,), }");
  REQUIRE(npy.data.size() == 8);
  CHECK(npy.data[0] == 0);
  CHECK(same_bits(npy.data[1], 1.0 / 3));
  CHECK(same_bits(npy.data[2], -0.0));
  CHECK(std::isnan(npy.data[6]));
}

TEST_CASE("npy: long headers leave the units out, so that numpy.load takes them") {
  Trajectory wide;
  for (int i = 0; i < 400; ++i) wide.columns.push_back({"θ" + std::to_string(i) + "'", "rad/s"});
  const Npy npy = read_npy(to_npy(wide));
  CHECK(npy.header.size() <= 10000);
  CHECK(npy.header.find("rad/s") == std::string::npos);
  CHECK(npy.header.find("('θ399\\'','<f8')") != std::string::npos);
}

TEST_CASE("every finite double survives each format to the bit") {
  const bool held = rc::check("round trip", [](const std::vector<std::uint64_t>& patterns) {
    std::vector<double> values;
    for (const auto bits : patterns) {
      double value;
      std::memcpy(&value, &bits, sizeof value);
      if (std::isfinite(value)) values.push_back(value);
    }
    const Trajectory trajectory = with_one_column(values);
    const auto records = read_csv(to_csv(trajectory));
    const auto rows = nlohmann::json::parse(to_json(trajectory))["rows"];
    const auto data = read_npy(to_npy(trajectory)).data;
    for (std::size_t i = 0; i < values.size(); ++i) {
      RC_ASSERT(same_bits(std::strtod(records[i + 1][1].c_str(), nullptr), values[i]));
      RC_ASSERT(same_bits(rows[i][1].get<double>(), values[i]));
      RC_ASSERT(same_bits(data[2 * i + 1], values[i]));
    }
  });
  CHECK(held);
}

TEST_CASE("column finds by name") {
  CHECK(sample().column("θ1'") == 1u);
  CHECK_FALSE(sample().column("θ2").has_value());
}

TEST_CASE("another independent variable heads the first column of every format") {
  Trajectory curve;
  curve.independent = {"x", "m"};
  curve.columns = {{"t", "s"}};  // a name like any other then
  curve.times = {0, 1};
  curve.values = {2, 3};
  CHECK(to_csv(curve).rfind("x [m],t [s]\r\n0,2\r\n", 0) == 0);
  CHECK(to_json(curve).find("\"columns\": [{\"name\": \"x\", \"unit\": \"m\"}, {\"name\": \"t\", \"unit\": \"s\"}]") !=
        std::string::npos);
  CHECK(to_npy(curve).find("(('x [m]','x'),'<f8'),(('t [s]','t'),'<f8'),") != std::string::npos);
  curve.independent.unit.clear();
  CHECK(to_csv(curve).rfind("x,t [s]\r\n", 0) == 0);
}
