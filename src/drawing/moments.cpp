#include "drawing/moments.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::drawing {
namespace {

/// The frame before an elapsed time, by bisection.
std::size_t frame_before(const std::vector<double>& times, double direction, double elapsed) {
  std::size_t low = 0, high = times.size() - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    if (direction * (times[middle] - times[0]) <= elapsed)
      low = middle;
    else
      high = middle;
  }
  return low;
}

}  // namespace

double duration_of(const Drawing& drawing) { return std::abs(drawing.times.back() - drawing.times.front()); }

std::vector<double> track_at(const Drawing& drawing, const std::vector<double>& track, std::size_t width,
                             double elapsed) {
  const std::vector<double>& times = drawing.times;
  const auto frame = [&](std::size_t f) { return track.begin() + static_cast<std::ptrdiff_t>(f * width); };
  if (times.size() == 1) return {frame(0), frame(1)};
  const double direction = times.back() < times.front() ? -1 : 1;
  const std::size_t i = frame_before(times, direction, elapsed), last = times.size() - 1;
  const double h = direction * (times[i + 1] - times[i]);
  const double u = h > 0 ? std::clamp((elapsed - direction * (times[i] - times[0])) / h, 0.0, 1.0) : 0;
  if (u == 0 || (drawing.moments_only && u < 0.5)) return {frame(i), frame(i + 1)};
  if (u == 1 || drawing.moments_only) return {frame(i + 1), frame(i + 2)};
  std::vector<double> out(width);
  const double w = 1 - u;
  for (std::size_t k = 0; k < width; ++k) {
    const auto value = [&](std::size_t f) { return track[f * width + k]; };
    const double p = value(i), q = value(i + 1);
    const auto slope = [&](std::size_t f) {
      return f == 0 || f >= last ? q - p
                                 : (value(f + 1) - value(f - 1)) / (direction * (times[f + 1] - times[f - 1])) * h;
    };
    out[k] = p * (1 + 2 * u) * w * w + q * (3 - 2 * u) * u * u + slope(i) * u * w * w - slope(i + 1) * u * u * w;
  }
  return out;
}

std::vector<double> points_at(const Drawing& drawing, const Drawing::Element& element, double elapsed) {
  if (element.still) return element.positions;
  return track_at(drawing, element.positions, element.points * static_cast<std::size_t>(drawing.dimension), elapsed);
}

void carry(const std::vector<double>& pose, const double* local, std::size_t dimension, double* world) {
  for (std::size_t k = 0; k < dimension; ++k) {
    world[k] = pose[k];
    for (std::size_t a = 0; a < dimension; ++a) world[k] += local[a] * (pose[(a + 1) * dimension + k] - pose[k]);
  }
}

std::vector<double> reach_of(const SolidShape& shape, const std::vector<double>& pose) {
  const std::size_t d = pose.size() == 6 ? 2 : 3;
  std::vector<double> out;
  const auto add = [&](const double* local) {
    out.resize(out.size() + d);
    carry(pose, local, d, &out[out.size() - d]);
  };
  for (const auto* list : {&shape.faces, &shape.lines})
    for (const SolidShape::Outline& o : *list)
      for (std::size_t i = 0; i < o.points.size(); i += d) add(&o.points[i]);
  if (shape.ball)
    for (std::size_t a = 0; a < d; ++a)
      for (const double side : {-1.0, 1.0}) {
        double tip[3] = {0, 0, 0};
        tip[a] = side;
        add(tip);
      }
  return out;
}

}  // namespace maupertuis::drawing
