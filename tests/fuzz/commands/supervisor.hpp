#pragma once
#include "judge.hpp"

#include <functional>

namespace maupertuis::fuzz {

struct Limits {
  double seconds = 20;  // of processor time, an input
  double waiting = 60;  // of the clock, for what waits and computes nothing
  std::uint64_t memory = 4ull << 30;
  std::uint64_t inputs_of_process = 20'000;  // then a fresh one: what one input leaves behind cannot hide for long
};

/// The program as a function: arguments with its name, and its exit code. It writes to the descriptors 1 and 2 and
/// reads 0.
using Program = std::function<int(int, char**)>;

/// Runs inputs one after another in a process of its own, which is begun anew when an input has ended it.
class Supervisor {
 public:
  /// `see`: called for each input with what came of it, in order. `interrupted_code`: what an interrupted program
  /// returns.
  Supervisor(Program program, Limits limits);
  ~Supervisor();

  /// What comes of the inputs `first`, `first` + 1, … `first` + `count` - 1, until `stop` says so. Outcomes are judged
  /// where they arise, in the process that has them, and told here only where `judge` finds a failure; `tell` gets the
  /// number of the input, the failure and the outcome.
  using Draw = std::function<Input(std::uint64_t)>;
  using Judge = std::function<std::optional<std::string>(const Input&, const Outcome&)>;
  using Tell = std::function<void(std::uint64_t, const std::string&, const Outcome&)>;
  void run(std::uint64_t first, std::uint64_t count, const Draw& draw, const Judge& judge, const Tell& tell,
           const std::function<bool()>& stop);

  /// How many inputs have been run, by exit code; too long but ended when asked, apart.
  struct Counts {
    std::uint64_t inputs = 0, long_runs = 0, out_of_memory = 0;
    std::map<int, std::uint64_t> by_code;
  };
  const Counts& counts() const { return counts_; }

 private:
  struct Shared;
  void child(std::uint64_t first, std::uint64_t last, const Draw& draw, const Judge& judge);
  Outcome carry_out(const Input& input);
  void prepare(const Input& input);

  Program program_;
  Limits limits_;
  Counts counts_;
  Shared* shared_ = nullptr;
  std::string folder_;
  int in_ = -1, out_ = -1, err_ = -1;
};

}  // namespace maupertuis::fuzz
