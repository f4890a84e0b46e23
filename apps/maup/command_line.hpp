#pragma once

namespace maup {

/// The whole program: reads the arguments, runs one command, returns its exit code.
int run(int argc, char** argv);

}  // namespace maup
