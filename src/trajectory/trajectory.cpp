#include <maupertuis/trajectory.hpp>

#include <fmt/format.h>

namespace maupertuis {

std::optional<std::size_t> Trajectory::column(const std::string& name) const {
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i].name == name) return i;
  return std::nullopt;
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
