#pragma once

namespace maupertuis::app {

/// What the program tells the shell.
enum class ExitCode : int {
  Fine = 0,
  ModelWrong = 1,
  Usage = 2,
  RunFailed = 3,
  ExpectationFailed = 4,
  NotProved = 5,  // nothing speaks against it, but it is evidence from points
  Interrupted = 130,
};

struct ExitCodeRow {
  ExitCode code;
  const char* meaning;
};

/// What the manual says of each.
inline constexpr ExitCodeRow exit_codes[] = {
    {ExitCode::Fine, "fine"},
    {ExitCode::ModelWrong, "the model is wrong, or asks for something of a later version"},
    {ExitCode::Usage, "usage: an option, or a file that cannot be read"},
    {ExitCode::RunFailed,
     "the run failed: it ended early (reason, time and state are given, and what was computed is kept), or a result "
     "could not be written"},
    {ExitCode::ExpectationFailed,
     "an expectation failed, or two models that were compared are not the same motion, or nothing could be decided"},
    {ExitCode::NotProved, "two models that were compared are the same motion by evidence from points, without a proof"},
    {ExitCode::Interrupted, "interrupted by Ctrl-C or SIGTERM; what was computed is kept"},
};

}  // namespace maupertuis::app
