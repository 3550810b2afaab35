#include "server/body/own_skin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "server/body/body_color.h"
#include "tests/captured_log.h"
#include "tests/temp_folder.h"
#include "tests/urdf/rig/rig_samples.h"

namespace kinescope::app {
namespace {

using ::testing::HasSubstr;

TEST(OwnSkin, HasNoColourThatCouldBeMistakenForALoadClass) {
  const testing::TempFolder folder;
  const auto path = folder / "person.glb";
  testing::RigSample sample;
  sample.edit = [](nlohmann::json& document, std::string&) {
    document["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0.6, 0.02, 0.02, 1};
  };
  std::ofstream(path, std::ios::binary) << testing::RigGlb(sample);
  const testing::CapturedLog log;
  const auto skin = ReadOwnSkin(path);
  for (const auto& color : skin->colors) {
    EXPECT_FALSE(FindNearClass({color[0] / 255.0, color[1] / 255.0, color[2] / 255.0}));
  }
  EXPECT_THAT(log.text(), HasSubstr("1 of its 1 colours look like those of load classes"));
}

TEST(OwnSkin, NamesTexturesThatItDoesNotDraw) {
  const testing::TempFolder folder;
  const auto path = folder / "person.vrm";
  testing::RigSample sample;
  sample.edit = [](nlohmann::json& document, std::string&) {
    document["materials"][0]["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", 0}}}};
  };
  std::ofstream(path, std::ios::binary) << testing::RigGlb(sample);
  const testing::CapturedLog log;
  const auto skin = ReadOwnSkin(path);
  EXPECT_THAT(log.text(), HasSubstr("its textures are not drawn"));
  EXPECT_EQ(skin->colors[0], (skin::SkinTemplate::Color{184, 176, 166, 255})) << "a plain colour";
}

TEST(OwnSkin, RefusesWhatIsNoFileAndTooLargeAFile) {
  const testing::TempFolder folder;
  const auto why = [](const std::filesystem::path& path) -> std::string {
    try {
      ReadOwnSkin(path);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(why(folder / "none.glb"), "no such file");
  EXPECT_EQ(why(folder.path()), "not a regular file");
  std::ofstream(folder / "large.glb") << "glTF";
  std::filesystem::resize_file(folder / "large.glb", 129u << 20);  // sparse
  EXPECT_THAT(why(folder / "large.glb"), HasSubstr("larger than 128 MiB"));
}

}  // namespace
}  // namespace kinescope::app
