#include "core/system/utf8.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/system/json_text.h"

namespace kinescope {
namespace {

TEST(Utf8, ReadsBackWhatItWrote) {
  const std::u32string text = U"a\u00E9\u07FF\u0800\uFFFD\U00010000\U0010FFFF";
  EXPECT_EQ(DecodeUtf8(EncodeUtf8(text)), text);
  EXPECT_EQ(EncodeUtf8(U"\u00E9\u2026\U0001F600"), "\xC3\xA9\xE2\x80\xA6\xF0\x9F\x98\x80");
}

TEST(Utf8, LeavesNothingInALineThatSteersATerminal) {
  const std::string name =
      "a\x1b]0;t\x07\x7f\xc2\x9b"
      "31m\r\n\xe2\x80\xae"
      "b\xff\xc3\xa9";
  EXPECT_EQ(DecodeUtf8(name), U"a\uFFFD]0;t\uFFFD\uFFFD\uFFFD31m\uFFFD\uFFFD\uFFFDb\uFFFD\u00E9");
  EXPECT_EQ(PrintableLine("\x1b[2J"), "\xEF\xBF\xBD[2J");
  EXPECT_EQ(PrintableLines("\ta\n\x1b\n"), "\ta\n\xEF\xBF\xBD\n");
  EXPECT_EQ(PrintableLines(""), "");
}

TEST(JsonText, EscapesWhatSteersATerminal) {
  const nlohmann::json name =
      "a\x1b\n\x7f\xc2\x80\xc2\x9f\xe2\x80\xaa\xe2\x80\xae\xe2\x81\xa6\xe2\x81\xa9\xc3\xa9\xe2\x80"
      "\xa6";
  const std::string text = JsonText(name);
  EXPECT_EQ(text,
            "\"a\\u001b\\n\\u007f\\u0080\\u009f\\u202a\\u202e\\u2066\\u2069\xc3\xa9\xe2\x80\xa6\"");
  EXPECT_EQ(nlohmann::json::parse(text), name);
}

}  // namespace
}  // namespace kinescope
