#pragma once
#include <maupertuis/action.hpp>
#include <maupertuis/diagram.hpp>
#include <maupertuis/drawing.hpp>
#include <maupertuis/invariants.hpp>
#include <maupertuis/layout.hpp>
#include <maupertuis/locus.hpp>
#include <maupertuis/modes.hpp>
#include <maupertuis/orbits.hpp>
#include <maupertuis/plot.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/trajectory.hpp>
#include <maupertuis/verification.hpp>

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace maupertuis {

/// All that a report shows. Formulas are layouts, which the page writes as MathML. Everything else is plain text in
/// UTF-8; nothing needs escaping. Empty parts do not appear on the page.
struct ReportContent {
  struct Formula {
    Layout left, right;  // left may be empty; a formula without right is a sentence alone
    std::string rule;    // "chain rule"
    std::string sentence;
  };
  struct Section {
    std::string title;
    std::vector<Formula> lines;
    std::vector<std::string> notes = {};  // of the model, before the lines
  };
  struct Parameter {
    Layout symbol;
    std::string value, unit;  // "60", "cm"
    std::string si;           // "0.6 m" where the text has other units
  };
  struct Coordinate {
    Layout symbol, velocity;
    std::string name;                   // in the model, where the symbol is shown otherwise: "ball.qw"
    std::string kind;                   // "angle", "length in m"
    std::string start, start_velocity;  // "2 rad", "0 rad/s"
  };
  struct Check {
    std::string name, statement, verdict;
    bool passed = false, applies = true;
    int points = 0;
    double error_bound = 1;  // 1: none claimed
  };
  struct Conserved {
    std::string sentence;
    Formula formula;
    std::string value, drift;  // along the run; empty without one
  };
  struct Message {
    Severity severity = Severity::Warning;
    std::string code, message, reason, help;
    std::uint32_t line = 0;  // of the model text; 0: none
    std::string text;        // that line
  };
  struct Picture {
    std::string caption;
    PlotOptions options;  // of `trajectory`; the theme is the page's
  };

  struct ModeRow {
    std::string kind, frequency, hertz, period, damping;  // "oscillation", "5.2 rad/s", …; damping: ζ, or a rate
  };
  struct ModeShape {
    std::string caption;
    std::optional<Drawing> drawing;     // one period, swinging from its turning point
    std::optional<Diagram> diagram;     // of systems that have no drawing, and of motions about which they swing
    std::string svg = {};               // of fields, in the page's theme
    std::optional<Drawing> beads = {};  // what `diagram` shows, in motion: each coordinate a bead that goes up and down
  };
  struct ModePoint {
    std::string name, stability;  // "θ1 = 0, θ2 = π"; the verdict with its reason
    bool stable = false;
    std::vector<Formula> formulas;  // M ξ̈ + …, and the matrices
    std::vector<ModeRow> rows;
    std::vector<ModeShape> shapes;
  };
  struct Locus {
    std::string caption;
    Diagram diagram;
  };

  std::string name, title, source;             // source: the citation
  std::vector<std::string> notes, last_notes;  // of the model: at the beginning, and about its motion
  std::string file, model_text;
  std::vector<std::pair<std::string, std::string>> summary;  // "freedoms" → "2"
  std::vector<Message> messages;
  std::optional<Drawing> drawing;
  std::vector<Coordinate> coordinates;
  std::vector<Parameter> parameters;
  std::vector<Formula> definitions;  // the legend of lets that stay symbols in print
  std::vector<Formula> energies;     // T, V, U, D, L
  std::string energies_title = "Energies";
  std::vector<Formula> equations;  // left = right, with right 0 or Aᵀλ; then the constraints, `sentence` their names
  std::vector<Formula> intermediates;  // what the names in the equations stand for
  std::vector<Section> derivation;
  std::vector<Section> phase_space;  // momenta, H, canonical equations, Routhian; `sentence` of a line without formula
  bool phase_space_certified = false;
  bool certified = false;
  std::vector<Check> certificate;
  std::vector<Conserved> conserved;
  std::vector<std::pair<std::string, std::string>> statistics;
  std::string ending;  // the reason where the run ended early
  std::vector<ExpectationResult> expectations;
  Trajectory trajectory;
  std::vector<Picture> pictures;
  std::vector<std::pair<std::string, std::string>> figures;  // captions and pictures in SVG, in the page's theme
  std::string mode_search;                                   // how equilibria were sought
  std::vector<ModePoint> mode_points;
  std::vector<Locus> loci;

  /// One finding about the long run: a periodic motion, a section, exponents.
  struct Finding {
    std::string title;
    std::vector<std::pair<std::string, std::string>> facts;
    std::string caption;  // of the picture; empty: none
    Trajectory rows;
    PlotOptions picture;
  };
  std::vector<Finding> orbits;

  std::vector<Finding> paths;  // between the ends of the model on which S is stationary
  std::string path_search;     // within what they were sought
  std::vector<Locus> path_pictures;
};

/// One HTML page that needs nothing else: no network, no fonts, no other file. Its policy forbids every request.
/// The drawing is animated on a canvas; formulas are MathML, plots are SVG; light and dark, narrow and wide, on paper.
std::string report_html(const ReportContent& content);

/// The drawing of a report alone, in motion, with its controls; a page that needs nothing else.
std::string animation_html(const Drawing& drawing, const std::string& title);

/// What else a report may show.
struct ReportParts {
  const SimulationResult* simulation = nullptr;  // null: no run, no drawing, no plots
  const Verification* verification = nullptr;    // null: the `expect` lines were not carried out
  const Invariants* invariants = nullptr;        // null: the energy function and cyclic coordinates alone
  const ModalStudy* modes = nullptr;             // null: no part on equilibria
  const Locus* locus = nullptr;                  // of the model's sweep
  const FloquetResult* floquet = nullptr;
  const SectionResult* section = nullptr;
  std::string section_what;  // "section x = 0 rising"
  const LyapunovResult* lyapunov = nullptr;
  const PathSearch* paths = nullptr;  // between the ends of the model's `path`
};

/// "Title: what", of a model without title and name `what` alone.
std::string picture_title(const MechanicalSystem& system, const std::string& what);

/// How a section is drawn: q' against q of the coordinate that it leaves free, a colour a motion, with the border of
/// what the energy allows.
PlotOptions section_picture(const SectionResult& section, const std::string& what, const MechanicalSystem& system);

/// Carries out the work of a section of the page (its id: "phase-space") or does without: false, and nothing of it is
/// shown.
using SectionGuard = std::function<bool(std::string_view section, const std::function<void()>& work)>;

/// Fills a report from the artifacts of one study, each section under the guard. `derivation` with its steps, or empty.
ReportContent compose_report(const Model& model, const SourceText& source, const EquationsOfMotion& equations,
                             const Derivation& derivation, const Certificate& certificate,
                             const ReportParts& parts = {}, const SectionGuard& guard = {});
/// The notes of a model, each at the section of the derivation that the statements before it are about; where there is
/// no such section, at the one before, or at the beginning.
void add_notes(ReportContent& content, const Model& model);
/// The messages of a page: those of `diagnostics` that are no errors.
void add_messages(ReportContent& content, const Diagnostics& diagnostics, const SourceText& source);

}  // namespace maupertuis
