#include "server/options/value.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinescope::options {
namespace {

using ::testing::ElementsAre;

std::string Reason(Value& value, const std::string& text) {
  try {
    value.Parse(text);
  } catch (const BadValue& error) {
    return error.what();
  }
  return "";
}

TEST(Value, IsUnchangedAfterARejectedText) {
  Number number(3, {0, 10, "s"});
  EXPECT_EQ(Reason(number, "11"), "expected a number from 0 to 10 s");
  EXPECT_EQ(*number, 3);
  Switch on(true);
  EXPECT_EQ(Reason(on, "yes"), "expected on or off");
  EXPECT_TRUE(*on);
  Size size({640, 360});
  for (const char* bad : {"", "1280", "x", "1280x", "x720", "1280x720p", "0x0", "1000000x2", "-5x7",
                          "99999999999999999999x16"}) {
    EXPECT_NE(Reason(size, bad), "") << bad;
  }
  EXPECT_EQ(size.ToText(), "640x360");
}

TEST(Value, PrintsTheTextThatItReads) {
  Size size({16, 16});
  size.Parse("1280x720");
  EXPECT_EQ(size.ToText(), "1280x720");
  Number number(0, {});
  number.Parse("0.1");
  EXPECT_EQ(number.ToText(), "0.1");
  Texts texts;
  texts.ParseAll({"a", "b"});
  EXPECT_EQ(texts.ToText(), "a;b");
  Texts again;
  again.Parse(texts.ToText());
  EXPECT_THAT(*again, ElementsAre("a", "b"));
  again.Parse(";a;;b;");
  EXPECT_THAT(*again, ElementsAre("a", "b")) << "an empty text is none";
}

TEST(Number, IsDescribedWithItsUnitAndItsOpenRange) {
  Number above(1, {0, 60, "s", true});
  EXPECT_EQ(Reason(above, "0"), "expected a number above 0, at most 60 s");
  EXPECT_EQ(Reason(above, "60"), "");
  Whole port(0, {0, 65535, "", false, "0: a free one"});
  EXPECT_EQ(Reason(port, "1.5"), "expected a whole number from 0 to 65535 (0: a free one)");
  EXPECT_EQ(Reason(port, "65536"), "expected a whole number from 0 to 65535 (0: a free one)");
}

TEST(Optional, IsNotGivenBeforeItIsSet) {
  Optional<Number> value(Number(5, {0, 10}));
  EXPECT_FALSE(value);
  EXPECT_FALSE(value.IsGiven());
  EXPECT_EQ(value.value_or(7.0), 7);
  value.Parse("2");
  EXPECT_TRUE(value);
  EXPECT_EQ(*value, 2);
}

TEST(List, HasAtMostTheAllowedNumberOfItems) {
  List<int> digits("digits", 2, [](const std::string& item) {
    if (item.size() != 1) throw BadValue("expected a digit");
    return item[0] - '0';
  });
  digits.Parse("1;2");
  EXPECT_THAT(*digits, ElementsAre(1, 2));
  EXPECT_EQ(Reason(digits, "1;2;3"), "expected at most 2 of digits");
  EXPECT_EQ(Reason(digits, "1;22"), "expected a digit");
  EXPECT_THAT(*digits, ElementsAre(1, 2));
}

}  // namespace
}  // namespace kinescope::options
