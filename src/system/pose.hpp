#pragma once
#include <maupertuis/mechanical_system.hpp>

#include <memory>

namespace maupertuis::elaboration {

/// Where a frame is and how it is turned, with its angular velocity, composed turn by turn from the world.
///
///     R = R₁(n₁, α₁) R₂(n₂, α₂) …      each turn about an axis of the frame that the turns before it have made
///
/// ω in the axes of the frame follows the same way, ω ← Rᵢᵀ ω + α̇ᵢ nᵢ, so that no matrix is differentiated.
struct Pose {
  ExprVector origin;       // world axes [dimension]
  ExprMatrix rotation;     // frame → world [dimension × dimension]
  ExprVector omega;        // frame axes [3], [1] in 2-D
  ExprVector omega_world;  // world axes [3], [1] in 2-D
  Expr angle;              // 2-D: the sum of the turns; 3-D: of the last turn, if about a coordinate axis
  int order = -1;          // 0: a coordinate stands in it; -1: it rests, or moves with time alone
  int last_axis = -1;      // 3-D: 0, 1, 2 of the last turn; -1: none or another axis
  std::shared_ptr<const Pose> before_last;
};

Pose world_pose(Context& context, int dimension);

/// Turns by `angle` counter-clockwise.  Precondition: 2-D.
Pose turned(const Pose& pose, Expr angle);
/// Turns about a coordinate axis of the frame (0, 1, 2). Successive turns about one axis add their angles.
Pose turned_about(const Pose& pose, int axis, Expr angle);
/// Turns by the quaternion (w, x, y, z) of norm 1, whose components may move. The matrix and the rates are polynomials
/// of degree 2 in them, not divided by the norm: off the norm they are |q|² times a rotation and its rates.
Pose turned_by(const Pose& pose, const ExprVector& quaternion);
/// Turns about a unit vector given in the axes of the frame, which may move.
Pose turned_about(const Pose& pose, const ExprVector& axis, Expr angle);

ExprVector rotate(const ExprMatrix& rotation, const ExprVector& components);
/// Rᵀ v
ExprVector rotate_back(const ExprMatrix& rotation, const ExprVector& vector);
ExprMatrix matrix_product(const ExprMatrix& a, const ExprMatrix& b);
ExprVector vector_sum(const ExprVector& a, const ExprVector& b);
ExprVector scaled(Expr s, const ExprVector& v);
Expr dot_of(const ExprVector& a, const ExprVector& b);
/// v·v, where sines and cosines of it add up to one product as that product: r² for r (sin θ, −cos θ). Sums stay as
/// they are, since other forms of them lose digits where v is short.
Expr square_of(const ExprVector& v);
ExprVector cross_of(const ExprVector& a, const ExprVector& b);  // [3]

}  // namespace maupertuis::elaboration
