#include "server/app/scene_reader.h"

#include <gtest/gtest.h>

#include "server/core/errors.h"
#include "tests/shared_data.h"

namespace kinescope::app {
namespace {

TEST(SceneTimeline, IsAFixedGridWhateverTheSourcesRate) {
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

TEST(SceneReader, RefusesALiveStream) {
  EXPECT_THROW(SceneReader("udp://127.0.0.1:0", {}), UsageError);
}

TEST(SceneReader, SaysWhatASourceMayBe) {
  for (const char* bad : {"", "nonsense", "demo:fly", "/nowhere.mvnx", "tcp:/x"}) {
    try {
      SceneReader reader(bad, {});
      FAIL() << "opened '" << bad << "'";
    } catch (const SourceError& error) {
      EXPECT_NE(std::string(error.what()).size(), 0u);
    }
  }
}

}  // namespace
}  // namespace kinescope::app
