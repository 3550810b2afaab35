#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/system/errors.h"
#include "server/mvn/file/mvnx_source.h"
#include "server/mvn/open.h"
#include "tests/heap_in_use.h"
#include "tests/server/mvn/file/synthetic_mvnx.h"
#include "tests/server/mvn/mvn_testing.h"
#include "tests/shared_data.h"

namespace kinescope::mvn {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using ::kinescope::testing::SharedData;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::RecordingSink;
using testing::SwingingArms;
using testing::WriteMvnx;

std::string SmallFile(int version = 4) {
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  return WriteMvnx(version, 240, skeleton, SwingingArms(skeleton, 8));
}

// A source of `text`, which must outlive it.
MvnxSource Open(std::string& text) {
  return MvnxSource(fmemopen(text.data(), text.size(), "rb"), "small.mvnx");
}

// All samples of a source, one a call.
RecordingSink ReadAll(Source& source) {
  RecordingSink sink;
  std::size_t calls = 0;
  while (source.Poll(std::chrono::milliseconds(0), sink) == Source::State::kMore) {
    ++calls;
    EXPECT_EQ(sink.samples.size(), calls) << "one sample a call";
  }
  return sink;
}

// The error of reading `text` to its end; "" if there is none.
std::string ErrorOfMvnx(std::string text) {
  try {
    MvnxSource source = Open(text);
    ReadAll(source);
  } catch (const SourceError& error) {
    return error.what();
  }
  return "";
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Mvnx, LeavesOutSensorsThatAreNotListedAndRefusesWrongCounts) {
  const std::string lists =
      "<sensorOrientation>1 0 0 0 1 0 0 0</sensorOrientation>"
      "<sensorFreeAcceleration>0 0 1 0 0 2</sensorFreeAcceleration>"
      "<sensorMagneticField>1 0 0 0 1 0</sensorMagneticField></frame>";
  std::string unlisted = Replaced(SmallFile(), "</frame>\n</frames>", lists + "</frames>");
  MvnxSource without = Open(unlisted);
  EXPECT_TRUE(ReadAll(without).samples.back().has_tracker.none()) << "whose sensors?";

  const auto listed = [&](const std::string& sensors) {
    return Replaced(unlisted, "<joints>", "<sensors>" + sensors + "</sensors><joints>");
  };
  std::string good = listed("<sensor label=\"Head\"/><sensor label=\"Prop1\"/>");
  MvnxSource with = Open(good);
  const BodySample last = ReadAll(with).samples.back();
  EXPECT_EQ(last.has_tracker.count(), 1U);
  ASSERT_TRUE(last.has_tracker.test(urdf::kHead));
  EXPECT_EQ(last.trackers[urdf::kHead].free_acceleration, Vector3d(0, 0, 1));
  EXPECT_FALSE(last.trackers[urdf::kHead].has_rates);

  const auto refusal = [](std::string text) -> std::string {
    try {
      MvnxSource source = Open(text);
      ReadAll(source);
      return "accepted";
    } catch (const SourceError& error) {
      return error.what();
    }
  };
  EXPECT_THAT(refusal(listed("<sensor label=\"Head\"/>")),
              HasSubstr("sensorOrientation has 8 numbers; expected 4"));
  EXPECT_THAT(refusal(listed("<sensor label=\"Head\"/><sensor label=\"Head\"/>")),
              HasSubstr("sensor Head is listed twice"));
}

class MvnxVersion : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Both, MvnxVersion, ::testing::Values(3, 4));

