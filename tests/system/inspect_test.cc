// `kinescope inspect` as people and programs use it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "server/mvn/encode.h"
#include "server/mvn/net/sender.h"
#include "server/subject/subject.h"
#include "tests/process.h"
#include "tests/server/mvn/mvn_testing.h"
#include "tests/shared_data.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/kinescope_program.h"
#include "tests/temp_folder.h"

namespace kinescope {
namespace {

using mvn::testing::RandomSample;
using mvn::testing::RandomValues;
using mvn::testing::RawDatagram;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Process;
using testing::ProgramResult;
using testing::SharedData;
using testing::TempFolder;
using Json = nlohmann::json;

constexpr std::size_t kFrames = 30;  // with all their types they fit into a small socket buffer

ProgramResult Inspect(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "inspect");
  return testing::Kinescope(arguments);
}

Json Parsed(const std::string& text) {
  Json json = Json::parse(text, nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << text;
  return json.is_discarded() ? Json::object() : json;
}

// What a suit sends in an eighth of a second at 240 Hz: a person with a name and a size.
std::vector<std::string> Stream() {
  RandomValues random(3);
  Character person;
  person.name = "Ben";
  person.color_rgb = 0x2080FF;
  person.skeleton = urdf::DefaultSkeleton(1.80);
  person.landmarks = urdf::LandmarksOf(*person.skeleton);
  std::vector<std::string> datagrams = mvn::EncodeCharacter(person);
  for (std::uint32_t counter = 0; counter < kFrames; ++counter) {
    const auto frame = mvn::EncodeSample(RandomSample(random, counter));
    datagrams.insert(datagrams.end(), frame.begin(), frame.end());
  }
  return datagrams;
}

std::string Write(const std::filesystem::path& path, const std::vector<std::string>& datagrams) {
  std::ofstream file(path, std::ios::binary);
  for (const std::string& datagram : datagrams) file << datagram;
  return path.string();
}

void ExpectBen(const Json& report) {
  EXPECT_EQ(report["can_be_shown"], true);
  ASSERT_EQ(report["characters"].size(), 1U) << report.dump(2);
  const Json& person = report["characters"][0];
  EXPECT_EQ(person["name"], "Ben");
  EXPECT_EQ(person["color"], "#2080ff");
  EXPECT_EQ(person["kind"], "person");
  EXPECT_EQ(person["segments"]["body"], 23);
  EXPECT_NEAR(person["height_m"].get<double>(), 1.80, 1e-3);
  EXPECT_EQ(person["samples"]["count"], kFrames);
  EXPECT_EQ(person["frames"]["lost"], 0);
  EXPECT_NEAR(person["frames"]["capture_rate_hz"].get<double>(), 240, 3);
  std::vector<std::string> types;
  for (const Json& type : person["types"]) types.push_back(type["type"]);
  EXPECT_THAT(types, ElementsAre("02", "12", "13", "20", "21", "22", "24"));
}

TEST(Inspect, ReportsAFileOfDatagramsInJsonAndInText) {
  const TempFolder folder;
  const std::string file = Write(folder / "take.bin", Stream());
  const ProgramResult as_json = Inspect({file, "--json"});
  EXPECT_EQ(as_json.exit_code, 0) << as_json.err;
  EXPECT_EQ(as_json.err, "");
  const Json report = Parsed(as_json.out);
  ExpectBen(report);
  EXPECT_EQ(report["format"], "MVN datagrams");
  EXPECT_EQ(report["has_arrival_times"], false);
  EXPECT_EQ(report["characters"][0]["frames"]["jitter_ms"], nullptr);

  const ProgramResult as_text = Inspect({file});
  EXPECT_EQ(as_text.exit_code, 0);
  EXPECT_THAT(as_text.out, AllOf(HasSubstr("Person 0 'Ben'"), HasSubstr("height      1.800 m"),
                                 HasSubstr("30, counter 0 to 29; 0 lost"),
                                 HasSubstr("02   Position + Orientation (Quaternion)"),
                                 ContainsRegex("24   Center of Mass .* 30 .* 60 .* 1 .*100.0 %"),
                                 Not(HasSubstr("Not used")), Not(HasSubstr(">"))));
  for (std::size_t at = 0, end = 0; end != std::string::npos; at = end + 1) {
    end = as_text.out.find('\n', at);
    const std::string line = as_text.out.substr(at, end - at);
    EXPECT_LE(line.size(), 100U) << line;
    EXPECT_FALSE(!line.empty() && line.back() == ' ') << "'" << line << "'";
  }
}

TEST(Inspect, ReportsErrorsWithTheirFirstPlace) {
  const TempFolder folder;
  auto datagrams = Stream();
  RawDatagram zero_id;
  zero_id.items = 1;
  zero_id.payload = mvn::testing::PoseItems(0, 1);
  datagrams.push_back(zero_id.Bytes());
  const ProgramResult result = Inspect({Write(folder / "take.bin", datagrams)});
  EXPECT_EQ(result.exit_code, 0) << "there still is somebody to show";
  EXPECT_THAT(result.out, AllOf(HasSubstr("Not used"), HasSubstr("1  id 0"),
                                ContainsRegex("first at .* s, byte [0-9]+, value 0")));
}

TEST(Inspect, ReportsNoPersonForTrackersOnlyAndNamesTheMissingSetting) {
  const TempFolder folder;
  RandomValues random(3);
  std::vector<std::string> datagrams;
  for (std::uint32_t counter = 0; counter < kFrames; ++counter) {
    for (const std::string& datagram : mvn::EncodeSample(
             RandomSample(random, counter), mvn::MakeTypeSet({mvn::Type::kTrackers}))) {
      datagrams.push_back(datagram);
    }
  }
  const std::string file = Write(folder / "trackers.bin", datagrams);
  const ProgramResult result = Inspect({file});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("> no pose: switch on Position + Orientation (Quaternion)"),
                    HasSubstr("No person or object to show.")));
  EXPECT_EQ(Parsed(Inspect({file, "--json"}).out)["can_be_shown"], false);
}

