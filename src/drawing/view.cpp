#include <maupertuis/drawing.hpp>

#include "drawing/moments.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr double room = 28,
                 strip = 34;  // px of weight 1: about the drawing; on the right for gravity, below for the scale
constexpr double distance_in_radii = 6;  // of the eye: near things are a little larger

}  // namespace

View::View(const Drawing& drawing, const FrameOptions& options) : drawing_(drawing) {
  const auto d = static_cast<std::size_t>(drawing.dimension);
  for (std::size_t k = 0; k < d; ++k) middle_.push_back((drawing.low[k] + drawing.high[k]) / 2);
  unit_ = std::max(0.6, std::sqrt(options.width * options.height) / 588);  // 1 at 720 × 480
  if (d == 2) {
    fit_plane(options);
    return;
  }
  const double ca = std::cos(options.camera.azimuth), sa = std::sin(options.camera.azimuth);
  const double ce = std::cos(options.camera.elevation), se = std::sin(options.camera.elevation);
  const double axes[3][3] = {{-sa, ca, 0}, {-se * ca, -se * sa, ce}, {ce * ca, ce * sa, se}};
  for (std::size_t k = 0; k < 3; ++k) right_[k] = axes[0][k], up_[k] = axes[1][k], toward_[k] = axes[2][k];
  fit_space(options);
}

void View::fit_plane(const FrameOptions& options) {
  const bool arrow = !drawing_.gravity.empty() && options.furniture;
  const double width = options.width - (2 * room + (arrow ? strip : 0)) * unit_,
               height = options.height - (2 * room + (options.furniture ? 0.6 * strip : 0)) * unit_;
  const double across = drawing_.high[0] - drawing_.low[0], up = drawing_.high[1] - drawing_.low[1];
  scale_ = std::min(width / (across > 0 ? across : 1e-300), height / (up > 0 ? up : 1e-300));
  if (!(across > 0) && !(up > 0)) scale_ = std::min(width, height) / 2;
  across_ = (options.width - (arrow ? strip * unit_ : 0)) / 2;
  down_ = (options.height - (options.furniture ? 0.6 * strip * unit_ : 0)) / 2;
}

void View::fit_space(const FrameOptions& options) {
  across_ = options.width / 2;
  down_ = options.height / 2;
  scale_ = (std::min(options.width, options.height) / 2 - room * unit_) / drawing_.radius / 1.1;
  if (!options.camera.fitted) return;
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  const auto include = [&](const std::vector<double>& points, const std::vector<double>& centre) {
    for (std::size_t i = 0; i + 3 <= points.size(); i += 3) {
      const Placed p = project(&points[i], centre);
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
      const double at[2] = {(p.x - across_) / scale_, (p.y - down_) / scale_};
      for (std::size_t k = 0; k < 2; ++k) low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
    }
  };
  const double duration = drawing::duration_of(drawing_);
  constexpr int moments = 120;
  for (int i = 0; i <= moments; ++i) {
    const double elapsed = duration * i / moments;
    const std::vector<double> centre = centre_at(elapsed);
    for (const Drawing::Element& e : drawing_.elements) {
      if ((e.still || e.kind == Drawing::Kind::Trail) && !drawing_.follow.empty()) continue;  // left behind
      const std::vector<double> points = drawing::points_at(drawing_, e, elapsed);
      include(e.kind == Drawing::Kind::Solid ? drawing::reach_of(e.shape, points) : points, centre);
    }
  }
  if (!(high[0] - low[0] > 0) && !(high[1] - low[1] > 0)) return;
  const double width = options.width - 2.6 * room * unit_, height = options.height - 2.6 * room * unit_;
  const double fitted =
      std::min(width / std::max(high[0] - low[0], 1e-300), height / std::max(high[1] - low[1], 1e-300));
  scale_ = fitted;
  across_ -= fitted * (low[0] + high[0]) / 2;
  down_ -= fitted * (low[1] + high[1]) / 2;
}

std::vector<double> View::centre_at(double elapsed) const {
  std::vector<double> centre = middle_;
  if (drawing_.follow.empty()) return centre;
  const std::vector<double> at = drawing::track_at(drawing_, drawing_.follow, centre.size(), elapsed);
  for (std::size_t k = 0; k < centre.size(); ++k) centre[k] += at[k];
  return centre;
}

std::vector<double> View::eye(const std::vector<double>& centre) const {
  std::vector<double> out = centre;
  for (std::size_t k = 0; k < out.size(); ++k) out[k] += distance_in_radii * drawing_.radius * toward_[k];
  return out;
}

View::Placed View::project(const double* place, const std::vector<double>& centre) const {
  if (drawing_.dimension == 2)
    return {across_ + scale_ * (place[0] - centre[0]), down_ - scale_ * (place[1] - centre[1]), 1, 0};
  double across = 0, up = 0, near = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = place[k] - centre[k];
    across += right_[k] * x;
    up += up_[k] * x;
    near += toward_[k] * x;
  }
  const double away = distance_in_radii * drawing_.radius;
  const double size = away / std::max(away - near, 0.05 * away);
  return {across_ + scale_ * size * across, down_ - scale_ * size * up, size, near};
}

double fitting_height(const Drawing& drawing, double width) {
  if (drawing.dimension == 3) return 2 * std::round(0.375 * width);
  const double across = drawing.high[0] - drawing.low[0], up = drawing.high[1] - drawing.low[1];
  const double frame = width - 2 * room - (drawing.gravity.empty() ? 0 : strip);
  const double ratio = across > 0 ? up / across : 1;
  return 2 * std::round(std::clamp(frame * ratio + 2.7 * room, 0.45 * width, 0.9 * width) / 2);
}

}  // namespace maupertuis
