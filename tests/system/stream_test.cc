// `kinescope stream` as its users run it, and what arrives at the other end of a real socket.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <future>
#include <map>
#include <nlohmann/json.hpp>

#include "server/mvn/encode.h"
#include "server/mvn/open.h"
#include "server/subject/subject.h"
#include "tests/patience.h"
#include "tests/process.h"
#include "tests/shared_data.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/kinescope_program.h"
#include "tests/temp_folder.h"

namespace kinescope {
namespace {

namespace fs = std::filesystem;
using mvn::Header;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::kPatience;
using testing::Process;
using testing::ProgramResult;
using testing::SharedData;
using testing::TempFolder;

using Arguments = std::vector<std::string>;

ProgramResult Stream(Arguments arguments) {
  arguments.insert(arguments.begin(), "stream");
  return testing::Kinescope(arguments);
}

// What the program sent, and what it says of it.
struct Sent {
  std::vector<std::string> datagrams;
  json summary;
};

// Keeps the bytes; addresses and times are the network's.
struct BytesSink : mvn::DatagramSink {
  std::vector<std::string> datagrams;
  void OnDatagram(const mvn::ReceivedDatagram& datagram) override {
    datagrams.emplace_back(datagram.bytes);
  }
};

// Streams to a socket of ours until the program ends and all that it has sent is here.
Sent StreamTo(const std::string& kind, Arguments arguments) {
  const bool is_tcp = kind == "tcp";
  const auto receiver = mvn::OpenDatagrams(kind + "://127.0.0.1:0" + (is_tcp ? "?listen" : ""));
  const std::string url = receiver->description();
  arguments.insert(arguments.end(), {"--to", url.substr(0, url.find('?')), "--json"});
  auto running = std::async(std::launch::async, [&] { return Stream(arguments); });
  BytesSink sink;
  const auto give_up = std::chrono::steady_clock::now() + kPatience;
  constexpr std::chrono::milliseconds kPoll(20);
  while (running.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    EXPECT_NE(receiver->Poll(kPoll, sink), mvn::DatagramSource::State::kEnded);
    if (std::chrono::steady_clock::now() > give_up) break;
  }
  Sent sent;
  const ProgramResult result = running.get();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  sent.summary = json::parse(result.out, nullptr, false);
  if (!sent.summary.is_object()) {
    ADD_FAILURE() << "no JSON object: " << result.out;
    return sent;
  }
  // The loopback delivers before sending returns; what is left is in our own buffers.
  const std::size_t expected = sent.summary.at("datagrams").get<std::size_t>() -
                               sent.summary.at("unsent").get<std::size_t>();
  while (sink.datagrams.size() < expected && std::chrono::steady_clock::now() < give_up) {
    const std::size_t before = sink.datagrams.size();
    EXPECT_NE(receiver->Poll(kPoll, sink), mvn::DatagramSource::State::kEnded);
    if (!is_tcp && sink.datagrams.size() == before) break;
  }
  sent.datagrams = std::move(sink.datagrams);
  EXPECT_EQ(sent.datagrams.size(), expected);
  return sent;
}

Sent StreamToUdp(const Arguments& arguments) { return StreamTo("udp", arguments); }

std::vector<Header> HeadersOf(const std::vector<std::string>& datagrams, mvn::Type type,
                              int character = 0) {
  std::vector<Header> headers;
  for (const std::string& datagram : datagrams) {
    const auto header = mvn::ParseHeader(datagram);
    if (header && header->type == type && header->character == character) {
      headers.push_back(*header);
    }
  }
  return headers;
}

template <class Content>
std::vector<Content> BodiesOf(const std::vector<std::string>& datagrams, int character = 0) {
  std::vector<Content> bodies;
  for (const std::string& datagram : datagrams) {
    const auto message = mvn::ParseDatagram(datagram);
    if (!message || message->header.character != character) continue;
    if (const auto* body = std::get_if<Content>(&message->body)) bodies.push_back(*body);
  }
  return bodies;
}

// A person who walks, as a file of raw datagrams.
std::vector<std::string> WriteRecording(const fs::path& path, int samples) {
  const auto motion = subject::MakeMotion("walk");
  std::vector<std::string> datagrams;
  constexpr double kRateHz = 100;
  for (int i = 0; i < samples; ++i) {
    BodySample sample = motion->At(i / kRateHz);
    sample.counter = 700U + static_cast<std::uint32_t>(i);
    sample.time_code_millis = 7000 + std::lround(i * 1000 / kRateHz);
    for (std::string& datagram : mvn::EncodeSample(sample)) {
      datagrams.push_back(std::move(datagram));
    }
    if (i > 0) continue;
    for (std::string& datagram : mvn::EncodeCharacter(motion->character())) {
      datagrams.push_back(std::move(datagram));
    }
  }
  std::ofstream file(path, std::ios::binary);
  for (const std::string& datagram : datagrams) file << datagram;
  return datagrams;
}

TEST(StreamCommand, SendsTheSubjectLikeASuit) {
  const Sent sent = StreamToUdp({"demo:lift", "--seconds", "0.5"});
  const auto poses = HeadersOf(sent.datagrams, mvn::Type::kPose);
  ASSERT_EQ(poses.size(), 60U) << "half a second at 120 Hz";
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].sample_counter, i);
    EXPECT_NEAR(poses[i].time_code_millis, static_cast<double>(i) * 1000 / 120, 0.51);
  }
  std::map<std::string, std::uint64_t> types;
  std::uint64_t bytes = 0;
  for (const std::string& datagram : sent.datagrams) {
    ++types[datagram.substr(4, 2)];
    bytes += datagram.size();
  }
  EXPECT_THAT(types, ElementsAre(std::pair("02", 60), std::pair("12", 1), std::pair("13", 3),
                                 std::pair("20", 60), std::pair("21", 60), std::pair("22", 60),
                                 std::pair("24", 60)));
  EXPECT_EQ(sent.summary.at("types").get<decltype(types)>(), types);
  EXPECT_EQ(sent.summary.at("samples"), 60);
  EXPECT_EQ(sent.summary.at("bytes"), bytes);
  EXPECT_EQ(sent.summary.at("unsent"), 0);
  EXPECT_EQ(sent.summary.at("source"), "demo:lift");
  // The last one is due 59 periods after the first.
  EXPECT_GE(sent.summary.at("seconds").get<double>(), 59.0 / 120);
}