TEST(Inspect, RejectsUnreadableSourcesInOneLine) {
  const TempFolder folder;
  std::ofstream(folder / "note.txt") << "no recording\n";
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{folder / "missing.pcap"}, "missing.pcap"},
      {{folder / "note.txt"}, "note.txt"},
      {{folder.path()}, folder.path()},
      {{"demo:nothing"}, "nothing"},
      {{"demo:lift", "--seconds", "0"}, "--seconds=0"},
      {{}, "source"}};
  for (const auto& [arguments, named] : cases) {
    const ProgramResult result = Inspect(arguments);
    EXPECT_EQ(result.exit_code, 2) << named;
    EXPECT_THAT(result.err, HasSubstr(named));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.out, "");
  }
}

// A program that listens at a port of its own, which it tells on stderr.
class Listening {
 public:
  explicit Listening(const std::string& url)
      : process_({"/bin/sh", "-c", "exec \"$0\" inspect \"$1\" --seconds 60 --json 2>&1",
                  testing::KinescopePath(), url}) {
    const std::string line = process_.ReadLine(std::chrono::seconds(60)).value_or("");
    std::smatch found;
    if (std::regex_search(line, found, std::regex("://[^ ]*:([0-9]+)"))) {
      port_ = std::stoi(found[1].str());
    }
    EXPECT_THAT(line, AllOf(HasSubstr("listening at"), HasSubstr("60 s"), HasSubstr("Ctrl-C")));
  }

  int port() const { return port_; }

  // Ends it as Ctrl-C would; what it then says.
  Json Stop() {
    process_.Signal(SIGINT);
    std::string text;
    while (const auto line = process_.ReadLine(std::chrono::seconds(60))) {
      // Before it comes what the program said of connections.
      if (!text.empty() || line->substr(0, 1) == "{") text += *line + "\n";
    }
    return Parsed(text);
  }

 private:
  Process process_;
  int port_ = 0;
};

// Of what a live stream of Stream() makes, but for what the transport adds.
void ExpectLiveBen(const Json& report) {
  ExpectBen(report);
  EXPECT_EQ(report["live"], true);
  EXPECT_EQ(report["datagrams"], Stream().size());
  EXPECT_NE(report["characters"][0]["frames"]["jitter_ms"], nullptr);
  EXPECT_THAT(report["characters"][0]["sender"].get<std::string>(), HasSubstr("127.0.0.1:"));
}

TEST(Inspect, ReceivesUdpUntilCtrlCAndThenReports) {
  Listening program("udp://127.0.0.1:0");
  ASSERT_NE(program.port(), 0);
  const auto sender = mvn::OpenSender("udp://127.0.0.1:" + std::to_string(program.port()));
  for (const std::string& datagram : Stream()) sender->Send(datagram);
  // What was sent before Ctrl-C lies in the socket, if it was not read already: both count.
  const Json report = program.Stop();
  ExpectLiveBen(report);
  EXPECT_EQ(report["format"], "UDP");
  EXPECT_GT(report["transport"]["receive_buffer_bytes"], 0);
  EXPECT_EQ(report["transport"]["kernel_drops"], 0);
}

