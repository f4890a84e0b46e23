#include "drawing/frame.hpp"
#include "drawing/moments.hpp"

#include <algorithm>
#include <array>
#include <cmath>

/// A moment of a drawing as strokes. The script of the page does the same (src/report/page/scene.js); a test compares
/// the two.
namespace maupertuis {
namespace {

using Ink = FrameColour::Ink;
using Kind = Drawing::Kind;
using SolidOutline = SolidShape::Outline;

constexpr double body_tint = 0.22, whole_trail = 0.2;
constexpr std::size_t ids_of_an_element = 4096, contour = 48;

/// The same line by this number of points, so that an animated picture finds each of them again.
SolidOutline with_points(const SolidOutline& line, std::size_t count) {
  SolidOutline out;
  const std::size_t n = line.points.size() / 3;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = static_cast<double>(i * (n - 1)) / static_cast<double>(count - 1);
    const std::size_t k = std::min(static_cast<std::size_t>(at), n - 2);
    for (std::size_t c = 0; c < 3; ++c)
      out.points.push_back(line.points[3 * k + c] +
                           (at - static_cast<double>(k)) * (line.points[3 * k + 3 + c] - line.points[3 * k + c]));
  }
  return out;
}

class Painter {
 public:
  Painter(const Drawing& drawing, const View& view, double elapsed, const FrameOptions& options)
      : drawing_(drawing),
        view_(view),
        elapsed_(elapsed),
        options_(options),
        centre_(view.centre_at(elapsed)),
        d_(static_cast<std::size_t>(drawing.dimension)) {}

  std::vector<FrameItem> paint() {
    std::size_t trails = 0;
    for (std::size_t i = 0; i < drawing_.elements.size(); ++i) {
      const Drawing::Element& e = drawing_.elements[i];
      id_ = i * ids_of_an_element;
      if (e.kind == Kind::Trail) {
        trail(e, 1 + trails++ % 6);
        continue;
      }
      const std::vector<double> points = drawing::points_at(drawing_, e, elapsed_);
      if (!std::all_of(points.begin(), points.end(), [](double x) { return std::isfinite(x); })) continue;
      const std::size_t begin = items_.size();
      switch (e.kind) {
        case Kind::Path:
          path(e, points);
          break;
        case Kind::Solid:
          solid(e.shape, points);
          break;
        case Kind::Arrow:
          force(e, points);
          break;
        case Kind::Label:
          label(e, points);
          break;
        case Kind::Trail:
          break;
      }
      if (e.kind == Kind::Solid && e.shape.role == SolidShape::Role::Ground) lay(begin, -1e300);
      if (e.kind == Kind::Arrow || e.kind == Kind::Label) lay(begin, 1e300);
    }
    for (const Plane& plane : planes_) order(plane);
    if (d_ == 3)
      std::stable_sort(items_.begin(), items_.end(), [](const auto& a, const auto& b) { return a.depth < b.depth; });
    return std::move(items_);
  }

 private:
  /// A flat thing in space, and where other things are: which lies in front is told by the side on which the eye is.
  struct Plane {
    std::size_t begin, end;  // its items
    double origin[3], normal[3], reach;
  };
  struct Spot {
    double place[3], depth;
    bool trail;
  };
  void order(const Plane& plane);
  void note(const double* at, double depth, bool trail = false) {
    if (d_ == 3) spots_.push_back({{at[0], at[1], at[2]}, depth, trail});
  }
  void note_plane(const std::vector<double>& pose, std::size_t begin);
  void lay(std::size_t from, double depth) {
    for (std::size_t i = from; i < items_.size(); ++i) items_[i].depth = depth;
  }
  View::Placed place(const double* at) const { return view_.project(at, centre_); }

  FrameItem& add(FrameItem item) {
    item.id = id_++;
    items_.push_back(std::move(item));
    return items_.back();
  }
  FrameItem& stroke(std::vector<double> points, FrameColour colour, double weight, double depth) {
    FrameItem item;
    item.points = std::move(points);
    item.stroke = colour;
    item.width = weight * view_.unit();
    item.depth = depth;
    return add(std::move(item));
  }
  void disc(const View::Placed& at, double radius, FrameColour fill, FrameColour edge, double depth) {
    FrameItem item;
    item.kind = FrameItem::Kind::Disc;
    item.points = {at.x, at.y};
    item.radius = radius;
    item.fill = fill;
    item.stroke = edge;
    item.width = 1.4 * view_.unit();
    item.depth = depth;
    add(std::move(item));
  }