TEST_P(MvnxVersion, RestoresTheWrittenSamples) {
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton(1.7);
  const auto written = SwingingArms(skeleton, 8);
  std::string text = WriteMvnx(GetParam(), 240, skeleton, written);
  MvnxSource source = Open(text);
  EXPECT_EQ(source.nominal_rate_hz(), 240);
  EXPECT_FALSE(source.is_live());
  const RecordingSink sink = ReadAll(source);
  ASSERT_EQ(sink.samples.size(), written.size());
  for (std::size_t frame = 0; frame < written.size(); ++frame) {
    const BodySample& given = sink.samples[frame];
    EXPECT_EQ(given.counter, frame);
    EXPECT_TRUE(given.has_linear);
    EXPECT_TRUE(given.has_angular);
    for (std::size_t i = 0; i < given.segments.size(); ++i) {
      const SegmentState& expected = written[frame].segments[i];
      EXPECT_LT((given.segments[i].position - expected.position).norm(), 2e-6);
      EXPECT_LT(given.segments[i].orientation.angularDistance(expected.orientation), 1e-5)
          << urdf::kSegments[i].mvn_name;
      EXPECT_LT((given.segments[i].velocity - expected.velocity).norm(), 2e-6);
      EXPECT_LT((given.segments[i].angular_velocity - expected.angular_velocity).norm(), 2e-6);
    }
    ASSERT_TRUE(given.com);
    EXPECT_EQ(given.com->has_derivatives, frame % 2 == 0);
    EXPECT_LT((given.com->velocity - written[frame].com->velocity).norm(), 2e-6);
    ASSERT_TRUE(given.streamed_angles_deg);
    EXPECT_EQ((*given.streamed_angles_deg)[7].x(), 7);
  }
  ASSERT_EQ(sink.characters.size(), 1U);
  EXPECT_EQ(sink.characters[0].name, "Synthetic");
  EXPECT_EQ(sink.characters[0].color_rgb, 0x4060FFU);
  ASSERT_TRUE(sink.characters[0].skeleton);
  EXPECT_NEAR(sink.characters[0].skeleton->height, 1.7, 1e-5);
}

TEST_P(MvnxVersion, ExcludesCalibrationFramesFromTheMotion) {
  std::string text = SmallFile(GetParam());
  MvnxSource source = Open(text);
  ReadAll(source);
  const SourceCounters counters = source.counters();
  EXPECT_EQ(counters.samples, 8U);
  EXPECT_EQ(counters.ignored.at("frame tpose"), 1U);
  EXPECT_EQ(counters.ignored.count("frame npose"), GetParam() == 3 ? 1U : 0U);
  EXPECT_EQ(counters.ignored.count("frame identity"), GetParam() == 4 ? 1U : 0U);
  EXPECT_EQ(counters.bytes, text.size());
}

TEST(Mvnx, ComputesTimesFromTheIndexAndTheFirstFrame) {
  std::string text = SmallFile();
  MvnxSource source = Open(text);
  const RecordingSink sink = ReadAll(source);
  const std::int64_t first = 1'600'000'000'000 * 1'000'000;
  for (std::size_t i = 0; i < sink.samples.size(); ++i) {
    const double seconds = static_cast<double>(i) / 240;
    EXPECT_NEAR(static_cast<double>(sink.samples[i].stamp_nanos - first), seconds * 1e9, 1);
    EXPECT_EQ(sink.samples[i].time_code_millis, std::llround(seconds * 1000));
    EXPECT_EQ(sink.samples[i].arrival_nanos, 0);
  }
}

TEST(Mvnx, KeepsTheSignOfNeighbouringQuaternions) {
  std::string text = SmallFile();  // which changes every sign with every frame
  MvnxSource source = Open(text);
  const RecordingSink sink = ReadAll(source);
  for (std::size_t frame = 1; frame < sink.samples.size(); ++frame) {
    for (std::size_t i = 0; i < urdf::kSegmentCount; ++i) {
      EXPECT_GT(sink.samples[frame].segments[i].orientation.dot(
                    sink.samples[frame - 1].segments[i].orientation),
                0);
    }
  }
}

