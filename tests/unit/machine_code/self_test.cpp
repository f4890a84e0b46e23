#include "machine_code/backend.hpp"

#include "../processors.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

using namespace maupertuis::machine_code;

namespace {

struct alignas(64) Lanes {
  double x[16], y[16];
};

Lanes run(int width, const std::string& processor = {}) {
  Request request;
  request.width = width;
  request.processor = processor.c_str();
  const Compiled compiled = compile(request, nullptr);
  REQUIRE_MESSAGE(compiled.code, compiled.trouble);
  const auto f = reinterpret_cast<void (*)(const double*, double*)>(compiled.code->find("self_test"));
  REQUIRE((f != nullptr));
  Lanes lanes{};
  for (int first = 0; first < 16; first += width) {
    Lanes part{};
    for (int i = 0; i < width; ++i) part.x[i] = 0.3 + 0.7 * (first + i);
    f(part.x, part.y);
    std::memcpy(lanes.x + first, part.x, sizeof(double) * static_cast<std::size_t>(width));
    std::memcpy(lanes.y + first, part.y, sizeof(double) * static_cast<std::size_t>(width));
  }
  return lanes;
}

double expected(double x) {
  const long double s = std::sin(static_cast<long double>(x)), c = std::cos(static_cast<long double>(x));
  return static_cast<double>(std::sqrt(s * s + x * c * c));
}

}  // namespace

TEST_CASE("code that is compiled at run time computes, the same bits at every width") {
  const Lanes one = run(1);
  for (int i = 0; i < 16; ++i) CHECK(std::abs(one.y[i] - expected(one.x[i])) <= 4e-16 * expected(one.x[i]));
  for (const int width : {2, 4, 8, 16}) {
    CAPTURE(width);
    const Lanes wide = run(width);
    CHECK(std::memcmp(wide.y, one.y, sizeof one.y) == 0);
  }
}

TEST_CASE("processors with less: the same to rounding, and the same at every width") {
  for (const std::string& processor : levels_here({"x86-64", "x86-64-v2", "x86-64-v3"})) {
    CAPTURE(processor);
    const Lanes one = run(1, processor);
    for (int i = 0; i < 16; ++i) CHECK(std::abs(one.y[i] - expected(one.x[i])) <= 4e-16 * expected(one.x[i]));
    for (const int width : {2, 4, 8, 16}) CHECK(std::memcmp(run(width, processor).y, one.y, sizeof one.y) == 0);
  }
}

TEST_CASE("a processor that LLVM does not know is declined with a sentence") {
  Request request;
  request.processor = "abacus";
  const Compiled compiled = compile(request, nullptr);
  CHECK(!compiled.code);
  CHECK(compiled.trouble == "LLVM knows no processor named abacus");
}

TEST_CASE("what was compiled once comes from the cache, and a damaged file is compiled anew") {
  const std::filesystem::path folder = std::filesystem::path(BUILD_DIR) / "tests/cache-of-self-test";
  std::filesystem::remove_all(folder);
  const ObjectCache cache(folder);
  Request request;
  request.width = 4;
  const auto works = [&](bool from_cache) {
    const Compiled compiled = compile(request, &cache);
    REQUIRE_MESSAGE(compiled.code, compiled.trouble);
    CHECK(compiled.cache_trouble == "");
    CHECK(compiled.from_cache == from_cache);
    CHECK(compiled.code->find("self_test"));
  };
  works(false);
  works(true);
  CHECK(cache.usage().files == 1);
  const std::filesystem::path file = folder / (key_of(request).hex() + ".o");
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  works(false);
  works(true);
}

TEST_CASE("a folder that cannot be written: the code is there, and the trouble is told") {
  const std::filesystem::path file = std::filesystem::path(BUILD_DIR) / "tests/no-folder";
  std::filesystem::create_directories(file.parent_path());
  std::filesystem::remove_all(file);
  std::fclose(std::fopen(file.c_str(), "w"));  // a file stands where the folder would be
  const ObjectCache cache(file / "cache");
  const Compiled compiled = compile({}, &cache);
  CHECK(compiled.code);
  CHECK(compiled.cache_trouble.find("no-folder/cache cannot be made") != std::string::npos);
}
