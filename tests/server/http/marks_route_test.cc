// /api/v1/marks and /api/v1/mark, without a socket: what they answer and what they reject.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "server/history/history.h"
#include "server/http/mark_order.h"
#include "server/http/router.h"
#include "server/marks/mark_book.h"
#include "tests/server/http/test_scene.h"
#include "tests/temp_folder.h"

namespace kinescope::http::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class MarksRouteTest : public ::testing::Test {
 protected:
  MarksRouteTest() {
    const auto model = MakePersonModel();
    for (std::uint64_t number = 1; number <= 100; ++number) {
      auto state = std::make_shared<SceneState>(
          MakeScene(number, static_cast<double>(number) / 60, 1, model, 2));
      state->made_nanos = static_cast<std::int64_t>(number) * 10'000'000;  // 10 ms apart
      if (number == 1) state->stamp_nanos = 0;
      history_.Add(state);
    }
  }

  Answer Ask(Request request) {
    Router::Site site;
    site.tokens = {kOperatorToken, kViewerToken};
    site.states = &states_;
    site.history = has_history_ ? &history_ : nullptr;
    site.marks = &book_;
    site.count_refusal = [this](const std::string& reason) { ++refusals_[reason]; };
    request.host = "localhost:8080";
    if (request.authorization.empty())
      request.authorization = std::string("Bearer ") + kOperatorToken;
    return Router(std::move(site)).Route(request);
  }
  Answer Get(const std::string& query = "", const std::string& token = kOperatorToken) {
    Request request;
    request.method = "GET";
    request.target = "/api/v1/marks" + query;
    request.authorization = "Bearer " + token;
    return Ask(request);
  }
  Answer Post(const std::string& body) {
    Request request;
    request.method = "POST";
    request.target = "/api/v1/mark";
    request.content_type = "application/json";
    request.body = body;
    return Ask(request);
  }

  const kinescope::testing::TempFolder folder_;
  bool has_history_ = true;
  history::History history_;
  marks::MarkBook book_{{folder_ / "marks.jsonl", {"lift", "lower"}}};
  Latest<SceneState> states_;
  std::map<std::string, int> refusals_;
};

