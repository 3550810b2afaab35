// Names in streams and files come from strangers: no output of the program may steer the terminal
// that shows it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "server/mvn/encode.h"
#include "tests/process.h"
#include "tests/server/mvn/mvn_testing.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/kinescope_program.h"
#include "tests/system/run_program.h"
#include "tests/temp_folder.h"

namespace kinescope {
namespace {

using testing::ExpectRefusal;
using ::testing::HasSubstr;
using testing::Kinescope;
using ::testing::Not;
using testing::Process;
using testing::ProgramResult;
using testing::TempFolder;

// A title for the window, CSI as one character, DEL, a line that looks like our own, and a
// right-to-left override.
const std::string kEvil =
    "n\x1b]0;t\x07\xc2\x9b"
    "31m\x7f\nkinescope: \xe2\x80\xae"
    "b";

void ExpectHarmless(const std::string& output) {
  for (const char* control : {"\xc2\x80", "\xc2\x9b", "\xc2\x9f", "\xe2\x80\xae", "\x7f"}) {
    EXPECT_EQ(output.find(control), std::string::npos) << output;
  }
  EXPECT_EQ(output.find("\nkinescope: "), std::string::npos) << "a forged line: " << output;
  for (const char c : output) {
    const auto byte = static_cast<unsigned char>(c);
    ASSERT_TRUE(byte >= 0x20 || c == '\n' || c == '\t') << int{byte} << " in " << output;
  }
}

void ExpectHarmless(const ProgramResult& result) {
  EXPECT_NE(result.out + result.err, "");
  ExpectHarmless(result.out);
  ExpectHarmless(result.err);
}

// A capture of a person with that name, in a file with that name.
std::string EvilTake(const TempFolder& folder) {
  mvn::testing::RandomValues random(3);
  Character person;
  person.name = kEvil;
  person.skeleton = urdf::DefaultSkeleton(1.8);
  person.landmarks = urdf::LandmarksOf(*person.skeleton);
  const std::string path = folder / (kEvil + ".bin");
  std::ofstream file(path, std::ios::binary);
  for (const std::string& datagram : mvn::EncodeCharacter(person)) file << datagram;
  for (std::uint32_t counter = 0; counter < 30; ++counter) {
    for (const std::string& datagram :
         mvn::EncodeSample(mvn::testing::RandomSample(random, counter))) {
      file << datagram;
    }
  }
  return path;
}

TEST(Terminal, ShowsHowFarTheFirstPassOfAClipIs) {
  const TempFolder folder;
  const std::vector<std::string> command = {"render", "demo:lift", "--seconds", "0.2",  "--fps",
                                            "10",     "--size",    "64x64",     "--out"};
  const std::string line = fmt::format("'{}' {} '{}'", testing::KinescopePath(),
                                       fmt::join(command, " "), std::string(folder / "shown.mp4"));
  const ProgramResult shown = testing::RunProgram({"/usr/bin/script", "-qec", line, "/dev/null"});
  EXPECT_EQ(shown.exit_code, 0) << shown.out;
  EXPECT_THAT(shown.out, HasSubstr("first pass, samples: 25 of 25, "));
  EXPECT_LT(shown.out.find("first pass"), shown.out.find("pictures: 1 of 2")) << shown.out;
  std::vector<std::string> piped = command;
  piped.emplace_back(folder / "piped.mp4");
  EXPECT_THAT(Kinescope(piped).err, Not(HasSubstr("first pass")));
}

TEST(Terminal, IsNotNeededForProgressThatProgramsRead) {
  const TempFolder folder;
  std::vector<std::string> command = {"loads",  "demo:lift",           "--seconds",  "1",
                                      "--json", folder / "loads.json", "--progress", "json"};
  const ProgramResult shown = Kinescope(command);
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  nlohmann::json last;
  std::istringstream lines(shown.err);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("\"progress\"") != std::string::npos) last = nlohmann::json::parse(line);
  }
  ASSERT_TRUE(last.is_object()) << shown.err;
  EXPECT_EQ(last.at("done"), last.at("total"));
  EXPECT_EQ(last.at("seconds_left"), 0);
  ExpectHarmless(shown.err);

