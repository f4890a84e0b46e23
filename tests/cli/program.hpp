#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace cli_test {

struct Outcome {
  int code = -1;
  std::string out, err;
  double seconds = 0;
};

/// Runs build/bin/maup with these arguments in a shell that bounds it to 60 s and 2 GB, `input` on standard input.
Outcome maup(const std::vector<std::string>& arguments, const std::string& input = {});
/// Runs any shell command line; $MAUP is the program.
Outcome shell(const std::string& command);

/// Starts maup with these arguments, sends the signal once it has computed for some time or waits for a pipe, and waits
/// for its end. `after`: in seconds of the processor, whatever else runs on it. `seconds`: from the signal to the end.
/// `input`: the file on standard input.
Outcome interrupted(const std::vector<std::string>& arguments, int signal, double after,
                    const std::string& input = "/dev/null");

/// A directory of its own, removed at the end.
class Folder {
 public:
  Folder();
  ~Folder();
  std::string path(const std::string& name) const { return (path_ / name).string(); }
  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& text) const;
  std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

std::string read(const std::string& path);
bool contains(const std::string& text, const std::string& part);

inline const char* const pendulum =
    "system pendulum \"Simple pendulum\"\n"
    "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
    "coord θ : angle\n"
    "point bob mass m at l (sin θ, -cos θ)\n"
    "gravity (0, -g)\n"
    "start θ = 60 deg\n"
    "run 10 s\n";

}  // namespace cli_test
