// What --plain prints is the model language: pasted back, it is read and holds.
#include "models.hpp"

#include <doctest/doctest.h>

using namespace print_test;

namespace {

/// The lines as statements: equations and natural conditions are expected, names and comments stand as they are.
std::string as_statements(const std::string& printed) {
  std::string out;
  for (const std::string& line : lines_of(printed)) {
    const bool statement = line.rfind("let ", 0) == 0 || line.rfind("#", 0) == 0;
    const bool natural = line.rfind("natural ", 0) == 0;
    out += (statement ? "" : natural ? "expect " : "expect equation ") + line + "\n";
  }
  return out;
}

/// E0244: an integral is held along a whole path, so that there are no equations of motion and no phase space.
bool holds_an_integral(const Outcome& refused) { return refused.code == 1 && contains(refused.err, "E0244"); }

void expect_equations(const std::string& file, const std::vector<std::string>& options) {
  std::vector<std::string> arguments{"derive", file, "--plain"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome derived = maup(arguments);
  const bool must_exist = options.empty() || options.back() == "residual";
  if (derived.code == 1 && !must_exist) return;  // too long for this form
  if (holds_an_integral(derived)) return;
  CHECK_MESSAGE(derived.code == 0, derived.err);
  const Folder folder;
  const std::string model = folder.write("model.lag", without_expectations(read(file)) + as_statements(derived.out));
  const Outcome tested = maup({"test", model});
  CHECK_MESSAGE(tested.code == 0, name_of(file), "\n", derived.out, tested.out, tested.err);
}

}  // namespace

TEST_CASE("every equation of the gallery passes as an expectation of its own model") {
  for (const std::string& file : models_in("models"))
    for (const std::vector<std::string>& options :
         std::vector<std::vector<std::string>>{{}, {"--form", "solved"}, {"--eliminate"}, {"--form", "residual"}}) {
      CAPTURE(file);
      expect_equations(file, options);
    }
}

TEST_CASE("what is printed of the fields of the gallery passes as expectations of its own model") {
  for (const std::string& file : models_in("models/fields")) {
    CAPTURE(file);
    expect_equations(file, {});
  }
}

TEST_CASE("every M, h, A and b of the gallery is read back as definitions") {
  for (const std::string& file : models_in("models")) {
    const Outcome derived = maup({"derive", file, "--plain", "--form", "matrix"});
    if (holds_an_integral(derived)) continue;
    CHECK_MESSAGE(derived.code == 0, derived.err);
    const Folder folder;
    const std::string model = folder.write("model.lag", without_expectations(read(file)) + derived.out);
    const Outcome checked = maup({"check", model});
    CHECK_MESSAGE(checked.code == 0, name_of(file), "\n", derived.out, checked.err);
  }
}

TEST_CASE("every Hamiltonian of the gallery passes as an expectation of its own model") {
  std::size_t tried = 0;
  for (const std::string& file : models_in("models")) {
    std::vector<std::string> command = {"hamiltonian", file, "--plain"};
    if (contains(read(file), "\ncontact ")) command.insert(command.end(), {"--mode", "free"});
    const Outcome printed = maup(command);
    if (holds_an_integral(printed)) continue;
    const bool only_rubs = contains(read(file), "\nfriction ") && contains(printed.err, "E0270");  // no phase space
    if (only_rubs) continue;
    CHECK_MESSAGE(printed.code == 0, printed.err);
    std::string statements;
    for (const std::string& line : lines_of(printed.out)) {
      if (line.rfind("let ", 0) == 0 || line.rfind("#", 0) == 0) statements += line + "\n";
      if (line.rfind("H = ", 0) == 0) statements += "expect hamiltonian = " + line.substr(4) + "\n", ++tried;
    }
    const Folder folder;
    const std::string model = folder.write("model.lag", without_expectations(read(file)) + statements);
    const Outcome tested = maup({"test", model});
    CHECK_MESSAGE(tested.code == 0, name_of(file), "\n", statements, tested.out, tested.err);
  }
  CHECK(tried >= 40);
}
