#include "progress_line.hpp"

#include <doctest/doctest.h>

#include <condition_variable>
#include <mutex>
#include <string>

using namespace maupertuis::app;

namespace {

constexpr std::chrono::hours never(1);

/// What is drawn, and a way to wait for it.
class Terminal {
 public:
  void operator()(std::string_view text) {
    const std::lock_guard lock(mutex_);
    all_ += text;
    changed_.notify_all();
  }
  std::string all() {
    const std::lock_guard lock(mutex_);
    return all_;
  }
  void wait_for(const std::string& text) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return all_.find(text) != std::string::npos; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string all_;
};

}  // namespace

TEST_CASE("a command that is done soon draws nothing") {
  Terminal terminal;
  {
    ProgressLine line("check", never, std::ref(terminal));
    line.tell("equations");
    line.measure("half of it");
    line.wipe();
  }
  CHECK(terminal.all().empty());
}

TEST_CASE("what is told at once is drawn at once, and wiped once, before other words and at the end") {
  Terminal terminal;
  {
    ProgressLine line("report", never, std::ref(terminal));
    line.tell_now("modes");
    line.wipe();
    line.wipe();
    line.tell_now("paths");
  }
  CHECK(terminal.all() == "\r\x1b[Kreport: modes, 0 s\r\x1b[K\r\x1b[Kreport: paths, 0 s\r\x1b[K");
}

TEST_CASE("what takes long is drawn by itself: the part at hand, how far it is, and again after other words") {
  Terminal terminal;
  ProgressLine line("hamiltonian", std::chrono::seconds(0), std::ref(terminal));
  terminal.wait_for("hamiltonian, 0 s");
  line.tell("proofs");
  terminal.wait_for("hamiltonian: proofs, 0 s");
  line.measure("42 %");
  terminal.wait_for("hamiltonian: proofs, 42 %");
  line.wipe();
  line.tell("lines to read");
  terminal.wait_for("hamiltonian: lines to read, 0 s");
}
