#include "command.hpp"
#include "outcome.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <filesystem>

namespace maupertuis::app {
namespace {

namespace fs = std::filesystem;

struct StudioOptions {
  std::string place;  // a folder or a model; empty: the folder one is in
  int port = 0;       // 0: any that is free
  bool no_browser = false;
  std::string page;
};

fs::path own_folder() {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : self.parent_path();
}

/// Where the page is: beside a build, or where it was installed.
std::optional<fs::path> find_page(const StudioOptions& options) {
  std::vector<fs::path> places{own_folder() / "../share/maupertuis/studio", own_folder() / "../studio"};
  if (!options.page.empty()) places = {options.page};
  std::error_code error;
  for (const fs::path& place : places)
    if (fs::is_regular_file(place / "index.html", error)) return place;
  return std::nullopt;
}

ExitCode refuse(Console& console, Diagnostics& diagnostics) {
  const SourceText nowhere("maup studio", "");
  if (console.json()) {
    Json document = json_document("studio");
    document["ok"] = false;
    document["diagnostics"] = to_json(diagnostics, nowhere);
    console.print_document(document);
  }
  console.show(diagnostics, nowhere);
  return ExitCode::Usage;
}

/// The folder of the models, and the one that is shown first.
bool find_models(const StudioOptions& options, fs::path& folder, std::string& open, Diagnostics& diagnostics) {
  const fs::path place = options.place.empty() ? fs::path(".") : fs::path(options.place);
  std::error_code error;
  folder = fs::canonical(fs::is_directory(place, error) ? place : fs::absolute(place).parent_path(), error);
  if (!fs::is_directory(place, error)) open = place.filename().string();
  const bool is_model = open.empty() || (place.extension() == ".lag" && fs::is_regular_file(place, error));
  if (!error && fs::is_directory(folder, error) && is_model) return true;
  diagnostics.error("E0801", {}, fmt::format("{} is no folder and no model.", options.place),
                    "The studio shows the .lag files of a folder.",
                    "Name a folder, or one .lag file; without a name it is the folder that you are in.");
  return false;
}

ExitCode start(const StudioOptions& options, Console& console) {
  console.end_progress();
  Diagnostics diagnostics;
  fs::path folder;
  std::string open;
  if (options.port < 0 || options.port > 65535)
    diagnostics.error("E0809", {}, fmt::format("--port {} is no port.", options.port), {},
                      "Give a number from 1024 to 65535, or leave --port out.");
  const bool models = find_models(options, folder, open, diagnostics);
  const auto page = find_page(options);
  const fs::path server = own_folder() / "maup-studio";
  std::error_code error;
  if (!fs::exists(server, error) || !page)
    diagnostics.error("E0850", {}, "The studio is not installed with this program.",
                      !page ? "Its page is not there: it is built by `make studio`, with npm."
                            : "Its server is not there: it is built where cpp-httplib is installed.",
                      "`maup report` makes a page of one model without it.");
  if (!models || diagnostics.has_errors()) return refuse(console, diagnostics);

  const std::string port = std::to_string(options.port), page_path = fs::canonical(*page).string(),
                    folder_path = folder.string(), program = server.string();
  std::vector<const char*> said{program.c_str(),     "--page", page_path.c_str(), "--folder",
                                folder_path.c_str(), "--port", port.c_str()};
  if (!open.empty()) said.insert(said.end(), {"--open", open.c_str()});
  if (!options.no_browser) said.push_back("--browser");
  if (console.json()) said.push_back("--json");
  said.push_back(nullptr);
  execv(program.c_str(), const_cast<char* const*>(said.data()));
  diagnostics.error("E0850", {}, fmt::format("{} could not be started.", program), {}, "Install it anew.");
  return refuse(console, diagnostics);
}

}  // namespace

void add_studio(CommandLine& line) {
  const auto options = std::make_shared<StudioOptions>();
  Command& command = line.add("studio", "The studio in your browser: write, watch, drag, derive",
                              "  maup studio                            # the models of this folder\n"
                              "  maup studio pendulum.lag\n"
                              "  maup studio lectures/ --port 8765 --no-browser\n",
                              [options](Console& console) { return start(*options, console); });
  command.add_option("PLACE", options->place, "A folder with models, or one model (default: this folder)")
      ->type_name("FOLDER|MODEL");
  command.add_option("--port", options->port, "The port of 127.0.0.1 (default: any that is free)")->type_name("NUMBER");
  command.add_flag("--no-browser", options->no_browser, "Print the address alone");
  command.add_option("--page", options->page, "Another build of the page")->type_name("FOLDER");
}

}  // namespace maupertuis::app
