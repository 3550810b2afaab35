// `kinescope record` as its users run it: a process that reads a socket, is stopped, killed, or
// runs out of disk.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "server/mvn/encode.h"
#include "server/mvn/net/sender.h"
#include "server/mvn/open.h"
#include "server/subject/motions.h"
#include "server/subject/subject.h"
#include "tests/folders.h"
#include "tests/patience.h"
#include "tests/process.h"
#include "tests/server/mvn/file/datagram_sink.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/kinescope_program.h"
#include "tests/system/run_program.h"
#include "tests/temp_folder.h"

namespace kinescope {
namespace {

namespace fs = std::filesystem;
using mvn::testing::Brief;
using mvn::testing::KeepingSink;
using mvn::testing::ReadToEnd;
using std::chrono::steady_clock;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::kPatience;
using testing::Process;
using testing::ProgramResult;
using testing::RunProgram;
using testing::TempFolder;

// All datagrams of one sample of `people` people who lift a box.
std::vector<std::string> SampleOf(std::uint32_t counter, int people) {
  static const auto motion = subject::MakeMotion("lift");
  constexpr double kRateHz = 240;
  BodySample sample = motion->At(counter / kRateHz);
  sample.counter = counter;
  sample.time_code_millis = static_cast<std::int64_t>(counter * 1000 / kRateHz);
  std::vector<std::string> datagrams;
  for (sample.character = 0; sample.character < people; ++sample.character) {
    for (std::string& datagram : mvn::EncodeSample(sample)) {
      datagrams.push_back(std::move(datagram));
    }
  }
  return datagrams;
}

KeepingSink ReadBack(const fs::path& path) { return ReadToEnd(*mvn::OpenDatagrams(path.string())); }

std::string Quoted(const std::string& text) { return "'" + text + "'"; }

ProgramResult Record(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "record");
  return testing::Kinescope(arguments);
}

ProgramResult Shell(const std::string& script) { return RunProgram({"/bin/sh", "-c", script}); }

// `kinescope record` of a socket, running. A shell around it tells process id and exit code.
class Recording {
 public:
  Recording(const std::string& source, const std::string& arguments)
      : shell_({"/bin/sh", "-c",
                fmt::format("{} record {} {} 2>&1 & echo pid $!; wait $!; echo exit $?",
                            Quoted(testing::KinescopePath()), Quoted(source), arguments)}) {
    pid_ = static_cast<pid_t>(std::stol(RestOfLine("pid ")));
    const std::string line = RestOfLine("recording ");
    url_ = line.substr(0, line.find(' '));
  }
  ~Recording() { kill(pid_, SIGKILL); }  // the shell's end does not end it

  const std::string& url() const { return url_; }  // with the port that it got
  void Signal(int number) const { kill(pid_, number); }

  // What follows `text` in the next line that has it.
  std::string RestOfLine(const std::string& text) {
    while (const auto line = shell_.ReadLine(kPatience)) {
      said_ += *line + "\n";
      const std::size_t at = line->find(text);
      if (at != std::string::npos) return line->substr(at + text.size());
    }
    throw std::runtime_error("it never said '" + text + "', but:\n" + said_);
  }

  int ExitCode() { return std::stoi(RestOfLine("exit ")); }

