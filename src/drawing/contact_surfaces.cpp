#include "drawing/contact_surfaces.hpp"

#include "drawing/shapes.hpp"
#include "linear_algebra/dense.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/repeated_evaluation.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace maupertuis::drawing {
namespace {

using Place = std::array<double, 2>;

double distance(const Place& a, const Place& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

/// The gap as a function of the place, by the configuration that has it there: G(P(q, t), t) = g(q, t).
class GapField {
 public:
  explicit GapField(const SurfaceRequest& r)
      : system_(r.system),
        n_(r.system.coordinates.size()),
        formulas_(with_slopes(r.system, {r.system.contacts[r.contact.contact].gap, r.contact.places[0].position[0],
                                         r.contact.places[0].position[1]})),
        written_(!r.contact.places[0].slope.empty()),
        values_of_(all(r)),
        parameters_(r.parameters) {
    time_ = system_.context->time();
    for (const Expr& s : symbols_of(formulas_)) moves_ = moves_ || s == time_;
  }

  bool moves() const { return moves_; }
  void put(const double* q, double t) {
    q_.assign(q, q + n_);
    t_ = t;
    look();
  }
  void pass_to(double t) {
    t_ = t;
    look();
  }

  double gap = 0;
  Place at{}, slope{};  // P; ∂G/∂P
  double steepness() const { return std::hypot(slope[0], slope[1]); }
  Place normal() const {
    const Place& n = written_ ? written_slope_ : slope;
    const double size = std::hypot(n[0], n[1]);
    return {n[0] / size, n[1] / size};
  }

  /// Newton's method over the configuration, by its smallest changes.
  bool go_to(const Place& place, double tolerance) {
    for (int round = 0; round < 30; ++round) {
      const double dx = place[0] - at[0], dy = place[1] - at[1];
      if (!std::isfinite(dx + dy)) return false;
      if (std::hypot(dx, dy) <= tolerance) return true;
      step(dx, dy);
    }
    return false;
  }

  /// To gap = 0 along the normal.
  bool fall(double tolerance) {
    for (int round = 0; round < 40; ++round) {
      const double w = steepness();
      if (!(w > 0) || !std::isfinite(gap)) return false;
      if (std::abs(gap) <= tolerance * w) return true;
      const double part = std::min(1.0, limit_ * w / std::abs(gap));
      step(-part * gap * slope[0] / (w * w), -part * gap * slope[1] / (w * w));
    }
    return false;
  }
  void limit_steps(double length) { limit_ = length; }

 private:
  ExprVector all(const SurfaceRequest& r) const {
    ExprVector out = formulas_;
    const ExprVector written = in_terms_of_motion(r.system, r.contact.places[0].slope);
    out.insert(out.end(), written.begin(), written.end());
    return out;
  }
  void look() {
    const std::vector<double> v = values_of_([&](Expr symbol) {
      if (symbol == time_) return t_;
      for (std::size_t i = 0; i < n_; ++i)
        if (system_.coordinates[i].q == symbol) return q_[i];
      const auto found = parameters_.find(symbol);
      return found == parameters_.end() ? 0.0 : found->second;
    });
    gap = v[0];
    at = {v[1], v[2]};
    if (written_) written_slope_ = {v[v.size() - 2], v[v.size() - 1]};
    // J Jᵀ w = J ∇g, and its inverse for steps; of rank one along the line on which the place moves
    double a = 0, b = 0, c = 0, x = 0, y = 0;
    const double *g = &v[3], *jx = &v[3 + n_], *jy = &v[3 + 2 * n_];
    for (std::size_t i = 0; i < n_; ++i)
      a += jx[i] * jx[i], b += jx[i] * jy[i], c += jy[i] * jy[i], x += jx[i] * g[i], y += jy[i] * g[i];
    jx_.assign(jx, jx + n_);
    jy_.assign(jy, jy + n_);
    const double trace = a + c, det = a * c - b * b;
    if (det > 1e-12 * trace * trace)
      inverse_ = {c / det, -b / det, a / det};
    else
      inverse_ = {a / (trace * trace), b / (trace * trace), c / (trace * trace)};
    slope = {inverse_[0] * x + inverse_[1] * y, inverse_[1] * x + inverse_[2] * y};
  }
  void step(double dx, double dy) {
    const double u = inverse_[0] * dx + inverse_[1] * dy, w = inverse_[1] * dx + inverse_[2] * dy;
    for (std::size_t i = 0; i < n_; ++i) q_[i] += u * jx_[i] + w * jy_[i];
    look();
  }

  const MechanicalSystem& system_;
  std::size_t n_;
  ExprVector formulas_;
  bool written_;
  Place written_slope_{};
  RepeatedEvaluation values_of_;
  const Bindings& parameters_;
  Expr time_;
  bool moves_ = false;
  std::vector<double> q_, jx_, jy_;
  std::array<double, 3> inverse_{};
  double t_ = 0, limit_ = HUGE_VAL;
};

struct Vertex {
  Place at, normal;
};

struct Curve {
  std::vector<Vertex> vertices;
  bool closed = false;
};

class Tracer {
 public:
  explicit Tracer(const SurfaceRequest& r) : r_(r), field_(r), tolerance_(1e-9 * r.extent) {
    field_.limit_steps(0.1 * r.extent);
  }

  std::vector<Surface> surfaces() {
    std::vector<Surface> out;
    for (const std::size_t frame : nearest_frames()) {
      field_.put(&r_.states[frame * n()], r_.drawing.times[frame]);
      if (!field_.fall(tolerance_)) continue;
      const Vertex seed{field_.at, field_.normal()};
      if (is_near(out, seed.at)) continue;
      std::optional<Surface> found = r_.contact.freedoms == 1 ? stop(frame, seed) : of_curve(frame, seed, trace(seed));
      if (found) out.push_back(std::move(*found));
      if (field_.moves()) break;
    }
    return out;
  }

 private:
  std::size_t n() const { return r_.system.coordinates.size(); }

  /// Where the gap is smallest, and where it comes to a minimum of its own.
  std::vector<std::size_t> nearest_frames() const {
    const std::vector<double>& gap = r_.contact.gap;
    std::vector<std::size_t> out;
    for (std::size_t f = 0; f < gap.size(); ++f) {
      const bool before = f == 0 || gap[f] <= gap[f - 1], after = f + 1 == gap.size() || gap[f] <= gap[f + 1];
      if (before && after && std::isfinite(gap[f])) out.push_back(f);
    }
    std::stable_sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) { return gap[a] < gap[b]; });
    constexpr std::size_t most = 24;
    if (out.size() > most) out.resize(most);
    return out;
  }

