#include "server/recording/raw_recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "server/mvn/open.h"
#include "tests/deadline.h"
#include "tests/server/mvn/file/datagram_sink.h"
#include "tests/temp_folder.h"

namespace kinescope::recording {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::TempFolder;

// The header of a datagram of this type, and a text that tells it from others.
std::string DatagramOf(const std::string& type, const std::string& text, int part = 0x80) {
  std::string datagram = "MXTP" + type;
  datagram += std::string("\0\0\0\x01", 4);
  datagram += static_cast<char>(part);
  datagram += std::string(13, '\0');
  return datagram + text;
}

class RawRecorderTest : public ::testing::Test {
 protected:
  void Send(RawRecorder& recorder, const std::string& bytes) {
    mvn::Endpoint from;
    from.port = 4711;
    recorder.OnDatagram({from, from, bytes, {wall_nanos_, wall_nanos_}});
    wall_nanos_ += 1'000'000;
  }
  std::vector<std::string> Recorded(const std::string& file) const {
    const auto source = mvn::OpenDatagrams((top_ / file).string());
    std::vector<std::string> texts;
    for (const auto& datagram : mvn::testing::ReadToEnd(*source).datagrams)
      texts.push_back(datagram.bytes.substr(24));
    return texts;
  }

  TempFolder top_;
  std::atomic<std::uintmax_t> free_bytes_{std::uintmax_t{1} << 40};
  const Folder folder_{top_.path(), false, [this](const auto&) { return free_bytes_.load(); }};
  std::int64_t wall_nanos_ = 1'700'000'000'000'000'000;
};

TEST_F(RawRecorderTest, WritesWhatComesBetweenStartAndStop) {
  RawRecorder recorder(folder_);
  Send(recorder, DatagramOf("02", "before"));
  ASSERT_EQ(recorder.Start("take"), "");
  EXPECT_EQ(recorder.status().state, RawRecorder::State::kOn);
  Send(recorder, DatagramOf("02", "one"));
  Send(recorder, DatagramOf("02", "two"));
  recorder.Stop();
  Send(recorder, DatagramOf("02", "after"));
  recorder.AwaitSaved("take.pcapng");
  const auto status = recorder.status();
  EXPECT_EQ(status.state, RawRecorder::State::kOff);
  EXPECT_EQ(status.datagrams, 2U);
  EXPECT_EQ(status.bytes, std::filesystem::file_size(top_ / "take.pcapng"));
  EXPECT_EQ(status.problem, "");
  EXPECT_THAT(Recorded("take.pcapng"), ElementsAre("one", "two"));
}

TEST_F(RawRecorderTest, KeepsCommentsWithThePacketsAfterThem) {
  RawRecorder recorder(folder_);
  recorder.Comment("before it records");
  ASSERT_EQ(recorder.Start("take"), "");
  Send(recorder, DatagramOf("02", "one"));
  recorder.Comment("belt slipped");
  Send(recorder, DatagramOf("02", "two"));
  recorder.Stop();
  recorder.AwaitSaved("take.pcapng");
  EXPECT_THAT(Recorded("take.pcapng"), ElementsAre("one", "two"));
  std::ifstream in(top_ / "take.pcapng", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(bytes.find("before it records"), std::string::npos);
  EXPECT_GT(bytes.find("belt slipped"), bytes.find("two"));
  EXPECT_NE(bytes.find("belt slipped"), std::string::npos);
}

TEST_F(RawRecorderTest, BeginsWithTheNewestNamesAndLengthsOfTheStream) {
  RawRecorder recorder(folder_);
  Send(recorder, DatagramOf("12", "old name"));
  Send(recorder, DatagramOf("13", "lengths 1", 0x00));
  Send(recorder, DatagramOf("13", "lengths 2", 0x81));
  Send(recorder, DatagramOf("12", "name"));
  ASSERT_EQ(recorder.Start("take"), "");
  Send(recorder, DatagramOf("02", "pose"));
  recorder.Stop();
  recorder.AwaitSaved("take.pcapng");
  EXPECT_THAT(Recorded("take.pcapng"), ElementsAre("name", "lengths 1", "lengths 2", "pose"));
}

TEST_F(RawRecorderTest, RefusesASecondRecordingAMissingFolderAndAFullDisk) {
  RawRecorder recorder(folder_);
  ASSERT_EQ(recorder.Start("one"), "");
  EXPECT_THAT(recorder.Start("two"), HasSubstr("a recording runs already: one.pcapng"));
  recorder.Stop();
  recorder.AwaitSaved("one.pcapng");
  free_bytes_ = 5'400'000;
  EXPECT_THAT(recorder.Start("two"), HasSubstr("the disk is full: 5.4 MB are free"));
  const Folder missing(top_ / "missing", false);
  RawRecorder other(missing);
  EXPECT_THAT(other.Start("two"), HasSubstr("is missing"));
  EXPECT_THAT(top_.Names(), ElementsAre("one.pcapng"));
}

TEST_F(RawRecorderTest, StopsByItselfBeforeTheDiskIsFullAndKeepsWhatItHas) {
  RawRecorder recorder(folder_);
  ASSERT_EQ(recorder.Start("take"), "");
  Send(recorder, DatagramOf("02", "kept"));
  free_bytes_ = 1'000'000;
  testing::WithDeadline([&] {
    while (recorder.status().state != RawRecorder::State::kOff) std::this_thread::yield();
  });
  EXPECT_THAT(recorder.status().problem,
              HasSubstr("the disk is full: recording stopped while 1.0 MB"));
  Send(recorder, DatagramOf("02", "too late"));
  EXPECT_THAT(Recorded("take.pcapng"), ElementsAre("kept"));
}

TEST_F(RawRecorderTest, SavesWhatItHasWhenTheServerEnds) {
  {
    RawRecorder recorder(folder_);
    ASSERT_EQ(recorder.Start("take"), "");
    Send(recorder, DatagramOf("02", "last"));
  }
  EXPECT_THAT(Recorded("take.pcapng"), ElementsAre("last"));
}

TEST_F(RawRecorderTest, KeepsTheDescriptionsOfAFloodOfSendersBounded) {
  StreamDescription description;
  mvn::testing::KeepingSink sink;
  for (int port = 0; port < 1000; ++port) {
    mvn::Endpoint from;
    from.port = static_cast<std::uint16_t>(port);
    const std::string bytes = DatagramOf("12", std::to_string(port));
    description.OnDatagram({from, from, bytes, {}});
  }
  description.PassTo(sink, {});
  EXPECT_EQ(sink.datagrams.size(), StreamDescription::kMost);
  EXPECT_EQ(sink.datagrams.back().bytes.substr(24), "999");
}

}  // namespace
}  // namespace kinescope::recording
