#pragma once
#include <filesystem>
#include <functional>
#include <string>

namespace maupertuis::studio {

struct ServerOptions {
  std::filesystem::path page;    // index.html and what belongs to it
  std::filesystem::path folder;  // of the models
  std::string open;              // the model that is shown first, below the folder; may be empty
  int port = 0;                  // 0: any that is free
  std::string program;           // what workers are started from
};

/// Serves 127.0.0.1 until `stop` is called from `started`, or for ever. `started` is told the address, and gets what
/// stops it. Returns what went wrong, a sentence; empty where it came to its end.
std::string serve(const ServerOptions& options,
                  const std::function<void(const std::string& address, int port, std::function<void()> stop)>& started);

}  // namespace maupertuis::studio
