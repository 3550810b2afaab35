// `kinescope convert` and `kinescope strip` as their users run them: files and sockets in, tables
// and MVNX out.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "server/mvn/file/mvnx_source.h"
#include "server/source/open_source.h"
#include "tests/csv_table.h"
#include "tests/full_disk.h"
#include "tests/process.h"
#include "tests/server/mvn/mvn_testing.h"
#include "tests/shared_data.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/kinescope_program.h"
#include "tests/temp_folder.h"

namespace kinescope {
namespace {

namespace fs = std::filesystem;
using mvn::testing::RecordingSink;
using testing::CsvTable;
using ::testing::ElementsAre;
using testing::ExpectRefusal;
using ::testing::HasSubstr;
using testing::Kinescope;
using testing::Process;
using testing::ProgramResult;
using testing::ReadFile;
using testing::SharedData;
using testing::TempFolder;

ProgramResult Convert(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "convert");
  return Kinescope(arguments);
}

RecordingSink SamplesOf(const std::string& path) {
  const auto source = app::OpenSource(path);
  RecordingSink sink;
  while (source->Poll(std::chrono::milliseconds(0), sink) == Source::State::kMore) {
  }
  return sink;
}

// To the last digit: no tolerance anywhere but in the sign of a turn, which means nothing.
void ExpectSameSamples(const std::vector<BodySample>& given,
                       const std::vector<BodySample>& expected) {
  ASSERT_EQ(given.size(), expected.size());
  for (std::size_t k = 0; k < given.size(); ++k) {
    const BodySample &a = given[k], &b = expected[k];
    EXPECT_EQ(a.counter - given[0].counter, b.counter - expected[0].counter);
    EXPECT_EQ(a.has_linear, b.has_linear);
    EXPECT_EQ(a.has_angular, b.has_angular);
    for (std::size_t i = 0; i < a.segments.size(); ++i) {
      const SegmentState &x = a.segments[i], &y = b.segments[i];
      ASSERT_EQ(x.position, y.position) << i << " of " << k;
      ASSERT_TRUE(x.orientation.coeffs() == y.orientation.coeffs() ||
                  x.orientation.coeffs() == -y.orientation.coeffs())
          << i << " of " << k;
      ASSERT_EQ(x.velocity, y.velocity);
      ASSERT_EQ(x.acceleration, y.acceleration);
      ASSERT_EQ(x.angular_velocity, y.angular_velocity);
      ASSERT_EQ(x.angular_acceleration, y.angular_acceleration);
    }
    ASSERT_EQ(a.com.has_value(), b.com.has_value());
    if (a.com) {
      EXPECT_EQ(a.com->position, b.com->position);
      EXPECT_EQ(a.com->velocity, b.com->velocity);
      EXPECT_EQ(a.com->acceleration, b.com->acceleration);
    }
    if (b.streamed_angles_deg) {
      EXPECT_EQ(a.streamed_angles_deg, b.streamed_angles_deg);
    }
    ASSERT_EQ(a.foot_contacts.has_value(), b.foot_contacts.has_value());
    ASSERT_EQ(a.has_tracker, b.has_tracker);
    for (std::size_t i = 0; i < a.trackers.size(); ++i) {
      if (!a.has_tracker.test(i)) continue;
      ASSERT_EQ(a.trackers[i].free_acceleration, b.trackers[i].free_acceleration);
      ASSERT_EQ(a.trackers[i].magnetic_field, b.trackers[i].magnetic_field);
    }
  }
}

// By name and number, whatever the order of segments; shoulders have two names.
std::map<std::pair<int, std::string>, Eigen::Vector3d> ByName(const urdf::Landmarks& landmarks) {
  std::map<std::pair<int, std::string>, Eigen::Vector3d> by_name;
  for (const urdf::Landmark& landmark : landmarks) {
    std::string name = landmark.name;
    const std::size_t at = name.find("C7Shoulder");
    if (at != std::string::npos) name.replace(at, 2, "T4");
    by_name[{landmark.segment, name}] = landmark.in_segment;
  }
  return by_name;
}

// Through MVNX and back: the same samples, the same landmarks, and from the second time on the same
// bytes but for the name of the source.
void ExpectRoundTrip(const std::string& source, const std::vector<std::string>& more = {}) {
  const TempFolder folder;
  const std::string once = folder / "once.mvnx", twice = folder / "twice.mvnx";
  std::vector<std::string> arguments = {source, "--out", once};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramResult first = Convert(arguments);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  ASSERT_EQ(Convert({once, "--out", twice}).exit_code, 0);
  const RecordingSink read = SamplesOf(once);
  ExpectSameSamples(SamplesOf(twice).samples, read.samples);
  const std::string a = ReadFile(once), b = ReadFile(twice);
  EXPECT_TRUE(a.substr(a.find("<segments>")) == b.substr(b.find("<segments>")))
      << "the second time gives other bytes";
  if (!more.empty()) return;  // a part of the source
  const RecordingSink expected = SamplesOf(source);
  ExpectSameSamples(read.samples, expected.samples);
  EXPECT_EQ(ByName(read.characters.back().landmarks), ByName(expected.characters.back().landmarks));
}

TEST(Convert, WritesMvnxThatReadsBackToTheLastDigit) {
  ExpectRoundTrip("demo:walk", {"--seconds", "1.5", "--rate_hz", "240"});
  ExpectRoundTrip("demo:lift", {"--seconds", "1", "--rate_hz", "60"});
}

TEST(Convert, WritesRealMvnxOfBothVersionsThatReadsBackToTheLastDigit) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/test_mocap.mvnx");
  ExpectRoundTrip(SharedData("mvnx/test_mocap.mvnx"));
  ExpectRoundTrip(SharedData("mvnx/Meri-020.mvnx"));
}