  void path(const Drawing::Element& e, const std::vector<double>& points);
  void solid(const SolidShape& shape, const std::vector<double>& pose);
  void ball(const SolidShape& shape, const std::vector<double>& pose, double depth, double tint);
  void trail(const Drawing::Element& e, std::size_t series);
  void force(const Drawing::Element& e, const std::vector<double>& points);
  void label(const Drawing::Element& e, const std::vector<double>& points);
  std::vector<double> outline(const std::vector<double>& pose, const SolidOutline& o, double* near = nullptr) const;
  double shade(const std::vector<double>& pose, const SolidOutline& face, bool& hidden) const;

  const Drawing& drawing_;
  const View& view_;
  double elapsed_;
  const FrameOptions& options_;
  std::vector<double> centre_;
  std::size_t d_, id_ = 0;
  std::vector<FrameItem> items_;
  std::vector<Plane> planes_;
  std::vector<Spot> spots_;
};

// Rods, then what hangs on them: bobs where mass is, joints where it is not.
void Painter::path(const Drawing::Element& e, const std::vector<double>& points) {
  std::vector<View::Placed> at;
  for (std::size_t p = 0; p < e.points; ++p) at.push_back(place(&points[p * d_]));
  if (d_ == 2 && e.points > 1) {
    std::vector<double> line;
    for (const auto& p : at) line.insert(line.end(), {p.x, p.y});
    stroke(std::move(line), {Ink::Ink}, 2.2, 0);
  }
  for (std::size_t p = 0; d_ == 3 && p + 1 < e.points; ++p) {
    const double depth = (at[p].near + at[p + 1].near) / 2;
    stroke({at[p].x, at[p].y, at[p + 1].x, at[p + 1].y}, {Ink::Ink}, 2.2, depth);
    note(&points[p * 3], depth);
    note(&points[p * 3 + 3], depth);
  }
  for (std::size_t p = 0; p < e.points; ++p) {
    if (!(e.radii[p] > 0)) continue;
    const bool bob = e.masses[p] > 0;
    const double radius = std::max((bob ? 3.5 : 2.6) * view_.unit(), view_.scale() * at[p].size * e.radii[p]);
    const double depth = at[p].near + 1e-3 * drawing_.radius;
    if (bob)
      disc(at[p], radius, {Ink::Series, 0}, {Ink::Paper}, depth);
    else
      disc(at[p], radius, {Ink::Paper}, {Ink::Ink}, depth);
  }
}

std::vector<double> Painter::outline(const std::vector<double>& pose, const SolidOutline& o, double* near) const {
  std::vector<double> out;
  double sum = 0, world[3];
  for (std::size_t i = 0; i < o.points.size(); i += d_) {
    drawing::carry(pose, &o.points[i], d_, world);
    const View::Placed p = place(world);
    out.insert(out.end(), {p.x, p.y});
    sum += p.near;
  }
  if (near) *near = sum / std::max<double>(1, static_cast<double>(o.points.size() / d_));
  return out;
}

/// How dark a face of a box is: by its normal against the light, which comes from above and from the eye.
double Painter::shade(const std::vector<double>& pose, const SolidOutline& face, bool& hidden) const {
  double a[3], b[3], c[3], n[3], facing = 0, size = 0;
  drawing::carry(pose, &face.points[0], 3, a);
  drawing::carry(pose, &face.points[3], 3, b);
  drawing::carry(pose, &face.points[6], 3, c);
  const std::vector<double> eye = view_.eye(centre_);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    n[k] = (b[i] - a[i]) * (c[j] - b[j]) - (b[j] - a[j]) * (c[i] - b[i]);
    facing += n[k] * (eye[k] - a[k]);
    size = std::hypot(size, n[k]);
  }
  hidden = facing <= 0;
  return size > 0 ? body_tint + 0.12 - 0.2 * std::max(0.0, n[2] / size) : body_tint;
}

