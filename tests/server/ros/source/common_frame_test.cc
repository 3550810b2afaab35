#include "server/ros/source/common_frame.h"

#include <gmock/gmock.h>

#include "core/system/clocks.h"
#include "tests/captured_log.h"

namespace kinescope::ros_bridge {
namespace {

using kinescope::testing::CapturedLog;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

constexpr std::int64_t kSecondOfSample = 1'700'000'000 * kNanosPerSecond;

// `child` at x, turned to the left.
tf2_msgs::TFMessage TurnedFrame(const std::string& parent, const std::string& child, double x,
                                std::int64_t stamp_nanos = 0) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  geometry_msgs::TransformStamped& transform = message.transforms[0];
  transform.header.frame_id = parent;
  transform.header.stamp.fromNSec(static_cast<std::uint64_t>(stamp_nanos));
  transform.child_frame_id = child;
  transform.transform.translation.x = x;
  transform.transform.rotation.z = transform.transform.rotation.w = std::sqrt(0.5);
  return message;
}

BodySample SampleAfter(double secs) {
  BodySample sample;
  sample.stamp_nanos = kSecondOfSample + static_cast<std::int64_t>(secs * 1e9);
  sample.segments[0].position = {1, 0, 2};
  sample.segments[0].velocity = {3, 0, 0};
  return sample;
}

TEST(CommonFrame, HasPeopleWhoseFramesHangOnDifferentOnes) {
  CommonFrame frame("ros:/tf", "");
  frame.Take(TurnedFrame("hall", "lab_a", 2), true);
  frame.Take(TurnedFrame("hall", "lab_b", -2), true);
  BodySample anna = SampleAfter(0), ben = SampleAfter(0);
  frame.Bring(anna, "lab_a", "lab_a");
  EXPECT_EQ(anna.segments[0].position, Eigen::Vector3d(1, 0, 2))
      << "the first one's is that of all";
  frame.Bring(ben, "lab_b", "lab_a");
  // 4 m to the left in the hall, of which both labs see the same side.
  EXPECT_LT((ben.segments[0].position - Eigen::Vector3d(1, 4, 2)).norm(), 1e-12)
      << ben.segments[0].position.transpose();
  CommonFrame in_hall("ros:/tf", "hall");
  in_hall.Take(TurnedFrame("hall", "lab_a", 2), true);
  anna = SampleAfter(0);
  in_hall.Bring(anna, "lab_a", "lab_a");
  EXPECT_LT((anna.segments[0].position - Eigen::Vector3d(2, 1, 2)).norm(), 1e-12);
  EXPECT_LT((anna.segments[0].velocity - Eigen::Vector3d(0, 3, 0)).norm(), 1e-12);
  EXPECT_NEAR(anna.segments[0].orientation.z(), std::sqrt(0.5), 1e-12);
}

// As the loads are those on a floor that stands.
TEST(CommonFrame, TakesOneThatMovesWhereItWasFirstAndSaysSo) {
  CommonFrame frame("ros:/tf", "");
  const CapturedLog log;
  const auto x_at = [&](double secs) {
    BodySample sample = SampleAfter(secs);
    frame.Bring(sample, "cart", "world");
    return sample.segments[0].position.x();
  };
  EXPECT_EQ(x_at(0), 1) << "not known yet";
  for (double secs = 0; secs < 4; secs += 0.1) {
    frame.Take(TurnedFrame("world", "cart", 10 + secs, SampleAfter(secs).stamp_nanos), false);
    EXPECT_NEAR(x_at(secs), 10, 1e-9) << secs;
  }
  const std::string said = log.text();
  EXPECT_THAT(said, HasSubstr("ros:/tf: people are in the frame 'cart', which moves"));
  EXPECT_EQ(said.find("which moves"), said.rfind("which moves"));
  EXPECT_THAT(frame.problems(), ElementsAre(HasSubstr("in the frame 'cart', which moves")));
  for (double secs = 4; secs < 5; secs += 0.1) {
    frame.Take(TurnedFrame("world", "cart", 14, SampleAfter(secs).stamp_nanos), false);
    static_cast<void>(x_at(secs));
  }
  EXPECT_THAT(frame.problems(), IsEmpty()) << "it stands again";
  EXPECT_EQ(log.text(), said);
}

TEST(CommonFrame, TakesAPlaceThatIsSetAnew) {
  CommonFrame frame("ros:/tf", "");
  const CapturedLog log;
  for (double secs = 0; secs < 3; secs += 0.1) {
    frame.Take(TurnedFrame("world", "lab", secs < 1 ? 2 : 5), true);
    BodySample sample = SampleAfter(secs);
    frame.Bring(sample, "lab", "world");
    if (secs < 0.95 || secs > 1.65) {
      EXPECT_NEAR(sample.segments[0].position.x(), secs < 1 ? 2 : 5, 1e-9) << secs;
    }
  }
  EXPECT_EQ(log.text(), "");
}

// Of two labs, one without a way to the hall.
TEST(CommonFrame, KeepsThoseInTheirPlaceWhoHaveAWay) {
  CommonFrame frame("ros:/tf", "hall");
  const CapturedLog log;
  frame.Take(TurnedFrame("hall", "lab_b", 20), true);
  const auto x_of = [&](const char* root, double secs) {
    BodySample sample = SampleAfter(secs);
    frame.Bring(sample, root, "lab_a");
    return sample.segments[0].position.x();
  };
  for (const double secs : {0.0, 3.0}) {
    EXPECT_EQ(x_of("lab_a", secs), 1);
    EXPECT_NEAR(x_of("lab_b", secs), 20, 1e-9);
  }
  EXPECT_THAT(log.text(),
              HasSubstr("in the frame 'lab_a', and TF has no way from there to 'hall'"));
  EXPECT_THAT(log.text(), Not(HasSubstr("lab_b")));
  EXPECT_THAT(frame.problems(), ElementsAre(HasSubstr("in the frame 'lab_a', and TF has no way")));
  frame.Take(TurnedFrame("hall", "lab_a", 7), true);
  EXPECT_NEAR(x_of("lab_a", 4), 7, 1e-9);
  EXPECT_THAT(frame.problems(), IsEmpty());
}

TEST(CommonFrame, HasNoProblemOfThoseWhoLeft) {
  CommonFrame frame("ros:/tf", "world");
  const CapturedLog log;
  for (const double secs : {0.0, 3.0}) {
    BodySample sample = SampleAfter(secs);
    frame.Bring(sample, "lab", "world");
  }
  EXPECT_THAT(frame.problems(), SizeIs(1));
  BodySample later = SampleAfter(6);
  frame.Bring(later, "world", "world");
  EXPECT_THAT(frame.problems(), IsEmpty());
}

TEST(CommonFrame, SaysOnceWhereThereIsNoWay) {
  CommonFrame frame("ros:/tf", "world");
  const CapturedLog log;
  const auto bring = [&](double secs, const char* root) {
    BodySample sample = SampleAfter(secs);
    frame.Bring(sample, root, "lab");
    EXPECT_EQ(sample.segments[0].position, Eigen::Vector3d(1, 0, 2));
  };
  bring(0, "lab");
  bring(1, "lab");
  EXPECT_EQ(log.text(), "") << "it may come";
  bring(2.5, "lab");
  bring(2.5, "lab");
  const std::string said = log.text();
  EXPECT_THAT(said, HasSubstr("ros:/tf: people are in the frame 'lab', and TF has no way from "
                              "there to 'world'"));
  EXPECT_THAT(said, HasSubstr("give --reference_frame lab"));
  EXPECT_EQ(said.find("people are"), said.rfind("people are"));
  bring(2.6, "");
  EXPECT_EQ(log.text(), said) << "of link states it is not known";
}

}  // namespace
}  // namespace kinescope::ros_bridge
