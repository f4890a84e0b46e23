#include <doctest/doctest.h>

#include "symbolic/transform/key_table.hpp"

#include <cstdint>
#include <unordered_map>

using maupertuis::terms::KeyTable;

TEST_CASE("a table of keys keeps what it was given, as it grows and where keys collide") {
  KeyTable table;
  std::unordered_map<std::uint64_t, std::uint32_t> same;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    // pairs of small numbers, as of monomials and harmonics; with the key 0
    const std::uint64_t key = std::uint64_t{i % 57} << 32 | i / 57;
    std::uint32_t& place = table[key];
    CHECK(place == KeyTable::none);
    place = same[key] = 7 * i;
  }
  for (const auto& [key, value] : same) CHECK(table[key] == value);
}

TEST_CASE("a key that was asked for and not set stays new") {
  KeyTable table;
  for (int turn = 0; turn < 100; ++turn) CHECK(table[5] == KeyTable::none);
  table[5] = 1;
  CHECK(table[5] == 1);
  CHECK(table[6] == KeyTable::none);
}