 private:
  Process shell_;
  pid_t pid_ = 0;
  std::string url_;
  std::string said_;
};

// Of a capture of `datagrams` over IPv4: a header, and around each datagram one of the file, of IP
// and of UDP.
std::uintmax_t SizeOfCapture(const std::vector<std::string>& datagrams) {
  std::uintmax_t size = 24;
  for (const std::string& datagram : datagrams) size += 16 + 20 + 8 + datagram.size();
  return size;
}

void WaitForSize(const fs::path& path, std::uintmax_t bytes) {
  const auto deadline = steady_clock::now() + kPatience;
  std::error_code ignored;
  for (;;) {
    const std::uintmax_t size = fs::file_size(path, ignored);
    if (!ignored && size >= bytes) return;
    ASSERT_LT(steady_clock::now(), deadline) << path << " stays at " << size << " bytes";
    std::this_thread::yield();
  }
}

TEST(Record, LosesNothingOfFourPeopleAt240Hz) {
  TempFolder folder;
  const std::string path = folder / "take.pcap";
  Recording recording("udp://127.0.0.1:0", "--json --out " + Quoted(path));
  const auto sender = mvn::OpenSender(recording.url());
  std::vector<std::string> sent;
  constexpr std::uint32_t kSamples = 2 * 240;
  const auto start = steady_clock::now();
  for (std::uint32_t counter = 0; counter < kSamples; ++counter) {
    // The rate is what is tested here, so the clock is the event to wait for.
    std::this_thread::sleep_until(start + counter * std::chrono::nanoseconds(1'000'000'000 / 240));
    for (const std::string& datagram : SampleOf(counter, 4)) {
      sender->Send(datagram);
      sent.push_back(datagram);
    }
  }
  WaitForSize(path, SizeOfCapture(sent));
  recording.Signal(SIGTERM);
  const auto summary = nlohmann::json::parse("{" + recording.RestOfLine("{"));
  EXPECT_EQ(recording.ExitCode(), 0);
  EXPECT_EQ(summary["datagrams"], sent.size());
  EXPECT_EQ(summary["lost"]["kernel"], 0);
  EXPECT_EQ(summary["lost"]["disk"], 0);
  EXPECT_EQ(summary["people"], 4);
  EXPECT_EQ(summary["counter_gaps"], 0);
  EXPECT_NEAR(summary["samples"].get<double>(), 4.0 * kSamples, 4 * 2);  // who is new is tried
  EXPECT_EQ(summary["bytes"], fs::file_size(path));
  const KeepingSink read = ReadBack(path);
  EXPECT_EQ(read.Brief(), Brief(sent));
  for (const auto& datagram : read.datagrams) {
    EXPECT_EQ("udp://" + mvn::Format(datagram.to), recording.url());
  }
}

TEST(Record, LeavesEveryCompletePacketReadableWhenKilled) {
  TempFolder folder;
  const fs::path path = folder / "take.pcap";
  Recording recording("udp://127.0.0.1:0", "--out " + Quoted(path));
  const auto sender = mvn::OpenSender(recording.url());
  std::vector<std::string> sent;
  std::atomic<bool> goes_on{true};
  std::thread suit([&] {
    const auto start = steady_clock::now();
    for (std::uint32_t counter = 0; goes_on; ++counter) {
      std::this_thread::sleep_until(start + counter * std::chrono::milliseconds(1));
      for (const std::string& datagram : SampleOf(counter, 1)) {
        sent.push_back(datagram);
        sender->Send(datagram);
      }
    }
  });
  WaitForSize(path, 500'000);
  recording.Signal(SIGKILL);
  EXPECT_EQ(recording.ExitCode(), 128 + SIGKILL);
  goes_on = false;
  suit.join();
  const std::vector<std::string> kept = ReadBack(path).Brief();
  EXPECT_GT(kept.size(), 400U);
  ASSERT_LE(kept.size(), sent.size());
  sent.resize(kept.size());
  EXPECT_EQ(kept, Brief(sent));
}

TEST(Record, RecordsTcpAndEndsRegularlyOnCtrlC) {
  TempFolder folder;
  const fs::path path = folder / "take.pcap";
  Recording recording("tcp://127.0.0.1:0?listen", "--json --out " + Quoted(path));
  const auto sender = mvn::OpenSender(recording.url().substr(0, recording.url().find('?')));
  const std::vector<std::string> sent = SampleOf(0, 1);
  const auto deadline = steady_clock::now() + kPatience;
  std::size_t next = 0;
  while (next < sent.size() && steady_clock::now() < deadline) {
    const auto before = sender->datagrams_sent();
    sender->Send(sent[next]);  // nowhere until it is connected
    next += sender->datagrams_sent() - before;
    std::this_thread::yield();
  }
  WaitForSize(path, SizeOfCapture(sent));
  recording.Signal(SIGINT);
  const auto summary = nlohmann::json::parse("{" + recording.RestOfLine("{"));
  EXPECT_EQ(recording.ExitCode(), 0);
  EXPECT_EQ(summary["datagrams"], sent.size());
  EXPECT_EQ(ReadBack(path).Brief(), Brief(sent));
}

TEST(Record, EndsAfterTheGivenTime) {
  TempFolder folder;
  const ProgramResult result =
      Record({"udp://127.0.0.1:0", "--seconds", "0.2", "--json", "--out", folder / "take.pcap"});
  EXPECT_EQ(result.exit_code, 1) << "nothing was received: " << result.err;
  const auto summary = nlohmann::json::parse(result.out);
  EXPECT_EQ(summary["datagrams"], 0);
  EXPECT_TRUE(summary["files"].empty());
  EXPECT_THAT(result.err, HasSubstr("nothing was recorded"));
  EXPECT_TRUE(folder.Names().empty()) << "in the way of the next attempt";
}

// Two people for some seconds as raw datagrams, as a file.
fs::path WriteRawFile(const TempFolder& folder, std::vector<std::string>& datagrams) {
  std::ofstream out(folder / "take.bin", std::ios::binary);
  for (std::uint32_t counter = 0; counter < 240; ++counter) {
    for (const std::string& datagram : SampleOf(counter, 2)) {
      datagrams.push_back(datagram);
      out << datagram;
    }
  }
  return folder / "take.bin";
}

TEST(Record, ConvertsAFileOrAPipeToACapture) {
  TempFolder folder;
  std::vector<std::string> datagrams;
  const std::string raw = WriteRawFile(folder, datagrams);
  const ProgramResult result = Record({raw, "--json", "--out", folder / "take.pcap"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto summary = nlohmann::json::parse(result.out);
  EXPECT_EQ(summary["datagrams"], datagrams.size());
  EXPECT_EQ(summary["people"], 2);
  EXPECT_NEAR(summary["stream_seconds"].get<double>(), 239 / 240.0, 0.002);
  EXPECT_EQ(ReadBack(folder / "take.pcap").Brief(), Brief(datagrams));

  const ProgramResult piped =
      Shell(fmt::format("gzip < {} | {} record - --out {}", Quoted(folder / "take.pcap"),
                        Quoted(testing::KinescopePath()), Quoted(folder / "again.pcap")));
  ASSERT_EQ(piped.exit_code, 0) << piped.err;
  EXPECT_EQ(ReadBack(folder / "again.pcap").datagrams, ReadBack(folder / "take.pcap").datagrams);
}

TEST(Record, NamesAFileWithInvalidUtf8InJson) {
  TempFolder folder;
  std::vector<std::string> datagrams;
  const std::string raw = folder / "n\xFF.bin";
  fs::rename(WriteRawFile(folder, datagrams), raw);
  const ProgramResult result = Record({raw, "--json", "--out", folder / "n\xFF.pcap"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto summary = nlohmann::json::parse(result.out);
  EXPECT_EQ(summary["source"], (folder / "n\uFFFD.bin").string());
  EXPECT_EQ(summary["files"][0], (folder / "n\uFFFD.pcap").string());
}

TEST(Record, SplitsItsFileBySizeAndNumbersTheFiles) {
  TempFolder folder;
  std::vector<std::string> datagrams;
  const std::string raw = WriteRawFile(folder, datagrams);
  const ProgramResult result =
      Record({raw, "--json", "--rotate_mb", "0.5", "--out", folder / "take.pcap"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::vector<std::string> together;
  const auto summary = nlohmann::json::parse(result.out);
  for (const std::string file : summary["files"]) {
    EXPECT_LE(fs::file_size(file), 500'000U);
    for (const std::string& brief : ReadBack(file).Brief()) together.push_back(brief);
  }
  EXPECT_EQ(together, Brief(datagrams));
  EXPECT_TRUE(fs::exists(folder / "take-0002.pcap"));
}

TEST(Record, RejectsInvalidSourcesAndExistingOutputs) {
  TempFolder folder;
  std::vector<std::string> datagrams;
  const std::string raw = WriteRawFile(folder, datagrams);
  const std::string out = folder / "take.pcap";
  const auto expect_refusal = [](const ProgramResult& result, const auto& says) {
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, says);
    EXPECT_EQ(result.out, "");
  };
  ASSERT_EQ(Record({raw, "--out", out}).exit_code, 0);
  expect_refusal(Record({raw, "--out", out}), AllOf(HasSubstr(out), HasSubstr("--force")));
  EXPECT_EQ(ReadBack(out).datagrams.size(), datagrams.size());
  EXPECT_EQ(Record({raw, "--out", out, "--force"}).exit_code, 0);
  expect_refusal(Record({out, "--out", out, "--force"}),
                 HasSubstr("output and source are the same file"));
  expect_refusal(Record({"demo:lift", "--out", folder / "demo.pcap"}),
                 HasSubstr("kinescope stream"));
  expect_refusal(Record({raw, "--out", folder / "x.pcap", "--seconds", "-1"}),
                 HasSubstr("--seconds=-1"));
  expect_refusal(Record({raw, "--out", folder / "x.pcap", "--rotate_mb", "0.01"}),
                 HasSubstr("--rotate_mb=0.01"));
  expect_refusal(Record({"/nowhere/take.bin", "--out", folder / "x.pcap"}), HasSubstr("/nowhere"));
  EXPECT_EQ(folder.Names(), (std::vector<std::string>{"take.bin", "take.pcap"}));
}

// What is left on a disk that got full: whole packets, from the first on.
void ExpectWholePackets(const fs::path& path, std::uintmax_t disk_bytes,
                        std::vector<std::string> datagrams) {
  EXPECT_LE(fs::file_size(path), disk_bytes);
  EXPECT_GT(fs::file_size(path), disk_bytes - 4096);
  ::testing::internal::CaptureStdout();  // where a reader would warn of a cut packet
  const std::vector<std::string> kept = ReadBack(path).Brief();
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  ASSERT_LT(kept.size(), datagrams.size());
  datagrams.resize(kept.size());
  EXPECT_EQ(kept, Brief(datagrams));
}

TEST(Record, KeepsCompletePacketsInAFileOfLimitedSize) {
  TempFolder folder;
  std::vector<std::string> datagrams;
  const std::string raw = WriteRawFile(folder, datagrams);
  const fs::path out = folder / "take.pcap";
  const ProgramResult result = Shell(fmt::format("ulimit -f 400; exec {} record {} --out {}",
                                                 Quoted(testing::KinescopePath()), Quoted(raw),
                                                 Quoted(out)));  // in units of 512 bytes
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr(out.string() + ": recording stopped"),
                                HasSubstr("File too large"), HasSubstr("kept and readable")));
  ExpectWholePackets(out, 400 * 512, datagrams);
}

TEST(Record, KeepsCompletePacketsOnAFullDisk) {
  TempFolder folder;
  std::vector<std::string> datagrams;
  const std::string raw = WriteRawFile(folder, datagrams);
  const std::string disk = folder / "disk";
  fs::create_directory(disk);
  // A file system of our own, which is gone with the shell.
  const std::string own_disk = fmt::format("mount -t tmpfs -o size=256k none {} && ", Quoted(disk));
  const std::string unshare = "unshare --map-root-user --mount sh -c ";
  if (Shell(unshare + "\"" + own_disk + "true\"").exit_code != 0) {
    GTEST_SKIP() << "no file systems of our own here: unshare or mount is not permitted";
  }
  const ProgramResult result = Shell(fmt::format(
      "{}\"{}{{ {} record {} --out {}/take.pcap; code=\\$?; cp {}/take.pcap {}; exit \\$code; }}\"",
      unshare, own_disk, Quoted(testing::KinescopePath()), Quoted(raw), Quoted(disk), Quoted(disk),
      Quoted(folder.path())));
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_THAT(result.err, AllOf(HasSubstr("take.pcap: recording stopped"),
                                HasSubstr("No space left on device"), HasSubstr("kept")));
  ExpectWholePackets(folder / "take.pcap", 256 * 1024, datagrams);
}

TEST(RecordCommand, LosesNothingOfASuitBesideAFloodOfHostileDatagrams) {
  const TempFolder folder;
  const fs::path path = folder.path() / "take.pcap";
  Recording recording("udp://127.0.0.1:0", "--out " + Quoted(path.string()) + " --seconds 60");
  const std::string port = recording.url().substr(recording.url().rfind(':') + 1);
  const Process hostile({kinescope::testing::InBuild("tests/soak/hostile_senders").string(), port,
                         "all", "5000", "60"});
  const ProgramResult suit =
      testing::Kinescope({"stream", "demo:walk", "--rate_hz", "240", "--seconds", "2", "--json",
                          "--to", recording.url()});
  ASSERT_EQ(suit.exit_code, 0) << suit.err;
  const auto sent = nlohmann::json::parse(suit.out).at("datagrams").get<std::size_t>();
  recording.Signal(SIGINT);
  EXPECT_EQ(recording.ExitCode(), 0);
  const KeepingSink take = ReadBack(path);
  EXPECT_GT(take.datagrams.size(), sent + 5000);
  std::map<std::uint16_t, std::size_t> by_port;
  for (const auto& datagram : take.datagrams) ++by_port[datagram.from.port];
  EXPECT_TRUE(std::any_of(by_port.begin(), by_port.end(),
                          [&](const auto& sender) { return sender.second == sent; }))
      << "no sender has " << sent;
}

}  // namespace
}  // namespace kinescope
