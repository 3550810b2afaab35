// What a browser receives without the right token.
#include "server/http/token_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/server/http/test_server.h"

namespace kinescope::http::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

// As a browser asks for an address that was typed.
const std::string kBrowser = "text/html,application/xhtml+xml,*/*;q=0.8";

TEST(TokenPage, IsForBrowsersAndJsonForOtherClients) {
  const TestServer site("s3cret-of-the-lab");
  for (const char* target : {"/", "/api/v1/state", "/api/v1/snapshot.png", "/nothing"}) {
    const Response page = site.Get(target, {{"Accept", kBrowser}});
    EXPECT_EQ(page.status, 401) << target;
    EXPECT_EQ(page.headers.at("content-type"), "text/html; charset=utf-8") << target;
    EXPECT_THAT(page.body, AllOf(HasSubstr("<label for=\"token\">"), HasSubstr("name=\"token\""),
                                 HasSubstr("token missing"),
                                 HasSubstr("action=\"" + std::string(target) + "\"")));
    for (const char* accept : {"", "*/*", "application/json", "image/avif,image/webp,*/*;q=0.8"}) {
      const Response json = site.Get(target, {{"Accept", accept}});
      EXPECT_EQ(json.status, 401) << target;
      EXPECT_THAT(json.json().at("error").get<std::string>(), StartsWith("token missing"));
    }
  }
}

// The policy of the page permits no form.
TEST(TokenPage, MaySendItsFormAndNothingElse) {
  const TestServer site("s3cret-of-the-lab");
  const Response page = site.Get("/", {{"Accept", kBrowser}});
  const std::string policy = page.headers.at("content-security-policy");
  EXPECT_THAT(policy, AllOf(HasSubstr("form-action 'self'"), HasSubstr("default-src 'none'"),
                            Not(HasSubstr("script-src")), Not(HasSubstr("unsafe"))));
  const std::size_t nonce = policy.find("nonce-") + 6;
  EXPECT_THAT(page.body, HasSubstr("<style nonce=\"" +
                                   policy.substr(nonce, policy.find('\'', nonce) - nonce) + "\">"));
  EXPECT_EQ(page.headers.at("cache-control"), "no-store");
  EXPECT_NE(site.Get("/", {{"Accept", kBrowser}}).headers.at("content-security-policy"), policy);
}

TEST(TokenPage, IsAlsoTheAnswerToAWrongTokenAndToTooManyOfThem) {
  const TestServer site("s3cret-of-the-lab");
  int statuses[2] = {};
  for (int i = 0; i < 11; ++i) {
    const Response page =
        site.Get("/?token=guess-number-" + std::to_string(i), {{"Accept", kBrowser}});
    ++statuses[page.status == 429 ? 1 : 0];
    EXPECT_THAT(page.body, AllOf(HasSubstr("wrong token"), HasSubstr("<form"),
                                 Not(HasSubstr("guess-number"))));
  }
  EXPECT_EQ(statuses[0], 10);
  EXPECT_EQ(statuses[1], 1);
}

TEST(TokenPage, LeadsToTheMomentOfALink) {
  const Answer page = TokenPage(401, "token missing", *ParseTarget("/?t=12.5&token=old"));
  EXPECT_THAT(page.body, HasSubstr(R"(<input type="hidden" name="t" value="12.5">)"));
  EXPECT_THAT(page.body, Not(HasSubstr("old")));
}

TEST(TokenPage, HasNoMarkupOfARequest) {
  const Answer page = TokenPage(
      401, "<b>", *ParseTarget("/%3Cscript%3E%22'?%22%3E%3Cscript%3E=%3Cimg%20src=x%3E&a=%27%26"));
  for (const char* markup : {"<script", "<img", "<b>", "\"'", "=\"'"}) {
    EXPECT_THAT(page.body, Not(HasSubstr(markup)));
  }
  EXPECT_THAT(page.body, AllOf(HasSubstr("action=\"/%3Cscript%3E%22%27\""),
                               HasSubstr("name=\"a\" value=\"&#39;&amp;\"")));
}

}  // namespace
}  // namespace kinescope::http::testing
