#include "codes.hpp"

#include <algorithm>
#include <maupertuis/codes.hpp>
#include <vector>

namespace maupertuis::app {
namespace {

constexpr CodeEntry own_codes[] = {
    {"E0692", "equations too coupled to be written out solved",
     "Solving for the accelerations needs the inverse of the mass matrix. For more than two coupled coordinates its "
     "formulas fill pages and help nobody; runs factor the matrix in numbers instead. The same holds for the "
     "multipliers "
     "of more than two constraints, and where M is singular and only the constraints make the motion unique. The "
     "matrix "
     "form shows M and h of M q'' + h = 0, with A and b of M q'' + h = Aᵀλ, A q'' = b.",
     "maup derive chain.lag --form solved", "maup derive chain.lag --form matrix"},
    {"E0693", "multipliers too long to be eliminated",
     "Combinations Zᵀ(M q'' + h) = 0 with A Z = 0 hold no multipliers. They are written out where they are short; with "
     "many "
     "constraints, or where one constraint repeats others so that A has no full rank, they are not.",
     "maup derive linkage.lag --eliminate", "maup derive linkage.lag --form matrix"},
    {"E0694", "no rates to write the equations in",
     "The form in rates has combinations of velocities in the place of q'. The model names them with `rates`; where it "
     "does not, they are the angular velocities of its bodies on body axes, of which this model has none.",
     "maup derive pendulum.lag --form rates", "maup derive satellite.lag --form rates"},
    {"E0695", "no equations in these rates",
     "Velocities follow from rates and constraints by a linear system that is solved in formulas: constraints have to "
     "be "
     "linear in q', and the system small enough that its solution can be read.",
     "maup derive satellites.lag --form rates", "maup derive satellites.lag --form standard"},
    {"E0801", "a file cannot be read",
     "The operating system refused to open or read the file; its reason is quoted. Check the spelling of the path and "
     "the permission of the file. `-` stands for standard input.",
     "maup check penduluum.lag", "maup check pendulum.lag"},
    {"E0802", "a directory was given where a model file is expected",
     "Name one file, or let the shell expand a pattern: `maup test models/*.lag`.", "maup test models",
     "maup test models/*.lag"},
    {"E0803", "a file is too large to be a model",
     "At most 64 MiB are read, so that a wrong path (a disk image, an endless device) ends with a message instead of a "
     "full memory.",
     "maup check /dev/zero", "maup check pendulum.lag"},
    {"E0804", "a file cannot be written",
     "The system refused to create or complete the file; its reason is quoted. A result goes to a temporary name in "
     "the "
     "same folder and is renamed when complete, so that a file that was there before is untouched.",
     "maup simulate pendulum.lag -o nowhere/motion.csv", "maup simulate pendulum.lag -o motion.csv"},
    {"E0805", "the result could not be written to standard output",
     "The disk behind the redirection is full, or the program at the other end of the pipe has stopped reading. The "
     "result is incomplete there.",
     "maup derive pendulum.lag > /dev/full", "maup derive pendulum.lag > equations.txt"},
    {"E0806", "a command of a later version",
     "The command is part of the plan and its name is taken, but this version does not carry it out.",
     "maup sweep pendulum.lag", "maup modes pendulum.lag --sweep \"l = 1 m .. 2 m steps 3\""},
    {"E0807", "a file exists already",
     "`maup new` and `maup reduce` never overwrite a model. Choose another name with -o, or say --force.",
     "maup new pendulum -o pendulum.lag", "maup new pendulum -o second.lag"},
    {"E0808", "there is no starter of this name", "`maup new --list` shows the starters.", "maup new penduluum",
     "maup new --list"},
    {"E0809", "an option has a wrong value",
     "A time is a number with a unit of time: 3s, 250ms, 2 min; a bare number is in seconds. A tolerance is a positive "
     "number below 1.",
     "maup simulate pendulum.lag --at 3kg", "maup simulate pendulum.lag --at 3s"},
    {"E0810", "the ending of a file names no format",
     "The format of a result follows the ending of its file: .csv, .npy, .json for a trajectory, .svg, .png, .pdf for "
     "a picture, "
     ".html for a report.",
     "maup simulate pendulum.lag -o motion.xls", "maup simulate pendulum.lag -o motion.csv"},
    {"E0812", "the result would be written over the model",
     "The file of -o, or of a plot, is the model that is read, also by standard input, or a link to another model. "
     "Results never take the place of what they were made from.",
     "maup reduce arm.lag -o arm.lag", "maup reduce arm.lag -o arm_reduced.lag"},
    {"W0813", "a section of the report is left out",
     "A report has a budget of time, 20 s unless --budget says otherwise. No section takes more than half of what is "
     "left of it, so that a slow one "
     "does not take the others with it; one that does not come is left out, and the page says so. `--sections` "
     "computes the named ones alone.",
     "maup report chain.lag", "maup report chain.lag --budget 10min"},
    {"W0827", "modes are left out by the budget",
     "`maup derive --modes` derives and certifies the equations of one mode after the other, and has a budget of time, "
     "20 s unless --budget says otherwise. Modes that do not come in it are left out; those that came are shown.",
     "maup derive table.lag --modes", "maup derive table.lag --modes --budget 10min"},
    {"W0815", "an environment variable has an unknown value",
     "MAUPERTUIS_INSTRUCTIONS holds the vector instructions back: `none`, `avx2`, or `avx512` for all that the "
     "processor has. Any other word is left out of account.",
     "MAUPERTUIS_INSTRUCTIONS=sse maup simulate pendulum.lag",
     "MAUPERTUIS_INSTRUCTIONS=avx2 maup simulate pendulum.lag"},
    {"W0818", "a text is too large to be looked at while it is typed",
     "An editor asks for mistakes at every keystroke, and each time the whole text is read. Up to 1 MiB that is quick; "
     "beyond it `maup lsp` says this and looks no further. `maup check` reads texts up to 8 MiB.",
     "", ""},
    {"W0817", "the name of a file is not what it seems",
     "The name holds escape bytes, characters that turn the direction of writing, or a letter of another alphabet that "
     "looks Latin. It is shown with such characters "
     "spelled out (\\x1b, \\u202e); typing what is seen finds another file, or none.",
     "", ""},
    {"E0816", "a result is no finite number",
     "A result is a number, or says that there is none. Where NaN or an infinity would stand in it the command has "
     "failed: the quantity grew beyond the range of "
     "numbers, or its formula has no value there (a root of a negative number, a division by zero).",
     "# maup simulate\ncoord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\nstart x = 1e200 "
     "m\nrun 1 s\n",
     "# maup simulate\ncoord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\nstart x = 1 m\nrun "
     "1 s\n"},
    {"N0819", "a curve has a gap",
     "A formula of --y, --x or --columns has no finite value at some moments of the motion: it divides by what is 0 "
     "there, or takes a root of what is negative. The picture leaves these moments out.",
     "# maup plot --y 1/x\ncoord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\nstart x' = 1 "
     "m/s\nrun 1 s\n",
     "# maup plot --y x\ncoord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\nstart x' = 1 "
     "m/s\nrun 1 s\n"},
    {"E0814", "the budget of a report was used up before its equations were certified",
     "Every section of a page stands on the certified equations: without them there is none.",
     "maup report chain.lag --budget 1s", "maup report chain.lag --budget none"},
    {"E0840", "a picture of this kind cannot be made here",
     "PNG, PDF and videos are drawn by librsvg and cairo, which are opened when they are needed. They are not on this "
     "machine, or the picture "
     "is too large for them. SVG is written by maup itself.",
     "", ""},
    {"E0841", "a film needs ffmpeg",
     "MP4 and GIF are encoded by ffmpeg, a program of its own that is looked for in the folders of PATH. It is not "
     "there, or it could not do what "
     "it was asked for; what it says is quoted. Pages and animated SVG are written by maup itself.",
     "", ""},
    {"E0842", "a film that is too long", "The frames are more than a file of this kind can hold and be of use.",
     "# maup animate -o film.svg --speed 0.01\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\npoint P mass "
     "m at l (sin θ, -cos θ)\ngravity (0, -g)\nstart θ = 1 rad\nrun 100 s\n",
     "# maup animate -o film.svg --speed 10\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\npoint P mass m "
     "at l (sin θ, -cos θ)\ngravity (0, -g)\nstart θ = 1 rad\nrun 100 s\n"},
    {"E0843", "nothing to draw",
     "A drawing shows where things are: points, bodies, springs, and what a `draw` statement names. A model of "
     "coordinates and energies alone says "
     "nothing of that.",
     "# maup animate\ncoord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\nstart x = 1 m\nrun 1 "
     "s\n",
     "# maup animate\ncoord x : length\nparam m = 1 kg, k = 1 N/m\npoint P mass m at (x, 0)\nV = 1/2 k x^2\nstart x = "
     "1 m\nrun 1 s\n"},
    {"N0844", "a motion faster than the frames of its drawing",
     "A page holds up to 12,000 moments of a motion, a film those of its frames. Where less than five of them fall on "
     "a swing, what is drawn between them would be made up: the nearest moment is shown. As the spokes of a wheel in a "
     "film, such a motion may seem to go slowly, or backwards.",
     "# maup animate -o film.html\ncoord x : length\nparam m = 1 kg, k = 4e7 N/m\npoint P mass m at (x, 0)\nV = 1/2 k "
     "x^2\nstart x = 1 m\nrun 10 s\n",
     "# maup animate -o film.html --duration 50ms\ncoord x : length\nparam m = 1 kg, k = 4e7 N/m\npoint P mass m at "
     "(x, 0)\nV = 1/2 k x^2\nstart x = 1 m\nrun 10 s\n"},
    {"E0850", "the studio is not here",
     "`maup studio` shows a page in the browser, served by a program of its own, maup-studio, from the files of the "
     "page. One of the two is not installed with this program. A build makes the page with npm (`make studio`) and the "
     "server where cpp-httplib is installed.",
     "", ""},
    {"E0851", "the studio could not be served",
     "The server of the studio listens at a port of 127.0.0.1, which no other program may use at the same time.",
     "maup studio --port 80", "maup studio"},
    {"E1305", "the motion does not reach the time asked for",
     "`maup modes --at 3s` linearizes about the state of the motion at that time; the run ended before. Its reason is "
     "quoted.",
     "# maup modes --at 3s\nparam m = 1 kg, c = 1 N/m^2\ncoord x : length\nT = 1/2 m x'^2\nV = -1/3 c x^3\nstart x = 1 "
     "m, x' = 1 m/s\nrun 1 s\n",
     "# maup modes --at 0.3s\nparam m = 1 kg, c = 1 N/m^2\ncoord x : length\nT = 1/2 m x'^2\nV = -1/3 c x^3\nstart x = "
     "1 m, x' = 1 m/s\nrun 1 s\n"},
    {"E0811", "there is no such column to plot",
     "A plot shows the columns of the trajectory: coordinates (θ), velocities (θ'), coordinates of points (B.x), "
     "energies.",
     "maup plot pendulum.lag --y t", "maup plot pendulum.lag --y \"θ'\""},
};

}  // namespace

std::span<const CodeEntry> all_codes() {
  static const std::vector<CodeEntry> all = [] {
    std::vector<CodeEntry> codes(std::begin(own_codes), std::end(own_codes));
    for (const auto entries : {syntax_codes(), system_codes(), equations_codes(), simulation_codes(),
                               verification_codes(), comparison_codes(), invariants_codes(), hamiltonian_codes(),
                               action_codes(), linearization_codes(), orbits_codes(), study_codes(), fields_codes()})
      codes.insert(codes.end(), entries.begin(), entries.end());
    // By number, so that E0301 and W0302 stand together.
    std::sort(codes.begin(), codes.end(),
              [](const CodeEntry& a, const CodeEntry& b) { return a.code.substr(1) < b.code.substr(1); });
    return codes;
  }();
  return all;
}

}  // namespace maupertuis::app
