#pragma once
#include <maupertuis/fields.hpp>

/// Fields with coordinates and bodies: docs/theory/fields.md.
namespace maupertuis {

/// Derives the equations of the coordinates and bodies beside the fields, and what holds where they meet: fills
/// `bodies`, `body_start` and `interfaces`. The system of the model has the values at places among its coordinates.
void attach_bodies(FieldEquations& equations, std::shared_ptr<const Model> model, Diagnostics& diagnostics);

/// A place where the density, the dissipation or a force density goes over from one formula to another.
struct DensityBorder {
  Expr place;          // SI, parameters and numbers only
  double at = 0;       // its value
  Expr switching;      // changes its sign there
  bool rising = true;  // with x
};
/// In ascending order, without the ends; of one space variable.
std::vector<DensityBorder> density_borders(const FieldEquations& equations);
/// Along one space variable of several: the lines across it.
std::vector<DensityBorder> density_borders_along(const FieldEquations& equations, std::size_t direction);

/// The place as it stands in names: l of u(l).
std::string place_text(const FieldEquations& equations, Expr place);

/// A jet of a field at a place, as it is named in interface conditions. `side`: 0, or the limit from the left (−1) or
/// right (+1) where the jet may jump.
Expr jet_at_place(const FieldEquations& equations, const FieldJet& jet, Expr place, int side);

/// The rows of the coordinates that are no values at places, with the coordinate's index in `bodies`: R − Aᵀλ, and of
/// those that move places the jump of the stress there.
struct CoordinateRow {
  std::size_t coordinate = 0;
  Expr value;
};
std::vector<CoordinateRow> coordinate_rows(const FieldEquations& equations);

/// Whether `difference` = 0 is a condition at a place or a row of a coordinate up to a factor of parameters. Nothing
/// where neither coordinates nor values at places stand in it.
std::optional<bool> row_of_bodies(const FieldEquations& equations, Expr difference);

/// Adds to the certificate: that of the bodies, and that interface rows and B leave nothing of the variation.
void certify_bodies(const FieldEquations& equations, Certificate& certificate);

/// Symbols of parameters first, then coordinates, places and jets: of rows that bodies and fields share.
ReadingOrder coupled_order(const FieldEquations& equations);
/// A row = 0 in readable form, perhaps with the other sign.
ReadableForm readable_row(const FieldEquations& equations, Expr row, Expr own);
/// Places typeset as subscripts: u_x(l).
Layout coupled_layout(const FieldEquations& equations, Layout layout);

}  // namespace maupertuis
