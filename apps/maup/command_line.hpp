#pragma once

namespace maupertuis::app {

/// The whole program: reads the arguments, runs one command, returns the exit code.
int run(int argc, char** argv);

}  // namespace maupertuis::app