// The names of the elements directly inside the first element that begins with `parent`, in order.
std::vector<std::string> ChildrenOf(const std::string& text, const std::string& parent,
                                    const std::string& indent) {
  std::vector<std::string> names;
  std::size_t at = text.find(parent);
  EXPECT_NE(at, std::string::npos) << parent;
  while ((at = text.find('\n', at)) != std::string::npos) {
    ++at;
    if (text.compare(at, indent.size() - 1, indent.substr(1)) == 0 &&
        text.compare(at, indent.size(), indent) != 0) {
      break;  // the parent ends
    }
    if (text.compare(at, indent.size(), indent) != 0 || text[at + indent.size()] != '<' ||
        text[at + indent.size() + 1] == '/') {
      continue;
    }
    const std::size_t begin = at + indent.size() + 1;
    names.push_back(text.substr(begin, text.find_first_of(" >/", begin) - begin));
  }
  return names;
}

TEST(Convert, OrdersMvnxAsVersion4Demands) {
  const TempFolder folder;
  const std::string path = folder / "walk.mvnx";
  ASSERT_EQ(Convert({"demo:walk", "--seconds", "0.1", "--out", path}).exit_code, 0);
  const std::string text = ReadFile(path);
  EXPECT_EQ(text.find("\n\n"), std::string::npos) << "a blank line";
  EXPECT_EQ(text.find('\r'), std::string::npos);
  EXPECT_THAT(text, HasSubstr("frameRate=\"120\"")) << "whole, for readers that take no 120.0";
  const auto types = [&text] {
    std::vector<std::string> found;
    for (std::size_t at = text.find("<frame "); at != std::string::npos && found.size() < 4;
         at = text.find("<frame ", at + 1)) {
      const std::size_t type = text.find("type=\"", at) + 6;
      found.push_back(text.substr(type, text.find('"', type) - type));
    }
    return found;
  }();
  EXPECT_THAT(types, ElementsAre("identity", "tpose", "tpose-isb", "normal"));
  EXPECT_THAT(ChildrenOf(text, "<frame time=\"0\" index=\"0\"", "\t\t\t\t"),
              ElementsAre("orientation", "position", "velocity", "acceleration", "angularVelocity",
                          "angularAcceleration", "jointAngle", "jointAngleXZY", "jointAngleErgo",
                          "jointAngleErgoXZY", "centerOfMass"));
  EXPECT_THAT(ChildrenOf(text, "<subject ", "\t\t"),
              ElementsAre("comment", "segments", "joints", "ergonomicJointAngles", "frames"));
  EXPECT_EQ(text.find(" ms=\"1"), std::string::npos) << "nobody knows the time of day";
}