void Painter::solid(const SolidShape& shape, const std::vector<double>& pose) {
  const bool ground = shape.role == SolidShape::Role::Ground;
  const View::Placed origin = place(pose.data());
  double reach = 0;
  for (std::size_t a = 1; a <= d_; ++a) {
    const View::Placed tip = place(&pose[a * d_]);
    reach = std::max(reach, std::hypot(tip.x - origin.x, tip.y - origin.y));
  }
  const bool round = shape.ball || (!shape.faces.empty() && shape.faces[0].points.size() > 4 * d_);
  if (!ground && round && reach < 3 * view_.unit()) {  // a planet in its orbit
    id_ += 1;
    return disc(origin, 3 * view_.unit(), {Ink::Series, 0}, {Ink::Paper}, origin.near);
  }
  const std::size_t begin = items_.size();
  const bool small = round && shape.lines.empty() && reach < 14 * view_.unit();
  if (shape.ball) {
    note(pose.data(), origin.near);
    return ball(shape, pose, origin.near, small ? 1 : body_tint);
  }
  for (const SolidOutline& face : shape.faces) {
    bool hidden = false;
    const double tint = shape.convex ? shade(pose, face, hidden) : small ? 1 : body_tint;
    if (hidden) {
      ++id_;
      continue;
    }
    FrameItem& item =
        stroke(outline(pose, face), small ? FrameColour{Ink::Paper} : FrameColour{ground ? Ink::Muted : Ink::Ink},
               ground ? 1.2 : 1.6, origin.near);
    item.closed = true;
    item.fill = ground ? FrameColour{Ink::Paper} : FrameColour{Ink::Series, 0, tint};
  }
  const bool grid = ground && d_ == 3;
  const bool plain = shape.faces.empty();  // a hoop, a spring
  for (const SolidOutline& line : shape.lines) {
    double near = origin.near;
    std::vector<double> points = outline(pose, line, plain && !grid ? &near : nullptr);
    const FrameColour colour = grid ? FrameColour{Ink::Muted, 0, 0.3} : FrameColour{ground ? Ink::Muted : Ink::Ink};
    stroke(std::move(points), colour, ground ? 1 : plain ? (line.closed ? 2.2 : 1.6) : 1.1, near).closed = line.closed;
  }
  if (d_ == 3 && !ground && !plain && !shape.convex)
    note_plane(pose, begin);
  else if (d_ == 3 && !ground)
    note(pose.data(), origin.near);
}

void Painter::note_plane(const std::vector<double>& pose, std::size_t begin) {
  Plane plane{begin, items_.size(), {}, {}, 0};
  const std::vector<double> eye = view_.eye(centre_);
  double towards = 0, length = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    plane.origin[k] = pose[k];
    plane.normal[k] =
        (pose[3 + i] - pose[i]) * (pose[6 + j] - pose[j]) - (pose[3 + j] - pose[j]) * (pose[6 + i] - pose[i]);
    plane.reach = std::hypot(plane.reach, pose[3 + k] - pose[k]);
    towards += plane.normal[k] * (eye[k] - pose[k]);
    length = std::hypot(length, plane.normal[k]);
  }
  for (double& x : plane.normal) x /= towards < 0 ? -length : length;
  planes_.push_back(plane);
}

/// Between what is on the far side and what is on the side of the eye; below the ways of points that are on this side.
void Painter::order(const Plane& plane) {
  double behind = -HUGE_VAL, before = HUGE_VAL, own = items_[plane.begin].depth;
  bool under_trail = false;
  for (const Spot& spot : spots_) {
    double side = 0;
    for (std::size_t k = 0; k < 3; ++k) side += plane.normal[k] * (spot.place[k] - plane.origin[k]);
    if (std::abs(side) < 0.01 * plane.reach) continue;
    if (spot.trail)
      under_trail = under_trail || side > 0;
    else if (side > 0)
      before = std::min(before, spot.depth);
    else
      behind = std::max(behind, spot.depth);
  }
  const double step = 1e-6 * drawing_.radius;
  own = std::min(std::max(own, behind + step), before - step);
  for (std::size_t i = plane.begin; i < plane.end; ++i) items_[i].depth = under_trail ? -2e299 : own;
}

/// The eye sees the unit ball from e = A⁻¹(eye − origin): it touches it where x·e = 1, a circle about e/|e|², and what
/// has x·e < 1 is behind it.
void Painter::ball(const SolidShape& shape, const std::vector<double>& pose, double depth, double tint) {
  const std::vector<double> eye = view_.eye(centre_);
  std::array<double, 3> a[3], e{};
  double b[3];
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < 3; ++j) a[k][j] = pose[(k + 1) * 3 + j] - pose[j];
    b[k] = eye[k] - pose[k];
  }
  const auto det = [](const auto& x, const auto& y, const auto& z) {
    return x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0]) + x[2] * (y[0] * z[1] - y[1] * z[0]);
  };
  const double volume = det(a[0], a[1], a[2]);
  e = {det(b, a[1], a[2]) / volume, det(a[0], b, a[2]) / volume, det(a[0], a[1], b) / volume};
  const double square = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
  if (!(square > 1)) return;  // from inside there is nothing to see
  const auto sides = drawing::sides_of(e);
  SolidOutline rim;
  const double r = std::sqrt(1 - 1 / square);
  for (std::size_t i = 0; i < contour; ++i) {
    const double angle = 6.283185307179586 * static_cast<double>(i) / contour;
    for (std::size_t k = 0; k < 3; ++k)
      rim.points.push_back(e[k] / square + r * (std::cos(angle) * sides[k] + std::sin(angle) * sides[3 + k]));
  }
  FrameItem& body = stroke(outline(pose, rim), tint == 1 ? FrameColour{Ink::Paper} : FrameColour{Ink::Ink}, 1.6, depth);
  body.closed = true;
  body.fill = {Ink::Series, 0, tint};
  for (const SolidOutline& line : shape.lines) {  // of a great circle half is seen: one piece, begun behind the ball
    const std::size_t n = line.points.size() / 3;
    const auto seen = [&](std::size_t i) {
      const double* x = &line.points[i % n * 3];
      return x[0] * e[0] + x[1] * e[1] + x[2] * e[2] >= 1;
    };
    std::size_t first = 0;
    while (first < n && !(seen(first + 1) && !seen(first))) ++first;
    SolidOutline half;
    for (std::size_t i = first + 1; i <= first + n && seen(i); ++i)
      half.points.insert(half.points.end(), &line.points[i % n * 3], &line.points[i % n * 3] + 3);
    if (half.points.size() < 6)
      ++id_;
    else
      stroke(outline(pose, with_points(half, 25)), {Ink::Ink, 0, 0.6}, 1, depth);
  }
}

