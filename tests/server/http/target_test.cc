#include "server/http/target.h"

#include <gtest/gtest.h>

#include <string>

namespace kinescope::http {
namespace {

using namespace std::string_literals;

TEST(Target, IsDecodedIntoPathAndQuery) {
  const auto target = ParseTarget("/a%20b/c.js?x=1&name=left%2Dhand&empty=&flag&x=2");
  ASSERT_TRUE(target) << target.error();
  EXPECT_EQ(target->path, "/a b/c.js");
  EXPECT_EQ(target->query, (std::map<std::string, std::string>{
                               {"x", "1"}, {"name", "left-hand"}, {"empty", ""}, {"flag", ""}}));
}

TEST(Target, MayEndWithASlash) {
  EXPECT_EQ(ParseTarget("/")->path, "/");
  EXPECT_EQ(ParseTarget("/api/v1/")->path, "/api/v1/");
}

TEST(Target, IsRejectedIfItMayBeUnsafe) {
  for (const std::string& text : {""s,
                                  "app.js"s,
                                  "http://elsewhere/app.js"s,
                                  "*"s,
                                  "/.."s,
                                  "/../etc/passwd"s,
                                  "/./app.js"s,
                                  "/a/../app.js"s,
                                  "/a/.."s,
                                  "/%2e%2e/etc/passwd"s,
                                  "/%2E%2e%2fetc/passwd"s,
                                  "/a/%2e./b"s,
                                  "//etc/passwd"s,
                                  "/a//b"s,
                                  "/%2fetc/passwd"s,
                                  "/..\\..\\etc"s,
                                  "/..%5c..%5cetc"s,
                                  "/app.js%00.png"s,
                                  "/app.js\0"s,
                                  "/a%0d%0ab"s,
                                  "/a\x7F"s,
                                  "/%"s,
                                  "/%2"s,
                                  "/%zz"s,
                                  "/a?x=%00"s,
                                  "/a?%0d=1"s,
                                  "/a?x=%"s,
                                  "/" + std::string(kMaxTargetBytes, 'a')}) {
    const auto target = ParseTarget(text);
    EXPECT_FALSE(target) << text << " was taken as " << target->path;
    EXPECT_TRUE(target || !target.error().empty()) << text;
  }
}

TEST(Target, IsDecodedOnlyOnce) {
  // %252e is an escaped "%2e", not a dot: no file of ours has such a name.
  EXPECT_EQ(ParseTarget("/%252e%252e/x")->path, "/%2e%2e/x");
}

TEST(PercentDecode, RejectsEveryTruncation) {
  EXPECT_EQ(*PercentDecode("a%41b"), "aAb");
  for (const char* text : {"%", "%4", "a%", "a%4", "%4g", "%g4"})
    EXPECT_FALSE(PercentDecode(text)) << text;
}

}  // namespace
}  // namespace kinescope::http
