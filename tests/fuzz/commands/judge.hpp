#pragma once
#include "input.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>

namespace maupertuis::fuzz {

/// What came of an input.
struct Outcome {
  int code = 0;               // what the command line returned
  int signal = 0;             // that ended it; 0: none
  bool too_long = false;      // more than the limit of processor time
  bool waiting = false;       // it computed nothing, and did not end: for input, or for somebody who asks
  bool interruptible = true;  // it then ended by itself when it was asked to
  std::string out, err;
  std::map<std::string, std::string> files;  // that it wrote
};

/// One sentence of what is wrong, the same for all inputs with the same cause; nothing where all is well. `documented`:
/// exit codes; `catalogue`: codes of messages that `maup explain` knows.
std::optional<std::string> failure(const Input& input, const Outcome& outcome, const std::set<int>& documented,
                                   const std::set<std::string>& catalogue);

/// The command runs motions, whose length is what the model asks for; such a run may take long, if it ends when it is
/// asked to.
bool runs_motions(const Input& input);

}  // namespace maupertuis::fuzz
