#pragma once
#include <maupertuis/drawing.hpp>

/// A drawing at any time between its frames.
namespace maupertuis::drawing {

double duration_of(const Drawing& drawing);

/// `width` numbers a frame at an elapsed time: cubics through the frames (Catmull and Rom's, on uneven times), exact at
/// each; the nearer frame in a drawing of moments only.
std::vector<double> track_at(const Drawing& drawing, const std::vector<double>& track, std::size_t width,
                             double elapsed);

/// The positions of one element.
std::vector<double> points_at(const Drawing& drawing, const Drawing::Element& element, double elapsed);

/// Places that a solid reaches to, from its origin and tips: what a picture must hold.
std::vector<double> reach_of(const SolidShape& shape, const std::vector<double>& pose);

/// A local place of a solid in the world.
void carry(const std::vector<double>& pose, const double* local, std::size_t dimension, double* world);

}  // namespace maupertuis::drawing