TEST(Mvnx, AcceptsMissingOptionalListsAndSkipsUnknownOnes) {
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  auto samples = SwingingArms(skeleton, 2);
  for (BodySample& sample : samples) {
    sample.has_linear = sample.has_angular = false;
    sample.com.reset();
    sample.streamed_angles_deg.reset();
  }
  std::string text = Replaced(WriteMvnx(4, 60, skeleton, samples), "</position>",
                              "</position><footContacts>1 1 x</footContacts>");
  MvnxSource source = Open(text);
  const RecordingSink sink = ReadAll(source);
  ASSERT_EQ(sink.samples.size(), 2U);
  EXPECT_FALSE(sink.samples[0].has_linear);
  EXPECT_FALSE(sink.samples[0].has_angular);
  EXPECT_FALSE(sink.samples[0].com);
  EXPECT_FALSE(sink.samples[0].streamed_angles_deg);
}

TEST(Mvnx, SkipsAPropAmongTheSegments) {
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  auto samples = SwingingArms(skeleton, 1);
  std::string text = WriteMvnx(4, 60, skeleton, samples);
  text = Replaced(text, "segmentCount=\"23\"", "segmentCount=\"24\"");
  text = Replaced(text, "</segments>", "<segment label=\"Prop1\" id=\"24\"/></segments>");
  for (const auto& [list, numbers] : {std::pair("orientation", "1 0 0 0"),
                                      {"position", "0 0 0"},
                                      {"velocity", "0 0 0"},
                                      {"acceleration", "0 0 0"},
                                      {"angularVelocity", "0 0 0"},
                                      {"angularAcceleration", "0 0 0"}}) {
    const std::string end = std::string("</") + list + ">";
    for (std::size_t at = text.find(end); at != std::string::npos;
         at = text.find(end, at + end.size() + std::strlen(numbers))) {
      text.insert(at, numbers);
    }
  }
  MvnxSource source = Open(text);
  EXPECT_EQ(ReadAll(source).samples.size(), 1U);
}

// The contacts of the first frame of motion of a file that defines `labels` and tells `numbers`.
std::optional<std::array<FootContactFlags, 2>> ContactsOf(const std::vector<std::string>& labels,
                                                          const std::string& numbers) {
  std::string definition = "</joints><footContactDefinition>";
  for (const std::string& label : labels) {
    definition += "<contactDefinition label=\"" + label + "\"/>";
  }
  const std::string frame = "type=\"normal\">";
  std::string text = Replaced(SmallFile(), "</joints>", definition + "</footContactDefinition>");
  text = Replaced(text, frame, frame + "<footContacts>" + numbers + "</footContacts>");
  MvnxSource source = Open(text);
  const RecordingSink sink = ReadAll(source);
  EXPECT_FALSE(sink.samples.at(1).foot_contacts) << "that frame says nothing";
  return sink.samples.at(0).foot_contacts;
}

TEST(Mvnx, ReadsFootContactsByTheirLabelsInAnyOrder) {
  const std::vector<std::string> four = {"LeftFoot_Toe", "RightFoot_Heel", "LeftFoot_Heel",
                                         "RightFoot_Toe"};
  const auto feet = ContactsOf(four, "1 0 0 1");
  ASSERT_TRUE(feet);
  EXPECT_FALSE((*feet)[urdf::kRight].heel);
  EXPECT_TRUE((*feet)[urdf::kRight].forefoot);
  EXPECT_FALSE((*feet)[urdf::kLeft].heel);
  EXPECT_TRUE((*feet)[urdf::kLeft].forefoot);
  EXPECT_FALSE(ContactsOf({"LeftFoot_Heel"}, "1")) << "one end is not both feet";
  EXPECT_FALSE(ContactsOf({}, "1 1 1 1")) << "nobody says which is which";
  EXPECT_THROW(ContactsOf(four, "1 0 0"), SourceError);
}

