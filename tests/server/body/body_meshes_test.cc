#include "server/body/body_meshes.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/temp_folder.h"
#include "urdf/robot_model.h"
#include "urdf/segments.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

class BodyMeshFiles : public ::testing::Test {
 protected:
  void SetUp() override { setenv("XDG_CACHE_HOME", folder_.path().c_str(), 1); }
  void TearDown() override { unsetenv("XDG_CACHE_HOME"); }
  testing::TempFolder folder_;
};

urdf::HumanModel Person(double height) {
  urdf::HumanModel human;
  human.skeleton = urdf::DefaultSkeleton(height);
  return human;
}

std::vector<MeshFile> FilesOf(const urdf::HumanModel& human) {
  return app::BodyMeshFiles(human, nullptr);
}

TEST_F(BodyMeshFiles, AreWrittenOnceForEachBody) {
  const std::string small = WriteToCache(FilesOf(Person(1.6)));
  const std::string tall = WriteToCache(FilesOf(Person(1.9)));
  EXPECT_NE(small, tall);
  EXPECT_EQ(WriteToCache(FilesOf(Person(1.6))), small);
  for (const urdf::SegmentInfo& segment : urdf::kSegments) {
    EXPECT_GT(fs::file_size(fs::path(small) / (std::string(segment.link_name) + ".stl")), 1000u);
  }
}

TEST_F(BodyMeshFiles, AreThoseOfFingersInPlaceOfAGlovedHand) {
  urdf::HumanModel human = Person(1.75);
  human.gloves[urdf::kRight] = urdf::DefaultHand(urdf::kRight, 0.19);
  const fs::path gloved = WriteToCache(FilesOf(human));
  EXPECT_FALSE(fs::exists(gloved / "right_hand.stl"));
  EXPECT_TRUE(fs::exists(gloved / "left_hand.stl"));
  for (int i = 0; i < urdf::kFingersPerHand; ++i) {
    EXPECT_GT(fs::file_size(gloved / (urdf::FingerFileName(urdf::kRight, i) + ".stl")), 1000u);
  }
  // Whatever the URDF names is there, and nothing else.
  human.body = urdf::MakeBodyParameters({}, human.skeleton);
  human.mesh_folder = gloved;
  std::size_t named = 0;
  for (const urdf::Link& link : urdf::ParseUrdf(urdf::WriteUrdf(human)).links) {
    for (const urdf::Visual& visual : link.visuals) {
      EXPECT_TRUE(fs::exists(visual.geometry.mesh_uri.substr(7))) << visual.geometry.mesh_uri;
      ++named;
    }
  }
  EXPECT_EQ(named, static_cast<std::size_t>(
                       std::distance(fs::directory_iterator(gloved), fs::directory_iterator())));
}

TEST_F(BodyMeshFiles, FallBackToNoneWhereNothingCanBeWritten) {
  const fs::path file = folder_.path() / "kinescope";
  std::FILE* blocks_the_folder = std::fopen(file.c_str(), "w");
  ASSERT_NE(blocks_the_folder, nullptr);
  std::fclose(blocks_the_folder);
  EXPECT_EQ(WriteToCache(FilesOf(Person(1.75))), "");
}

}  // namespace
}  // namespace kinescope::app
