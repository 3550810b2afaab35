#include "server/app/render/output_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/system/errors.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using ::testing::ElementsAre;

TEST(PathOfPicture, AcceptsTheNumberPatternsOfFfmpegAndBlender) {
  EXPECT_EQ(PathOfPicture("frames/%05d.png", 42), "frames/00042.png");
  EXPECT_EQ(PathOfPicture("a%d.png", 42), "a42.png");
  EXPECT_EQ(PathOfPicture("a-####.png", 42), "a-0042.png");
  EXPECT_EQ(PathOfPicture("#.png", 42), "42.png");
  EXPECT_EQ(PathOfPicture("%03d.png", 12345), "12345.png");
  // Only the file's own name has a number, and not every sign is one.
  EXPECT_EQ(PathOfPicture("#1/%02d.png", 3), "#1/03.png");
  EXPECT_EQ(PathOfPicture("100%.png", 3), "100%.png");
  EXPECT_EQ(PathOfPicture("%s.png", 3), "%s.png");
  EXPECT_EQ(PathOfPicture("%", 3), "%");
}

TEST(PlanOutputs, CombinesEverySourceWithEveryNameAndCamera) {
  const testing::TempFolder folder;
  RenderOptions options;
  options.sources = std::vector<std::string>{"demo:lift", "takes/one.mvnx.gz"};
  options.outs = std::vector<std::string>{folder / "{source} {camera}.mp4",
                                          folder / "{camera}-{source}-%d.png"};
  options.view.camera.Parse("front,top");
  const std::vector<SourcePlan> plans = PlanOutputs(options);
  ASSERT_EQ(plans.size(), 2u);
  EXPECT_EQ(plans[1].source, "takes/one.mvnx.gz");
  std::vector<std::string> paths;
  for (const Output& output : plans[1].outputs) paths.push_back(output.path);
  EXPECT_THAT(paths, ElementsAre(folder / "one front.mp4", folder / "one top.mp4",
                                 folder / "front-one-%d.png", folder / "top-one-%d.png"));
  EXPECT_EQ(plans[0].outputs[0].path, folder / "demo_lift front.mp4");
  EXPECT_EQ(plans[0].outputs[0].kind, OutputKind::kClip);
  EXPECT_EQ(plans[0].outputs[3].kind, OutputKind::kSequence);
  EXPECT_EQ(plans[0].outputs[3].camera, "top");
}

TEST(PlanOutputs, NamesThePlaceholderThatSeparatesTwoOutputs) {
  const testing::TempFolder folder;
  const auto message = [&](std::vector<std::string> sources, const std::string& camera,
                           const std::string& out) -> std::string {
    RenderOptions options;
    options.sources = std::move(sources);
    options.view.camera.Parse(camera);
    options.outs = std::vector<std::string>{folder / out};
    try {
      PlanOutputs(options);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "took it";
  };
  EXPECT_THAT(message({"a.mvnx", "b.mvnx"}, "front", "x.mp4"), ::testing::HasSubstr("{source}"));
  EXPECT_THAT(message({"a.mvnx"}, "front,top", "x.mp4"), ::testing::HasSubstr("{camera}"));
  EXPECT_THAT(message({"1/a.mvnx", "2/a.mvnx"}, "front", "{source}.mp4"),
              ::testing::HasSubstr("two outputs"));
  EXPECT_EQ(message({"a.mvnx", "b.mvnx"}, "front,top", "{source}{camera}.mp4"), "took it");
}

TEST(PlanOutputs, RejectsInvalidOutputsAndUnusedOptions) {
  const testing::TempFolder folder;
  const auto refuses = [&](const std::string& out, auto&& change) {
    RenderOptions options;
    options.sources = std::vector<std::string>{"demo:lift"};
    options.outs = std::vector<std::string>{out[0] == '/' ? out : (folder / out).string()};
    change(options);
    try {
      PlanOutputs(options);
    } catch (const UsageError&) {
      return true;
    }
    return false;
  };
  const auto as_is = [](RenderOptions&) {};
  EXPECT_FALSE(refuses("a.png", as_is));
  for (const char* out : {"a.avi", "a", "a%d-%d.png", "a%d.mp4", "no/such/a.png", "/proc/a", ""}) {
    EXPECT_TRUE(refuses(out, as_is)) << out;
  }
  EXPECT_TRUE(refuses(folder.path(), as_is)) << "a folder";
  const auto time = [](RenderOptions& o) { o.moment.time = 1.0; };
  const auto both = [](RenderOptions& o) { o.moment.time = 1.0, o.moment.sample = 1L; };
  const auto start = [](RenderOptions& o) { o.clip.start = 1.0; };
  const auto crf = [](RenderOptions& o) { o.pack.crf = 20L; };
  EXPECT_FALSE(refuses("a.png", time));
  EXPECT_TRUE(refuses("a.png", both));
  EXPECT_TRUE(refuses("a.png", start));
  EXPECT_TRUE(refuses("a.mp4", time));
  EXPECT_FALSE(refuses("a%d.png", start));
  EXPECT_FALSE(refuses("a.webm", crf));
  EXPECT_TRUE(refuses("a.gif", crf));
  const auto quality = [](RenderOptions& o) { o.pack.quality = 50L; };
  EXPECT_FALSE(refuses("a.webp", quality));
  EXPECT_TRUE(refuses("a.png", quality));
  EXPECT_TRUE(refuses("a.gif", quality));
  EXPECT_TRUE(refuses("a.mp4", [](RenderOptions& o) {
    o.outs = std::vector<std::string>{o.outs->front(), o.outs->front()};
  }));
}

}  // namespace
}  // namespace kinescope::app