TEST(StreamCommand, SendsOverTcp) {
  const Sent sent = StreamTo("tcp", {"demo:walk", "--seconds", "0.5", "--types", "02,24"});
  const auto unsent = sent.summary.at("unsent").get<std::size_t>();
  EXPECT_LT(unsent, 60U) << "only what came before there was a connection";
  EXPECT_EQ(sent.summary.at("datagrams"), 2 * 60);
}

TEST(StreamCommand, SendsExactlyTheRequestedTypes) {
  const Sent sent =
      StreamToUdp({"demo:lift", "--seconds", "0.1", "--types", "01,02,03,12,13,20,21,22,23,24,25"});
  for (const char* type : {"01", "02", "03", "20", "21", "22", "23", "24", "25"}) {
    EXPECT_EQ(sent.summary.at("types").at(type), 12) << type;
  }
  const Sent some = StreamToUdp({"demo:lift", "--seconds", "0.1", "--types", "25,02"});
  EXPECT_EQ(some.summary.at("types"), json({{"02", 12}, {"25", 12}}));
}

TEST(StreamCommand, SendsCopiesSideBySide) {
  const Sent sent = StreamToUdp({"demo:walk", "--seconds", "0.1", "--characters", "3"});
  const auto first = BodiesOf<mvn::PoseMessage>(sent.datagrams, 0);
  ASSERT_EQ(first.size(), 12U);
  for (int copy = 0; copy < 3; ++copy) {
    const auto poses = BodiesOf<mvn::PoseMessage>(sent.datagrams, copy);
    ASSERT_EQ(poses.size(), first.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Eigen::Vector3d offset = poses[i].items[0].position - first[i].items[0].position;
      EXPECT_LT((offset - Eigen::Vector3d(0, copy, 0)).norm(), 1e-6);
    }
    const auto names = BodiesOf<mvn::MetaDataMessage>(sent.datagrams, copy);
    ASSERT_EQ(names.size(), 1U);
    EXPECT_EQ(names[0].name, copy == 0 ? "Demo" : "Demo " + std::to_string(copy + 1));
  }
  EXPECT_EQ(sent.summary.at("samples"), 36);
}

