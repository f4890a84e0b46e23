#pragma once
#include "description.hpp"

#include <string>

/// A random steep model, run by the program and by the reference.
namespace steep {

enum class Verdict {
  Right,     // the program exits 0, within 10 times the stated error (without one: 1e-9)
  Ended,     // it ends with a reason
  Wrong,     // it exits 0 beyond that, gives no end within a minute, or breaks down
  Refused,   // it does not take the model
  Unjudged,  // the reference does not know the value well enough: its two runs differ, or rounding grows by more than
             // 1e4
};

struct Judgement {
  Verdict verdict = Verdict::Unjudged;
  double error = 0;          // the largest of q and v, relative where they are above 1
  double stated = 0;         // of the same component; 0 where nothing is stated
  std::string reason;        // Ended, Wrong: in the program's words
  std::string expectations;  // the right values as `expect` lines
};

/// `arguments`: more of them for `maup simulate`.
Judgement judge(const Description& d, const std::string& arguments = {});

}  // namespace steep