  bool is_near(const std::vector<Surface>& surfaces, const Place& place) const {
    for (const Surface& s : surfaces)
      for (std::size_t i = 0; i + 1 < s.line.size(); i += 2)
        if (distance({s.line[i], s.line[i + 1]}, place) < s.distance + 0.03 * r_.extent) return true;
    return false;
  }

  bool inside(const Place& p, double margin) const {
    for (std::size_t k = 0; k < 2; ++k)
      if (p[k] < r_.low[k] - margin || p[k] > r_.high[k] + margin) return false;
    return true;
  }

  /// Both ways from the seed, by steps that turn little, until it closes or leaves what is seen.
  Curve trace(const Vertex& seed) {
    Curve out;
    std::vector<Vertex> ahead = follow(seed, 1, out.closed);
    if (out.closed) {
      ahead.insert(ahead.begin(), seed);
      out.vertices = std::move(ahead);
      return out;
    }
    bool unused = false;
    field_.go_to(seed.at, tolerance_);
    std::vector<Vertex> back = follow(seed, -1, unused);
    out.vertices.assign(back.rbegin(), back.rend());
    out.vertices.push_back(seed);
    out.vertices.insert(out.vertices.end(), ahead.begin(), ahead.end());
    return out;
  }

  std::vector<Vertex> follow(const Vertex& seed, int way, bool& closed) {
    constexpr std::size_t most = 4000;
    constexpr double most_turn = 0.12;
    const double longest = r_.extent / 100, shortest = longest / 256, margin = 3 * r_.extent;
    std::vector<Vertex> out;
    Vertex now = seed;
    double h = longest, length = 0;
    while (out.size() < most && inside(now.at, margin)) {
      // +1 goes to the right of the normal
      const Place ahead{now.at[0] + way * h * now.normal[1], now.at[1] - way * h * now.normal[0]};
      const bool there = field_.go_to(ahead, 1e-3 * h) && field_.fall(tolerance_);
      const Vertex next{field_.at, there ? field_.normal() : now.normal};
      const double turn = std::hypot(next.normal[0] - now.normal[0], next.normal[1] - now.normal[1]);
      if (!there || turn > most_turn || distance(next.at, now.at) > 1.5 * h) {
        if ((h /= 2) < shortest) break;
        field_.go_to(now.at, tolerance_);
        continue;
      }
      length += distance(next.at, now.at);
      out.push_back(next);
      now = next;
      if (length > 4 * longest && distance(now.at, seed.at) < 0.75 * h) {
        closed = true;
        out.pop_back();
        break;
      }
      h = std::min(longest, 1.5 * h);
    }
    return out;
  }