TEST(Convert, GivesTheSameBytesAgain) {
  const TempFolder folder;
  std::vector<std::string> texts;
  for (const char* name : {"a", "b"}) {
    const std::string path = folder / name;
    ASSERT_EQ(Convert({"demo:lift", "--seconds", "1", "--hand_load", "both:10", "--out",
                       path + ".csv", "--out", path + ".mvnx"})
                  .exit_code,
              0);
    texts.push_back(ReadFile(path + ".csv") + ReadFile(path + ".mvnx"));
  }
  EXPECT_EQ(texts[0], texts[1]);
  EXPECT_THAT(texts[0], HasSubstr("\"\"hand_load\"\":\"\"both:10\"\"")) << "provenance";
}

TEST(Convert, WritesTheValuesOfTheSamplesIntoATableWithUnits) {
  const TempFolder folder;
  const std::string path = folder / "lift.csv";
  ASSERT_EQ(Convert({"demo:lift", "--seconds", "0.5", "--out", path}).exit_code, 0);
  const CsvTable table(ReadFile(path));
  const auto source = app::OpenSource("demo:lift");
  RecordingSink sink;
  ASSERT_EQ(table.rows.size(), 61U);
  while (sink.samples.size() < table.rows.size()) {
    ASSERT_EQ(source->Poll(std::chrono::milliseconds(0), sink), Source::State::kMore);
  }
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const BodySample& sample = sink.samples[row];
    EXPECT_EQ(table.Number(row, "time_s"),
              static_cast<double>(sample.stamp_nanos - sink.samples[0].stamp_nanos) / 1e9);
    EXPECT_EQ(table.At(row, "utc"), "") << "nobody knows the time of day";
    const SegmentState& hand = sample.segments[urdf::kRightHand];
    EXPECT_EQ(table.Number(row, "right_hand_position_x_m"), hand.position.x());
    EXPECT_EQ(table.Number(row, "right_hand_orientation_w"), hand.orientation.w());
    EXPECT_EQ(table.Number(row, "right_hand_acceleration_z_m_s2"), hand.acceleration.z());
    EXPECT_EQ(table.Number(row, "right_hand_angular_velocity_y_rad_s"), hand.angular_velocity.y());
    EXPECT_EQ(table.Number(row, "com_velocity_z_m_s"), sample.com->velocity.z());
    EXPECT_EQ(table.At(row, "com_source"), "mvn");
    const auto& knee = (*sample.streamed_angles_deg)[urdf::jRightKnee];
    EXPECT_NEAR(table.Number(row, "right_knee_angle_zxy_flexion_deg"), knee.z(), 1e-9);
    EXPECT_TRUE(std::isfinite(table.Number(row, "pelvis_t8_angle_xzy_flexion_deg")));
    EXPECT_EQ(table.At(row, "right_foot_on_floor"), "1");
    EXPECT_EQ(table.At(row, "right_foot_heel_contact"), "") << "no suit reported it";
  }
  const auto provenance = nlohmann::json::parse(table.At(0, "provenance"));
  EXPECT_EQ(provenance["source"]["name"], "demo:lift");
  EXPECT_EQ(table.At(1, "provenance"), "");
}

// What is written in a pose is what the table prints: all 66 angles, by the names of the columns.
TEST(Convert, PrintsTheAnglesOfAWrittenPose) {
  const TempFolder folder;
  const std::string path = folder / "pose.csv";
  std::map<std::string, double> written;  // by column
  std::string pose;
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    const std::string name(urdf::kJoints[urdf::At(joint)].ros_name);
    const bool is_trunk = joint <= urdf::jC1Head;
    double degrees = 4 + joint % 3;
    for (const char* axis : {is_trunk ? "lateral_bending" : "abduction",
                             is_trunk ? "axial_rotation" : "rotation", "flexion"}) {
      pose += fmt::format("{}{}_{}={}", pose.empty() ? "pose:" : ", ", name, axis, degrees);
      written[fmt::format("{}_angle_zxy_{}_deg", name, axis)] = degrees;
      degrees += 7.5;
    }
  }
  ASSERT_EQ(written.size(), 66U);
  ASSERT_EQ(Convert({pose, "--quantities", "angles", "--seconds", "0.1", "--out", path}).exit_code,
            0);
  const CsvTable table(ReadFile(path));
  for (const std::size_t row : {std::size_t{0}, table.rows.size() - 1}) {
    for (const auto& [column, degrees] : written) {
      EXPECT_NEAR(table.Number(row, column), degrees, 1e-6) << column;
    }
  }
}

