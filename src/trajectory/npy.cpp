#include <maupertuis/trajectory.hpp>

#include <fmt/format.h>

#include <cstdint>
#include <cstring>

namespace maupertuis {
namespace {

// numpy.load refuses longer headers unless it is told otherwise.
constexpr std::size_t longest_header = 10'000;

// A Python string literal.
std::string python_string(std::string_view text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') result += '\\';
    result += c;
  }
  return result + "'";
}

std::string field(const std::string& name, const std::string& unit, bool with_units) {
  if (!with_units || unit.empty()) return fmt::format("({},'<f8'),", python_string(name));
  return fmt::format("(({},{}),'<f8'),", python_string(fmt::format("{} [{}]", name, unit)), python_string(name));
}

std::string description(const Trajectory& trajectory, bool with_units) {
  std::string fields = field(trajectory.independent.name, trajectory.independent.unit, with_units);
  for (const auto& column : trajectory.columns) fields += field(column.name, column.unit, with_units);
  return fmt::format("{{'descr': [{}], 'fortran_order': False, 'shape': ({},), }}", fields, trajectory.rows());
}

void append_little_endian(std::string& out, std::uint64_t bits, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(bits >> (8 * i) & 0xff);
}

void append_double(std::string& out, double value) {
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  append_little_endian(out, bits, 8);
}

}  // namespace

std::string to_npy(const Trajectory& trajectory) {
  std::string header = description(trajectory, true);
  if (header.size() + 64 > longest_header) header = description(trajectory, false);
  // Magic, version and length take 12 bytes; the data begin at a multiple of 64, after a line break.
  header.append(63 - (12 + header.size()) % 64, ' ');
  header += '\n';

  std::string out("\x93NUMPY\x03\x00", 8);
  out.reserve(12 + header.size() + trajectory.rows() * (trajectory.columns.size() + 1) * sizeof(double));
  append_little_endian(out, header.size(), 4);
  out += header;
  for (std::size_t row = 0; row < trajectory.rows(); ++row) {
    append_double(out, trajectory.times[row]);
    for (std::size_t column = 0; column < trajectory.columns.size(); ++column)
      append_double(out, trajectory.at(row, column));
  }
  return out;
}

}  // namespace maupertuis
