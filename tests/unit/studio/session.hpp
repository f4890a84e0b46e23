#pragma once
#include <maupertuis/studio.hpp>

#include <nlohmann/json.hpp>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace maupertuis::studio {

using Json = nlohmann::json;

/// A session with requests and answers as values.
class Asked {
 public:
  explicit Asked(const std::string& text = {}) {
    if (!text.empty()) opened = ask({{"do", "open"}, {"text", text}});
  }
  Json ask(const Json& request) {
    messages.clear();
    return Json::parse(session.answer(request.dump(), [&](std::string_view m) { messages.push_back(Json::parse(m)); }));
  }
  Json ask(const char* what) { return ask(Json{{"do", what}}); }

  Session session;
  Json opened;
  std::vector<Json> messages;
};

inline std::string file_text(const std::string& path) {
  std::ifstream file(std::string(PROJECT_DIR) + "/" + path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace maupertuis::studio