TEST(Convert, HasTheLoadsOfTheLoadsCommand) {
  const TempFolder folder;
  const std::string motion = folder / "motion.csv", loads = folder / "loads.csv";
  ASSERT_EQ(Convert({"demo:lift", "--seconds", "1", "--hand_load", "both:10", "--out", motion,
                     "--quantities", "loads,ground"})
                .exit_code,
            0);
  ASSERT_EQ(
      Kinescope({"loads", "demo:lift", "--seconds", "1", "--hand_load", "both:10", "--csv", loads})
          .exit_code,
      0);
  const CsvTable a(ReadFile(motion)), b(ReadFile(loads));
  ASSERT_EQ(a.rows.size(), b.rows.size());
  for (std::size_t row = 0; row < a.rows.size(); row += 10) {
    for (const char* name :
         {"right_knee_ratio", "l5_s1_class", "left_hip_moment_y_Nm", "l5_s1_compression_N",
          "cop_x_m", "ground_force_z_N", "right_foot_force_z_N", "right_hand_load_kg"}) {
      EXPECT_EQ(a.At(row, name), b.At(row, name)) << name;
    }
  }
}

TEST(Convert, HasTheSameValuesInALongTable) {
  const TempFolder folder;
  const std::string wide = folder / "wide.csv", tidy = folder / "tidy.csv";
  ASSERT_EQ(Convert({"demo:walk", "--seconds", "0.2", "--out", wide}).exit_code, 0);
  ASSERT_EQ(Convert({"demo:walk", "--seconds", "0.2", "--layout", "long", "--out", tidy}).exit_code,
            0);
  const CsvTable a(ReadFile(wide)), b(ReadFile(tidy));
  std::map<std::string, std::size_t> row_of;  // time: row of `a`
  std::size_t known = 0;
  for (std::size_t row = 0; row < a.rows.size(); ++row) {
    row_of[a.At(row, "time_s")] = row;
    for (const std::string& cell : a.rows[row]) known += cell.empty() ? 0 : 1;
  }
  for (std::size_t row = 0; row < b.rows.size(); ++row) {
    std::string name;
    for (const char* part : {"item", "quantity", "component", "unit"}) {
      const std::string& text = b.At(row, part);
      if (!text.empty()) name += (name.empty() ? "" : "_") + text;
    }
    const std::string& value = b.At(row, "value");
    EXPECT_EQ(value.empty() ? b.At(row, "text") : value, a.At(row_of.at(b.At(row, "time_s")), name))
        << name;
  }
  const std::size_t own = 3 * a.rows.size() + 1;  // time, counter, person; provenance once
  EXPECT_EQ(b.rows.size(), known - own);
}

// `kinescope convert` of a socket, running.
class LiveConvert {
 public:
  explicit LiveConvert(const std::string& arguments)
      : shell_({"/bin/sh", "-c",
                fmt::format("'{}' convert udp://127.0.0.1:0 {} 2>&1 & echo pid $!; wait $!; echo "
                            "exit $?",
                            testing::KinescopePath(), arguments)}) {
    pid_ = static_cast<pid_t>(std::stol(testing::RestOfLine(shell_, "pid ")));
    const std::string line = testing::RestOfLine(shell_, "reading ");
    url_ = line.substr(0, line.find(';'));
  }
  ~LiveConvert() { kill(pid_, SIGKILL); }

  const std::string& url() const { return url_; }
  void WaitFor(const std::string& text) { testing::RestOfLine(shell_, text); }
  int Stop() {
    kill(pid_, SIGINT);
    return std::stoi(testing::RestOfLine(shell_, "exit "));
  }

 private:
  Process shell_;
  pid_t pid_ = 0;
  std::string url_;
};

