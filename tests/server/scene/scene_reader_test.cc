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

// As if each had read the recording on its own.
TEST(SceneReader, ComputesTheSameSamplesUnderOtherOptions) {
  SceneOptions heavy;
  heavy.body.mass_kg = 90;
  SceneReader reader("demo:lift", {}), alone("demo:lift", heavy);
  std::vector<std::shared_ptr<const SceneState>> also;
  reader.Also(heavy, [&](const auto& state) {
    if (!state->people.empty()) also.push_back(state);
  });
  for (int i = 0; i < 40; ++i) ASSERT_NE(reader.Next(), nullptr);
  ASSERT_GE(also.size(), 40U);
  for (std::size_t i = 0; i < 40; ++i) {
    const auto state = alone.Next();
    EXPECT_EQ(also[i]->stamp_nanos, state->stamp_nanos);
    EXPECT_EQ(also[i]->people[0].loads[0].ratio, state->people[0].loads[0].ratio);
    EXPECT_NEAR(also[i]->people[0].forces.body_mass_kg, 90, 1e-9);
  }
}

TEST(SceneReader, LetsTheBuiltInSubjectBeAsTallAsThePersonIsSaidToBe) {
  SceneOptions small;
  small.height_m = 1.62;
  SceneReader reader("demo:t_pose", small), average("demo:t_pose", {});
  const auto top = [](SceneReader& of) {
    const PersonState person = of.Next()->people.at(0);
    EXPECT_TRUE(person.model->lengths_are_measured);
    return person.links[urdf::kHead].position.z();
  };
  EXPECT_NEAR(top(reader) / top(average), 1.62 / 1.75, 0.01);
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
}

TEST(SceneReader, RefusesALiveSourceByItsName) {
  for (const auto& [url, how] : {std::pair<std::string, std::string>{"ros:", "rosbag record"},
                                 {"udp://", "kinescope record"},
                                 {"tcp://lab:9763", "kinescope record"}}) {
    try {
      const SceneReader reader(url, {});
      ADD_FAILURE() << url;
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr("'" + url + "': this command cannot read a live"),
                                      HasSubstr(how)));
    }
  }
}

}  // namespace
}  // namespace kinescope::app