TEST(StreamCommand, AddsGlovesAndProps) {
  const Sent sent =
      StreamToUdp({"demo:walk", "--seconds", "2", "--rate_hz", "10", "--gloves", "--props", "2"});
  const auto headers = HeadersOf(sent.datagrams, mvn::Type::kPose);
  const auto poses = BodiesOf<mvn::PoseMessage>(sent.datagrams);
  ASSERT_EQ(poses.size(), 20U);
  constexpr auto kFinger = static_cast<std::size_t>(urdf::kSegmentCount);
  double furthest = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(headers[i].props, 2);
    EXPECT_EQ(headers[i].finger_segments, 40);
    EXPECT_EQ(poses[i].present.count(), 23U + 2 + 40);
    EXPECT_EQ(poses[i].mismatched_ids, 0);
    // Every finger hangs on its hand.
    for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
      const auto hand =
          static_cast<std::size_t>(side == urdf::kRight ? urdf::kRightHand : urdf::kLeftHand);
      for (int finger = 0; finger < kFingersPerHand; ++finger) {
        const auto& item =
            poses[i].items[kFinger + static_cast<std::size_t>(FingerIndex(side, finger))];
        EXPECT_LT((item.position - poses[i].items[hand].position).norm(), 0.2);
        // The tip of the little finger, as seen from its hand.
        const Eigen::Quaterniond in_hand =
            poses[i].items[hand].orientation.conjugate() * item.orientation;
        furthest = std::max(furthest, in_hand.angularDistance(Eigen::Quaterniond::Identity()));
      }
    }
  }
  EXPECT_GT(furthest, 1.5) << "the hand closes";
  std::vector<std::string> names;
  for (const auto& scale : BodiesOf<mvn::ScaleMessage>(sent.datagrams)) {
    for (const auto& segment : scale.segments) names.push_back(segment.name);
  }
  ASSERT_GE(names.size(), 65U);
  EXPECT_EQ(names[23], "RightHandSword");
  EXPECT_EQ(names[25], "LeftCarpus");
  EXPECT_EQ(names[64], "RightFifthDP");
}

TEST(StreamCommand, SkipsSamplesButCountsThem) {
  const Sent sent = StreamToUdp({"demo:walk", "--seconds", "0.5", "--stream_hz", "30"});
  const auto poses = HeadersOf(sent.datagrams, mvn::Type::kPose);
  ASSERT_EQ(poses.size(), 15U);
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_EQ(poses[i].sample_counter, 4 * i);
}

TEST(StreamCommand, ForwardsDatagramsByteForByte) {
  const TempFolder folder;
  const auto written = WriteRecording(folder / "walk.bin", 30);
  EXPECT_EQ(StreamToUdp({folder / "walk.bin"}).datagrams, written);
  EXPECT_EQ(StreamToUdp({folder / "walk.bin", "--speed", "20"}).datagrams, written);
}

// Ten seconds in a tenth; a busy machine makes more of it, but not a hundred times as much.
TEST(StreamCommand, SendsFasterThanRecordedOnRequest) {
  const TempFolder folder;
  WriteRecording(folder / "walk.bin", 1001);
  const Sent sent = StreamToUdp({folder / "walk.bin", "--speed", "100", "--types", "24"});
  EXPECT_EQ(sent.datagrams.size(), 1001U);
  EXPECT_GE(sent.summary.at("seconds").get<double>(), 0.1);
  EXPECT_LT(sent.summary.at("seconds").get<double>(), 9.9);
}

TEST(StreamCommand, NamesAFileWithInvalidUtf8InJson) {
  const TempFolder folder;
  WriteRecording(folder / "n\xFF.bin", 3);
  EXPECT_THAT(StreamToUdp({folder / "n\xFF.bin"}).summary.at("source").get<std::string>(),
              HasSubstr("n\uFFFD.bin"));
}

TEST(StreamCommand, ChangesOnlyTheCharacterInCopiesOfDatagrams) {
  const TempFolder folder;
  const auto written = WriteRecording(folder / "walk.bin", 10);
  const Sent sent = StreamToUdp({folder / "walk.bin", "--characters", "2", "--types", "02,24"});
  std::vector<std::string> expected;
  for (std::string datagram : written) {
    if (datagram.substr(4, 2) != "02" && datagram.substr(4, 2) != "24") continue;
    expected.push_back(datagram);
    datagram[16] = 1;
    expected.push_back(datagram);
  }
  EXPECT_EQ(sent.datagrams, expected);
}

TEST(StreamCommand, ContinuesCountersAndTimeCodesInALoop) {
  const TempFolder folder;
  WriteRecording(folder / "walk.bin", 20);
  const Sent sent = StreamToUdp({folder / "walk.bin", "--loop", "--seconds", "0.7"});
  const auto poses = HeadersOf(sent.datagrams, mvn::Type::kPose);
  ASSERT_EQ(poses.size(), 70U) << "three rounds and a half at 100 Hz";
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].sample_counter, 700 + i);
    EXPECT_EQ(poses[i].time_code_millis, 7000 + 10 * i);
  }
  EXPECT_EQ(BodiesOf<mvn::ScaleMessage>(sent.datagrams).size(), 4U * 3)
      << "once in each round, in three parts";
}

