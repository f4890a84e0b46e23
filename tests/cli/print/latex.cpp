// Every model in every form is LaTeX that compiles, and none of its lines is wider than the page.
#include "models.hpp"

#include <doctest/doctest.h>

#include <regex>
#include <set>

using namespace print_test;

namespace {

/// Many documents as one: what is declared before them once, their bodies one after the other.
class Collection {
 public:
  void add(const std::string& title, const std::string& document) {
    const std::string begin = "\\begin{document}\n", end = "\\end{document}";
    const std::size_t from = document.find(begin), to = document.rfind(end);
    REQUIRE(from != std::string::npos);
    REQUIRE(to != std::string::npos);
    for (const std::string& line : lines_of(document.substr(0, from)))
      if (seen_.insert(line).second) head_ += line + "\n";
    // What is wrong is found by the title in the log.
    body_ += "\\typeout{MODEL " + title + "}\n" + document.substr(from + begin.size(), to - from - begin.size()) +
             "\n\\clearpage\n";
  }

  std::string document() const { return head_ + "\\begin{document}\n" + body_ + "\\end{document}\n"; }

 private:
  std::set<std::string> seen_;
  std::string head_, body_;
};

/// The lines of the log that say what is wrong, each with the model that it is about.
std::string complaints(const std::string& log, double tolerance) {
  std::string model, out;
  std::size_t count = 0;
  for (const std::string& line : lines_of(log)) {
    std::smatch found;
    if (line.rfind("MODEL ", 0) == 0) model = line.substr(6);
    const bool error = line.rfind("!", 0) == 0;
    const bool wide =
        std::regex_search(line, found, std::regex("Overfull .hbox \\(([0-9.]+)pt")) && std::stod(found[1]) > tolerance;
    if ((error || wide) && ++count <= 20) out += model + ": " + line + "\n";
  }
  return out;
}

void compile(const Collection& all) {
  const Folder folder;
  folder.write("all.tex", all.document());
  const Outcome outcome =
      shell("cd " + folder.path("") +
            " && timeout 300 pdflatex -interaction=nonstopmode -file-line-error=0 all.tex >all.out 2>&1; cat all.log");
  const std::string wrong = complaints(outcome.out, 1.0);
  CHECK_MESSAGE(wrong.empty(), wrong);
  CHECK(contains(read(folder.path("all.pdf")).substr(0, 5), "%PDF"));
}

void compile_all(const std::vector<std::string>& files, const std::vector<std::vector<std::string>>& commands) {
  Collection all;
  std::size_t documents = 0;
  for (const std::string& file : files)
    for (const std::vector<std::string>& command : commands) {
      std::vector<std::string> arguments = command;
      arguments.insert(arguments.begin() + 1, file);
      arguments.push_back("--latex");
      const Outcome outcome = maup(arguments);
      if (outcome.code == 1) continue;  // too long for this form, or no model of a motion: told by its code
      std::string title = name_of(file);
      for (const std::string& word : command) title += " " + word;
      CHECK_MESSAGE(outcome.code == 0, title, ": ", outcome.err);
      all.add(title, outcome.out);
      ++documents;
    }
  CHECK(documents >= files.size());
  compile(all);
}

}  // namespace

TEST_CASE("the models of the gallery, in every form") {
  compile_all(models_in("models"), {{"derive"},
                                    {"derive", "--form", "solved"},
                                    {"derive", "--form", "matrix"},
                                    {"derive", "--form", "residual"},
                                    {"derive", "--eliminate"},
                                    {"derive", "--steps"},
                                    {"hamiltonian"}});
}

TEST_CASE("the models of the literature, with their derivation") {
  std::vector<std::string> files = models_in("tests/problems");
  // The steps of the arm of seven joints are 53,000 lines, which take as long as those of all other models.
  std::erase_if(files, [](const std::string& file) { return contains(file, "urdf_panda"); });
  // L = q has no motion, and nothing is shown of it.
  std::erase_if(files, [](const std::string& file) { return contains(file, "degen_contradiction"); });
  compile_all(files, {{"derive", "--steps"}});
}

TEST_CASE("names with underscores, letters of other alphabets and signs of LaTeX") {
  const Folder folder;
  folder.write("names.lag",
               "system s\nparam m_ü = 1 kg, größe = 2 m, ж = 3 m, k_close_x = 1 N/m\ncoord x_far_left, y_1 : length\n"
               "T = 1/2 m_ü (x_far_left'^2 + y_1'^2)\nV = 1/2 k_close_x (größe - x_far_left)^2 + k_close_x ж y_1\n"
               "constraint x_far_left^2 + y_1^2 = größe^2 name close_x\n");
  compile_all({folder.path("names.lag")}, {{"derive", "--steps"}, {"derive", "--form", "matrix"}, {"hamiltonian"}});
}
