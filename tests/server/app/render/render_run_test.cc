// What `kinescope render` hands to the pool that draws and to its files; the drawing itself is
// faked.
#include "server/app/render/render_run.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "render/image/png_file.h"
#include "tests/captured_log.h"
#include "tests/deadline.h"
#include "tests/server/picture/fake_renderer.h"
#include "tests/shared_data.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using kinescope::testing::FakeRenderer;
using kinescope::testing::ReadFile;
using kinescope::testing::TempFolder;
using kinescope::testing::WithDeadline;

RenderOptions SmallRun(const std::string& source, const std::vector<std::string>& outs) {
  RenderOptions options;
  options.sources = std::vector<std::string>{source};
  options.outs = outs;
  options.view.size = {16, 16};
  options.person.body_model.Parse("primitive");
  return options;
}

std::vector<OutputResult> RenderFaked(const RenderOptions& options, std::size_t most_pictures,
                                      FakeRenderer::OnDraw on_draw = nullptr) {
  DrawPool pool(1, most_pictures, [&] { return std::make_unique<FakeRenderer>(on_draw); });
  RunSettings settings;
  settings.sidecar = false;
  return RenderSource(options, PlanOutputs(options).at(0), settings, pool);
}

// The record of a picture of `pose`.
nlohmann::json RecordOf(const std::string& pose) {
  const TempFolder folder;
  DrawPool pool(1, 1, [&] { return std::make_unique<FakeRenderer>(nullptr); });
  const RenderOptions options = SmallRun(pose, {folder / "a.png"});
  RenderSource(options, PlanOutputs(options).at(0), RunSettings(), pool);
  return nlohmann::json::parse(ReadFile(folder / "a.png.json"));
}

TEST(RenderRun, RecordsHowThePictureOfALyingPersonIsTurned) {
  const kinescope::testing::CapturedLog log;
  EXPECT_FALSE(RecordOf("pose: n_pose").contains("camera_note"));
  EXPECT_EQ(log.text(), "");
  const nlohmann::json lying = RecordOf("pose: n_pose, vertical_pelvis=-85");
  const std::string note = lying.at("camera_note");
  EXPECT_THAT(note, ::testing::HasSubstr("lies on the back or the belly"));
  EXPECT_THAT(log.text(), ::testing::EndsWith("a.png: " + note + "\n"));
}

TEST(RenderRun, RendersAnyNumberOfStillsInTheMemoryOfOnePicture) {
  for (const char* layer : {"", "svg"}) {
    const TempFolder folder;
    RenderOptions options =
        SmallRun("demo:lift", {folder / "{camera}.png", folder / "{camera}_again.png"});
    options.view.camera.Parse("front,back,left,right,top,iso,three_quarter");
    if (*layer != '\0') options.moment.overlay_layer.Parse(layer);
    std::vector<OutputResult> results;
    WithDeadline([&] { results = RenderFaked(options, 1); });
    ASSERT_EQ(results.size(), 14u);
    std::map<int, int> files_of;  // by number of the picture
    for (const OutputResult& result : results) {
      EXPECT_EQ(result.drawn, 1) << result.out;
      const int number = render::ReadPng(result.out).rgba.at(0);
      ++files_of[number];
      if (*layer == '\0') continue;
      EXPECT_EQ(ReadFile(std::filesystem::path(result.out).replace_extension(".svg")),
                fmt::format("over picture {}", number));
    }
    EXPECT_EQ(files_of.size(), 7u) << "one picture for each camera";
    for (const auto& [number, files] : files_of) EXPECT_EQ(files, 2) << number;
    EXPECT_EQ(folder.Names().size(), *layer == '\0' ? 14u : 28u);
  }
}

TEST(RenderRun, RendersEightStillsWithAPoolOfTwoPictures) {
  const TempFolder folder;
  RenderOptions options = SmallRun("demo:lift", {folder / "{camera}.png"});
  options.view.camera.Parse("front,back,left,right,top,iso,three_quarter;0,-4,1:0,0,1");
  std::vector<OutputResult> results;
  WithDeadline([&] { results = RenderFaked(options, 2); });
  EXPECT_EQ(results.size(), 8u);
  EXPECT_EQ(folder.Names().size(), 8u);
}

TEST(RenderRun, WritesTheSameFilesWithAnyNumberOfThreads) {
  const auto files_with = [](int jobs) {
    const TempFolder folder;
    RenderOptions options =
        SmallRun("demo:lift", {folder / "{camera}.png", folder / "{camera}_%d.png"});
    options.view.camera.Parse("front,top");
    options.moment.time = 0.15;
    options.clip.seconds = 0.3;
    options.clip.fps.Parse("10");
    DrawPool pool(jobs, 6, [] {
      return std::make_unique<FakeRenderer>(
          [](render::Image& image, const SceneState& state, const auto&...) {
            const auto level = static_cast<std::uint8_t>(state.stamp_nanos / 1'000'000);
            std::fill(image.rgba.begin(), image.rgba.end(), level);
          });
    });
    RunSettings settings;
    settings.jobs = jobs;
    RenderSource(options, PlanOutputs(options).at(0), settings, pool);
    std::map<std::string, std::string> files;
    for (const std::string& name : folder.Names()) files[name] = ReadFile(folder / name);
    return files;
  };
  const auto one = files_with(1);
  EXPECT_EQ(one.size(), 2u * (1 + 1) + 2u * (3 + 1)) << "pictures and sidecars";
  EXPECT_TRUE(files_with(3) == one);
}

TEST(RenderRun, RendersStillsAndAClipInTheSameMemory) {
  const TempFolder folder;
  RenderOptions options =
      SmallRun("demo:lift", {folder / "{camera}.png", folder / "{camera}_%02d.png"});
  options.view.camera.Parse("front,left,top");
  options.moment.time = 0.05;
  options.clip.seconds = 0.1;
  WithDeadline([&] { RenderFaked(options, 1); });
  EXPECT_EQ(folder.Names().size(), 3u * (1 + 3));
}

TEST(RenderRun, LeavesNoPictureIfItsLayerCannotBeWritten) {
  const TempFolder folder;
  std::filesystem::create_directory(folder / "a.svg");
  RenderOptions options = SmallRun("demo:lift", {folder / "a.png"});
  options.moment.overlay_layer.Parse("svg");
  EXPECT_THROW(RenderFaked(options, 2), std::runtime_error);
  EXPECT_THAT(folder.Names(), ::testing::ElementsAre("a.svg"));
}

TEST(RenderRun, GivesAReferencePoseTheAppearanceOfThePerson) {
  const TempFolder folder;
  RenderOptions options = SmallRun("demo:lift", {folder / "a.png"});
  options.view.ghost.Parse("demo:walk@0.5");
  options.person.model_name.Parse("anna");
  options.person.height = 1.6;
  int drawn = 0;
  RenderFaked(options, 2, [&](const auto&, const SceneState& state, const auto&, const auto& view) {
    ++drawn;
    ASSERT_EQ(view.look.ghosts.size(), 1u);
    const urdf::HumanModel& ghost = view.look.ghosts[0].person.model->human;
    const urdf::HumanModel& person = state.people.at(0).model->human;
    EXPECT_EQ(ghost.mesh_folder, "") << "primitives have no meshes";
    EXPECT_EQ(ghost.model_name, person.model_name);
  });
  EXPECT_EQ(drawn, 1);
}

}  // namespace
}  // namespace kinescope::app
