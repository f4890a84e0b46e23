#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/plot.hpp>
#include <maupertuis/trajectory.hpp>

#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

/// What a solid looks like in its own axes, whose tips are where 1 stands. Local coordinates, [n × dimension] each.
struct SolidShape {
  enum class Role { Body, Ground };
  struct Outline {
    std::vector<double> points;
    bool closed = true;
  };
  std::vector<Outline> faces;  // filled and outlined
  std::vector<Outline> lines;
  Role role = Role::Body;
  bool convex = false;  // in space: faces turn counter-clockwise seen from outside, and are hidden from behind
  bool ball = false;    // in space: the unit ball, outlined where the view touches it; its lines are hidden behind it
};

/// The drawing of a model as geometry: where every element is at the times of the frames. World axes, metres. What is
/// decided here (springs, hoops, ellipsoids of inertia, pivots, the ground, the size of bobs) is decided once, for
/// pages and for frames alike; what is left is the camera.
struct Drawing {
  enum class Kind { Path, Trail, Solid, Arrow, Label };
  /// Whether an arrow is of the model's own drawing (reactions, contacts), and what acts otherwise.
  enum class ForceOrigin { Asked, Reaction, Weight, Spring, Damper, Applied, Potential, Torque };
  struct Element {
    Kind kind = Kind::Path;
    std::size_t points = 1;  // of a frame; Solid: dimension + 1, its origin and the tips of its axes; Arrow: from its
                             // foot to its tip, an arc about its place for a torque
    std::vector<double> positions =
        {};  // [frames × points × dimension], or [points × dimension] where still; NaN: no value
    bool still = false;
    std::vector<double> masses = {};  // [points] Path: kg, 0 for a point without mass
    std::vector<double> radii =
        {};  // [points] Path: m, of the bob where there is mass, of the joint where there is none; 0: no mark
    std::vector<std::string> names = {};  // [points] Path, Trail: "" where the text has an expression; Arrow: what acts
    NameParts text = {};                  // Label, Arrow
    SolidShape shape = {};                // Solid
    bool impulse = false;                 // Arrow: of an impact, not of a force
    ForceOrigin origin = ForceOrigin::Asked;  // Arrow
  };
  int dimension = 2;              // 2 or 3
  std::vector<double> times;      // [frames] s, ascending or descending
  std::vector<Element> elements;  // the first is drawn first, in the plane
  std::vector<double> gravity;    // [dimension] its direction; empty without gravity
  bool dimensionless = false;     // no metres, no seconds
  bool moments_only = false;   // the motion swings faster than the frames follow: between two, the nearer one is shown
  std::vector<double> follow;  // [frames × dimension] what the camera goes along with; empty: it rests
  double metres_a_newton = 0;  // of arrows of forces; 0: there are none
  double largest_torque = 0;   // N m, of which the arc is three quarters of a turn; 0: there is none
  std::vector<std::string> unplaced_forces;  // of all forces: those that no arrow stands for, "V on s", "U"
  std::vector<double> low, high;             // [dimension] all that ever appears, seen from what is followed
  double radius = 1;                         // of the ball about the middle that holds it

  bool empty() const { return elements.empty() || times.empty(); }
};

/// What an impact gave to a contact, to be seen as an arrow for a moment.
struct ContactImpulse {
  std::size_t contact = 0;  // of the system
  double t = 0;             // s
  double size = 0;          // Λ
};

/// Which arrows of forces a drawing has: those that the model asks for, or those of all forces as well, weights,
/// springs, dampers, applied forces, torques and reactions of constraints. Forces of V, of D, of torsion springs and of
/// `force q = …` act on coordinates: each is shown at what its coordinate moves, as the force or the torque there that
/// does the same work; where no single one does, it is named in `unplaced_forces`.
enum class ForcesShown { Asked, All };

/// The drawing of a model at the rows of a run, at most `frames` of them. Where the model has no `draw`, it shows what
/// the model has: bobs where mass is, rods where a distance is kept, bodies as the ellipsoids of their inertia,
/// springs, dampers. Nothing where there is neither a point nor a body. With the equations the forces of `draw reaction
/// rod` too: arrows on the points, the longest a third of the scene. In the plane contacts show their surfaces, where
/// no item shows them, with the equations their forces, and impulses as arrows that shrink from the instant on.
std::optional<Drawing> evaluate_drawing(const Model& model, const Trajectory& trajectory, std::size_t frames = 6000,
                                        const EquationsOfMotion* equations = nullptr,
                                        const std::vector<ContactImpulse>& impulses = {},
                                        ForcesShown forces = ForcesShown::Asked);

