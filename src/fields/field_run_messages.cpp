#include "fields/field_run_messages.hpp"

#include "fields/resolution.hpp"

#include <fmt/format.h>

#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

namespace maupertuis {

void refuse_mesh(const FieldMotion& mesh, const FieldEquations& equations, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  const std::string& what = mesh.trouble();
  if (what == "slope") {
    Span span = s.density_span;
    for (const BoundaryCondition& b : s.boundary)
      if (b.jet.order() == 1) span = b.span;
    std::string natural;
    for (const NaturalCondition& n : equations.natural)
      natural += (natural.empty() ? "" : ", ") +
                 to_plain(field_layout(s, lay_out(readable(n.value, equations.order), equations.order))) + " = 0";
    diagnostics.error(
        "E0292", span, "this condition clashes with the natural one",
        fmt::format("What the variation leaves at a free end is {}; a given slope does not say what it is.", natural),
        "Give the field itself, or leave the end natural.");
  } else if (what == "mass") {
    diagnostics.error("E0642", s.density_span, "the motion of the field is not determined",
                      "The equations do not hold enough derivatives by t to go on from a start.",
                      "`maup derive` shows them.");
  } else if (what == "moment") {
    diagnostics.error("E0508", s.end_forces.empty() ? s.density_span : s.end_forces.front().span,
                      "not supported yet: a moment on a field without curvature",
                      "A moment acts on the slope, which has no part in the energy of this field at its end.",
                      "Give a force on the field itself, or a density with its second derivative.");
  } else if (what == "ends") {
    diagnostics.error("E0642", s.boundary.empty() ? s.density_span : s.boundary.front().span,
                      "the conditions at the ends do not determine the motion",
                      "The part of the density that is linear in the velocities leaves a shape of the field without an "
                      "equation of motion of its own: a free end asks for more than the start can give.",
                      "Hold the field at both ends and take elements of an odd order, or make the domain periodic.");
  } else if (what == "shapes") {
    diagnostics.error("E0508", s.density_span,
                      "not supported yet: a run of a field of first order in time whose energy holds no curvature",
                      "Shapes that the part linear in the velocities leaves out stand within each element, and nothing "
                      "in the energy holds them.",
                      "Add a term with the second derivative, as KdV's 1/2 w_xx^2, with a small factor.");
  } else if (what == "stuck") {
    diagnostics.error(
        "E0643", s.density_span, "no step leads on from here",
        fmt::format("At t = {:.6g} s the equations of a step have no solution near, nor those of its 4096th part.",
                    mesh.time()),
        "The field grows beyond all bounds, or comes to where its equations are singular.");
  } else if (what == "start") {
    diagnostics.error("E0645", equations.model->start.empty() ? s.density_span : equations.model->start.front().span,
                      "the start of a field is not a finite number somewhere in its domain",
                      "A run can only begin from definite values at all places.",
                      "Look for a logarithm or a root of a negative number in it, or a division by zero.");
  } else if (what == "overflow") {
    diagnostics.error("E0643", s.density_span, "the field grew beyond all numbers",
                      fmt::format("At t = {:.6g} s a value of the field is no number any more.", mesh.time()),
                      "The start, or an unstable density, lets it grow.");
  } else {
    diagnostics.error("E0508", s.density_span, fmt::format("not supported yet: a run of a density with `{}`", what),
                      "Its Taylor series over a mesh has no rule yet.",
                      "Write it with sums, products, powers, exp, log, sin, cos, sinh, cosh or tanh.");
  }
}

void refuse_infinite_density(const FieldEquations& equations, Diagnostics& diagnostics) {
  diagnostics.error("E0645", equations.system().density_span,
                    "the density has no finite value at the start somewhere in its domain",
                    "A coefficient is infinite or undefined there, or the start is where the density is.",
                    "Look for a division by zero, or a logarithm or a root of a negative number.");
}

namespace {

const char* side_name(BoundaryCondition::Side side, const FieldSystem& s) {
  constexpr const char* names[] = {"left", "right", "bottom", "top"};
  constexpr const char* ends[] = {"left end", "right end", "bottom", "top"};
  return (s.space.size() == 1 ? ends : names)[static_cast<int>(side)];
}

std::string jet_name(const FieldMotion::StartClash& c, const FieldEquations& equations) {
  std::vector<int> space(equations.system().space.size(), 0);
  space[c.side == BoundaryCondition::Side::Bottom || c.side == BoundaryCondition::Side::Top ? 1 : 0] = c.space;
  return equations.system().jet_name({equations.varied[c.field], std::move(space), c.time});
}

/// Where the start of a field, or of its rates, is written; else the density.
Span span_of_start(const FieldEquations& equations, std::size_t varied, int order) {
  for (const FieldStart& start : equations.model->start)
    if (start.field == equations.varied[varied] && start.order == order) return start.span;
  return equations.system().density_span;
}

/// Two numbers that differ, also where they do so in late digits.
std::string both_numbers(double value, double other) {
  const std::string one = fmt::format("{:.6g}", value), two = fmt::format("{:.6g}", other);
  return one != two ? one + " beside " + two : fmt::format("{}, off by {:.2g}", two, value - other);
}

}  // namespace

void warn_of_clashes(const std::vector<FieldMotion::StartClash>& clashes, const FieldEquations& equations,
                     Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  for (const FieldMotion::StartClash& c : clashes) {
    const std::string name = jet_name(c, equations);
    diagnostics.warning(
        "W0646", span_of_start(equations, c.field, c.time),
        fmt::format("the start does not fit the condition at the {}: {} = {} (SI units)", side_name(c.side, s), name,
                    both_numbers(c.start, c.condition)),
        fmt::format("The condition is followed, so that a jump of {} runs into the field, which no mesh "
                    "resolves.",
                    name),
        fmt::format("Give a start whose {} is that of the condition there.", name));
  }
}

void tell_moved_starts(const std::vector<SemiDiscrete::MovedStart>& moved, const FieldEquations& equations,
                       Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  for (const SemiDiscrete::MovedStart& m : moved) {
    const std::string &field = s.fields[equations.varied[m.varied]].name, &x = s.space.front().name;
    diagnostics.note(
        "N0662", span_of_start(equations, m.varied, m.order),
        fmt::format("{}, which has no inertia, does not begin as written: {}{} = {} at {} = {:.6g} (SI units)", field,
                    field, m.order == 1 ? "'" : "", both_numbers(m.found, m.written), x, m.x),
        "It is at rest at every moment, in the shape that the places of the masses give it; these start as written.",
        "Give the masses their start by it; what it says between them does not count.");
  }
}

bool warn_of_short_action(const FieldEquations& equations, const std::vector<double>& switching, double step,
                          const FieldRunOptions& options, Diagnostics& diagnostics) {
  const auto moment = unresolved_moment(equations, switching, step, {options.begin, options.duration});
  if (!moment) return false;
  diagnostics.warning(
      "W0650", equations.system().density_span,
      fmt::format("what acts changes within less than a step at t = {:.6g} s", *moment),
      fmt::format(
          "Steps are {:.3g} s long: a pulse between their ends is passed by, a jump is taken for something else, "
          "and no error can be estimated.",
          step),
      "Make steps shorter with `output every`, or the change slower.");
  return true;
}

void tell_what_is_fixed(const FieldMotion& mesh, const FieldEquations& equations, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  for (const std::size_t a : mesh.fixed_fields()) {
    const std::string& name = s.fields[equations.varied[a]].name;
    diagnostics.note("N0648", s.fields[equations.varied[a]].span,
                     fmt::format("a constant in {} is not determined by the density", name),
                     fmt::format("It holds derivatives of {0} alone, so that {0} plus any function of t is the same "
                                 "motion. The run keeps {0} as it starts at the left end.",
                                 name),
                     fmt::format("Ask for {}_{}, or for what is made of it.", name, s.space.front().name));
  }
}

namespace {

/// The memory of this machine in bytes; 0 where it does not say.
double memory_of_machine() {
#if defined(_SC_PHYS_PAGES) && defined(_SC_PAGESIZE)
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
#else
  return 0;
#endif
}

}  // namespace

bool refuse_large_mesh(const FieldEquations& equations, const FieldMethod& method, const Cells& cells,
                       Diagnostics& diagnostics) {
  const double bytes = method.bytes(equations, cells), memory = memory_of_machine();
  if (!(memory > 0) || bytes < 0.8 * memory) return false;
  std::string numbers;
  for (const int n : cells) numbers += (numbers.empty() ? "" : " × ") + std::to_string(n);
  diagnostics.error(
      "E0649", equations.system().space.front().span,
      fmt::format("{} cells of order {} do not fit into the memory of this machine", numbers, method.order()),
      fmt::format("{} would take {:.3g} GB; there are {:.3g} GB.",
                  needs_collocation(equations) ? "The matrices of its steps" : "Its Taylor series", bytes / 1e9,
                  memory / 1e9),
      "Write fewer cells, or a lower order of the elements.");
  return true;
}

bool refuse_too_many_rows(const FieldEquations& equations, const FieldRunOptions& options,
                          const std::vector<std::vector<double>>& rows, Diagnostics& diagnostics) {
  constexpr double most_rows = 20'000'000, most_values = 10 * most_rows;  // as of coordinates
  if (!(options.every > 0)) return false;
  double values = rows.empty() ? 0 : 2 * static_cast<double>(equations.varied.size());  // with velocities
  for (const std::vector<double>& places : rows) values *= static_cast<double>(places.size());
  const double count = std::abs(options.duration) / options.every;
  if (count <= most_rows && count * values <= most_values) return false;
  diagnostics.error("E0705", std::nullopt,
                    fmt::format("this run would write {:.3g} rows", count) +
                        (values > 0 ? fmt::format(" of {:.0f} values", values) : ""),
                    "The whole trajectory is kept in memory until it is written.",
                    "Choose a longer `output every`, or a shorter run.");
  return true;
}

void announce_memory(const FieldRunOptions& options, double bytes) {
  constexpr double gigabyte = 1e9;
  if (options.announce && bytes >= gigabyte)
    options.announce(fmt::format("The mesh of this run takes {:.2g} GB of memory.", bytes / gigabyte));
}

}  // namespace maupertuis
