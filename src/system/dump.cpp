#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/print.hpp>

#include <fmt/format.h>

#include <iterator>

/// `maup derive --emit system`.
namespace maupertuis {
namespace {

class Dump {
 public:
  explicit Dump(const MechanicalSystem& system) : system_(system) {
    for (const Parameter& p : system.parameters) order_.parameters.push_back(p.symbol);
    for (const Coordinate& c : system.coordinates) order_.coordinates.push_back(c.q);
  }

  std::string text() {
    line("system {}{}", system_.name.empty() ? "(unnamed)" : system_.name,
         system_.title.empty() ? "" : " \"" + system_.title + "\"");
    line("space {}{}", system_.space_dimension, system_.dimensionless ? ", dimensionless" : "");
    if (system_.independent != "t")
      line("independent {} [{}]", system_.independent, to_string(system_.independent_dimension));
    for (const Coordinate& c : system_.coordinates)
      line("coordinate {} : {} [{}]", c.name, c.kind.empty() ? "unit" : c.kind, to_string(c.dimension));
    for (const Parameter& p : system_.parameters)
      line("{} {} = {} [{}]", p.symbol.role() == Role::Constant ? "constant" : "parameter", p.name, p.si_value,
           to_string(p.dimension));
    for (const Input& i : system_.inputs) line("input {} = {} [{}]", i.name, show(i.formula), to_string(i.dimension));
    for (const Definition& d : system_.definitions) definition(d);
    for (const Frame& f : system_.frames)
      line("frame {} at {} rotation {} ω {}", f.name, show(f.origin), show(f.rotation.entries),
           show(f.angular_velocity));
    for (const Point& p : system_.points)
      line("point {}{} at {}", p.name, p.mass ? " mass " + show(p.mass) : "", show(p.position));
    for (const Body& b : system_.bodies)
      line("body {}{}{} at {} rotation {} ω {}", b.name, b.mass ? " mass " + show(b.mass) : "",
           b.inertia.rows ? " inertia " + show(b.inertia.entries) : "", show(b.position), show(b.rotation.entries),
           show(b.angular_velocity));
    terms("T", system_.kinetic);
    terms("V", system_.potential);
    terms("U", system_.generalized_potential);
    terms("D", system_.dissipation);
    terms("L", system_.lagrangian_extra);
    if (system_.lagrangian_given) line("L = {}", show(system_.lagrangian_given->value));
    for (const EnergyClaim& c : system_.claims)
      line("claim {} = {}", "TVULD"[static_cast<int>(c.which)], show(c.value));
    for (const AppliedForce& f : system_.forces)
      line("force {} on {}{}: {} along {}",
           f.kind == AppliedForce::Kind::OnPoint  ? "at a point"
           : f.kind == AppliedForce::Kind::Torque ? "(torque)"
                                                  : "(generalized)",
           f.target, f.reaction_on.empty() ? "" : " from " + f.reaction_on, show(f.components),
           f.lever.empty() ? f.target : show(f.lever));
    for (const Constraint& c : system_.constraints)
      line("{} constraint {}: {} = 0 [{}], multiplier {}",
           c.level == Constraint::Level::Position ? "position" : "velocity",
           c.body.empty() ? c.name : "norm of " + c.body, show(c.value), to_string(c.dimension), show(c.multiplier));
    for (const IntegralConstraint& c : system_.integral_constraints)
      line("integral constraint {}: ∫ {} d{} = {} [{}]", c.name, show(c.integrand), system_.independent, show(c.value),
           to_string(c.dimension));
    return out_;
  }

 private:
  template <typename... Values>
  void line(fmt::format_string<Values...> pattern, Values&&... values) {
    fmt::format_to(std::back_inserter(out_), pattern, std::forward<Values>(values)...);
    out_ += '\n';
  }
  std::string show(Expr e) { return to_plain(e, order_); }
  std::string show(const ExprVector& v) {
    std::string out = "(";
    for (std::size_t i = 0; i < v.size(); ++i) out += (i ? ", " : "") + show(v[i]);
    return out + ")";
  }
  void definition(const Definition& d) {
    line("definition {} = {} [{}]", d.name, d.is_vector ? show(d.components) : show(d.formula), to_string(d.dimension));
  }
  void terms(const char* name, const std::vector<EnergyTerm>& list) {
    for (const EnergyTerm& t : list) line("{} += {}    from {}", name, show(t.value), t.origin);
  }

  const MechanicalSystem& system_;
  ReadingOrder order_;
  std::string out_;
};

}  // namespace

std::string dump(const MechanicalSystem& system) { return Dump(system).text(); }

}  // namespace maupertuis
