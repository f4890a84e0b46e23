#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

/// A time series with names and units: what a run leaves behind.
struct Trajectory {
  struct Column {
    std::string name;   // "θ1", "θ1'", "B.x", "energy"
    std::string unit;   // SI, "rad", "m/s"; empty for a bare number
  };
  std::vector<Column> columns;
  std::vector<double> times;                 // [rows] s, in the order of the run (descending when backwards)
  std::vector<double> values;                // [rows × columns]
  std::map<std::string, std::string> metadata;  // system, version, method, tolerance, …

  std::size_t rows() const { return times.size(); }
  double at(std::size_t row, std::size_t column) const { return values[row * columns.size() + column]; }
  std::optional<std::size_t> column(const std::string& name) const;
};

/// Why a file could not be written: the sentence for the user; empty on success.
/// The text goes to a temporary name in the same folder and is renamed when complete, so that nothing is half
/// written or lost. The format follows the ending: .csv, .npy, .json.
std::string write_trajectory(const Trajectory& trajectory, const std::string& path);
std::string to_csv(const Trajectory& trajectory);
std::string to_json(const Trajectory& trajectory);
std::string to_npy(const Trajectory& trajectory);

/// Writes any text by way of a temporary name; the sentence for the user, empty on success.
std::string write_file(const std::string& path, const std::string& content);

}  // namespace maupertuis
