#include "server/ros/source/bag_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <kinescope/JointLoadArray.h>
#include <std_msgs/String.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <vector>

#include "core/system/clocks.h"
#include "server/ros/link_states.h"
#include "tests/captured_log.h"
#include "tests/server/ros/source/written_bag.h"
#include "tests/shared_data.h"
#include "tests/system/run_program.h"

namespace kinescope::ros_bridge {
namespace {

using kinescope::testing::RunProgram;
using kinescope::testing::SharedData;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

xsens_mvn_ros_msgs::LinkStateArray LinkStatesOf(const PersonState& person) {
  xsens_mvn_ros_msgs::LinkStateArray message;
  FillLinkStates(person, "world", message);
  return message;
}

void ExpectMotion(const BodySample& sample, const PersonState& person) {
  EXPECT_TRUE(sample.has_linear && sample.has_angular) << "sample " << sample.counter;
  const SegmentState& got = sample.segments[urdf::kLeftHand];
  const SegmentState& sent = person.sample.segments[urdf::kLeftHand];
  EXPECT_EQ(got.velocity, sent.velocity);
  EXPECT_EQ(got.angular_acceleration, sent.angular_acceleration);
}

TEST_F(BagTest, SaysWhatItsJointLoadsWereComputedWith) {
  const std::string path = Bag([](rosbag::Bag& bag) {
    for (int n = 0; n < 20; ++n) {
      const ros::Time now = RosTimeOf(kBagStart + n * kBagPeriod);
      bag.write("/tf", now, TransformsOf(PersonAt(n, "anna")));
      kinescope_ros::JointLoadArray loads;
      loads.body_mass = n < 10 ? 80 : 95;
      loads.held_mass[urdf::kLeft] = n < 5 ? 0 : 3;
      bag.write("/anna/joint_loads", now, loads);
      loads.body_mass_assumed = 1;
      loads.held_mass[urdf::kLeft] = 0;
      bag.write("/ben/joint_loads", now, loads);
    }
  });
  const kinescope::testing::CapturedLog log;
  EXPECT_EQ(ReadBag(path).samples.size(), 20U);
  EXPECT_THAT(log.text(),
              HasSubstr("the joint loads of /anna/joint_loads were computed with a body "
                        "mass of 80 to 95 kg and up to 3 kg in the left hand; those"));
  EXPECT_THAT(log.text(), ::testing::Not(HasSubstr("/ben")));
}

// Loads are those of the motion then, and not of someone who stands still.
TEST_F(BagTest, HasTheVelocitiesOfLinkStatesBeforeOrAfterTheTransforms) {
  const ReadPeople recorded = ReadBag(Bag([](rosbag::Bag& bag) {
    for (int n = 0; n < 20; ++n) {
      const PersonState one = PersonAt(n, "anna");
      PersonState other = PersonAt(n + 3, "ben");
      other.sample.stamp_nanos = one.sample.stamp_nanos;
      for (auto& link : other.links) link.position.x() += 2;
      for (auto& segment : other.sample.segments) segment.position.x() += 2;
      const std::int64_t late = kBagStart + n * kBagPeriod + 2'000'000;
      const bool is_before = n % 2 == 1;
      bag.write("/tf", RosTimeOf(late), TransformsOf(one));
      bag.write("/tf", RosTimeOf(late + 1000), TransformsOf(other));
      bag.write("/xsens/link_states", RosTimeOf(late + (is_before ? -2000 : 2000)),
                LinkStatesOf(one));
      bag.write("/xsens/ben/link_states", RosTimeOf(late + (is_before ? -1000 : 3000)),
                LinkStatesOf(other));
    }
  }));
  ASSERT_EQ(recorded.samples.size(), 40U);
  EXPECT_THAT(recorded.counters.rejected, IsEmpty());
  for (const BodySample& sample : recorded.samples) {
    const int n = static_cast<int>(sample.counter) + (sample.character == 0 ? 0 : 3);
    ExpectMotion(sample, PersonAt(n));
  }
}

TEST_F(BagTest, ReadsPeopleOfWhomOnlyLinkStatesWereRecorded) {
  const ReadPeople recorded = ReadBag(Bag([](rosbag::Bag& bag) {
    for (int n = 0; n < 20; ++n) {
      const ros::Time time = RosTimeOf(kBagStart + n * kBagPeriod + 2'000'000);
      bag.write("/xsens/link_states", time, LinkStatesOf(PersonAt(n)));
      bag.write("/xsens/ben/link_states", time, LinkStatesOf(PersonAt(n + 3)));
    }
  }));
  ASSERT_EQ(recorded.samples.size(), 40U);
  ASSERT_EQ(recorded.characters.size(), 2U);
  EXPECT_NE(recorded.characters[0].id, recorded.characters[1].id);
  EXPECT_NEAR(recorded.rate_hz, 1e9 / kBagPeriod, 0.1);
  for (const BodySample& sample : recorded.samples) {
    if (sample.character != recorded.characters[0].id) continue;
    const bool is_ben = recorded.characters[0].name.find("ben") != std::string::npos;
    const PersonState sent = PersonAt(static_cast<int>(sample.counter) + (is_ben ? 3 : 0));
    ExpectPoses(sample, sent);
    ExpectMotion(sample, sent);
  }
}

TEST_F(BagTest, NamesTransformsElsewhereIfItsPeopleAreThoseOfLinkStates) {
  const std::string path = Bag([](rosbag::Bag& bag) {
    for (int n = 0; n < 20; ++n) {
      const ros::Time now = RosTimeOf(kBagStart + n * kBagPeriod);
      bag.write("/lab/link_states", now, LinkStatesOf(PersonAt(n)));
      bag.write("/lab/tf", now, TransformsOf(PersonAt(n)));
    }
  });
  const kinescope::testing::CapturedLog log;
  EXPECT_EQ(ReadBag(path).samples.size(), 20U);
  EXPECT_THAT(log.text(),
              HasSubstr("has no transforms on /tf (--tf_topic); it has some on /lab/tf: "
                        "people are those of its link states"));
}

// What somebody else's driver streamed from a suit, next to a robot with a head and hands of its
// own.
TEST_F(BagTest, ReadsTheSamplesOfARecordedBagAsInItsCsv) {
  KINESCOPE_NEEDS_SHARED_DATA("ros1/2018-05-28-17-34-45.bag.xz");
  KINESCOPE_NEEDS_SHARED_DATA("ros1/2018-05-28-17-34-45.xsens_tf.csv");
  const ReadPeople recorded = ReadBag(SharedData("ros1/2018-05-28-17-34-45.bag.xz"));
  ASSERT_EQ(recorded.samples.size(), 135U);
  std::ifstream csv(SharedData("ros1/2018-05-28-17-34-45.xsens_tf.csv"));
  std::string line;
  ASSERT_TRUE(std::getline(csv, line));
  for (const BodySample& sample : recorded.samples) {
    for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
      ASSERT_TRUE(std::getline(csv, line));
      std::istringstream fields(line);
      std::vector<std::string> row;
      for (std::string field; std::getline(fields, field, ',');) row.push_back(field);
      ASSERT_EQ(row.size(), 13U);
      ASSERT_THAT(row[5], HasSubstr(std::string(urdf::kSegments[At(segment)].link_name)));
      const auto number = [&](std::size_t column) { return std::stod(row[column]); };
      const Eigen::Vector3d position(number(6), number(7), number(8));
      const Eigen::Quaterniond turn(number(12), number(9), number(10), number(11));
      const SegmentState& got = sample.segments[At(segment)];
      EXPECT_EQ(got.position, position) << line;
      EXPECT_NEAR(std::abs(got.orientation.dot(turn)), 1, 1e-15) << line;
      if (segment == urdf::kPelvis) {  // its header says 34486 s after the epoch, and steps back
        EXPECT_EQ(sample.stamp_nanos, std::stoll(row[0]) * 1'000'000'000 + std::stoll(row[1]));
      }
    }
  }
  EXPECT_FALSE(std::getline(csv, line)) << "the recording has more";
  ASSERT_EQ(recorded.characters.size(), 1U);
  EXPECT_EQ(recorded.characters[0].name, "xsens");
  EXPECT_THAT(recorded.counters.rejected, IsEmpty());
  EXPECT_EQ(
      recorded.counters.ignored.count("topic /ar_pose_marker (ar_track_alvar_msgs/AlvarMarkers)"),
      1U);
  EXPECT_NEAR(recorded.rate_hz, 57, 1);
}

// How it is known that the recorded arms are in segment frames: the next joint lies along y in
// them, at the same place in all samples.
TEST_F(BagTest, ReadsArmsAlongTheirYAxisWithRigidSegments) {
  KINESCOPE_NEEDS_SHARED_DATA("ros1/2018-05-28-17-34-45.bag.xz");
  const ReadPeople recorded = ReadBag(SharedData("ros1/2018-05-28-17-34-45.bag.xz"));
  ASSERT_FALSE(recorded.samples.empty());
  for (const BodySample& sample : recorded.samples) {
    const auto next_joint = [&](int segment) -> Eigen::Vector3d {
      const SegmentState& from = sample.segments[At(segment)];
      return from.orientation.conjugate() *
             (sample.segments[At(segment) + 1].position - from.position);
    };
    EXPECT_LT((next_joint(urdf::kRightUpperArm) - Eigen::Vector3d(0, -0.2849, 0)).norm(), 2e-4);
    EXPECT_LT((next_joint(urdf::kLeftUpperArm) - Eigen::Vector3d(0, 0.2849, 0)).norm(), 2e-4);
    EXPECT_LT((next_joint(urdf::kRightForeArm) - Eigen::Vector3d(0, -0.2344, 0)).norm(), 2e-4);
    EXPECT_LT((next_joint(urdf::kLeftForeArm) - Eigen::Vector3d(0, 0.2344, 0)).norm(), 2e-4);
  }
  ASSERT_TRUE(recorded.characters[0].skeleton);
  const urdf::Skeleton& skeleton = *recorded.characters[0].skeleton;
  EXPECT_NEAR(skeleton.origin_in_parent[urdf::kRightForeArm].z(), -0.2849, 2e-4)
      << "hangs, in a link";
  EXPECT_NEAR(skeleton.origin_in_parent[urdf::kLeftLowerLeg].z(), -0.4669, 2e-4);
  EXPECT_NEAR(skeleton.height, 1.7, 0.15);
}

struct Written {
  TfShape shape;
  rosbag::CompressionType compression;
  bool one_by_one;  // a message for each transform
};

class WrittenBagTest : public BagTest, public ::testing::WithParamInterface<Written> {};

TEST_P(WrittenBagTest, RestoresThePublishedPoses) {
  constexpr int kSamples = 50;
  const Written& how = GetParam();
  const std::string bag = Bag(
      [&](rosbag::Bag& out) {
        for (int n = 0; n < kSamples; ++n) {
          const tf2_msgs::TFMessage message = TransformsOf(PersonAt(n), how.shape);
          std::int64_t recorded_at = kBagStart + n * kBagPeriod + 3 * kNanosPerMilli;
          if (!how.one_by_one) {
            out.write("/tf", RosTimeOf(recorded_at), message);
            continue;
          }
          for (const auto& transform : message.transforms) {
            tf2_msgs::TFMessage single;
            single.transforms.push_back(transform);
            out.write("/tf", RosTimeOf(recorded_at), single);
            recorded_at += 10'000;
          }
        }
      },
      how.compression);
  const ReadPeople recorded = ReadBag(bag);
  ASSERT_EQ(recorded.samples.size(), static_cast<std::size_t>(kSamples));
  for (int n = 0; n < kSamples; ++n) {
    const BodySample& sample = recorded.samples[static_cast<std::size_t>(n)];
    ExpectPoses(sample, PersonAt(n));
    EXPECT_EQ(sample.stamp_nanos, kBagStart + n * kBagPeriod) << "the header's, not the bag's";
    EXPECT_EQ(sample.counter, static_cast<std::uint32_t>(n));
    EXPECT_EQ(sample.time_code_millis, n * kBagPeriod / kNanosPerMilli);
    EXPECT_EQ(sample.arrival_nanos, 0);
    EXPECT_FALSE(sample.has_linear || sample.has_angular || sample.com);
  }
  ASSERT_EQ(recorded.characters.size(), 1U);
  EXPECT_EQ(recorded.characters[0].name, "skeleton");
  ASSERT_TRUE(recorded.characters[0].skeleton);
  EXPECT_NEAR(recorded.characters[0].skeleton->origin_in_parent[urdf::kRightLowerLeg].z(),
              urdf::DefaultSkeleton().origin_in_parent[urdf::kRightLowerLeg].z(), 1e-9);
  EXPECT_NEAR(recorded.rate_hz, 100, 0.1);
  EXPECT_THAT(recorded.counters.rejected, IsEmpty());
  EXPECT_EQ(recorded.counters.samples, static_cast<std::uint64_t>(kSamples));
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, WrittenBagTest,
    ::testing::Values(Written{TfShape::kFlat, rosbag::compression::Uncompressed, false},
                      Written{TfShape::kFlat, rosbag::compression::BZ2, true},
                      Written{TfShape::kTree, rosbag::compression::LZ4, false},
                      Written{TfShape::kTree, rosbag::compression::Uncompressed, true}));

TEST_F(BagTest, ReadsABagCompressedWithGzip) {
  const std::string bag = Bag(
      [](rosbag::Bag& out) { out.write("/tf", RosTimeOf(kBagStart), TransformsOf(PersonAt(0))); });
  ASSERT_EQ(RunProgram({"/bin/gzip", bag}).exit_code, 0);
  const ReadPeople recorded = ReadBag(bag + ".gz");
  ASSERT_EQ(recorded.samples.size(), 1U);
  ExpectPoses(recorded.samples[0], PersonAt(0));
}

TEST_F(BagTest, DistinguishesTwoPeopleAndARobotWithHands) {
  const std::string bag = Bag([](rosbag::Bag& out) {
    for (int n = 0; n < 3; ++n) {
      tf2_msgs::TFMessage both = TransformsOf(PersonAt(n, "anna"));
      tf2_msgs::TFMessage ben = TransformsOf(PersonAt(n + 10, "ben"), TfShape::kTree);
      for (auto& transform : ben.transforms) {  // tf before tf2 put a slash before each
        transform.child_frame_id.insert(0, "/");
        transform.header.frame_id.insert(0, "/");
      }
      both.transforms.insert(both.transforms.end(), ben.transforms.begin(), ben.transforms.end());
      tf2_msgs::TFMessage robot;
      for (const char* frame : {"left_hand", "right_hand", "head", "pelvis", "head_camera"}) {
        geometry_msgs::TransformStamped transform;
        transform.header.frame_id = "base";
        transform.child_frame_id = frame;
        transform.transform.rotation.w = 1;
        robot.transforms.push_back(transform);
      }
      std_msgs::String text;
      text.data = "hello";
      out.write("/chatter", RosTimeOf(kBagStart + n * kBagPeriod), text);
      out.write("/tf", RosTimeOf(kBagStart + n * kBagPeriod), robot);
      out.write("/tf", RosTimeOf(kBagStart + n * kBagPeriod), both);
    }
  });
  const ReadPeople recorded = ReadBag(bag);
  ASSERT_EQ(recorded.characters.size(), 2U);
  EXPECT_EQ(recorded.characters[0].name, "anna");
  EXPECT_EQ(recorded.characters[1].name, "ben");
  ASSERT_EQ(recorded.samples.size(), 6U);
  for (const BodySample& sample : recorded.samples) {
    const int n = static_cast<int>(sample.counter);
    ExpectPoses(sample, sample.character == 0 ? PersonAt(n, "anna") : PersonAt(n + 10, "ben"));
  }
  EXPECT_THAT(recorded.counters.ignored,
              UnorderedElementsAre(Pair("topic /chatter (std_msgs/String)", 3),
                                   Pair("message on /tf without a person's segment", 3)));
  EXPECT_EQ(recorded.counters.datagrams, 9U);
}

// Names as foreign drivers give them, orientations as MVN has them.
TEST_F(BagTest, RecognisesArmsInSegmentFramesByTheirGeometry) {
  const std::string bag = Bag([](rosbag::Bag& out) {
    const PersonState person = PersonAt(4);
    tf2_msgs::TFMessage message = TransformsOf(person);
    message.transforms.resize(urdf::kSegmentCount);
    for (std::size_t i = 0; i < message.transforms.size(); ++i) {
      auto& transform = message.transforms[i];
      const SegmentState& state = person.sample.segments[At(SegmentsByName()[i])];
      transform.transform.rotation.w = state.orientation.w();
      transform.transform.rotation.x = state.orientation.x();
      transform.transform.rotation.y = state.orientation.y();
      transform.transform.rotation.z = state.orientation.z();
    }
    out.write("/tf", RosTimeOf(kBagStart), message);
  });
  const ReadPeople recorded = ReadBag(bag);
  ASSERT_EQ(recorded.samples.size(), 1U);
  ExpectPoses(recorded.samples[0], PersonAt(4));
}

TEST_F(BagTest, ReadsAnOldMessageTypeOfTheSameLayout) {
  const std::string bag = Bag([](rosbag::Bag& out) {
    const tf2_msgs::TFMessage message = TransformsOf(PersonAt(1));
    AnyBytes raw;
    raw.bytes.resize(ros::serialization::serializationLength(message));
    ros::serialization::OStream stream(raw.bytes.data(),
                                       static_cast<std::uint32_t>(raw.bytes.size()));
    ros::serialization::serialize(stream, message);
    out.write("/tf", RosTimeOf(kBagStart), raw);
  });
  EXPECT_EQ(ReadBag(bag).samples.size(), 1U);
}

TEST_F(BagTest, UsesHeaderTimeStampsUntilTheyGoBack) {
  const std::vector<std::int64_t> headers = {0, 10, 20, 20, 5, 40, 50};  // ms
  const std::string bag = Bag([&](rosbag::Bag& out) {
    for (std::size_t i = 0; i < headers.size(); ++i) {
      PersonState person = PersonAt(static_cast<int>(i));
      person.sample.stamp_nanos = kBagStart + headers[i] * kNanosPerMilli;
      out.write("/tf",
                RosTimeOf(kBagStart + (static_cast<std::int64_t>(i) * 10 + 2) * kNanosPerMilli),
                TransformsOf(person));
    }
  });
  const ReadPeople recorded = ReadBag(bag);
  std::vector<std::int64_t> millis;
  for (const BodySample& sample : recorded.samples) {
    millis.push_back((sample.stamp_nanos - kBagStart) / kNanosPerMilli);
  }
  EXPECT_THAT(millis, ElementsAre(0, 10, 20, 42, 52, 62));
  EXPECT_EQ(recorded.counters.duplicates, 1U) << "20 ms twice is one sample";
}

TEST_F(BagTest, IgnoresHeaderTimeStampsOfAnotherDay) {
  const std::string bag = Bag([](rosbag::Bag& out) {
    for (int n = 0; n < 3; ++n) {
      PersonState person = PersonAt(n);
      person.sample.stamp_nanos = 34'486'000 * kNanosPerMilli;  // the same wrong stamp every time
      out.write("/tf", RosTimeOf(kBagStart + n * kBagPeriod), TransformsOf(person));
    }
  });
  const ReadPeople recorded = ReadBag(bag);
  ASSERT_EQ(recorded.samples.size(), 3U);
  EXPECT_EQ(recorded.samples[0].stamp_nanos, kBagStart);
  EXPECT_EQ(recorded.samples[2].stamp_nanos, kBagStart + 2 * kBagPeriod);
  EXPECT_EQ(recorded.samples[2].time_code_millis, 20);
}

TEST_F(BagTest, SkipsAndCountsSamplesWithMissingSegments) {
  const std::string bag = Bag([](rosbag::Bag& out) {
    for (int n = 0; n < 5; ++n) {
      tf2_msgs::TFMessage message = TransformsOf(PersonAt(n));
      if (n == 1 || n == 4) message.transforms.erase(message.transforms.begin() + 7);
      out.write("/tf", RosTimeOf(kBagStart + n * kBagPeriod), message);
    }
  });
  const ReadPeople recorded = ReadBag(bag);
  ASSERT_EQ(recorded.samples.size(), 3U);
  ExpectPoses(recorded.samples[1], PersonAt(2));
  EXPECT_THAT(recorded.counters.rejected, ElementsAre(Pair("sample without all 23 segments", 2)));
}

TEST_F(BagTest, ReadsFramesOfThePersonFromTfStatic) {
  const std::string bag = Bag([](rosbag::Bag& out) {
    tf2_msgs::TFMessage fixed;
    for (int n = 0; n < 3; ++n) {
      tf2_msgs::TFMessage moving;
      for (const auto& transform : TransformsOf(PersonAt(0)).transforms) {
        const bool is_toe = transform.child_frame_id == "skeleton_left_toe";
        if (is_toe && n == 0) fixed.transforms.push_back(transform);
        if (is_toe) continue;
        moving.transforms.push_back(transform);
        moving.transforms.back().header.stamp = RosTimeOf(kBagStart + n * kBagPeriod);
      }
      if (n == 0) out.write("/tf_static", RosTimeOf(kBagStart - kBagPeriod), fixed);
      out.write("/tf", RosTimeOf(kBagStart + n * kBagPeriod), moving);
    }
  });
  const ReadPeople recorded = ReadBag(bag);
  ASSERT_EQ(recorded.samples.size(), 3U);
  for (const BodySample& sample : recorded.samples) ExpectPoses(sample, PersonAt(0));
  EXPECT_THAT(recorded.counters.rejected, IsEmpty());
  EXPECT_THAT(recorded.counters.ignored, IsEmpty());
}

// So that a picture's time code is that of the recording, whoever's sample is the newest.
TEST_F(BagTest, CountsAPersonWhoAppearsLaterFromWhereTheOthersAre) {
  const ReadPeople recorded = ReadBag(Bag([](rosbag::Bag& out) {
    for (int n = 0; n < 200; ++n) {
      const std::int64_t now = kBagStart + n * kBagPeriod;
      out.write("/tf", RosTimeOf(now), TransformsOf(PersonAt(n, "anna")));
      if (n >= 100) out.write("/tf", RosTimeOf(now), TransformsOf(PersonAt(n, "ben")));
    }
  }));
  ASSERT_EQ(recorded.samples.size(), 300U);
  for (const BodySample& sample : recorded.samples) {
    const std::int64_t since = sample.stamp_nanos - kBagStart;
    EXPECT_EQ(sample.time_code_millis, since / kNanosPerMilli);
    EXPECT_NEAR(sample.counter, static_cast<double>(since / kBagPeriod), 1);
  }
}

// A recorder hears the first messages together, some time after they were sent.
TEST_F(BagTest, HasTheRateOfTheHeadersAndNotOfTheRecorder) {
  const ReadPeople recorded = ReadBag(Bag([](rosbag::Bag& out) {
    for (int n = 0; n < 100; ++n) {
      out.write("/tf", RosTimeOf(kBagStart + std::max(n, 8) * kBagPeriod + n),
                TransformsOf(PersonAt(n)));
    }
  }));
  EXPECT_EQ(recorded.rate_hz, 100);
}

TEST_F(BagTest, HasTheRateWithoutThePauses) {
  const ReadPeople recorded = ReadBag(Bag([](rosbag::Bag& out) {
    for (int n = 0; n < 100; ++n) {
      const int at = n < 50 ? n : n + 200;
      out.write("/tf", RosTimeOf(kBagStart + at * kBagPeriod), TransformsOf(PersonAt(at)));
    }
  }));
  EXPECT_EQ(recorded.rate_hz, 100);
}

TEST_F(BagTest, FindsAPersonWhoAppearsLater) {
  const std::string bag = Bag([](rosbag::Bag& out) {
    for (int n = 0; n < 30; ++n) {
      out.write("/tf", RosTimeOf(kBagStart + n * 1000 * kNanosPerMilli),
                TransformsOf(PersonAt(n, "anna")));
      if (n >= 20) {
        out.write("/tf", RosTimeOf(kBagStart + n * 1000 * kNanosPerMilli),
                  TransformsOf(PersonAt(n, "aa")));
      }
    }
  });
  const ReadPeople recorded = ReadBag(bag);
  ASSERT_EQ(recorded.characters.size(), 2U);
  EXPECT_EQ(recorded.characters[0].name, "anna") << "keeps her number";
  EXPECT_EQ(recorded.characters[1].name, "aa");
  EXPECT_EQ(recorded.samples.size(), 40U);
}

TEST_F(BagTest, CountsRejectedTransformsByReason) {
  const std::string bag = Bag([](rosbag::Bag& out) {
    for (int n = 0; n < 6; ++n) {
      tf2_msgs::TFMessage message = TransformsOf(PersonAt(n));
      auto& transform = message.transforms[3].transform;
      if (n == 1) transform.translation.y = std::numeric_limits<double>::quiet_NaN();
      if (n == 2) transform.rotation.w += 0.1;
      if (n == 3) transform.translation.z = 1e9;
      if (n == 4) message.transforms[3].header.frame_id = "somewhere_else";
      out.write("/tf", RosTimeOf(kBagStart + n * kBagPeriod), message);
    }
    AnyBytes liar;
    liar.bytes.assign(100, 0xFF);  // 4294967295 transforms
    out.write("/tf", RosTimeOf(kBagStart + 6 * kBagPeriod), liar);
    liar.bytes.assign(100, 0);
    liar.bytes[0] = 1;
    liar.bytes[16] = 0xFF;  // a name longer than the message
    out.write("/tf", RosTimeOf(kBagStart + 7 * kBagPeriod), liar);
    liar.bytes.assign(2, 0);
    out.write("/tf", RosTimeOf(kBagStart + 8 * kBagPeriod), liar);
    AnyBytes::datatype = "std_msgs/String";
    AnyBytes::md5 = ros::message_traits::md5sum<std_msgs::String>();
    out.write("tf", RosTimeOf(kBagStart + 9 * kBagPeriod),
              AnyBytes{{0, 0, 0, 0}});  // a topic has one type
  });
  const ReadPeople recorded = ReadBag(bag);
  EXPECT_EQ(recorded.samples.size(), 2U);
  EXPECT_THAT(
      recorded.counters.rejected,
      UnorderedElementsAre(Pair("transform with a number that is not finite", 1),
                           Pair("transform with a quaternion that is not of unit length", 1),
                           Pair("transform with a position out of range", 1),
                           Pair("sample without all 23 segments", 3),
                           Pair("sample whose frames have no common parent", 1),
                           Pair("transforms that are truncated or have a wrong length field", 3),
                           Pair("message on the topic of transforms that is not a TFMessage", 1)));
}

// As two suits, or a suit beside a robot, that were recorded with remapped topics.
TEST_F(BagTest, TakesTransformsOfTheTopicThatIsChosen) {
  const std::string bag = Bag([](rosbag::Bag& out) {
    for (int n = 0; n < 3; ++n) {
      const ros::Time now = RosTimeOf(kBagStart + n * kBagPeriod);
      out.write("lab/tf", now, TransformsOf(PersonAt(n, "anna")));
      out.write("/second/tf", now, TransformsOf(PersonAt(n, "ben")));
    }
  });
  for (const char* name : {"/lab/tf", "lab/tf"}) {
    const ReadPeople read = ReadBag(bag, name);
    ASSERT_EQ(read.characters.size(), 1u) << name;
    EXPECT_EQ(read.characters[0].name, "anna");
    EXPECT_EQ(read.samples.size(), 3u);
    EXPECT_THAT(read.counters.ignored,
                ElementsAre(Pair(
                    "topic /second/tf (tf2_msgs/TFMessage); --tf_topic takes people from it", 3)));
  }
  EXPECT_THAT(RefusalOf(bag), AllOf(HasSubstr("contains neither /tf nor link_states"),
                                    HasSubstr("It has transforms on /second/tf, lab/tf: choose one "
                                              "of these with --tf_topic")));
  EXPECT_THAT(RefusalOf(bag, "/third/tf"), HasSubstr("contains neither /third/tf nor link_states"));
}

TEST_F(BagTest, HasStaticTransformsBesideTheTopicThatIsChosen) {
  const std::string bag = Bag([](rosbag::Bag& out) {
    tf2_msgs::TFMessage moving = TransformsOf(PersonAt(0)), still;
    still.transforms.push_back(moving.transforms.back());
    moving.transforms.pop_back();
    out.write("/lab/tf_static", RosTimeOf(kBagStart), still);
    out.write("/lab/tf", RosTimeOf(kBagStart), moving);
  });
  EXPECT_EQ(ReadBag(bag, "/lab/tf").samples.size(), 1u);
}

TEST_F(BagTest, RejectsCyclicFrames) {
  const std::string bag = Bag([](rosbag::Bag& out) {
    tf2_msgs::TFMessage message = TransformsOf(PersonAt(0));
    message.transforms[0].header.frame_id = message.transforms[1].child_frame_id;
    message.transforms[1].header.frame_id = message.transforms[0].child_frame_id;
    out.write("/tf", RosTimeOf(kBagStart), message);
  });
  EXPECT_THAT(ReadBag(bag).counters.rejected,
              ElementsAre(Pair("sample whose frames have no common parent", 1)));
}

}  // namespace
}  // namespace kinescope::ros_bridge