// Sends all, ends the connection, and returns when the other side has read it to the end.
void SendOverTcp(int port, const std::vector<std::string>& datagrams) {
  const int connection = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  ASSERT_EQ(connect(connection, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  for (const std::string& datagram : datagrams) {
    ASSERT_EQ(send(connection, datagram.data(), datagram.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(datagram.size()));
  }
  shutdown(connection, SHUT_WR);
  char byte = 0;
  EXPECT_EQ(recv(connection, &byte, 1, 0), 0) << "it closes its side after the last byte";
  close(connection);
}

TEST(Inspect, ReceivesTcpUntilCtrlCAndThenReports) {
  Listening program("tcp://:0");
  ASSERT_NE(program.port(), 0);
  SendOverTcp(program.port(), Stream());
  const Json report = program.Stop();
  ExpectLiveBen(report);
  EXPECT_EQ(report["format"], "TCP");
  EXPECT_EQ(report["transport"]["connections"], 1);
  EXPECT_EQ(report["transport"]["connections_open"], 0);
}

TEST(Inspect, ReportsTheMvnSettingsIfALiveStreamHasNoData) {
  const ProgramResult result = Inspect({"udp://127.0.0.1:0", "--seconds", "0.1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("for 0.1 s"));
  EXPECT_THAT(result.out, AllOf(HasSubstr("> no datagrams received"), HasSubstr("Network Streamer"),
                                HasSubstr("receive buffer")));
}

TEST(Inspect, InspectsTheBuiltInSubjectForTheRequestedTime) {
  const ProgramResult result = Inspect({"demo:lift", "--seconds", "2", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json report = Parsed(result.out);
  EXPECT_EQ(report["has_datagrams"], false);
  EXPECT_EQ(report["format"], "built-in subject");
  EXPECT_NEAR(report["seconds"].get<double>(), 2, 0.02);
  EXPECT_NEAR(report["characters"][0]["frames"]["rate_hz"].get<double>(), 120, 0.01);
}

// A person who stands for a second on a platform, as a file of datagrams.
TEST(Inspect, ReportsTheFloorThatLoadsFindsInAFile) {
  const TempFolder folder;
  const auto write = [&](double secs) {
    std::vector<std::string> datagrams;
    const auto motion = subject::MakeMotion("n_pose");
    for (std::uint32_t counter = 0; counter < 60 * secs; ++counter) {
      BodySample sample = motion->At(counter / 60.0);
      sample.counter = counter;
      sample.time_code_millis = static_cast<std::int64_t>(counter * 1000 / 60);
      for (SegmentState& segment : sample.segments) segment.position.z() += 0.4;
      const auto frame = mvn::EncodeSample(sample);
      datagrams.insert(datagrams.end(), frame.begin(), frame.end());
    }
    return Write(folder / "platform.bin", datagrams);
  };
  const std::string file = write(2);
  const ProgramResult text = Inspect({file});
  const Json floor = Parsed(Inspect({file, "--json"}).out)["characters"].at(0)["floor"];
  EXPECT_NEAR(floor["height_m"].get<double>(), 0.4, 0.02);
  EXPECT_EQ(floor["reason"], nullptr);
  const std::string height = fmt::format("z = {:.3f} m", floor["height_m"].get<double>());
  EXPECT_THAT(text.out, HasSubstr("floor       " + height + "\n"));
  EXPECT_THAT(testing::Kinescope({"loads", file}).out, HasSubstr(height + " (found)"));

  const std::string brief = write(0.2);
  EXPECT_THAT(Inspect({brief}).out,
              HasSubstr("floor       not found: no foot has rested for 0.3 s"));
  const Json none = Parsed(Inspect({brief, "--json"}).out)["characters"].at(0)["floor"];
  EXPECT_EQ(none["height_m"], nullptr);
  EXPECT_EQ(none["reason"], "no foot has rested for 0.3 s");
  EXPECT_EQ(
      Parsed(Inspect({"demo:walk", "--seconds", "1", "--json"}).out)["characters"].at(0)["floor"],
      nullptr)
      << "the built-in subject is no file";
}

TEST(Inspect, ReportsVersionPersonAndRateOfAnMvnxFile) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/test_mocap.mvnx");
  const ProgramResult result = Inspect({SharedData("mvnx/test_mocap.mvnx"), "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json report = Parsed(result.out);
  EXPECT_EQ(report["format"], "MVNX version 4");
  const Json& person = report["characters"].at(0);
  EXPECT_EQ(person["samples"]["count"], 112);
  EXPECT_EQ(person["samples"]["quantities"]["joint angles"], 112);
  EXPECT_NEAR(person["frames"]["rate_hz"].get<double>(), 60, 0.01);
  EXPECT_EQ(person["floor"]["reason"], "the source does not measure the legs");
  EXPECT_NE(person["name"], "");
}

#ifdef KINESCOPE_WITH_ROS
TEST(Inspect, ReportsThePersonAndOtherTopicsOfABag) {
  KINESCOPE_NEEDS_SHARED_DATA("ros1/2018-05-28-17-34-45.bag.xz");
  const std::string bag = SharedData("ros1/2018-05-28-17-34-45.bag.xz");
  const ProgramResult result = Inspect({bag, "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json report = Parsed(result.out);
  EXPECT_EQ(report["format"], "ROS 1 bag");
  EXPECT_EQ(report["characters"].at(0)["samples"]["count"], 135);
  EXPECT_EQ(report["characters"].at(0)["name"], "xsens");
  EXPECT_NE(report["ignored"].dump().find("/ar_pose_marker"), std::string::npos);
}
#endif

}  // namespace
}  // namespace kinescope
