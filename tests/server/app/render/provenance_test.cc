#include "server/app/render/provenance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <tuple>

#include "core/errors.h"
#include "tests/server/options_testing.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

Json Sample(const RenderOptions& options, const std::string& source = "demo:lift") {
  const render::RendererInfo renderer{"osmesa", "a renderer", "4.5", true, ""};
  return Provenance(options, source, renderer).Of({"a.mp4", OutputKind::kClip, "top"});
}

TEST(Provenance, GivesBackTheOptionsThatItWasMadeOf) {
  const auto options = testing::With<RenderOptions>({{"fps", "30000/1001"},
                                                     {"start", "0.1"},
                                                     {"end", "2.000000000000001"},
                                                     {"crf", "0"},
                                                     {"title", "Prüfung \"3\"\n"},
                                                     {"no_overlays", "true"},
                                                     {"mass", "61.3"},
                                                     {"hand_load", "both:5"}});
  const Json first = Sample(options);
  const auto read = FromText(ToText(first));
  ASSERT_TRUE(read);
  const RenderOptions again = OptionsOf(*read, "b.mp4");
  EXPECT_EQ(*again.clip.end, *options.clip.end);
  EXPECT_EQ(*again.view.title, *options.view.title);
  EXPECT_EQ(again.view.camera.ToText(), "top");
  EXPECT_EQ(*again.outs, std::vector<std::string>{"b.mp4"});
  EXPECT_TRUE(DecideTheSame(first, Sample(again)));
  // What a file can carry anywhere: a PNG's text is Latin-1, a GIF's comment bytes.
  for (const char c : ToText(first)) EXPECT_GE(c, ' ');
}

// A .gif says the quality that was asked for, too; drawn again, nobody asks for it.
TEST(Provenance, GivesBackAQualityToWhatHasOne) {
  const auto options = testing::With<RenderOptions>({{"quality", "50"}});
  const render::RendererInfo renderer{"osmesa", "a renderer", "4.5", true, ""};
  for (const std::string out : {"a.webp", "a.gif"}) {
    const Json json =
        Provenance(options, "demo:lift", renderer).Of({out, OutputKind::kClip, "top"});
    EXPECT_EQ(*OptionsOf(json, out).pack.quality, out == "a.webp" ? 50 : *PackOptions().quality);
  }
}

TEST(Provenance, DiffersWithEverythingThatDecidesAPixelAndWithNothingElse) {
  const RenderOptions plain;
  const auto differs = [&](const char* name, const char* text) {
    return !DecideTheSame(Sample(plain), Sample(testing::With<RenderOptions>({{name, text}})));
  };
  EXPECT_TRUE(differs("fps", "25"));
  EXPECT_TRUE(differs("size", "640x480"));
  EXPECT_TRUE(differs("sex", "female"));
  EXPECT_TRUE(differs("capacity_factor", "0.9"));
  EXPECT_TRUE(differs("crf", "20"));
  EXPECT_FALSE(differs("jobs", "7"));
  EXPECT_FALSE(differs("force", "true"));
  EXPECT_FALSE(differs("json", "true"));
  EXPECT_FALSE(differs("quality", "3")) << "only .webp has it";
  EXPECT_FALSE(differs("sample", "3")) << "a clip has no moment";
}

TEST(Provenance, HasTheHashOfTheSourceAndOfFilesThatOptionsName) {
  const testing::TempFolder folder;
  std::ofstream(folder / "take.mvnx") << "abc";
  std::filesystem::create_directory(folder / "meshes");
  std::ofstream(folder / "meshes" / "Head.stl") << "solid";
  const auto options =
      testing::With<RenderOptions>({{"body_model", "mesh:" + (folder / "meshes").string()}});
  const Json first = Sample(options, folder / "take.mvnx");
  EXPECT_EQ(first.at("source").at("name"), "take.mvnx");
  EXPECT_EQ(first.at("source").at("sha256"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  ASSERT_EQ(first.at("inputs").size(), 1u) << first.at("inputs");
  EXPECT_EQ(first.at("inputs").at(0).at("name"), "Head.stl");
  std::ofstream(folder / "meshes" / "Head.stl") << "another";
  EXPECT_FALSE(DecideTheSame(first, Sample(options, folder / "take.mvnx")));
}

TEST(Provenance, ChangesWithTheFilesBehindRobotsAndGhosts) {
  const testing::TempFolder folder;
  const std::string urdf = folder / "r.urdf", ghost = folder / "take.mvnx";
  std::ofstream(urdf) << "<robot name='before'><link name='a'/></robot>";
  std::ofstream(ghost) << "before";
  for (const auto& [name, text, file] :
       {std::tuple("robot", urdf + "@1,0", urdf), std::tuple("ghost", ghost + "@2", ghost)}) {
    const auto options = testing::With<RenderOptions>({{name, text}});
    const Json first = Sample(options);
    ASSERT_EQ(first.at("inputs").size(), 1u) << first.at("inputs");
    std::ofstream(file) << "<robot name='after'><link name='a'/></robot>";
    EXPECT_FALSE(DecideTheSame(first, Sample(options))) << name;
  }
}

// A folder that is called as a camera, a theme or a segment is no input of the picture.
TEST(Provenance, AFolderOfAnOptionsWordIsNoInput) {
  const testing::TempFolder folder;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  for (const char* name : {"top", "light", "com", "skeleton"}) {
    std::filesystem::create_directory(name);
    std::ofstream(std::string(name) + "/00.png") << "a picture";
  }
  const Json json = Sample(testing::With<RenderOptions>({{"trail", "com"}}));
  std::filesystem::current_path(before);
  EXPECT_EQ(json.at("inputs").size(), 0u) << json.at("inputs");
}

TEST(Provenance, WhateverAFileSaysIsTakenOrRefusedButNeverHarms) {
  const std::string whole = ToText(Sample({}));
  std::mt19937 random(3);
  int taken = 0, refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = whole;
    for (int k = 0; k < 3; ++k) text[random() % text.size()] = "0\"{}[],:-e9n "[random() % 13];
    const auto json = FromText(text);
    if (!json) continue;
    try {
      EXPECT_EQ(*OptionsOf(*json, "a.mp4").outs, std::vector<std::string>{"a.mp4"});
      ++taken;
    } catch (const std::exception& error) {
      EXPECT_STRNE(error.what(), "");
      ++refused;
    }
  }
  EXPECT_GT(taken, refused) << "most of what still is JSON says nothing that cannot be";
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace kinescope::app
