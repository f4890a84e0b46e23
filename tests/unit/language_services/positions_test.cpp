#include <maupertuis/positions.hpp>

#include <doctest/doctest.h>

#include <string>

using namespace maupertuis::language;

TEST_CASE("characters are counted in the units of the encoding") {
  const std::string text = "coord θ : angle\nθ̇ = 1 # 🎡 x\r\nend";
  const auto wheel = static_cast<std::uint32_t>(text.find("🎡")), x = static_cast<std::uint32_t>(text.find(" x\r") + 1);
  const Positions utf16(text, Encoding::Utf16), utf8(text, Encoding::Utf8), utf32(text, Encoding::Utf32);
  CHECK(utf16.at(wheel) == Position{1, 9});  // θ and its dot: one unit each
  CHECK(utf8.at(wheel) == Position{1, 11});  // two bytes each
  CHECK(utf32.at(wheel) == Position{1, 9});
  CHECK(utf16.at(x) == Position{1, 12});  // the wheel is a pair of surrogates
  CHECK(utf8.at(x) == Position{1, 16});
  CHECK(utf32.at(x) == Position{1, 11});
  CHECK(utf16.offset({1, 12}) == x);
  CHECK(utf16.offset({1, 10}) == wheel);  // between the surrogates: the wheel itself
  CHECK(utf8.offset({1, 13}) == wheel);
}

TEST_CASE("lines end by one of three marks, and places beyond them are their ends") {
  const std::string text = "a\r\nbc\rd\n";
  const Positions positions(text, Encoding::Utf16);
  CHECK(positions.line_count() == 4);
  CHECK(positions.at(3) == Position{1, 0});
  CHECK(positions.at(6) == Position{2, 0});
  CHECK(positions.at(8) == Position{3, 0});
  CHECK(positions.at(2) == Position{0, 1});  // between \r and \n
  CHECK(positions.offset({0, 99}) == 1);
  CHECK(positions.offset({1, 99}) == 5);
  CHECK(positions.offset({99, 0}) == 8);
  CHECK(positions.offset({3, 5}) == 8);
}

TEST_CASE("every offset of every encoding comes back") {
  const std::string text = "θ̈₁ ½ 🎡🎡\n\n…\xff\xc3\x28é\r\n\xf0\x9f end";  // with bytes that are no UTF-8
  for (const Encoding encoding : {Encoding::Utf8, Encoding::Utf16, Encoding::Utf32}) {
    const Positions positions(text, encoding);
    std::uint32_t last = 0;
    for (std::uint32_t i = 0; i <= text.size(); ++i) {
      const std::uint32_t back = positions.offset(positions.at(i));
      CHECK(back <= i);
      CHECK(back >= last);  // the beginning of the same character
      CHECK(i - back < 4);
      last = back;
    }
  }
}

TEST_CASE("an empty text has one place") {
  const Positions positions("", Encoding::Utf16);
  CHECK(positions.at(0) == Position{});
  CHECK(positions.at(7) == Position{});
  CHECK(positions.offset({3, 3}) == 0);
}

TEST_CASE("a long line is counted from places within it, in both directions") {
  std::string text = "first\n";
  for (int i = 0; i < 3000; ++i) text += "θ🎡x";  // 7 bytes, 4 units of UTF-16
  text += "\nlast";
  const Positions positions(text, Encoding::Utf16);
  for (std::uint32_t i = 0; i < 3000; i += 7) {
    const std::uint32_t begin = 6 + 7 * i;
    CHECK(positions.at(begin) == Position{1, 4 * i});
    CHECK(positions.at(begin + 2) == Position{1, 4 * i + 1});
    CHECK(positions.at(begin + 6) == Position{1, 4 * i + 3});
    CHECK(positions.offset({1, 4 * i}) == begin);
    CHECK(positions.offset({1, 4 * i + 2}) == begin + 2);  // between the surrogates
    CHECK(positions.offset({1, 4 * i + 3}) == begin + 6);
  }
  CHECK(positions.offset({1, 999'999}) == 6 + 7 * 3000);
  CHECK(positions.at(static_cast<std::uint32_t>(text.size())) == Position{2, 4});
}