TEST(StreamCommand, SendsARecordingOfSamples) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/test_mocap.mvnx");
  const Sent sent = StreamToUdp({SharedData("mvnx/test_mocap.mvnx"), "--speed", "4"});
  EXPECT_EQ(HeadersOf(sent.datagrams, mvn::Type::kPose).size(), 112U);
  EXPECT_GE(sent.summary.at("seconds").get<double>(), 111.0 / 60 / 4);
}

TEST(StreamCommand, LoopsARecordingOfSamplesWithoutAGap) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/Meri-020.mvnx");
  const Sent sent = StreamToUdp({SharedData("mvnx/Meri-020.mvnx"), "--loop", "--seconds", "0.248"});
  const auto poses = HeadersOf(sent.datagrams, mvn::Type::kPose);
  ASSERT_EQ(poses.size(), 60U) << "four frames at 240 Hz, fifteen times";
  for (std::size_t i = 1; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].sample_counter, poses[i - 1].sample_counter + 1);
    EXPECT_NEAR(poses[i].time_code_millis - poses[i - 1].time_code_millis, 1000.0 / 240, 1.01);
  }
  EXPECT_EQ(BodiesOf<mvn::MetaDataMessage>(sent.datagrams).size(), 1U) << "once a second";
}

TEST(StreamCommand, InjectsTheRequestedFaultsAndCountsThem) {
  const Arguments arguments = {"demo:walk",
                               "--seconds",
                               "2",
                               "--rate_hz",
                               "60",
                               "--fault",
                               "loss=0.1",
                               "--fault",
                               "foreign=0.1",
                               "--fault",
                               "corrupt=0.1",
                               "--fault",
                               "duplicate=0.1",
                               "--fault",
                               "reorder=0.1",
                               "--seed",
                               "7"};
  const Sent sent = StreamToUdp(arguments);
  const json& faults = sent.summary.at("faults");
  const auto injected = [&](const char* fault) {
    return faults.at(fault).at("injected").get<std::size_t>();
  };
  const std::size_t whole = 120 * 5 + 2 * 4;
  EXPECT_EQ(sent.datagrams.size(),
            whole - injected("loss") + injected("foreign") + injected("duplicate"));
  for (const char* fault : {"loss", "foreign", "corrupt", "duplicate", "reorder"}) {
    EXPECT_GT(injected(fault), 20U) << fault;
  }
  EXPECT_EQ(faults.size(), 5U) << "those asked for";
  std::size_t rejected = 0;
  for (const std::string& datagram : sent.datagrams)
    rejected += mvn::ParseDatagram(datagram) ? 0 : 1;
  EXPECT_EQ(rejected,
            injected("foreign") + faults.at("corrupt").at("detectable").get<std::size_t>());
  EXPECT_EQ(StreamToUdp(arguments).datagrams, sent.datagrams) << "the same seed, the same bytes";
}

// Held back until its end, a burst still goes out before the program ends.
TEST(StreamCommand, SendsDelayedDatagramsBeforeItEnds) {
  const Sent sent = StreamToUdp({"demo:walk", "--seconds", "0.2", "--fault", "burst=1:0.5"});
  EXPECT_EQ(HeadersOf(sent.datagrams, mvn::Type::kPose).size(), 24U);
  EXPECT_GE(sent.summary.at("seconds").get<double>(), 0.5);
}