  static bool is_straight(const Curve& curve) {
    const auto turned = [&](const Vertex& v) {
      return std::hypot(v.normal[0] - curve.vertices[0].normal[0], v.normal[1] - curve.vertices[0].normal[1]) > 1e-7;
    };
    return !curve.closed && std::none_of(curve.vertices.begin(), curve.vertices.end(), turned);
  }

  // ------------------------------------------------------------------------------------------------------- shapes

  /// On the way of a place that moves along a line: a short piece across it.
  std::optional<Surface> stop(std::size_t frame, const Vertex& seed) {
    Surface out;
    out.straight = out.stop = true;
    out.distance = r_.reach(seed.normal[0], seed.normal[1]);
    const double along = std::max(r_.reach(seed.normal[1], -seed.normal[0]), r_.reach(-seed.normal[1], seed.normal[0]));
    const double half = std::max(0.1 * r_.extent, 1.5 * along);
    out.shape = shapes::ground_line(half, r_.spacing);
    out.still = !field_.moves();
    for (std::size_t f = 0; f < (out.still ? 1 : frames()); ++f) {
      if (!out.still && !follow_in_time(f, frame)) return std::nullopt;
      add_pose(out, {field_.at, field_.normal()});
    }
    for (const int side : {-1, 0, 1})
      out.line.insert(out.line.end(), {out.positions[0] + side * half * (out.positions[2] - out.positions[0]),
                                       out.positions[1] + side * half * (out.positions[3] - out.positions[1])});
    return out;
  }

  std::size_t frames() const { return r_.drawing.times.size(); }

  /// The configuration that was on the surface at another time, brought onto it again.
  bool follow_in_time(std::size_t f, std::size_t seed) {
    if (f == 0) field_.put(&r_.states[seed * n()], r_.drawing.times[0]);
    field_.pass_to(r_.drawing.times[f]);
    return field_.fall(tolerance_);
  }

  void add_pose(Surface& out, const Vertex& v) const {
    const double x = v.at[0] - out.distance * v.normal[0], y = v.at[1] - out.distance * v.normal[1];
    out.positions.insert(out.positions.end(),
                         {x, y, x + v.normal[1], y - v.normal[0], x + v.normal[0], y + v.normal[1]});
  }

  std::optional<Surface> of_curve(std::size_t frame, const Vertex& seed, const Curve& curve) {
    if (curve.vertices.size() < 3) return std::nullopt;
    Surface out;
    out.distance = r_.reach(seed.normal[0], seed.normal[1]);
    out.straight = is_straight(curve);
    out.closed = curve.closed;
    for (const Vertex& v : curve.vertices)
      out.line.insert(out.line.end(), {v.at[0] - out.distance * v.normal[0], v.at[1] - out.distance * v.normal[1]});
    const bool placed = out.straight ? place_line(out, frame, seed) : place_curve(out, curve);
    return placed ? std::optional(out) : std::nullopt;
  }

  /// Along a line what carries it may move too: a belt.
  std::vector<double> ways_along() const {
    const std::vector<double>& speed = r_.contact.surface_speed;
    std::vector<double> way(frames(), 0);
    for (std::size_t f = 1; f < way.size() && !speed.empty(); ++f)
      way[f] = way[f - 1] + 0.5 * (speed[f] + speed[f - 1]) * (r_.drawing.times[f] - r_.drawing.times[f - 1]);
    return way;
  }