/// Whether frames at these moments, in s after the first row, ascending, show how a motion swings: about five of them
/// fall on each swing, at least. Each moment is taken for that of the row nearest to it.
bool frames_follow(const Model& model, const Trajectory& trajectory, const std::vector<double>& elapsed);

/// As JSON, for the page that draws it.
std::string drawing_json(const Drawing& drawing);

// ------------------------------------------------------------------------------------------------------------ frames

/// From where a drawing in space is seen. In the plane nothing of it matters.
struct Camera {
  double azimuth = -0.9, elevation = 0.32;  // rad, of the eye seen from the middle
  bool fitted = true;                       // as near as the whole motion allows; else as near as every view allows
};

enum class TrailLength { None, Fading, Whole };

struct FrameOptions {
  double width = 720, height = 480;    // px
  PlotTheme theme = PlotTheme::Light;  // Light or Dark
  Camera camera;
  TrailLength trail = TrailLength::Fading;
  double trail_time = 3;  // s, over which a trail fades
  int trail_pieces = 24;  // of which a fading trail is made
  bool furniture = true;  // scale bar, direction of gravity, axes of space
  std::string caption;    // at the top left; empty: none
};

/// Px of the world in the picture: fixed for a drawing and a size, so that frames fit each other.
class View {
 public:
  View(const Drawing& drawing, const FrameOptions& options);

  /// Where a place of the world stands, and how much larger near things are.
  struct Placed {
    double x = 0, y = 0, size = 1, near = 0;
  };
  /// `centre`: what the camera looks at, see centre_at.
  Placed project(const double* place, const std::vector<double>& centre) const;
  std::vector<double> centre_at(double elapsed) const;
  std::vector<double> eye(const std::vector<double>& centre) const;  // [3] in the world
  double scale() const { return scale_; }                            // px of a metre, at the middle
  double unit() const { return unit_; }                              // px of a line of weight 1

 private:
  void fit_plane(const FrameOptions& options);
  void fit_space(const FrameOptions& options);

  const Drawing& drawing_;
  double unit_ = 1, scale_ = 1, across_ = 0, down_ = 0;  // the middle in px
  double right_[3] = {1, 0, 0}, up_[3] = {0, 1, 0}, toward_[3] = {0, 0, 1};
  std::vector<double> middle_;
};

/// One of the inks; `strength` is how far a fill goes from the paper to it, and how opaque a stroke is.
struct FrameColour {
  enum class Ink { None, Paper, Ink, Muted, Series } ink = Ink::None;
  std::size_t series = 0;  // 0 … 6
  double strength = 1;
};

/// One stroke, filled outline, disc or word of a frame, in px. The first is painted first.
struct FrameItem {
  enum class Kind { Outline, Disc, Text } kind = Kind::Outline;
  std::vector<double> points = {};  // [n × 2]; Disc, Text: one
  bool closed = false;
  double radius = 0;  // Disc
  FrameColour fill = {}, stroke = {};
  double width = 0;     // of the stroke
  NameParts text = {};  // Text
  char align = 'c';     // l, c, r
  double depth = 0;     // nearer things have a larger one
  std::size_t id = 0;   // the same thing has the same number in every frame
};

/// Everything of the model at `elapsed` seconds from the first frame; between frames by cubics.
std::vector<FrameItem> frame_items(const Drawing& drawing, const View& view, double elapsed,
                                   const FrameOptions& options);

/// The same with its furniture, as one picture.
std::string frame_svg(const Drawing& drawing, double elapsed, const FrameOptions& options);

/// A picture that moves in browsers (SMIL): frames at these elapsed times, shown after these seconds of watching.
struct Playback {
  std::vector<double> elapsed;  // [frames]
  double seconds = 0;           // of the whole
  bool loop = true;
};
std::string animated_svg(const Drawing& drawing, const Playback& playback, const FrameOptions& options);

/// A height that suits the drawing at this width.
double fitting_height(const Drawing& drawing, double width);

}  // namespace maupertuis
