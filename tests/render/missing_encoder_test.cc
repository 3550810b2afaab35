// A program whose libavcodec has no encoder, as where a distribution leaves x264 out: this
// definition comes before libavcodec's, also for modules that are loaded later.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "render/video.h"
#include "tests/temp_folder.h"

struct AVCodec;
extern "C" __attribute__((visibility("default"))) const AVCodec* avcodec_find_encoder_by_name(
    const char*) {
  return nullptr;
}

namespace kinescope::render {
namespace {

TEST(MissingEncoder, IsReportedWithItsPackage) {
  const testing::TempFolder folder;
  const auto message = [&](const char* name) -> std::string {
    try {
      MakeVideoWriter(folder / name, 64, 48, {});
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(message("a.mp4"), ::testing::AllOf(::testing::HasSubstr("libx264"),
                                                 ::testing::HasSubstr("libavcodec59")));
  EXPECT_THAT(message("a.webm"), ::testing::HasSubstr("libvpx7"));
  EXPECT_THAT(message("a.gif"), ::testing::HasSubstr("libavcodec59"));
  EXPECT_THAT(folder.Names(), ::testing::IsEmpty());
}

}  // namespace
}  // namespace kinescope::render