  command.back() = "off";
  const std::string line =
      fmt::format("'{}' '{}'", testing::KinescopePath(), fmt::join(command, "' '"));
  EXPECT_EQ(
      testing::RunProgram({"/usr/bin/script", "-qec", line, "/dev/null"}).out.find("per second"),
      std::string::npos);
  command.back() = "loud";
  ExpectRefusal(Kinescope(command), "--progress");
}

TEST(Terminal, IsNotSteeredByNamesInFiles) {
  const TempFolder folder;
  const std::string take = EvilTake(folder), mvnx = folder / (kEvil + ".mvnx");
  const ProgramResult converted = Kinescope({"convert", take, "--out", mvnx});
  EXPECT_EQ(converted.exit_code, 0) << converted.err;
  ExpectHarmless(converted);
  for (const std::string& file : {take, mvnx}) {
    for (const std::vector<std::string>& command :
         std::vector<std::vector<std::string>>{{"inspect", file},
                                               {"inspect", file, "--json"},
                                               {"loads", file},
                                               {"loads", file, "--json", "-"},
                                               {"loads", file, "--csv", "-"}}) {
      const ProgramResult result = Kinescope(command);
      EXPECT_LE(result.exit_code, 1) << result.err;
      ExpectHarmless(result);
    }
  }
  ExpectHarmless(Kinescope({"record", take, "--out", folder / (kEvil + ".pcap")}));
  const ProgramResult drawn =
      Kinescope({"render", take, "--size", "64x64", "--out", folder / (kEvil + ".png")});
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  ExpectHarmless(drawn);
}

TEST(Terminal, IsNotSteeredByTheNameOfASenderOfALiveStream) {
  const TempFolder folder;
  const std::string take = EvilTake(folder);
  Process server({"/bin/sh", "-c",
                  fmt::format("exec '{}' serve --source udp://127.0.0.1:0 --http_port 0 --ros off "
                              "--pictures off 2>&1",
                              testing::KinescopePath())});
  const std::string line = testing::RestOfLine(server, "listening at ");
  const ProgramResult sent = Kinescope({"stream", take, "--to", line.substr(0, line.find(": "))});
  EXPECT_EQ(sent.exit_code, 0);
  ExpectHarmless(sent);
  const std::string live = testing::RestOfLine(server, "live: ");
  EXPECT_THAT(live, HasSubstr(" from udp://")) << "the name ends the line";
  ExpectHarmless(live);
}

TEST(Terminal, IsNotSteeredByValuesInErrors) {
  const TempFolder folder;
  const std::string wrenches = folder / "f.csv", config = folder / "c.yaml";
  std::ofstream(wrenches) << "time_s,body," << kEvil << "\n";
  std::ofstream(config) << "\"theme\\e]0;t\\a\\x7f\\x9b\": 1\n";
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {kEvil},
           {"render", "demo:walk", "--" + kEvil},
           {"render", "demo:walk", kEvil, "--out", "a.png"},
           {"render", "demo:walk", "--out", folder / "a.png", "--theme", kEvil},
           {"render", "demo:walk", "--out", folder / "a.png", "--sample", kEvil},
           {"render", kEvil, "--out", folder / "a.png"},
           {"loads", "demo:" + kEvil},
           {"loads", "demo:lift", "--wrenches", wrenches},
           {"loads", "demo:lift", "--config", config},
           {"convert", "demo:lift", "--out", kEvil},
           {"golden", "check", folder / kEvil},
           {"urdf", "check", folder / kEvil}}) {
    const ProgramResult result = Kinescope(command);
    ExpectRefusal(result, "kinescope: ");
    ExpectHarmless(result);
  }
}

}  // namespace
}  // namespace kinescope
