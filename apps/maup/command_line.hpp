#pragma once
#include "option_table.hpp"

namespace maupertuis::app {

/// The whole program: reads the arguments, runs one command, returns the exit code.
int run(int argc, char** argv);

/// The same without what belongs to a process of its own, the handlers of signals.
int run_command_line(int argc, char** argv);

/// All commands with all options.
OptionTable option_table();

}  // namespace maupertuis::app
