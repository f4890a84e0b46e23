#include <maupertuis/trajectory.hpp>

#include <fmt/format.h>

namespace maupertuis {

std::optional<std::size_t> Trajectory::column(const std::string& name) const {
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i].name == name) return i;
  return std::nullopt;
}

Trajectory with_error_columns(const Trajectory& trajectory) {
  Trajectory out = trajectory;
  if (trajectory.errors.empty()) return out;
  out.errors.clear();
  out.values.clear();
  const std::size_t count = trajectory.columns.size();
  for (const Trajectory::Column& c : trajectory.columns) out.columns.push_back({"error(" + c.name + ")", c.unit});
  out.values.reserve(2 * trajectory.values.size());
  for (std::size_t row = 0; row < trajectory.rows(); ++row)
    for (const auto* part : {&trajectory.values, &trajectory.errors}) {
      const auto from = part->begin() + static_cast<std::ptrdiff_t>(row * count);
      out.values.insert(out.values.end(), from, from + static_cast<std::ptrdiff_t>(count));
    }
  return out;
}

std::string write_trajectory(const Trajectory& trajectory, const std::string& path) {
  const auto ends_with = [&](std::string_view ending) {
    return path.size() > ending.size() && std::string_view(path).substr(path.size() - ending.size()) == ending;
  };
  if (ends_with(".csv")) return write_file(path, to_csv(trajectory));
  if (ends_with(".npy")) return write_file(path, to_npy(trajectory));
  if (ends_with(".json")) return write_file(path, to_json(trajectory));
  return fmt::format("cannot write {}: the format follows the ending, which is one of .csv, .npy, .json", path);
}

}  // namespace maupertuis
