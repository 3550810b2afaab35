#include "core/system/words.h"

#include <gtest/gtest.h>

namespace kinescope {
namespace {

TEST(Nearest, IsTheMostSimilarName) {
  const std::vector<std::string> cameras = {"front", "back", "left", "right", "three_quarter"};
  EXPECT_EQ(Nearest("fron", cameras), "front");
  EXPECT_EQ(Nearest("Front", cameras), "front");
  EXPECT_EQ(Nearest("rihgt", cameras), "right");
  EXPECT_EQ(Nearest("three-quarter", cameras), "three_quarter");
  EXPECT_EQ(Nearest("bottom", cameras), "");
  EXPECT_EQ(Nearest("", cameras), "");
  EXPECT_EQ(Nearest(std::string(10'000, 'f'), cameras), "");
}

TEST(Counted, HasTheWordForOneAndForOthers) {
  EXPECT_EQ(Counted(0, "person", "people"), "0 people");
  EXPECT_EQ(Counted(1, "person", "people"), "1 person");
  EXPECT_EQ(Counted(2, "person", "people"), "2 people");
  EXPECT_EQ(Counted(1, "sample"), "1 sample");
  EXPECT_EQ(Counted(2, "sample"), "2 samples");
}

TEST(Alternatives, AreReadAsASentence) {
  EXPECT_EQ(Alternatives({"a"}), "a");
  EXPECT_EQ(Alternatives({"a", "b"}), "a or b");
  EXPECT_EQ(Alternatives({"a", "b", "c"}), "a, b or c");
}

TEST(SuggestionFor, EndsAnErrorOrIsEmpty) {
  EXPECT_EQ(SuggestionFor("rihgt", {"left", "right"}), "; nearest: right");
  EXPECT_EQ(SuggestionFor("wings", {"left", "right"}), "");
}

}  // namespace
}  // namespace kinescope
