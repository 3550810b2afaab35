#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/http/hand_load_order.h"
#include "tests/server/http/test_server.h"

namespace kinescope::http::testing {
namespace {

using ::testing::HasSubstr;

constexpr char kFive[] = R"({"right_kg": 5, "left_kg": 0.5})";

Response Post(const TestServer& site, const std::string& body, Headers headers = {},
              const std::string& target = "/api/v1/hand_load") {
  headers.try_emplace("Content-Type", "application/json");
  return Fetch(site.server.port(), target, headers, "POST", body);
}

TEST(HandLoadOrder, IsOneObjectOfMasses) {
  const auto order = ParseHandLoadOrder(kFive);
  ASSERT_TRUE(order) << order.error();
  EXPECT_TRUE(order->load.is_known);
  EXPECT_EQ(order->load.mass_kg[urdf::kRight], 5);
  EXPECT_EQ(order->load.mass_kg[urdf::kLeft], 0.5);
  EXPECT_EQ(order->load.both_kg, 0);
  EXPECT_FALSE(order->person);
  EXPECT_EQ(ParseHandLoadOrder(R"({"person": 3, "both_kg": 2})")->person, 3);
}

TEST(HandLoadOrder, ContainsThePositionOfTheLoad) {
  const auto order = ParseHandLoadOrder(R"({"right_kg": 2, "right_com_m": [0.1, 0, -0.25]})");
  ASSERT_TRUE(order);
  ASSERT_TRUE(order->load.com_in_hand[urdf::kRight]);
  EXPECT_EQ(*order->load.com_in_hand[urdf::kRight], Eigen::Vector3d(0.1, 0, -0.25));
  EXPECT_FALSE(order->load.com_in_hand[urdf::kLeft]);
}

TEST(HandLoadOrder, IsRejectedIfItIsInvalid) {
  for (const std::string& body :
       {std::string(), std::string("{}"), std::string("5"), std::string("[5]"), std::string("{"),
        std::string(R"({"right_kg": "5"})"), std::string(R"({"right": 5})"),
        std::string(R"({"right_kg": null})"), std::string(R"({"right_kg": 1e999})"),
        std::string(R"({"right_com_m": [0, 0]})"), std::string(R"({"right_com_m": [0, 0, null]})"),
        std::string(R"({"right_com_m": 0.2})"), std::string(R"({"person": -1, "right_kg": 5})"),
        std::string(R"({"person": 1.5, "right_kg": 5})"),
        std::string(R"({"person": 99999999999, "right_kg": 5})"), std::string(2000, '{')}) {
    const auto order = ParseHandLoadOrder(body);
    EXPECT_FALSE(order) << body;
  }
}

TEST(HandLoadRoute, AppliesTheLoadAndReturnsTheAcceptedValues) {
  TestServer site;
  site.PublishState(1);
  const Response answer = Post(site, kFive);
  EXPECT_EQ(answer.status, 200) << answer.body;
  EXPECT_EQ(answer.json()["right_kg"], 5);
  EXPECT_EQ(site.Told().at(0).mass_kg[urdf::kLeft], 0.5);
}

TEST(HandLoadRoute, RejectsOtherOriginsTypesAndMethodsAndCountsThem) {
  TestServer site;
  site.PublishState(1);
  const std::string own = "http://127.0.0.1:" + std::to_string(site.server.port());
  EXPECT_EQ(Post(site, kFive, {{"Origin", own}}).status, 200);
  EXPECT_EQ(Post(site, kFive, {{"Origin", "http://elsewhere.example"}}).status, 403);
  EXPECT_EQ(Post(site, kFive, {{"Content-Type", "text/plain"}}).status, 415)
      << "what any page's form could send";
  EXPECT_EQ(Post(site, kFive, {{"Content-Type", "application/json; charset=utf-8"}}).status, 200);
  EXPECT_EQ(Post(site, kFive, {}, "/api/v1/state").status, 405);
  EXPECT_EQ(site.Get("/api/v1/hand_load").status, 405);
  EXPECT_EQ(site.Get("/api/v1/hand_load").headers.at("allow"), "POST");
  EXPECT_EQ(Fetch(site.server.port(), "/api/v1/hand_load", {}, "OPTIONS").status, 405)
      << "a browser asks so for a foreign page";
  EXPECT_EQ(Post(site, "{}").status, 400);
  const Response too_heavy = Post(site, R"({"right_kg": 101})");
  EXPECT_EQ(too_heavy.status, 400);
  EXPECT_THAT(too_heavy.body, HasSubstr("nobody holds that"));
  EXPECT_EQ(Post(site, R"({"right_kg": 5, "person": 7})").status, 404);
  EXPECT_EQ(Post(site, std::string(5000, ' ')).status, 413);
  const auto rejected = site.HttpCounters()["rejected"];
  EXPECT_EQ(rejected["foreign origin"], 1);
  EXPECT_EQ(rejected["bad content type"], 1);
  EXPECT_EQ(rejected["bad hand load"], 2);
}

TEST(HandLoadRoute, NeedsTheTokenAndAPerson) {
  TestServer site("s3cret-of-the-lab");
  EXPECT_EQ(Post(site, kFive).status, 401);
  EXPECT_EQ(Post(site, kFive, {}, "/api/v1/hand_load?token=s3cret-of-the-lab").status, 409)
      << "nobody is here";
  site.PublishState(1);
  EXPECT_EQ(Post(site, kFive, {}, "/api/v1/hand_load?token=s3cret-of-the-lab").status, 200);
  EXPECT_EQ(site.Told().size(), 1u);
}

TEST(StateJson, ContainsTheInputsOfTheLoads) {
  TestServer site;
  site.PublishState(1);
  const auto person = site.Get("/api/v1/state").json()["people"][0];
  const auto& forces = person["forces"];
  EXPECT_EQ(forces["metric"], "total");
  EXPECT_EQ(forces["mode"], "dynamic");
  EXPECT_EQ(forces["body_mass_is_assumed"], true);
  EXPECT_EQ(forces["hand_load"]["right_kg"], 5);
  EXPECT_EQ(forces["hands"]["right"]["held_kg"], 5);
  EXPECT_EQ(forces["support"].size(), 4u);
  EXPECT_EQ(forces["l5_s1_compression_n"], 2150);
  EXPECT_TRUE(forces["com_minus_mvn_m"].is_null());
  EXPECT_TRUE(person["loads"][0]["secs_in_band"].contains("high"));
}

}  // namespace
}  // namespace kinescope::http::testing
