#pragma once
#include <maupertuis/evaluate.hpp>
#include <maupertuis/mechanical_system.hpp>

/// What is no constraint, or none that can be carried out. Each returns true after its message.
namespace maupertuis::elaboration {

struct Elaboration;

/// Every quantity of the model at a scattered value, the parameters at theirs; other values for another `shift`.
Bindings scattered_state(Elaboration& e, double shift);

/// E0426: a function with a switch stands in it, or in an input that it names.
bool refuse_switch(Elaboration& e, const syntax::ConstraintStatement& s, Expr value);
/// E0423: parameters and time alone.
bool refuse_without_coordinates(Elaboration& e, const Constraint& c);
/// E0424: 0 = 0.
bool refuse_identity(Elaboration& e, const Constraint& c);
/// W0425: the same constraint once more.
void warn_of_repetition(Elaboration& e);

}  // namespace maupertuis::elaboration
