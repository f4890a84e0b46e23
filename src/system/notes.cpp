#include "system/elaboration.hpp"

namespace maupertuis::elaboration {
namespace {

using NotePlace = Note::Place;

/// What a statement is about; nothing for those that say nothing of where a reader is.
struct PlaceOfStatement {
  using Place = std::optional<NotePlace>;
  Place operator()(const syntax::CoordStatement&) const { return NotePlace::Coordinates; }
  Place operator()(const syntax::IndependentStatement&) const { return NotePlace::Coordinates; }
  Place operator()(const syntax::RatesStatement&) const { return NotePlace::Coordinates; }
  Place operator()(const syntax::FieldStatement&) const { return NotePlace::Lagrangian; }
  Place operator()(const syntax::FrameStatement&) const { return NotePlace::Positions; }
  Place operator()(const syntax::PointStatement&) const { return NotePlace::Positions; }
  Place operator()(const syntax::BodyStatement&) const { return NotePlace::Positions; }
  Place operator()(const syntax::GravityStatement&) const { return NotePlace::PotentialEnergy; }
  Place operator()(const syntax::SpringStatement&) const { return NotePlace::PotentialEnergy; }
  Place operator()(const syntax::TorsionSpringStatement&) const { return NotePlace::PotentialEnergy; }
  Place operator()(const syntax::DamperStatement&) const { return NotePlace::Forces; }
  Place operator()(const syntax::ForceStatement&) const { return NotePlace::Forces; }
  Place operator()(const syntax::ConstraintStatement&) const { return NotePlace::Constraints; }
  Place operator()(const syntax::ContactStatement&) const { return NotePlace::Constraints; }
  Place operator()(const syntax::FrictionStatement&) const { return NotePlace::Forces; }
  Place operator()(const syntax::StartStatement&) const { return NotePlace::End; }
  Place operator()(const syntax::RunStatement&) const { return NotePlace::End; }
  Place operator()(const syntax::DrawStatement&) const { return NotePlace::End; }
  Place operator()(const syntax::ExpectStatement&) const { return NotePlace::End; }
  Place operator()(const syntax::EnergyStatement& s) const {
    using Which = syntax::EnergyStatement::Which;
    switch (s.which) {
      case Which::T:
        return NotePlace::KineticEnergy;
      case Which::V:
      case Which::U:
        return NotePlace::PotentialEnergy;
      case Which::L:
        return NotePlace::Lagrangian;
      case Which::D:
        return NotePlace::Forces;
    }
    return std::nullopt;
  }
  template <class Other>
  Place operator()(const Other&) const {
    return std::nullopt;
  }
};

}  // namespace

void elaborate_notes(Elaboration& e) {
  NotePlace place = NotePlace::Beginning;
  for (const syntax::Statement& s : e.tree.statements) {
    if (const auto* note = std::get_if<syntax::NoteStatement>(&s.body))
      e.model.notes.push_back({place, note->text, s.span});
    else if (const auto next = std::visit(PlaceOfStatement{}, s.body))
      place = *next;
  }
}

}  // namespace maupertuis::elaboration