TEST(Convert, CompletesTheFilesOfALiveStreamOnCtrlC) {
  const TempFolder folder;
  const std::string take = folder / "take.mvnx", live = folder / "live.mvnx",
                    table = folder / "live.csv";
  ASSERT_EQ(Convert({"demo:walk", "--seconds", "1.2", "--rate_hz", "240", "--out", take}).exit_code,
            0);
  LiveConvert convert(fmt::format("--out '{}' --out '{}'", live, table));
  const ProgramResult sent = Kinescope({"stream", take, "--to", convert.url()});
  ASSERT_EQ(sent.exit_code, 0) << sent.err;
  EXPECT_EQ(convert.Stop(), 0);
  const RecordingSink given = SamplesOf(live), expected = SamplesOf(take);
  EXPECT_THAT(ReadFile(live), HasSubstr("frameRate=\"240\""));
  ASSERT_EQ(given.samples.size(), expected.samples.size());
  for (std::size_t k = 0; k < given.samples.size(); ++k) {
    ASSERT_EQ(given.samples[k].counter, expected.samples[k].counter);
    for (std::size_t i = 0; i < urdf::kSegmentCount; ++i) {
      const SegmentState &a = given.samples[k].segments[i], &b = expected.samples[k].segments[i];
      ASSERT_LT((a.position - b.position).norm(), 1e-6) << "float";
      ASSERT_LT(a.orientation.angularDistance(b.orientation), 1e-6);
      ASSERT_LT((a.acceleration - b.acceleration).norm(), 1e-4);
    }
  }
  const urdf::Landmarks &sent_points = expected.characters[0].landmarks,
                        &points = given.characters[0].landmarks;
  EXPECT_EQ(points.size(), sent_points.size());
  EXPECT_EQ(CsvTable(ReadFile(table)).rows.size(), given.samples.size());
}

// At 100 Hz a suit of 240 Hz counts 2, 3, 2, 3, 2 from sample to sample.
TEST(Convert, KnowsTheRateOfAStreamWhoseCounterHasAlternatingSteps) {
  const TempFolder folder;
  const std::string live = folder / "live.mvnx";
  LiveConvert convert(fmt::format("--out '{}'", live));
  const ProgramResult sent = Kinescope({"stream", "demo:walk", "--rate_hz", "240", "--stream_hz",
                                        "100", "--seconds", "1.3", "--to", convert.url()});
  ASSERT_EQ(sent.exit_code, 0) << sent.err;
  EXPECT_EQ(convert.Stop(), 0);
  EXPECT_THAT(ReadFile(live), HasSubstr("frameRate=\"100\""));
  const std::vector<BodySample> samples = SamplesOf(live).samples;
  ASSERT_EQ(samples.size(), 130U);
  EXPECT_EQ(samples.back().counter - samples.front().counter, 129U) << "there are holes";
}

TEST(Convert, LeavesNoFileWithoutASampleAndAdvisesWhileItWaits) {
  const TempFolder folder;
  const std::string path = folder / "nobody.mvnx";
  LiveConvert convert(fmt::format("--seconds 1 --out '{}'", path));
  convert.WaitFor(
      "no pose of a person within 4 s; check the stream with `kinescope inspect udp://");
  EXPECT_EQ(convert.Stop(), 2);
  EXPECT_FALSE(fs::exists(path));
}

TEST(Convert, NamesHolesAndKeepsThemOpen) {
  const TempFolder folder;
  const std::string whole = folder / "whole.mvnx", holed = folder / "holed.mvnx",
                    out = folder / "out.mvnx";
  ASSERT_EQ(Convert({"demo:walk", "--seconds", "1", "--out", whole}).exit_code, 0);
  std::string text = ReadFile(whole);
  const std::size_t from = text.find("\t\t\t<frame time=\"500\"");
  const std::size_t to = text.find("\t\t\t<frame time=\"750\"");
  ASSERT_TRUE(from != std::string::npos && to != std::string::npos);
  text.erase(from, to - from);
  std::ofstream(holed) << text;
  const ProgramResult result = Convert({holed, "--out", out});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out,
              HasSubstr("30 samples are missing in 1 hole; the longest: 0.26 s after 0.49 s"));
  ExpectSameSamples(SamplesOf(out).samples, SamplesOf(holed).samples);
}