TEST_F(MarksRouteTest, AMarkHasTheSampleThatItsAuthorSaw) {
  const Answer answer = Post(R"({"state": 42, "button": 2})");
  ASSERT_EQ(answer.status, 200) << answer.body;
  const json mark = json::parse(answer.body);
  const auto state = history_.Numbered(42);
  EXPECT_EQ(mark["text"], "lower");
  EXPECT_EQ(mark["role"], "operator");
  EXPECT_EQ(mark["at"]["state"], 42);
  EXPECT_EQ(mark["at"]["counter"], state->counter);
  EXPECT_EQ(mark["at"]["micros"], 420'000);
  EXPECT_EQ(mark["at"]["stamp_micros"], state->stamp_nanos / 1000);
  EXPECT_NEAR(mark["behind_secs"], 0.58, 1e-9);
  EXPECT_EQ(mark["window_stamp_micros"][1].get<std::int64_t>() -
                mark["window_stamp_micros"][0].get<std::int64_t>(),
            6'000'000);
  EXPECT_EQ(json::parse(Get().body)["marks"], json::array({mark}));
}

TEST_F(MarksRouteTest, ASpanIsBegunAndEndedAndAMarkIsRemoved) {
  const json begun =
      json::parse(Post(R"({"state": 20, "text": "<b>&\u00e9", "is_span": true})").body);
  EXPECT_EQ(begun["is_open"], true);
  EXPECT_EQ(begun["text"], "<b>&\u00e9");
  const json ended = json::parse(Post(R"({"id": 1, "state": 60})").body);
  EXPECT_EQ(ended["end"]["state"], 60);
  EXPECT_EQ(json::parse(Get("?after=1").body)["marks"], json::array({ended}));
  EXPECT_EQ(json::parse(Post(R"({"id": 1, "remove": true})").body)["is_removed"], true);
  const json after = json::parse(Get("?after=2").body);
  EXPECT_EQ(after["marks"][0]["is_removed"], true);
  EXPECT_EQ(after["revision"], 3);
  EXPECT_EQ(json::parse(Get().body)["marks"], json::array());
}

TEST_F(MarksRouteTest, RefusesMomentsThatWereNotSeenAndSaysWhy) {
  const auto expect = [&](const std::string& body, int status, const std::string& why) {
    const Answer answer = Post(body);
    EXPECT_EQ(answer.status, status) << body;
    EXPECT_THAT(answer.body, HasSubstr(why)) << body;
  };
  expect(R"({"state": 101, "button": 1})", 409,
         "state 101 has not come yet; the newest one is 100");
  expect(R"({"state": 9007199254740992, "button": 1})", 409, "has not come yet");
  expect(R"({"state": 1, "button": 1})", 409, "state 1 has no sample");
  expect(R"({"state": 0, "button": 1})", 410, "state 0 is no longer kept");
  expect(R"({"state": 50, "button": 3})", 409, "button 3: there are 2");
  expect(R"({"id": 8, "state": 50})", 409, "there is no mark 8");
  expect(R"({"id": 8, "remove": true})", 409, "there is no mark 8");
  EXPECT_EQ(refusals_["mark not kept"], 3);
  has_history_ = false;
  expect(R"({"state": 50, "button": 1})", 503, "--history_minutes=0");
  EXPECT_EQ(Get().status, 503);
  EXPECT_FALSE(std::filesystem::exists(book_.file()));
}

TEST_F(MarksRouteTest, NamesTheMemberThatIsWrong) {
  const std::string long_text(kLongestMark + 1, 'x');
  for (const auto& [body, why] : std::map<std::string, std::string>{
           {"", "expected {"},
           {"[]", "expected {"},
           {"{}", "expected {"},
           {R"({"state": 5})", "expected {"},
           {R"({"button": 1})", "expected {"},
           {R"({"state": 5, "button": 1, "text": "x"})", "expected {"},
           {R"({"id": 5, "state": 5, "text": "x"})", "expected {"},
           {R"({"id": 5, "state": 5, "remove": true})", "expected {"},
           {R"({"id": 5})", "expected {"},
           {R"({"state": -5, "button": 1})", "\\\"state\\\": unknown member or invalid value"},
           {R"({"state": 5, "button": 10})", "\\\"button\\\": unknown member or invalid value"},
           {R"({"state": 5, "button": 0})", "\\\"button\\\""},
           {R"({"state": 5, "text": "  "})", "text: it is empty"},
           {R"({"state": 5, "text": ")" + long_text + R"("})", "text: 201 characters"},
           {R"({"state": 5, "text": "x", "weather": 1})", "\\\"weather\\\""}}) {
    const Answer answer = Post(body);
    EXPECT_EQ(answer.status, 400) << body;
    EXPECT_THAT(answer.body, HasSubstr(why)) << body;
  }
  EXPECT_EQ(Get("?after=x").status, 400);
  EXPECT_EQ(Get("?before=1").status, 400);
}

TEST_F(MarksRouteTest, ATextIsOneLineOfValidCharacters) {
  const Answer answer = Post("{\"state\": 5, \"text\": \"a\\nb\\u202ec\"}");
  ASSERT_EQ(answer.status, 200) << answer.body;
  EXPECT_EQ(json::parse(answer.body)["text"], "a\uFFFDb\uFFFDc");
}

TEST_F(MarksRouteTest, ViewersReadMarksButNotTheFolder) {
  EXPECT_EQ(json::parse(Get().body)["file"], book_.file().string());
  const json seen = json::parse(Get("", kViewerToken).body);
  EXPECT_EQ(seen["names"], json::array({"lift", "lower"}));
  EXPECT_FALSE(seen.contains("file"));
}

}  // namespace
}  // namespace kinescope::http::testing
