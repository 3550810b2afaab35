#include "server/http/access.h"

#include <gtest/gtest.h>

namespace kinescope::http {
namespace {

Access Check(const std::string& token, const std::string& target, const std::string& cookies) {
  return CheckToken(token, "kinescope_80", *ParseTarget(target), cookies);
}

TEST(Access, IsOpenWithoutToken) { EXPECT_EQ(Check("", "/", ""), Access::kOpen); }

TEST(Access, AcceptsTheTokenFromQueryOrCookie) {
  EXPECT_EQ(Check("abc", "/?token=abc", ""), Access::kByQuery);
  EXPECT_EQ(Check("abc", "/", "kinescope_80=abc"), Access::kByCookie);
  EXPECT_EQ(Check("abc", "/", "a=b;  kinescope_80=abc ; c=d"), Access::kByCookie);
  EXPECT_EQ(Check("abc", "/?token=old", "kinescope_80=abc"), Access::kByCookie);
}

TEST(Access, IsDeniedForAnythingElse) {
  for (const char* target :
       {"/", "/?token=", "/?token=ab", "/?token=abcd", "/?token=ABC", "/?Token=abc"}) {
    EXPECT_EQ(Check("abc", target, ""), Access::kDenied) << target;
  }
  for (const char* cookies : {"", "kinescope_80=", "kinescope_80=ab", "kinescope_81=abc",
                              "xkinescope_80=abc", "kinescope_80", ";;;=", "kinescope_80=abcabc"}) {
    EXPECT_EQ(Check("abc", "/", cookies), Access::kDenied) << cookies;
  }
}

TEST(Access, RejectsTokensThatDoNotFitIntoACookie) {
  EXPECT_TRUE(FitsIntoCookie("Az09-._~"));
  for (const char* token : {"a b", "a;b", "a\r\nb", "a=b", "\"a\"", "ä"}) {
    EXPECT_FALSE(FitsIntoCookie(token)) << token;
  }
}

TEST(Access, AllowsOnlyTheOriginOfTheHost) {
  EXPECT_TRUE(IsSameOrigin("", "127.0.0.1:8080"));
  EXPECT_TRUE(IsSameOrigin("http://127.0.0.1:8080", "127.0.0.1:8080"));
  EXPECT_TRUE(IsSameOrigin("https://lab.example", "lab.example"));
  for (const char* origin :
       {"null", "http://evil.example", "http://127.0.0.1:8081", "127.0.0.1:8080",
        "http://127.0.0.1:8080.evil.example", "http://evil.example/127.0.0.1:8080"}) {
    EXPECT_FALSE(IsSameOrigin(origin, "127.0.0.1:8080")) << origin;
  }
  EXPECT_FALSE(IsSameOrigin("http://", ""));
}

TEST(Access, RecognisesNamesOfThisMachine) {
  for (const char* host : {"localhost", "localhost:8080", "127.0.0.1", "127.0.0.1:8080",
                           "127.1.2.3:80", "[::1]", "[::1]:8080"}) {
    EXPECT_TRUE(NamesThisMachine(host)) << host;
  }
  for (const char* host :
       {"", "evil.example", "evil.example:8080", "127.evil.example", "127.0.0.1.evil.example",
        "localhost.evil.example", "[::1]evil", "[::2]:80", "128.0.0.1", "[::1"}) {
    EXPECT_FALSE(NamesThisMachine(host)) << host;
  }
}

}  // namespace
}  // namespace kinescope::http
