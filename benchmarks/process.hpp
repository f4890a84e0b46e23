#pragma once
#include <string>
#include <vector>

namespace bench {

struct ProcessRun {
  int exit_code = -1;
  double seconds = 0;  // from spawn to end
  long peak_kilobytes = 0;
  std::string output;  // of standard output
};

/// Runs a program to its end; standard error goes to /dev/null.
ProcessRun run_process(const std::vector<std::string>& arguments);

}  // namespace bench
