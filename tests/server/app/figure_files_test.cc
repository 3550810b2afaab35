#include "server/app/figure_files.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/temp_folder.h"
#include "urdf/segments.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

class FigureFiles : public ::testing::Test {
 protected:
  void SetUp() override { setenv("XDG_CACHE_HOME", folder_.path().c_str(), 1); }
  void TearDown() override { unsetenv("XDG_CACHE_HOME"); }
  testing::TempFolder folder_;
};

TEST_F(FigureFiles, AreWrittenOnceForEachBody) {
  const std::string small = WriteFigureFiles(urdf::DefaultSkeleton(1.6));
  const std::string tall = WriteFigureFiles(urdf::DefaultSkeleton(1.9));
  EXPECT_NE(small, tall);
  EXPECT_EQ(WriteFigureFiles(urdf::DefaultSkeleton(1.6)), small);
  for (const urdf::SegmentInfo& segment : urdf::kSegments) {
    EXPECT_GT(fs::file_size(fs::path(small) / (std::string(segment.link_name) + ".stl")), 1000u);
  }
}

TEST_F(FigureFiles, FallBackToNoneWhereNothingCanBeWritten) {
  const fs::path file = folder_.path() / "kinescope";
  std::FILE* blocks_the_folder = std::fopen(file.c_str(), "w");
  ASSERT_NE(blocks_the_folder, nullptr);
  std::fclose(blocks_the_folder);
  EXPECT_EQ(WriteFigureFiles(urdf::DefaultSkeleton()), "");
}

}  // namespace
}  // namespace kinescope::app