TEST(Mvnx, SkipsFingersAndUnknownElements) {
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  const std::string plain = WriteMvnx(4, 60, skeleton, SwingingArms(skeleton, 3));
  std::string text = Replaced(
      plain, "</segments>",
      "</segments><fingerTrackingSegmentsLeft><segments><segment label=\"Pelvis\" id=\"1\">"
      "<points><point label=\"jLeftWrist\"><pos_b>not numbers</pos_b></point></points></segment>"
      "</segments><segment label=\"LeftCarpus\" id=\"1\"/></fingerTrackingSegmentsLeft>"
      "<fingerTrackingJointsLeft><joint label=\"jL5S1\"/></fingerTrackingJointsLeft>");
  text = Replaced(text, "</position>",
                  "</position><orientationFingersLeft>1 0 0 0</orientationFingersLeft>"
                  "<future><orientation>1 2</orientation></future><marker>take 3</marker>");
  text = Replaced(text, "</subject>", "</subject><securityCode code=\"87b44419\"/>");
  MvnxSource source = Open(text);
  const RecordingSink sink = ReadAll(source);
  std::string untouched = plain;
  MvnxSource plain_source = Open(untouched);
  const RecordingSink expected = ReadAll(plain_source);
  ASSERT_EQ(sink.samples.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < urdf::kSegmentCount; ++k) {
      const SegmentState& given = sink.samples[i].segments[k];
      const SegmentState& wanted = expected.samples[i].segments[k];
      EXPECT_EQ(given.position, wanted.position);
      EXPECT_EQ(given.orientation.coeffs(), wanted.orientation.coeffs());
    }
  }
}

// A file that is written while it is read: `start`, then `frames` times the text between the two
// halves of a frame with the next index, then `end`.
class EndlessFile {
 public:
  EndlessFile(std::string start, std::string before, std::string after, std::string end, int frames)
      : text_(std::move(start)),
        before_(std::move(before)),
        after_(std::move(after)),
        end_(std::move(end)),
        frames_(frames) {}

  std::FILE* Open() {
    cookie_io_functions_t functions{};
    functions.read = [](void* self, char* to, std::size_t size) {
      return static_cast<EndlessFile*>(self)->Read(to, size);
    };
    return fopencookie(this, "rb", functions);
  }

 private:
  ssize_t Read(char* to, std::size_t size) {
    while (at_ == text_.size()) {
      if (next_ > frames_) return 0;
      text_ = next_ == frames_ ? end_ : before_ + std::to_string(next_) + after_;
      ++next_;
      at_ = 0;
    }
    const std::size_t count = std::min(size, text_.size() - at_);
    std::memcpy(to, text_.data() + at_, count);
    at_ += count;
    return static_cast<ssize_t>(count);
  }

  std::string text_, before_, after_, end_;
  std::size_t at_ = 0;
  int next_ = 0;
  int frames_;
};

