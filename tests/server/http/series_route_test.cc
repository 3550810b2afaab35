// /api/v1/series, without a socket: what it answers and what it rejects.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "server/history/history.h"
#include "server/http/router.h"
#include "server/http/series_json.h"
#include "tests/folders.h"
#include "tests/server/http/test_scene.h"

namespace kinescope::http::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class SeriesRouteTest : public ::testing::Test {
 protected:
  Answer Get(const std::string& query, bool has_history = true) {
    Router::Site site;
    site.states = &states_;
    site.history = has_history ? &history_ : nullptr;
    site.count_refusal = [this](const std::string& reason) { ++refusals_[reason]; };
    Request request;
    request.method = "GET";
    request.target = "/api/v1/series" + query;
    request.host = "localhost:8080";
    return Router(std::move(site)).Route(request);
  }

  void Fill() {
    const auto model = MakePersonModel();
    for (std::uint64_t number = 1; number <= 100; ++number) {
      auto state = std::make_shared<SceneState>(
          MakeScene(number, static_cast<double>(number) / 60, 1, model, 2));
      state->made_nanos = static_cast<std::int64_t>(number) * 10'000'000;  // 10 ms apart
      state->people[0].forces.lumbar->compression = number == 42 ? 4000 : 2000;
      history_.Add(state);
    }
  }

  history::History history_;
  Latest<SceneState> states_;
  std::map<std::string, int> refusals_;
};

TEST_F(SeriesRouteTest, AnswersLeastAndMostOfEachColumnAndNullWithoutAValue) {
  Fill();
  const Answer answer = Get(
      "?person=0&keys=l5_s1,compression,left_ankle&from=0&to=2000000&columns=20&token=of-others");
  ASSERT_EQ(answer.status, 200) << answer.body;
  EXPECT_EQ(answer.content_type, "application/json");
  const json body = json::parse(answer.body);
  EXPECT_EQ(body["person"], 0);
  EXPECT_EQ(body["from"], 0);
  EXPECT_EQ(body["to"], 2'000'000);
  EXPECT_EQ(body["samples"].size(), 20u);
  EXPECT_EQ(body["samples"][0], 9) << "the first sample is number 1";
  EXPECT_EQ(body["samples"][5], 10);
  EXPECT_EQ(body["samples"][11], 0);
  const json& compression = body["keys"]["compression"];
  EXPECT_EQ(compression["unit"], "N");
  EXPECT_EQ(compression["max"][4], 4000);
  EXPECT_EQ(compression["min"][4], 2000);
  EXPECT_EQ(compression["last"][4], 2000);
  EXPECT_EQ(compression["max"][5], 2000);
  EXPECT_TRUE(compression["max"][11].is_null());
  EXPECT_NEAR(body["keys"]["l5_s1"]["max"][3].get<double>(), 0.9, 0.021);
  for (const json& value : body["keys"]["left_ankle"]["min"]) EXPECT_TRUE(value.is_null());
}

TEST_F(SeriesRouteTest, NamesTheValueThatItRejects) {
  Fill();
  const std::string good = "person=0&from=0&to=1000&columns=5";
  std::string many = "rate";
  for (int i = 0; i < 24; ++i) many += ",rate";
  for (const auto& [query, part] : std::map<std::string, std::string>{
           {"keys=rate&from=0&to=9&columns=5", "set person="},
           {"person=x&keys=rate&from=0&to=9&columns=5", "person=x: expected a whole number"},
           {"person=-1&keys=rate&from=0&to=9&columns=5", "person=-1: "},
           {good, "set keys="},
           {good + "&keys=", "keys=: unknown key; expected l5_s1, "},
           {good + "&keys=rate,elbow", "keys=elbow: unknown key"},
           {good + "&keys=rate,", "keys=: unknown key"},
           {good + "&keys=" + many, "25 keys; expected 1 to 24"},
           {good + "&keys=rate&colums=3", "colums=3: expected person, keys"},
           {"person=0&keys=rate&from=9&to=9&columns=5", "to=9: expected a whole number from 10 to"},
           {"person=0&keys=rate&from=1e3&to=9&columns=5", "from=1e3: "},
           {"person=0&keys=rate&from=0&to=86400000001&columns=5", "to=86400000001: "},
           {"person=0&keys=rate&from=9000000000000001&to=9&columns=5", "from=9000000000000001: "},
           {"person=0&keys=rate&from=0&to=9&columns=0",
            "columns=0: expected a whole number from 1"},
           {"person=0&keys=rate&from=0&to=9&columns=4097", "columns=4097: "},
           {"person=0&keys=rate,l5_s1,loss,margin,com_x&from=0&to=9&columns=4001",
            "columns=4001: 5 keys have at most 4000 columns"}}) {
    const Answer answer = Get("?" + query);
    EXPECT_EQ(answer.status, 400) << query;
    EXPECT_THAT(json::parse(answer.body)["error"].get<std::string>(), HasSubstr(part)) << query;
  }
  EXPECT_EQ(refusals_["bad series"], 16);
}

TEST_F(SeriesRouteTest, SaysWhichPeopleThereAre) {
  const std::string rest = "&keys=rate&from=0&to=1000&columns=5";
  EXPECT_THAT(Get("?person=0" + rest).body, HasSubstr("no person has been in the stream yet"));
  Fill();
  const Answer answer = Get("?person=7" + rest);
  EXPECT_EQ(answer.status, 404);
  EXPECT_THAT(answer.body, HasSubstr("person=7: no samples are kept; expected 0, 1"));
  EXPECT_EQ(Get("?person=1" + rest).status, 200);
  EXPECT_EQ(Get("?person=1" + rest, false).status, 503);
}

TEST_F(SeriesRouteTest, TheManualHasEveryKeyAndLimit) {
  std::ifstream file(kinescope::testing::InSourceTree("docs/http.md"));
  const std::string manual{std::istreambuf_iterator<char>(file), {}};
  for (const history::SeriesKey& key : history::SeriesKeys()) {
    EXPECT_THAT(manual, HasSubstr('`' + std::string(key.name) + '`'));
  }
  EXPECT_THAT(manual, HasSubstr("at most " + std::to_string(kMostSeriesKeys) + " keys, " +
                                std::to_string(kMostSeriesColumns) + " columns and " +
                                std::to_string(kMostSeriesCells) + " values"));
}

}  // namespace
}  // namespace kinescope::http::testing
