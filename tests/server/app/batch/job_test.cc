#include "server/app/batch/job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/system/errors.h"
#include "server/app/batch/job_command.h"
#include "server/app/batch/label_pattern.h"
#include "server/app/render/draw_pools.h"
#include "server/app/shard.h"

namespace kinescope::app {
namespace {

using ::testing::HasSubstr;

// Why ReadJob() refuses a line; "": it does not.
std::string RefusalOf(const std::string& line) {
  try {
    ReadJob(line);
    return "";
  } catch (const UsageError& error) {
    return error.what();
  }
}

TEST(Jobs, AreReadAsTheyAreWritten) {
  const std::string line =
      R"({"id":"s1","command":"loads","labels":{"person":"P1"},"options":{"csv":"a.csv","mass":80}})";
  const Job job = ReadJob(line);
  EXPECT_EQ(job.id, "s1");
  EXPECT_EQ(job.command, "loads");
  EXPECT_EQ(job.labels.at("person"), "P1");
  EXPECT_EQ(job.options.at("mass"), 80);
  EXPECT_EQ(ToLine(job), line);
}

TEST(Jobs, SayWhatIsWrongWithALine) {
  EXPECT_THAT(RefusalOf("{"), HasSubstr("not valid JSON: parse error"));
  EXPECT_THAT(RefusalOf(std::string(100'000, '[')), HasSubstr("more than 8 levels"));
  EXPECT_THAT(RefusalOf("[]"), HasSubstr("expected an object"));
  EXPECT_THAT(RefusalOf(R"({"id":"a"})"), HasSubstr("'command' is missing"));
  EXPECT_THAT(RefusalOf(R"({"command":"render"})"), HasSubstr("'id' is missing"));
  EXPECT_THAT(RefusalOf(R"({"id":"","command":"render"})"), HasSubstr("'id': expected 1 to"));
  EXPECT_THAT(RefusalOf("{\"id\":\"a\\u001b[2J\",\"command\":\"render\"}"), HasSubstr("'id'"));
  EXPECT_THAT(RefusalOf(R"({"id":7,"command":"render"})"), HasSubstr("'id': expected a text"));
  EXPECT_THAT(
      RefusalOf(R"({"id":"a","command":"rendr"})"),
      HasSubstr("command=rendr: expected render, loads, convert or golden; nearest: render"));
  EXPECT_THAT(RefusalOf(R"({"id":"a","command":"render","source":"x"})"),
              HasSubstr("'source': expected id, command, options or labels"));
  EXPECT_THAT(RefusalOf(R"({"id":"a","command":"render","options":[]})"), HasSubstr("'options'"));
  EXPECT_THAT(RefusalOf(R"({"id":"a","command":"render","labels":{"p":1}})"),
              HasSubstr("'labels.p': expected a text"));
  EXPECT_THAT(RefusalOf(R"({"id":"a","command":"render","options":{"out":"a","out":"b"}})"),
              HasSubstr("'out' is given twice"));
}

TEST(Jobs, HaveADigestOfWhatDecidesTheirResult) {
  Job job = ReadJob(R"({"id":"a","command":"loads","options":{"csv":"a.csv","mass":80}})");
  Job same = ReadJob(R"({"options":{"mass":80,"csv":"a.csv"},"command":"loads","id":"b"})");
  EXPECT_EQ(job.Digest(), same.Digest());
  same.labels["person"] = "P1";
  EXPECT_EQ(job.Digest(), same.Digest());
  same.options["mass"] = 81;
  EXPECT_NE(job.Digest(), same.Digest());
}

// Of the command that a job with these options runs.
std::string ErrorOf(const std::string& options) {
  const auto pools = std::make_shared<DrawPools>();
  try {
    OutputsOf(
        CommandOf(ReadJob(R"({"id":"a","command":"loads","options":)" + options + "}"), pools));
    return "";
  } catch (const UsageError& error) {
    return error.what();
  }
}

TEST(Jobs, SetTheOptionsOfTheirCommand) {
  EXPECT_EQ(ErrorOf(R"({"source":"demo:lift","mass":80,"csv":"a.csv"})"), "");
  EXPECT_THAT(ErrorOf(R"({"source":"demo:lift","mas":80})"),
              HasSubstr("unknown option 'mas'; nearest: mass (see kinescope loads --help)"));
  EXPECT_THAT(ErrorOf(R"({"source":"demo:lift","mass":"heavy"})"),
              HasSubstr("mass=heavy: expected"));
  EXPECT_THAT(ErrorOf(R"({"source":"demo:lift","mass":{"kg":80}})"),
              HasSubstr("mass: expected a text, a number, true or false"));
  EXPECT_THAT(ErrorOf(R"({"csv":"a.csv"})"), HasSubstr("--source is missing"));
  EXPECT_THAT(ErrorOf(R"({"source":"demo:lift","csv":"-"})"), HasSubstr("csv=-: standard output"));
  EXPECT_THAT(ErrorOf(R"({"source":"demo:lift","layout":"long"})"),
              HasSubstr("layout=long: has no effect without --csv"));
}

TEST(Jobs, TakeListsAsArrays) {
  const auto pools = std::make_shared<DrawPools>();
  const Job job = ReadJob(
      R"({"id":"a","command":"render","options":{"source":["demo:lift"],"out":["a;b.png","c.png"],
          "camera":["front","0,-4,1:0,0,1"]}})");
  Command command = CommandOf(job, pools);
  EXPECT_EQ(command.options.Find("out")->value->ToTexts(),
            (std::vector<std::string>{"a;b.png", "c.png"}));
  EXPECT_EQ(command.options.Find("camera")->value->ToText(), "front;0,-4,1:0,0,1");
}

Shard ParseShard(const std::string& text) {
  ShardValue value;
  value.Parse(text);
  return *value;
}

// Others compute the same: sha256sum | cut -c1-16, modulo the number of shares.
TEST(Shards, FollowFromTheIdAlone) {
  EXPECT_TRUE(ParseShard("8/16").Has("s1"));  // e8bc163c82eee187
  EXPECT_TRUE(ParseShard("1/1").Has("anything"));
  for (int i = 0; i < 200; ++i) {
    int owners = 0;
    for (int k = 1; k <= 7; ++k) owners += Shard{k, 7}.Has("job" + std::to_string(i)) ? 1 : 0;
    EXPECT_EQ(owners, 1);
  }
}

using Labels = std::map<std::string, std::string>;

std::optional<Labels> LabelsBy(const std::string& pattern, const std::string& name) {
  LabelPattern labels;
  labels.Parse(pattern);
  return labels.Of(name);
}

TEST(LabelPatterns, ReadLabelsFromNames) {
  EXPECT_EQ(LabelsBy("{person}_{task}_{n}", "S07_lift_003"),
            (Labels{{"person", "S07"}, {"task", "lift"}, {"n", "003"}}));
  EXPECT_EQ(LabelsBy("trial-{n}", "trial-7"), (Labels{{"n", "7"}}));
  EXPECT_EQ(LabelsBy("{a}-x", "1-x-x"), (Labels{{"a", "1-x"}}));
  EXPECT_EQ(LabelsBy("{person}_{task}", "S07_lift_003"),
            (Labels{{"person", "S07"}, {"task", "lift_003"}}));
  for (const char* const name : {"S07", "S07_", "_lift", ""}) {
    EXPECT_EQ(LabelsBy("{person}_{task}", name), std::nullopt) << name;
  }
  EXPECT_EQ(LabelsBy("trial-{n}", "Trial-7"), std::nullopt);
  EXPECT_EQ(LabelsBy("{a}-x", "-x"), std::nullopt);
}

TEST(LabelPatterns, RefuseWhatHasNoClearEnd) {
  LabelPattern labels;
  for (const char* const text : {"", "plain", "{a}{b}", "{a", "{}", "{a}_{a}", "{a b}"}) {
    EXPECT_THROW(labels.Parse(text), options::BadValue) << text;
  }
}

}  // namespace
}  // namespace kinescope::app