TEST(Convert, RefusesWhatItCannotWriteBeforeItReads) {
  const TempFolder folder;
  const std::string csv = folder / "a.csv";
  ExpectRefusal(Convert({"demo:walk", "--out", folder / "a.bvh"}),
                "a.bvh: expected a name that ends in .csv");
  ExpectRefusal(Convert({"demo:walk", "--out", csv, "--out", csv}), "is given twice");
  ExpectRefusal(Convert({"demo:walk", "--out", folder / "none/a.csv"}),
                "No such file or directory");
  for (const char* name : {"none/a.csv", "none/a.mvnx"}) {
    ExpectRefusal(Convert({folder / "missing.mvnx", "--out", folder / name}), name);
  }
  ExpectRefusal(Convert({"demo:walk", "--out", csv, "--quantities", "angle"}), "nearest: angles");
  ExpectRefusal(Convert({"demo:walk", "--out", csv, "--quantities", "trackers"}),
                "demo:walk has none of them");
  ExpectRefusal(Convert({"demo:walk", "--out", folder / "a.mvnx", "--layout", "long"}),
                "has no effect without a table");
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Convert, LeavesNoHalfFileOnAFullDisk) {
  const TempFolder folder;
  const std::string path = folder / "big.csv", other = folder / "big.mvnx";
  ProgramResult result;
  {
    const testing::SmallFilesOnly full(300'000);
    result = Convert({"demo:walk", "--seconds", "2", "--out", path, "--out", other});
  }
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("big."));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Convert, WritesAFilePerPersonWhereAFormatHasOnlyOne) {
  const TempFolder folder;
  const std::string capture = folder / "two.pcap", out = folder / "two.mvnx",
                    table = folder / "two.csv";
  Process record(
      {"/bin/sh", "-c",
       fmt::format("'{}' record udp://127.0.0.1:0 --seconds 3 --out '{}' 2>&1; echo over",
                   testing::KinescopePath(), capture)});
  const std::string line = testing::RestOfLine(record, "recording ");
  ASSERT_EQ(Kinescope({"stream", "demo:walk", "--characters", "2", "--seconds", "1", "--to",
                       line.substr(0, line.find(' '))})
                .exit_code,
            0);
  testing::RestOfLine(record, "over");
  const ProgramResult result = Convert({capture, "--out", out, "--out", table});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string second = folder / "two_2.mvnx";
  ASSERT_TRUE(fs::exists(second)) << result.out;
  const auto first_samples = SamplesOf(out).samples, second_samples = SamplesOf(second).samples;
  EXPECT_EQ(first_samples.size(), second_samples.size());
  EXPECT_NEAR((second_samples[5].segments[0].position - first_samples[5].segments[0].position).y(),
              1, 1e-5);
  EXPECT_EQ(CsvTable(ReadFile(table)).rows.size(), first_samples.size() + second_samples.size());
}

TEST(Strip, ReadsTheSampleOfEveryFrame) {
  const TempFolder folder;
  const std::string clip = folder / "walk.mp4", still = folder / "walk.png",
                    bare = folder / "bare.png", table = folder / "frames.csv";
  ASSERT_EQ(Kinescope({"render", "demo:walk", "--seconds", "0.5", "--size", "640x360", "--overlay",
                       "frame_code", "--out", clip})
                .exit_code,
            0);
  ASSERT_EQ(Kinescope({"render", "demo:walk", "--time", "0.5", "--size", "640x360", "--overlay",
                       "frame_code", "--out", still})
                .exit_code,
            0);
  ASSERT_EQ(Kinescope({"render", "demo:walk", "--time", "0.5", "--size", "640x360", "--out", bare})
                .exit_code,
            0);
  const ProgramResult result = Kinescope({"strip", clip, still, bare, "--out", table});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("bare.png: no readable frame code in the picture"));
  const CsvTable frames(ReadFile(table));
  ASSERT_EQ(frames.rows.size(), 15U + 2);
  for (std::size_t k = 0; k < 15; ++k) {
    EXPECT_EQ(frames.At(k, "sample_counter"), std::to_string(4 * k));  // 120 Hz at 30 a second
    EXPECT_NEAR(frames.Number(k, "time_code_s"), static_cast<double>(k) / 30, 6e-4);
  }
  EXPECT_EQ(frames.At(15, "sample_counter"), "60");
  EXPECT_EQ(frames.At(16, "sample_counter"), "");
  EXPECT_EQ(Kinescope({"strip", bare}).exit_code, 1);
  ExpectRefusal(Kinescope({"strip", folder / "none.mp4"}), "No such file");
}

}  // namespace
}  // namespace kinescope
