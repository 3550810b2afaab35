#include "server/scene/scene_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/system/errors.h"
#include "tests/shared_data.h"

namespace kinescope::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(SceneTimeline, IsAFixedGridForAnyRateOfTheSource) {
  SceneReader reader("demo:walk", {});
  SceneTimeline timeline(reader);
  std::int64_t start = 0;
  for (int k = 0; k < 50; ++k) {
    const auto scene = timeline.At(k / 24.0);
    ASSERT_TRUE(scene);
    if (k == 0) start = scene->stamp_nanos;
    EXPECT_NEAR(static_cast<double>(scene->stamp_nanos - start) * 1e-9, k / 24.0, 1e-6);
  }
}

TEST(SceneTimeline, EndsWithTheRecording) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/test_mocap.mvnx");
  SceneReader reader(testing::SharedData("mvnx/test_mocap.mvnx"), {});
  SceneTimeline timeline(reader);
  EXPECT_TRUE(timeline.At(111.0 / 60));  // 112 frames at 60 Hz
  EXPECT_FALSE(timeline.At(112.0 / 60));
}

TEST(SceneReader, RejectsALiveStream) {
  EXPECT_THROW(SceneReader("udp://127.0.0.1:0", {}), UsageError);
}

std::string SceneReaderError(const std::string& url) {
  try {
    SceneReader reader(url, {});
  } catch (const SourceError& error) {
    return error.what();
  }
  return "";
}

TEST(SceneReader, NamesAnInvalidSourceAndEverySupportedKind) {
  for (const char* bad : {"", "nonsense", "/nowhere.mvnx", "upd://:9763"}) {
    const std::string error = SceneReaderError(bad);
    EXPECT_THAT(error, HasSubstr("'" + std::string(bad) + "'"));
    for (const char* kind : {"udp://", "tcp://", "MVNX", "pcap", ".bin", "ROS bag",
                             "ros:", "demo:", "lift", "walk", "overhead"}) {
      EXPECT_THAT(error, HasSubstr(kind)) << "for '" << bad << "'";
    }
  }
}

TEST(SceneReader, NamesTheNearestSchemeAndMotion) {
  EXPECT_THAT(SceneReaderError("upd://:9763"), HasSubstr("; nearest: udp:"));
  EXPECT_THAT(SceneReaderError("demo:lfit"), HasSubstr("; nearest: lift"));
}

TEST(SceneReader, NamesTheErrorInASourceOfAKnownKind) {
  EXPECT_THAT(SceneReaderError("demo:fly"), AllOf(HasSubstr("fly"), HasSubstr("lift")));
  EXPECT_THAT(SceneReaderError("tcp:/x"), AllOf(HasSubstr("tcp:/x"), HasSubstr("tcp://")));
}

}  // namespace
}  // namespace kinescope::app
