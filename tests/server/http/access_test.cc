#include "server/http/access.h"

#include <gtest/gtest.h>

namespace kinescope::http {
namespace {

Access Check(const std::string& token, const std::string& target, const std::string& cookies,
             const std::string& authorization = "") {
  return CheckToken({token, ""},
                    FindTokens(*ParseTarget(target), authorization, cookies, "kinescope_80"))
      .access;
}

// The role that "op" or "view" gives; "": denied.
std::string RoleFor(const std::string& target, const std::string& cookies,
                    const std::string& authorization = "") {
  const Admission admission = CheckToken(
      {"op", "view"}, FindTokens(*ParseTarget(target), authorization, cookies, "kinescope_80"));
  return admission.access == Access::kDenied ? "" : std::string(Name(admission.role));
}

TEST(Access, IsOpenWithoutToken) { EXPECT_EQ(Check("", "/", ""), Access::kOpen); }

TEST(Access, AcceptsTheTokenFromQueryOrCookie) {
  EXPECT_EQ(Check("abc", "/?token=abc", ""), Access::kByQuery);
  EXPECT_EQ(Check("abc", "/", "kinescope_80=abc"), Access::kByCookie);
  EXPECT_EQ(Check("abc", "/", "a=b;  kinescope_80=abc ; c=d"), Access::kByCookie);
  EXPECT_EQ(Check("abc", "/?token=old", "kinescope_80=abc"), Access::kByCookie);
}

// A page on another port of the same host can set cookies of our name for longer paths.
TEST(Access, AcceptsTheTokenFromAnyOfSeveralCookiesOfItsName) {
  EXPECT_EQ(Check("abc", "/", "kinescope_80=old; kinescope_80=abc"), Access::kByCookie);
  EXPECT_EQ(Check("abc", "/", "kinescope_80=abc;kinescope_80=old"), Access::kByCookie);
  EXPECT_EQ(Check("abc", "/", "kinescope_80=old; kinescope_80=older"), Access::kDenied);
}

TEST(Access, AcceptsTheTokenAsABearerToken) {
  EXPECT_EQ(Check("abc", "/", "", "Bearer abc"), Access::kByHeader);
  EXPECT_EQ(Check("abc", "/", "kinescope_80=old", "bearer  abc "), Access::kByHeader);
  for (const char* authorization : {"abc", "Bearer", "Bearer ", "Bearer abcd", "Basic abc"}) {
    EXPECT_EQ(Check("abc", "/", "", authorization), Access::kDenied) << authorization;
  }
}

TEST(Access, GivesTheRoleOfTheToken) {
  EXPECT_EQ(RoleFor("/?token=op", ""), "operator");
  EXPECT_EQ(RoleFor("/?token=view", ""), "viewer");
  EXPECT_EQ(RoleFor("/", "", "Bearer view"), "viewer");
  EXPECT_EQ(RoleFor("/", "kinescope_80=view"), "viewer");
  EXPECT_EQ(RoleFor("/", "kinescope_80=view; kinescope_80=op"), "operator") << "the highest";
  EXPECT_EQ(RoleFor("/?token=view", "kinescope_80=op"), "viewer") << "a link gives its own role";
  EXPECT_EQ(RoleFor("/?token=other", "kinescope_80=view"), "viewer");
  EXPECT_EQ(RoleFor("/?token=other", ""), "");
  EXPECT_EQ(RoleFor("/", ""), "");
  EXPECT_EQ(CheckToken({}, {}).role, Role::kOperator) << "no token is set";
}

// Without a token of viewers, an empty token is not theirs.
TEST(Access, HasNoViewersWithoutTheirToken) {
  for (const char* target : {"/?token=", "/?token=view"}) {
    EXPECT_EQ(CheckToken({"op", ""}, FindTokens(*ParseTarget(target), "", "", "c")).access,
              Access::kDenied)
        << target;
  }
}

TEST(Access, MakesTokensThatCannotBeGuessed) {
  const std::string token = RandomToken();
  EXPECT_GE(token.size(), 2 * kMinTokenLength);
  EXPECT_TRUE(FitsIntoCookie(token));
  EXPECT_NE(RandomToken(), token);
  EXPECT_EQ(Shortened("0123456789abcdef"), "0123...");
}

TEST(Access, KnowsRequestsOfOtherSites) {
  for (const char* site : {"", "same-origin", "none"})
    EXPECT_FALSE(IsFromAnotherSite(site)) << site;
  for (const char* site : {"cross-site", "same-site", "anything"}) {
    EXPECT_TRUE(IsFromAnotherSite(site)) << site;
  }
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