TEST(Mvnx, NeedsNoMoreMemoryForLargerFiles) {
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  const std::string small = WriteMvnx(4, 240, skeleton, SwingingArms(skeleton, 1));
  const std::string mark = "index=\"0\"";
  const std::size_t index = small.find(mark);
  const std::size_t frame = small.rfind("<frame ", index);
  const std::size_t after = small.find("</frame>", index) + std::strlen("</frame>");
  ASSERT_LT(frame, index);
  constexpr int kFrames = 12'000;  // 60 MB
  EndlessFile file(small.substr(0, frame), small.substr(frame, index - frame) + "index=\"",
                   "\"" + small.substr(index + mark.size(), after - index - mark.size()),
                   small.substr(after), kFrames);
  MvnxSource source(file.Open(), "endless.mvnx");
  struct Watching : SampleSink {
    void OnCharacter(const Character&) override {}
    void OnSample(const BodySample&) override {
      if (++samples % 100 == 0) most = std::max(most, kinescope::testing::HeapInUse());
    }
    int samples = 0;
    std::size_t most = 0;
  } sink;
  while (sink.samples < 100) ASSERT_NE(source.Poll({}, sink), Source::State::kEnded);
  const std::size_t at_the_beginning = sink.most;
  while (source.Poll({}, sink) == Source::State::kMore) {
  }
  EXPECT_EQ(sink.samples, kFrames);
  EXPECT_GT(source.counters().bytes, 50'000'000U);
  EXPECT_LT(sink.most, at_the_beginning + 100'000);
}

TEST(Mvnx, ReportsFileLineAndErrorOfAnInvalidFile) {
  const std::string good = SmallFile();
  ASSERT_EQ(ErrorOfMvnx(good), "");
  EXPECT_THAT(ErrorOfMvnx(Replaced(good, "version=\"4\"", "version=\"2\"")),
              AllOf(HasSubstr("small.mvnx:3: "), HasSubstr("version '2'"), HasSubstr("3 and 4")));
  EXPECT_THAT(ErrorOfMvnx("{\"json\": true}"), HasSubstr("not XML"));
  EXPECT_THAT(ErrorOfMvnx("<robot name=\"x\"/>"), HasSubstr("begins with <robot>"));
  EXPECT_THAT(ErrorOfMvnx("<mvnx version=\"4\"></mvnx>"), HasSubstr("<frames> is missing"));
  EXPECT_THAT(ErrorOfMvnx(Replaced(good, "segmentCount=\"23\"", "segmentCount=\"24\"")),
              HasSubstr("24, but 23"));
  EXPECT_THAT(ErrorOfMvnx(Replaced(good, "label=\"LeftToe\"", "label=\"Sword\"")),
              HasSubstr("LeftToe is listed 0 times"));
  EXPECT_THAT(ErrorOfMvnx(Replaced(good, "jRightElbow", "jElsewhere")), HasSubstr("jRightElbow"));
  EXPECT_THAT(ErrorOfMvnx(Replaced(good, "frameRate=\"240", "frameRate=\"-240")),
              HasSubstr("frameRate"));
  EXPECT_THAT(ErrorOfMvnx(Replaced(good, "<velocity>", "<velocity>1 ")),
              AllOf(HasSubstr("velocity has 70 numbers"), HasSubstr("69")));
  EXPECT_THAT(ErrorOfMvnx(Replaced(good, "<velocity>", "<velocity>nan ")), HasSubstr("NaN"));
  EXPECT_THAT(ErrorOfMvnx(Replaced(good, "<velocity>", "<velocity>1,5 ")),
              HasSubstr("is not a number"));
  EXPECT_THAT(ErrorOfMvnx(Replaced(good, "index=\"5\"", "index=\"3\"")),
              HasSubstr("frame index 3"));
  EXPECT_THAT(ErrorOfMvnx(Replaced(good, "ms=\"1600000000000\"", "ms=\"99999999999999999\"")),
              HasSubstr("ms is"));
  EXPECT_THAT(ErrorOfMvnx(Replaced(good, "</subject>", "</subject><subject/>")),
              HasSubstr("second <subject>"));
}

TEST(Mvnx, ReportsEveryTruncation) {
  const std::string whole = SmallFile();
  for (std::size_t size = 1; size < whole.size() - 8; size += 997) {
    const std::string error = ErrorOfMvnx(whole.substr(0, size));
    EXPECT_THAT(error, ::testing::AnyOf(HasSubstr("truncated here"), HasSubstr("not XML")))
        << "cut after " << size << " of " << whole.size() << " bytes";
  }
}

TEST(Mvnx, RejectsADocumentType) {
  const std::string bomb =
      "<!DOCTYPE mvnx [<!ENTITY a \"aaaaaaaa\"><!ENTITY b \"&a;&a;&a;\">]>"
      "<mvnx version=\"4\">&b;</mvnx>";
  EXPECT_THAT(ErrorOfMvnx(bomb), HasSubstr("DOCTYPE"));
}

TEST(Mvnx, RejectsOversizedAndTooDeeplyNestedContent) {
  EXPECT_THAT(ErrorOfMvnx("<mvnx version=\"4\" x=\"" + std::string(3 << 20, 'a')),
              HasSubstr("longer than a megabyte"));
  std::string deep = "<mvnx version=\"4\">";
  for (int i = 0; i < 100; ++i) deep += "<a>";
  EXPECT_THAT(ErrorOfMvnx(deep), HasSubstr("nested too deeply"));
  const std::string good = SmallFile();
  EXPECT_THAT(ErrorOfMvnx(Replaced(good, "<velocity>", "<velocity>" + std::string(1 << 20, ' '))),
              HasSubstr("too long"));
}

TEST(Mvnx, NamesAFileThatIsMissing) {
  try {
    OpenMvnx("/nowhere/motion.mvnx");
    FAIL() << "opened a file that is not there";
  } catch (const SourceError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("/nowhere/motion.mvnx"), HasSubstr("No such file")));
  }
}

