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

}  // namespace maupertuis::app
