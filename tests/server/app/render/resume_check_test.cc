#include "server/app/render/resume_check.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "render/image/png_file.h"
#include "server/app/render/provenance_files.h"
#include "tests/server/options_testing.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using kinescope::testing::Settings;
using kinescope::testing::TempFolder;

// What a run with some options would write; the renderer is a name only.
class PlannedRun {
 public:
  explicit PlannedRun(const Settings& options = {}, const std::string& source = "demo:lift")
      : options_(testing::With<RenderOptions>(options)),
        provenance_(options_, source, {"osmesa", "a renderer", "4.5", true, ""}) {}

  const Provenance& provenance() const { return provenance_; }

  bool IsUpToDate(const Output& output, bool force = false, bool sidecar = true) const {
    RunSettings settings;
    settings.force = force;
    settings.sidecar = sidecar;
    return ResumeCheck(provenance_, settings).IsUpToDate(output);
  }
  bool Wants(const Output& output, long k, const RunSettings& settings = {}) const {
    return ResumeCheck(provenance_, settings).Wants(output, k);
  }

 private:
  const RenderOptions options_;
  const Provenance provenance_;
};

// One pixel that says where it came from.
void WritePixel(const std::string& path, const Json& provenance) {
  render::Image image{1, 1, {1, 2, 3, 255}};
  render::WritePng(path, image, {{kProvenanceKey, ToText(provenance)}});
}

void WriteWithSidecar(const Output& output, const PlannedRun& run) {
  WritePixel(output.path, run.provenance().Of(output));
  WriteSidecar(output, run.provenance().Of(output), "demo:lift", 1);
}

TEST(ResumeCheck, AcceptsAFileOfTheSameOptionsAndSource) {
  const TempFolder folder;
  const Output output = {folder / "a.png", OutputKind::kStill, "front"};
  EXPECT_FALSE(PlannedRun().IsUpToDate(output)) << "no file";
  WriteWithSidecar(output, PlannedRun());
  EXPECT_TRUE(PlannedRun().IsUpToDate(output));
  EXPECT_TRUE(PlannedRun({{"jobs", "3"}}).IsUpToDate(output)) << "threads decide no pixel";
  EXPECT_FALSE(PlannedRun({{"sex", "female"}}).IsUpToDate(output));
  EXPECT_FALSE(PlannedRun({}, "demo:walk").IsUpToDate(output));
  EXPECT_FALSE(PlannedRun().IsUpToDate(output, /*force=*/true));
}

TEST(ResumeCheck, RequestsAChangedOrMissingFileAgain) {
  const TempFolder folder;
  const Output output = {folder / "a.png", OutputKind::kStill, "front"};
  WriteWithSidecar(output, PlannedRun());
  std::ofstream(output.path, std::ios::app) << "more";
  EXPECT_FALSE(PlannedRun().IsUpToDate(output)) << "not the file of its sidecar";
  std::filesystem::remove(output.path);
  EXPECT_FALSE(PlannedRun().IsUpToDate(output));
}

TEST(ResumeCheck, ReadsProvenanceFromTheFileIfSidecarsAreOff) {
  const TempFolder folder;
  const Output output = {folder / "a.png", OutputKind::kStill, "front"};
  WritePixel(output.path, PlannedRun().provenance().Of(output));
  EXPECT_FALSE(PlannedRun().IsUpToDate(output)) << "its sidecar is missing";
  EXPECT_TRUE(PlannedRun().IsUpToDate(output, false, /*sidecar=*/false));
  EXPECT_FALSE(PlannedRun({{"mass", "60"}}).IsUpToDate(output, false, false));
}

TEST(ResumeCheck, NeverAcceptsAFileOfASourceThatCanBeReadOnlyOnce) {
  const TempFolder folder;
  const Output output = {folder / "a.png", OutputKind::kStill, "front"};
  const PlannedRun run({}, "/dev/null");
  WriteWithSidecar(output, run);
  EXPECT_FALSE(run.IsUpToDate(output));
}

TEST(ResumeCheck, ChecksEachFrameOfASequence) {
  const TempFolder folder;
  const Output output = {folder / "%d.png", OutputKind::kSequence, "front"};
  const PlannedRun run({{"seconds", "1"}});
  for (const long k : {0, 2})
    WritePixel(PathOfPicture(output.path, k), run.provenance().Of(output, k));
  WriteSidecar(output, run.provenance().Of(output), "demo:lift", 3);
  EXPECT_FALSE(run.IsUpToDate(output));
  EXPECT_FALSE(run.Wants(output, 0));
  EXPECT_TRUE(run.Wants(output, 1)) << "missing";
  EXPECT_FALSE(run.Wants(output, 2));
  EXPECT_TRUE(PlannedRun({{"theme", "dark"}}).Wants(output, 0));
  RunSettings force;
  force.force = true;
  EXPECT_TRUE(run.Wants(output, 0, force));
}

// A longer sequence has the same pictures at its beginning, unless they show all of it.
TEST(ResumeCheck, RequestsFramesAgainOnlyIfTheyDependOnAChangedLength) {
  const TempFolder folder;
  const Output output = {folder / "%d.png", OutputKind::kSequence, "front"};
  const auto wants_longer = [&](Settings options) {
    Settings longer = options;
    options.emplace_back("seconds", "1");
    longer.emplace_back("seconds", "2");
    WritePixel(PathOfPicture(output.path, 0), PlannedRun(options).provenance().Of(output, 0));
    return PlannedRun(longer).Wants(output, 0);
  };
  EXPECT_TRUE(wants_longer({})) << "the camera's distance is that of the whole clip";
  EXPECT_FALSE(wants_longer({{"fit", "off"}}));
  EXPECT_TRUE(wants_longer({{"plot", "l5_s1"}}));
  EXPECT_TRUE(wants_longer({{"orbit", "turn"}}));
  EXPECT_FALSE(wants_longer({{"fit", "off"}, {"orbit", "10"}}));
  EXPECT_TRUE(wants_longer({{"fit", "clip"}}));
}

TEST(ResumeCheck, RequestsOnlyTheGivenFrame) {
  const PlannedRun run;
  RunSettings settings;
  settings.only_picture = 4;
  const Output output = {"nowhere/%d.png", OutputKind::kSequence, "front"};
  EXPECT_TRUE(run.Wants(output, 4, settings));
  EXPECT_FALSE(run.Wants(output, 3, settings));
}

}  // namespace
}  // namespace kinescope::app