// Real files. --------------------------------------------------------------------------------

struct RealFile {
  const char* path;
  std::size_t samples;
  double rate_hz;
  std::int64_t first_millis;
  std::size_t landmarks, sensors;
};

class RealMvnx : public ::testing::TestWithParam<RealFile> {};
INSTANTIATE_TEST_SUITE_P(
    Files, RealMvnx,
    ::testing::Values(RealFile{"mvnx/Meri-020.mvnx", 4, 240, 1478188786272, 125, 17},
                      RealFile{"mvnx/test_mocap.mvnx", 112, 60, 0, 127, 11}),
    [](const auto& file) { return file.index == 0 ? "Version3" : "Version4"; });

TEST_P(RealMvnx, HasSegmentsThatMeetWithinTwoMillimetres) {
  KINESCOPE_NEEDS_SHARED_DATA(GetParam().path);
  const auto source = OpenMvnx(SharedData(GetParam().path));
  const RecordingSink sink = ReadAll(*source);
  ASSERT_EQ(sink.samples.size(), GetParam().samples);
  ASSERT_TRUE(sink.characters.at(0).skeleton);
  const urdf::Skeleton& skeleton = *sink.characters[0].skeleton;
  double worst = 0;
  for (const BodySample& sample : sink.samples) {
    for (int joint = 0; joint < urdf::kJointCount; ++joint) {
      const int parent = urdf::ParentOf(joint);
      const auto child = static_cast<std::size_t>(urdf::ChildOf(joint));
      const SegmentState& state = sample.segments[static_cast<std::size_t>(parent)];
      const Vector3d chained =
          state.position +
          state.orientation * (urdf::SegmentFromLink(parent) * skeleton.origin_in_parent[child]);
      const double gap = (chained - sample.segments[child].position).norm();
      EXPECT_LT(gap, 0.002) << urdf::kJoints[static_cast<std::size_t>(joint)].mvn_name;
      worst = std::max(worst, gap);
    }
  }
  RecordProperty("worst_gap_mm", std::to_string(worst * 1000));
}

TEST_P(RealMvnx, HasJointAnglesThatFollowFromTheQuaternions) {
  KINESCOPE_NEEDS_SHARED_DATA(GetParam().path);
  const auto source = OpenMvnx(SharedData(GetParam().path));
  const RecordingSink sink = ReadAll(*source);
  int compared = 0;
  for (const BodySample& sample : sink.samples) {
    if (!sample.streamed_angles_deg) continue;
    const auto computed = urdf::AnatomicalAngles(OrientationsOf(sample), urdf::AngleSequence::kZxy);
    for (int joint = 0; joint < urdf::kJointCount; ++joint) {
      const Vector3d difference = computed[static_cast<std::size_t>(joint)] -
                                  (*sample.streamed_angles_deg)[static_cast<std::size_t>(joint)];
      for (const double degrees : difference) {
        EXPECT_LT(std::abs(std::remainder(degrees, 360.0)), 0.002)
            << urdf::kJoints[static_cast<std::size_t>(joint)].mvn_name << " at " << sample.counter;
        ++compared;
      }
    }
  }
  EXPECT_GE(compared, 3 * 22 * 3);
}

