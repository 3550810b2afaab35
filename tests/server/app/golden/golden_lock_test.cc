#include "server/app/golden/golden_lock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "server/app/golden/finding.h"
#include "server/app/golden/golden_changes.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

AcceptedCase Sample() {
  AcceptedCase accepted;
  accepted.pixels_sha256 = "ab";
  accepted.file_sha256 = "cd";
  accepted.width = 640;
  accepted.height = 360;
  accepted.options = {{"source", "walk.mvnx"}, {"time", 2}};
  accepted.inputs = {{"source", "walk.mvnx", "0123456789abcdef"}};
  accepted.environment = {{"renderer", "llvmpipe"}};
  ObjectFact knee;
  knee.name = "left_knee \"of\" person 2";
  knee.load_class = LoadClass::kHigh;
  knee.ratio = 0.7142;
  knee.pixels = 12;
  knee.through = 34;
  knee.x_px = 100.04;
  accepted.facts.objects = {knee};
  accepted.facts.texts = {{"title", "a “lift”", 1, 2}};
  accepted.facts.cameras = {{"front", render::Camera()}};
  return accepted;
}

TEST(GoldenLock, IsReadAsItWasWritten) {
  const testing::TempFolder folder;
  const auto path = folder.path() / "golden.lock";
  EXPECT_THAT(ReadLock(path), IsEmpty());
  WriteLock(path, {{"a", Sample()}, {"b", AcceptedCase()}});
  const GoldenLock lock = ReadLock(path);
  ASSERT_EQ(lock.size(), 2u);
  EXPECT_EQ(ToJson(lock.at("a")), ToJson(Sample()));
  EXPECT_THAT(Compare(lock.at("a").facts, Sample().facts), IsEmpty());
  const GoldenChanges changes = ChangesBetween(lock.at("a"), Sample());
  EXPECT_THAT(changes.options, IsEmpty());
  EXPECT_THAT(changes.inputs, IsEmpty());
  EXPECT_THAT(changes.environment, IsEmpty());
}

TEST(GoldenLock, NamesItselfWhereItIsDamaged) {
  const testing::TempFolder folder;
  const auto path = folder.path() / "golden.lock";
  const auto complaint = [&](const std::string& text) -> std::string {
    std::ofstream(path) << text;
    try {
      ReadLock(path);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(complaint("{\"schema\": 1,\n<<<<<<< ours"), HasSubstr("golden.lock: "));
  EXPECT_THAT(complaint("{\"schema\": 1, \"cases\": {\"a\": {}}}"), HasSubstr("golden.lock: "));
  EXPECT_THAT(complaint("{\"schema\": 7, \"cases\": {}}"), HasSubstr("schema 7"));
  EXPECT_THAT(complaint("{\"schema\": 1, \"cases\": {\"a\": {}, \"b\": {}, \"a\": {}}}"),
              HasSubstr("\"a\" stands there twice"));
}

TEST(GoldenChanges, SayWhatDecidedAnotherPicture) {
  const AcceptedCase then = Sample();
  AcceptedCase now = then;
  EXPECT_EQ(CauseOf(ChangesBetween(then, now)), "program");
  now.environment["renderer"] = "softpipe";
  EXPECT_EQ(CauseOf(ChangesBetween(then, now)), "environment");
  now.inputs[0].sha256 = "fedcba9876543210";
  EXPECT_EQ(CauseOf(ChangesBetween(then, now)), "recording");
  EXPECT_THAT(ChangesBetween(then, now).inputs,
              ElementsAre("source: the content of walk.mvnx has changed (SHA-256 was "
                          "0123456789ab…, is fedcba987654…)"));
  now.options["time"] = 2.5;
  now.options["camera"] = "front";
  EXPECT_EQ(CauseOf(ChangesBetween(then, now)), "case");
  EXPECT_THAT(ChangesBetween(then, now).options,
              ElementsAre("camera: added, front", "time: was 2, is 2.5"));
  EXPECT_THAT(CauseText(ChangesBetween(then, now)), HasSubstr("says nothing about the program"));
}

TEST(PixelsHash, IsOfSizeAndPixels) {
  render::Image wide, high;
  wide.width = high.height = 4;
  wide.height = high.width = 2;
  wide.rgba.assign(32, 7);
  high.rgba.assign(32, 7);
  EXPECT_NE(PixelsHash(wide), PixelsHash(high));
  high.width = 4;
  high.height = 2;
  EXPECT_EQ(PixelsHash(wide), PixelsHash(high));
  high.rgba[5] = 8;
  EXPECT_NE(PixelsHash(wide), PixelsHash(high));
  EXPECT_EQ(PixelsHash(wide).size(), 64u);
}

}  // namespace
}  // namespace kinescope::app
