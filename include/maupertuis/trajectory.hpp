#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace maupertuis {

/// A time series with names and units: what a run leaves behind.
/// Column names differ from each other and from that of the independent variable, the first column in every format.
struct Trajectory {
  struct Column {
    std::string name;  // "θ1", "θ1'", "B.x", "energy"
    std::string unit;  // SI, "rad", "m/s"; empty for a bare number
  };
  Column independent{"t", "s"};  // what `times` are
  std::vector<Column> columns;
  std::vector<double> times;      // [rows] in the order of the run (descending when backwards)
  std::vector<double> values;     // [rows × columns]
  std::vector<double> errors;     // [rows × columns] by how much each may be off (uncertainty.hpp); empty: not known
  std::vector<std::size_t> gaps;  // rows before which others were left out, ascending: no line goes there (pictures of
                                  // oscillations that are much faster than the run is long)
  std::map<std::string, std::string> metadata;  // system, version, method, tolerance, …
  /// Where functions of time are free: these rows with every column, as one choice of the functions makes them. For
  /// formulas that do not depend on the choice; else null.
  std::shared_ptr<const Trajectory> of_one_choice{};

  std::size_t rows() const { return times.size(); }
  double at(std::size_t row, std::size_t column) const { return values[row * columns.size() + column]; }
  double error(std::size_t row, std::size_t column) const { return errors[row * columns.size() + column]; }
  std::optional<std::size_t> column(const std::string& name) const;
};

/// The trajectory with its errors as further columns, error(θ1) of θ1 in the same unit, after all others. For files;
/// without errors, as it is. Infinite where no digit is certain.
Trajectory with_error_columns(const Trajectory& trajectory);

/// The formats that `write_trajectory` knows, by their endings.
inline constexpr std::string_view trajectory_endings[] = {".csv", ".npy", ".json"};

/// Writes the format that the ending of `path` names. Returns the sentence for the user when it could not be written,
/// empty on success; then nothing at `path` has changed (see write_file).
std::string write_trajectory(const Trajectory& trajectory, const std::string& path);

/// RFC 4180: one header record `t [s],θ1 [rad],θ1' [rad/s]`, records end with CR LF, names with a comma or a quote are
/// quoted. Numbers have 17 digits, so that reading gives the same doubles; NaN and infinities are `nan`, `inf`, `-inf`.
/// UTF-8. Metadata have no place in CSV.
std::string to_csv(const Trajectory& trajectory);

/// {"schema": "maupertuis-trajectory-1", "metadata": {…}, "columns": [{"name", "unit"}, …], "rows": [[…], …]}; the
/// first column is the time, numbers have 17 digits, null where a value is not finite.
std::string to_json(const Trajectory& trajectory);

/// A NumPy array of records [rows], format 3.0 (UTF-8): `numpy.load(f)["θ1"]`, `["t"]`. Little-endian doubles, as they
/// were computed. A field's title carries its unit, `a.dtype.fields["θ1"][2]` is `θ1 [rad]`; titles are left out where
/// the header would pass the 10,000 characters that numpy.load accepts.
std::string to_npy(const Trajectory& trajectory);

/// Writes any text or bytes by way of a temporary name in the same folder that is renamed when complete and on the
/// disk: another program sees the old content or the new, never a part, and a failure leaves the old content. A link is
/// followed; a device or a pipe is written to as it is. The permissions of an existing file stay. Returns the sentence
/// for the user, empty on success.
std::string write_file(const std::string& path, const std::string& content);

}  // namespace maupertuis