TEST_P(RealMvnx, HasAllItsLandmarks) {
  KINESCOPE_NEEDS_SHARED_DATA(GetParam().path);
  const auto source = OpenMvnx(SharedData(GetParam().path));
  const RecordingSink sink = ReadAll(*source);
  const urdf::Landmarks& landmarks = sink.characters.at(0).landmarks;
  ASSERT_EQ(landmarks.size(), GetParam().landmarks);
  EXPECT_EQ(landmarks[12].name, "pSacrum");
  EXPECT_EQ(landmarks[12].number, 13) << "269 in the specification: 256 * 1 + 13";
  EXPECT_FALSE(sink.characters[0].skeleton->ends_are_estimated);
}

TEST_P(RealMvnx, HasTheSensorsAsTrackers) {
  KINESCOPE_NEEDS_SHARED_DATA(GetParam().path);
  const auto source = OpenMvnx(SharedData(GetParam().path));
  const RecordingSink sink = ReadAll(*source);
  const bool has_rates = GetParam().sensors == 17;  // the file of version 3
  for (const BodySample& sample : sink.samples) {
    ASSERT_EQ(sample.has_tracker.count(), GetParam().sensors);
    for (std::size_t i = 0; i < urdf::kSegmentCount; ++i) {
      if (!sample.has_tracker.test(i)) continue;
      const TrackerState& tracker = sample.trackers[i];
      EXPECT_NEAR(tracker.orientation.norm(), 1, 1e-12);
      EXPECT_NEAR(tracker.magnetic_field.norm(), 1, 0.6);
      EXPECT_LT(tracker.free_acceleration.norm(), 30);
      EXPECT_EQ(tracker.has_rates, has_rates);
      if (has_rates) {  // nearly at rest in these frames
        EXPECT_NEAR(tracker.acceleration.norm(), 9.8, 2.5) << i;
        EXPECT_LT(tracker.free_acceleration.norm(), 3) << i;
      }
    }
  }
}

TEST_P(RealMvnx, HasItsRateAndClock) {
  KINESCOPE_NEEDS_SHARED_DATA(GetParam().path);
  const auto source = OpenMvnx(SharedData(GetParam().path));
  EXPECT_EQ(source->nominal_rate_hz(), GetParam().rate_hz);
  const RecordingSink sink = ReadAll(*source);
  ASSERT_FALSE(sink.samples.empty());
  if (GetParam().first_millis != 0) {
    EXPECT_EQ(sink.samples[0].stamp_nanos, GetParam().first_millis * 1'000'000);
  }
  for (std::size_t i = 1; i < sink.samples.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(sink.samples[i].stamp_nanos - sink.samples[i - 1].stamp_nanos),
                1e9 / GetParam().rate_hz, 2);
    for (std::size_t s = 0; s < urdf::kSegmentCount; ++s) {
      EXPECT_GT(
          sink.samples[i].segments[s].orientation.dot(sink.samples[i - 1].segments[s].orientation),
          0);
    }
  }
}

TEST(RealMvnxVersion4, HasFootContactsInEverySample) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/test_mocap.mvnx");
  const auto source = OpenMvnx(SharedData("mvnx/test_mocap.mvnx"));
  for (const BodySample& sample : ReadAll(*source).samples) ASSERT_TRUE(sample.foot_contacts);
}

TEST(RealMvnxVersion3, HasTwoCalibrationFramesAndEveryListButNoComDerivatives) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/Meri-020.mvnx");
  const auto source = OpenMvnx(SharedData("mvnx/Meri-020.mvnx"));
  const RecordingSink sink = ReadAll(*source);
  EXPECT_EQ(source->counters().ignored.at("frame npose"), 1U);
  EXPECT_EQ(source->counters().ignored.at("frame tpose"), 1U);
  for (const BodySample& sample : sink.samples) {
    EXPECT_TRUE(sample.has_linear);
    EXPECT_TRUE(sample.has_angular);
    ASSERT_TRUE(sample.com);
    EXPECT_FALSE(sample.com->has_derivatives);
  }
}

}  // namespace
}  // namespace kinescope::mvn