  bool place_line(Surface& out, std::size_t frame, const Vertex& seed) {
    const Place middle{(r_.low[0] + r_.high[0]) / 2, (r_.low[1] + r_.high[1]) / 2};
    const std::vector<double> way = ways_along();
    const auto [least, most] = std::minmax_element(way.begin(), way.end());
    const double longest = std::max(std::abs(*least), std::abs(*most));
    const bool belt = longest > 1e-6 * r_.extent && longest < 30 * r_.extent;
    const double half = std::hypot(r_.high[0] - r_.low[0], r_.high[1] - r_.low[1]) / 2 + 2 * r_.extent;
    out.shape = shapes::ground_line(half + (belt ? longest : 0), r_.spacing);
    out.still = !field_.moves() && !belt;
    field_.go_to(seed.at, tolerance_);
    for (std::size_t f = 0; f < (out.still ? 1 : frames()); ++f) {
      if (field_.moves() && !follow_in_time(f, frame)) return false;
      Vertex foot{field_.at, field_.normal()};
      const double along =
          (middle[0] - foot.at[0]) * foot.normal[1] - (middle[1] - foot.at[1]) * foot.normal[0] + (belt ? way[f] : 0);
      foot.at[0] += along * foot.normal[1];
      foot.at[1] -= along * foot.normal[0];
      add_pose(out, foot);
    }
    return true;
  }

  /// A curve that moves without turning; by the normal distances of some of its points.
  bool place_curve(Surface& out, const Curve& curve) {
    out.shape.role = SolidShape::Role::Ground;
    out.shape.lines.push_back({out.line, out.closed});
    hatch(out, curve);
    out.positions = {0, 0, 1, 0, 0, 1};
    out.still = !field_.moves();
    if (out.still) return true;
    constexpr std::size_t points = 8;
    Place moved{0, 0};
    out.positions.clear();
    for (std::size_t f = 0; f < frames(); ++f) {
      field_.pass_to(r_.drawing.times[f]);
      double worst = HUGE_VAL;
      for (int round = 0; round < 6 && worst > 1e-6 * r_.extent; ++round) {
        Eigen::MatrixXd normals(points, 2);
        Eigen::VectorXd off(points);
        worst = 0;
        for (std::size_t k = 0; k < points; ++k) {
          const Place& p = curve.vertices[k * (curve.vertices.size() - 1) / (points - 1)].at;
          if (!field_.go_to({p[0] + moved[0], p[1] + moved[1]}, tolerance_)) return false;
          const auto row = static_cast<Eigen::Index>(k);
          normals(row, 0) = field_.normal()[0], normals(row, 1) = field_.normal()[1];
          off(row) = -field_.gap / field_.steepness();
          worst = std::max(worst, std::abs(off(row)));
        }
        const Eigen::VectorXd more = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(normals).solve(off);
        moved[0] += more(0), moved[1] += more(1);
      }
      if (!(worst <= 1e-4 * r_.extent)) return false;
      out.positions.insert(out.positions.end(), {moved[0], moved[1], moved[0] + 1, moved[1], moved[0], moved[1] + 1});
    }
    return true;
  }

  /// Strokes behind the line, leaning back, at equal distances along it.
  void hatch(Surface& out, const Curve& curve) const {
    double length = 0;
    const std::size_t count = curve.vertices.size(), pieces = count - (curve.closed ? 0 : 1);
    const auto at = [&](std::size_t i) { return Place{out.line[2 * (i % count)], out.line[2 * (i % count) + 1]}; };
    for (std::size_t i = 0; i < pieces; ++i) length += distance(at(i), at(i + 1));
    constexpr double most = 1500;
    const double spacing = std::max(length / std::max(1.0, std::round(length / r_.spacing)), length / most);
    const double depth = 0.7 * spacing;
    double next = spacing, passed = 0;
    for (std::size_t i = 0; i < pieces; ++i) {
      const double piece = distance(at(i), at(i + 1));
      for (; piece > 0 && next <= passed + piece * (1 + 1e-12); next += spacing) {
        const double u = (next - passed) / piece;
        const Place &a = at(i), &b = at(i + 1);
        const Place &m = curve.vertices[i].normal, &n = curve.vertices[(i + 1) % count].normal;
        const double nx = m[0] + u * (n[0] - m[0]), ny = m[1] + u * (n[1] - m[1]);
        const double x = a[0] + u * (b[0] - a[0]), y = a[1] + u * (b[1] - a[1]);
        out.shape.lines.push_back({{x, y, x - depth * (nx + ny), y - depth * (ny - nx)}, false});
      }
      passed += piece;
    }
  }

  const SurfaceRequest& r_;
  GapField field_;
  double tolerance_;
};

}  // namespace

std::vector<Surface> surfaces_of(const SurfaceRequest& request) { return Tracer(request).surfaces(); }

}  // namespace maupertuis::drawing