/// The whole way as a hint, and what the last seconds left, fading into the past.
void Painter::trail(const Drawing::Element& e, std::size_t series) {
  if (options_.trail == TrailLength::None) return;
  const double duration = drawing::duration_of(drawing_);
  const auto way = [&](double from, double to, int steps) {
    std::vector<double> line;
    for (int i = 0; i <= steps; ++i) {
      const std::vector<double> p = drawing::points_at(drawing_, e, from + (to - from) * i / steps);
      if (!std::all_of(p.begin(), p.end(), [](double x) { return std::isfinite(x); })) continue;
      const View::Placed at = place(p.data());
      line.insert(line.end(), {at.x, at.y});
    }
    return line;
  };
  const bool whole = options_.trail == TrailLength::Whole;
  if (const std::vector<double> now = drawing::points_at(drawing_, e, elapsed_); std::isfinite(now[0]))
    note(now.data(), 0, true);
  const int steps = static_cast<int>(std::clamp<std::size_t>(drawing_.times.size(), 2, 1500));
  if (drawing_.follow.empty())
    stroke(drawing::thinned(way(0, duration, steps), 0.7), {Ink::Series, series, whole ? 0.75 : whole_trail},
           whole ? 1.4 : 1, -1e299);
  if (whole) return;
  const double from = std::max(0.0, elapsed_ - options_.trail_time);
  const int pieces = options_.trail_pieces;
  for (int k = 0; k < pieces; ++k) {
    const double part = (k + 1.0) / pieces;
    const std::vector<double> line =
        way(from + (elapsed_ - from) * k / pieces, from + (elapsed_ - from) * part, std::max(4, 192 / pieces));
    stroke(line, {Ink::Series, series, 0.1 + 0.85 * std::pow(part, 1.5)}, 1.2 + 0.9 * part, -1e298);
  }
}

void Painter::force(const Drawing::Element& e, const std::vector<double>& points) {
  const std::size_t last = e.points - 1;
  const FrameColour colour{Ink::Series, drawing::series_of(e)};
  if (last > 1) {  // an arc, whose last piece has the head
    std::vector<double> way;
    for (std::size_t p = 0; p < last; ++p) {
      const View::Placed at = place(&points[p * d_]);
      way.insert(way.end(), {at.x, at.y});
    }
    stroke(way, colour, 2.2, 0);
  }
  const View::Placed foot = place(&points[(last - 1) * d_]), tip = place(&points[last * d_]);
  for (FrameItem& item : drawing::arrow({foot.x, foot.y}, {tip.x, tip.y}, colour, 2.2, view_.unit()))
    add(std::move(item));
  const double dx = tip.x - foot.x, dy = tip.y - foot.y, length = std::hypot(dx, dy), gap = 14 * view_.unit();
  if (length <= 24 * view_.unit() || e.text.base.empty()) return;
  const char align = dy > 0.3 * length ? 'r' : dy < -0.3 * length ? 'l' : 'c';
  add(drawing::words(e.text, tip.x - gap * dy / length, tip.y + gap * dx / length, align, {Ink::Muted}));
}

void Painter::label(const Drawing::Element& e, const std::vector<double>& points) {
  const View::Placed at = place(points.data());
  const double gap = 14 * view_.unit();
  add(drawing::words(e.text, at.x + 0.8 * gap, at.y - gap, 'l', {Ink::Ink}));
}

}  // namespace

std::vector<FrameItem> frame_items(const Drawing& drawing, const View& view, double elapsed,
                                   const FrameOptions& options) {
  return Painter(drawing, view, elapsed, options).paint();
}

}  // namespace maupertuis
