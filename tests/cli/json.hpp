#pragma once
#include "program.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

namespace cli_test {

using Json = nlohmann::json;

/// The document on standard output.
inline Json json_of(const Outcome& told) {
  const Json out = Json::parse(told.out, nullptr, false);
  REQUIRE_MESSAGE(out.is_object(), told.err);
  return out;
}

}  // namespace cli_test
