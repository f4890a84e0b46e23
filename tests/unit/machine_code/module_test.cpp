#include "machine_code/backend.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>

using namespace maupertuis::machine_code;
namespace fs = std::filesystem;

TEST_CASE("a module that is not here, or is none, is told by name") {
  const Module missing = open_module("/nowhere/libmaup_machine_code_llvm.so");
  CHECK(!missing.interface);
  CHECK(missing.trouble == "the module /nowhere/libmaup_machine_code_llvm.so is not here");
  const fs::path text = fs::path(BUILD_DIR) / "tests/not-a-module.so";
  fs::create_directories(text.parent_path());
  std::ofstream(text) << "no object\n";
  const Module wrong = open_module(text);
  CHECK(!wrong.interface);
  CHECK(wrong.trouble.find("not-a-module.so") != std::string::npos);
}

TEST_CASE("a shared object of another kind is not taken for the module") {
  const Module foreign = open_module("/lib/x86_64-linux-gnu/libm.so.6");
  CHECK(!foreign.interface);
  CHECK(!foreign.trouble.empty());
}

TEST_CASE("the module is looked for where the environment says, and nowhere else") {
  setenv("MAUPERTUIS_LLVM_MODULE", "/elsewhere/module.so", 1);
  CHECK(module_path() == "/elsewhere/module.so");
  const Compiled compiled = compile({}, nullptr);
  CHECK(!compiled.code);
  CHECK(compiled.trouble == "the module /elsewhere/module.so is not here");
  unsetenv("MAUPERTUIS_LLVM_MODULE");
  CHECK(module_path() != "/elsewhere/module.so");
}

TEST_CASE("damaged objects are declined, not run") {
  std::string trouble;
  const auto resolve = [](const std::string&) -> void* { return nullptr; };
  const std::string nothing, text(1000, 'x'),
      head = std::string(
                 "\x7f"
                 "ELF\x02\x01\x01",
                 7) +
             std::string(200, '\xff');
  for (const std::string& object : {nothing, text, head}) {
    trouble.clear();
    CHECK(!LoadedObject::load(object, resolve, trouble));
    CHECK(!trouble.empty());
  }
}

TEST_CASE("the processor has one identity") { CHECK(processor_identity() == processor_identity()); }
