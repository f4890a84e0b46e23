// Every model of the gallery has its picture, small and whole, and its line on the page of pictures.
#include "program.hpp"

#include <doctest/doctest.h>

#include <filesystem>

using namespace cli_test;
namespace fs = std::filesystem;

TEST_CASE("each model has a picture below 60 kB and a line in the gallery, and no picture is without a model") {
  const fs::path project = PROJECT_DIR;
  const std::string page = read((project / "docs/gallery/README.md").string());
  std::size_t models = 0, pictures = 0;
  std::vector<fs::path> texts;
  for (const char* folder : {"models", "models/degenerate"})
    for (const auto& entry : fs::directory_iterator(project / folder)) texts.push_back(entry.path());
  for (const auto& entry : fs::directory_iterator(project / "models/fields"))  // of fields those that run or rest
    if (const std::string text = read(entry.path().string());
        contains(text, "\nrun ") || contains(text, "\nexpect equilibrium "))
      texts.push_back(entry.path());
  for (const fs::path& text : texts) {
    if (text.extension() != ".lag") continue;
    const std::string name = text.stem().string(), picture = (project / "docs/gallery" / (name + ".svg")).string();
    CAPTURE(name);
    ++models;
    REQUIRE(fs::exists(picture));
    CHECK(fs::file_size(picture) < 60'000);
    CHECK(fs::file_size(picture) > 500);
    CHECK(contains(read(picture), "</svg>"));
    CHECK(contains(page, "](" + name + ".svg)"));
    CHECK(contains(page, "../../" + fs::relative(text, project).generic_string()));
  }
  for (const auto& entry : fs::directory_iterator(project / "docs/gallery"))
    pictures += entry.path().extension() == ".svg";
  CHECK(pictures == models);
}

TEST_CASE("pictures are those that the program draws today") {
  const Folder folder;
  const std::string project = PROJECT_DIR;
  for (const char* name : {"pendulum", "rolling_disk", "henon_heiles", "fields/breather"}) {
    CAPTURE(name);
    const std::string stem = fs::path(name).stem().string(), picture = folder.path(stem + ".svg");
    REQUIRE(shell("cd " + project + " && MAUP=$MAUP scripts/gallery --one " + name + " " + picture).code == 0);
    CHECK(read(picture) == read(project + "/docs/gallery/" + stem + ".svg"));
  }
}

TEST_CASE("the README shows four models of bodies and two of fields") {
  const std::string readme = read(std::string(PROJECT_DIR) + "/README.md");
  std::size_t shown = 0;
  for (std::size_t at = readme.find("docs/gallery/"); at != std::string::npos;
       at = readme.find("docs/gallery/", at + 1)) {
    const std::string name = readme.substr(at, readme.find_first_of("\") ", at) - at);
    if (!name.ends_with(".svg")) continue;
    ++shown;
    CHECK(fs::exists(std::string(PROJECT_DIR) + "/" + name));
  }
  CHECK(shown == 6);
}