// A relay between two sockets; Ctrl-C ends it, and it still says what it did.
TEST(StreamCommand, RelaysALiveStreamUntilItIsStopped) {
  const auto receiver = mvn::OpenDatagrams("udp://127.0.0.1:0");
  Process relay({"/bin/sh", "-c",
                 fmt::format("exec '{}' stream udp://127.0.0.1:0 --to {} --json 2>&1",
                             testing::KinescopePath(), receiver->description())});
  std::string from;
  while (from.empty()) {
    const auto line = relay.ReadLine(kPatience);
    ASSERT_TRUE(line) << "it never said what it streams";
    const std::string before = "streaming ";
    const std::size_t at = line->find(before);
    if (at == std::string::npos) continue;
    from = line->substr(at + before.size());
    from = from.substr(0, from.find(' '));
  }
  const ProgramResult suit =
      Stream({"demo:walk", "--seconds", "0.1", "--characters", "2", "--to", from});
  EXPECT_EQ(suit.exit_code, 0) << suit.err;
  constexpr std::size_t kSent = 2 * (12 * 5 + 4);
  BytesSink sink;
  const auto give_up = std::chrono::steady_clock::now() + kPatience;
  while (sink.datagrams.size() < kSent && std::chrono::steady_clock::now() < give_up) {
    EXPECT_NE(receiver->Poll(std::chrono::milliseconds(100), sink),
              mvn::DatagramSource::State::kEnded);
  }
  EXPECT_EQ(sink.datagrams.size(), kSent);
  relay.Signal(SIGINT);
  std::string last;
  while (const auto line = relay.ReadLine(kPatience)) last = *line;
  const json summary = json::parse(last, nullptr, false);
  ASSERT_TRUE(summary.is_object()) << last;
  EXPECT_EQ(summary.at("datagrams"), kSent);
  EXPECT_EQ(summary.at("samples"), 24);
}

// Nothing is made up: what the recording lacks is not sent, and asking for it is an error.
TEST(StreamCommand, SendsOnlyWhatARecordingContains) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/test_mocap.mvnx");
  const std::string recording = SharedData("mvnx/test_mocap.mvnx");
  const TempFolder folder;
  const std::string without_sensors = folder / "walk.mvnx";
  ASSERT_EQ(
      testing::Kinescope({"convert", "demo:walk", "--seconds", "0.1", "--out", without_sensors})
          .exit_code,
      0);
  const ProgramResult result = Stream({without_sensors, "--types", "02,23"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--types: 23: "));
  EXPECT_THAT(result.err, HasSubstr("contains no trackers"));
  const Sent sent = StreamToUdp({recording, "--speed", "20", "--types", "02,23,25"});
  const auto trackers = BodiesOf<mvn::TrackersMessage>(sent.datagrams);
  ASSERT_EQ(trackers.size(), 112U);
  EXPECT_EQ(trackers[0].present.count(), 11U) << "an upper body";
  std::string first_time;
  for (const std::string& datagram : sent.datagrams) {
    if (datagram.substr(4, 2) == "25" && first_time.empty()) first_time = datagram.substr(28, 12);
  }
  EXPECT_EQ(first_time, "04:17:11.842") << "the recording's time of day";
}

TEST(StreamCommand, RejectsInvalidOptionsWithNameValueAndRange) {
  const auto expect_refusal = [](const Arguments& arguments, const std::string& flag,
                                 const std::string& range) {
    const ProgramResult result = Stream(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(flag));
    EXPECT_THAT(result.err, HasSubstr(range));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.out, "");
  };
  expect_refusal({"demo:walk", "--characters", "17"}, "--characters=17", "1 to 16");
  expect_refusal({"demo:walk", "--types", "02,99"}, "--types=02,99", "25");
  expect_refusal({"demo:walk", "--types", "2"}, "--types=2", "02");
  expect_refusal({"demo:walk", "--rate_hz", "0"}, "--rate_hz=0", "1 to 1000");
  expect_refusal({"demo:walk", "--stream_hz", "-1"}, "--stream_hz=-1", "0 to 1000");
  expect_refusal({"demo:walk", "--speed", "0"}, "--speed=0", "0.01 to 100");
  expect_refusal({"demo:walk", "--seconds", "-1"}, "--seconds=-1", "0 to 1000000000 s");
  expect_refusal({"demo:walk", "--props", "5"}, "--props=5", "0 to 4");
  expect_refusal({"demo:walk", "--fault", "loss=2"}, "--fault=loss=2", "0 to 1");
  expect_refusal({"demo:walk", "--fault", "rain=0.5"}, "--fault=rain=0.5", "silence");
  expect_refusal({"demo:walk", "--to", "udp://127.0.0.1:0"}, "udp://127.0.0.1:0", "port 0");
  expect_refusal({"udp://127.0.0.1:0", "--loop"}, "--loop", "live");
  expect_refusal({"udp://127.0.0.1:0", "--speed", "2"}, "--speed", "live");
  expect_refusal({"udp://127.0.0.1:0", "--gloves"}, "--gloves", "demo:");
  expect_refusal({"udp://127.0.0.1:0", "--rate_hz", "60"}, "--rate_hz=60", "--stream_hz");
  expect_refusal({"-", "--loop"}, "--loop", "standard input");
}

}  // namespace
}  // namespace kinescope
