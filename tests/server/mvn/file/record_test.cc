#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>

#include "core/system/errors.h"
#include "server/mvn/encode.h"
#include "server/mvn/file/pcap_datagrams.h"
#include "server/mvn/file/pcap_recorder.h"
#include "server/mvn/file/pcap_writer.h"
#include "server/mvn/open.h"
#include "tests/full_disk.h"
#include "tests/patience.h"
#include "tests/server/mvn/file/capture_builder.h"
#include "tests/server/mvn/file/datagram_sink.h"
#include "tests/server/mvn/mvn_testing.h"
#include "tests/temp_folder.h"

namespace kinescope::mvn {
namespace {

using namespace testing;
using kinescope::testing::SmallFilesOnly;
using kinescope::testing::TempFolder;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::int64_t kRecordNoon = 1'700'000'000'123'456'789;
const Endpoint kRecordedSuit = Ipv4(20, 50'001);
const Endpoint kRecorder = Ipv4(10, 9763);

KeptDatagram Datagram(std::uint32_t counter, std::size_t items = 23) {
  RawDatagram raw;
  raw.counter = counter;
  raw.items = static_cast<int>(items);
  raw.payload = PoseItems(1, static_cast<int>(items));
  const std::int64_t time = kRecordNoon + counter * 4'166'667LL;
  return {kRecordedSuit, kRecorder, raw.Bytes(), {time, time}};
}

ReceivedDatagram View(const KeptDatagram& datagram) {
  return {datagram.from, datagram.to, datagram.bytes, datagram.arrival};
}

void Write(PcapWriter& writer, const KeptDatagram& datagram) {
  writer.Write(datagram.from, datagram.to, datagram.arrival.wall_nanos, datagram.bytes);
}

std::vector<KeptDatagram> ReadBack(const std::string& path) {
  return ReadToEnd(*OpenDatagrams(path)).datagrams;
}

TEST(PcapWriter, WritesEveryByteAddressAndTime) {
  TempFolder folder;
  Endpoint nobody;
  nobody.port = 9763;
  std::vector<KeptDatagram> written = {
      Datagram(1),
      Datagram(2, 63),
      {Ipv6(1, 1), Ipv6(2, 9763), Datagram(3).bytes, {}},
      {kRecordedSuit, Ipv6(2, 9763), Datagram(4).bytes, {}},  // a mapped address
      {kRecordedSuit, kRecorder, "", {}},
      {kRecordedSuit, kRecorder, "odd", {}},
      {kRecordedSuit, kRecorder, std::string(kMaxUdpPayload, 'x'), {}},
      {Endpoint(), kRecorder, "MXTP", {}},
      {nobody, nobody, "MXTP", {}},
  };
  for (std::size_t i = 0; i < written.size(); ++i) {
    written[i].arrival.wall_nanos = kRecordNoon + static_cast<std::int64_t>(i) * 1'234'567;
  }
  for (const char* name : {"take.pcap", "take.pcapng"}) {
    const std::string path = folder / name;
    PcapWriter writer({path});
    for (const KeptDatagram& datagram : written) Write(writer, datagram);
    writer.Close();
    EXPECT_EQ(writer.datagrams(), written.size());
    EXPECT_EQ(writer.bytes(), std::filesystem::file_size(path));
    EXPECT_EQ(ReadBack(path), written) << name;
  }
}

struct Block {
  std::uint32_t type = 0;
  std::string body;
};

// Of a pcapng file; checks that lengths in front and behind agree.
std::vector<Block> BlocksOf(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;)
      value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
    return value;
  };
  std::vector<Block> blocks;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::uint32_t length = word(at + 4);
    EXPECT_EQ(length % 4, 0U);
    EXPECT_EQ(word(at + length - 4), length);
    blocks.push_back({word(at), bytes.substr(at + 8, length - 12)});
    at += length;
  }
  return blocks;
}

TEST(PcapWriter, CommentsOnTheNextPacket) {
  TempFolder folder;
  const std::string path = folder / "take.pcapng";
  PcapWriter writer({path});
  Write(writer, Datagram(1));
  writer.Comment("belt slipped");
  writer.Comment(std::string(65'534, 'x') + "é");  // cut in the middle of the last character
  Write(writer, Datagram(2));
  Write(writer, Datagram(3));
  writer.Comment("after the last one");
  writer.Close();
  const std::vector<Block> blocks = BlocksOf(path);
  ASSERT_EQ(blocks.size(), 6U);
  constexpr std::uint32_t kSection = 0x0A0D0D0A, kInterface = 1, kStatistics = 5, kPacket = 6;
  EXPECT_EQ(blocks[0].type, kSection);
  EXPECT_EQ(blocks[1].type, kInterface);
  for (int i = 2; i < 5; ++i) EXPECT_EQ(blocks[i].type, kPacket);
  EXPECT_EQ(blocks[5].type, kStatistics);
  const std::string option("\1\0\x0C\0", 4);  // opt_comment, 12 bytes
  EXPECT_EQ(blocks[2].body.find("belt"), std::string::npos);
  EXPECT_NE(blocks[3].body.find(option + "belt slipped"), std::string::npos);
  const std::string cut("\1\0\xFE\xFF", 4);
  EXPECT_NE(blocks[3].body.find(cut + "xxx"), std::string::npos);
  EXPECT_EQ(blocks[3].body.find("\xC3", blocks[3].body.find("xxx")), std::string::npos);
  EXPECT_EQ(blocks[4].body.find("belt"), std::string::npos);
  EXPECT_NE(blocks[5].body.find("after the last one"), std::string::npos);
  EXPECT_EQ(ReadBack(path), (std::vector<KeptDatagram>{Datagram(1), Datagram(2), Datagram(3)}));
}

TEST(PcapWriter, LosesCommentsInPcap) {
  TempFolder folder;
  const std::string path = folder / "take.pcap";
  PcapWriter writer({path});
  writer.Comment("belt slipped");
  Write(writer, Datagram(1));
  writer.Close();
  EXPECT_EQ(ReadBack(path), std::vector<KeptDatagram>{Datagram(1)});
}

TEST(PcapWriter, KeepsEveryTimeToTheNanosecond) {
  TempFolder folder;
  const std::string path = folder / "take.pcap";
  std::vector<KeptDatagram> written;
  for (const std::int64_t time : {std::int64_t{0}, std::int64_t{999'999'999}, kRecordNoon}) {
    written.push_back({kRecordedSuit, kRecorder, "MXTP", {time, time}});
  }
  PcapWriter writer({path});
  for (const KeptDatagram& datagram : written) Write(writer, datagram);
  writer.Close();
  EXPECT_EQ(ReadBack(path), written);
}

// What tshark says, line by line; it is what Wireshark understands.
TEST(PcapWriter, WritesFilesThatWiresharkReads) {
  if (std::system("tshark --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no tshark here";
  TempFolder folder;
  const std::string path = folder / "take.pcap";
  PcapWriter writer({path});
  Write(writer, Datagram(1, 63));
  Write(writer, {Ipv6(1, 7), Ipv6(2, 9763), Datagram(2).bytes, {kRecordNoon, kRecordNoon}});
  Write(writer, {kRecordedSuit, kRecorder, "odd", {kRecordNoon, kRecordNoon}});
  writer.Close();
  const std::string command =
      "tshark -r '" + path +
      "' -o ip.check_checksum:TRUE -o udp.check_checksum:TRUE -T fields -E separator=/s "
      "-e frame.time_epoch -e ip.src -e ip.dst -e ipv6.src -e ipv6.dst -e udp.srcport "
      "-e udp.dstport -e udp.length -e ip.checksum.status -e udp.checksum.status "
      "-e _ws.expert.message 2>/dev/null";
  std::FILE* const said = popen(command.c_str(), "r");
  ASSERT_NE(said, nullptr);
  std::string text;
  std::array<char, 512> line{};
  while (std::fgets(line.data(), line.size(), said) != nullptr) text += line.data();
  ASSERT_EQ(pclose(said), 0) << text;
  // Status 1: the checksum is good. Nothing from the expert at the end of a line.
  EXPECT_EQ(text,
            "1700000000.127623456 10.0.0.20 10.0.0.10   50001 9763 2048 1 1 \n"
            "1700000000.123456789   fd00::1 fd00::2 7 9763 768  1 \n"
            "1700000000.123456789 10.0.0.20 10.0.0.10   50001 9763 11 1 1 \n");
}

TEST(PcapWriter, StartsANewFileBeforeOneExceedsTheLimit) {
  TempFolder folder;
  const std::string path = folder / "take.pcap";
  PcapWriterSettings settings{path};
  settings.rotate_bytes = 5000;
  PcapWriter writer(settings);
  std::vector<KeptDatagram> written;
  for (std::uint32_t i = 0; i < 40; ++i) {
    written.push_back(Datagram(i, i == 20 ? 250 : 23));  // one that is larger than a file may be
    Write(writer, written.back());
  }
  writer.Close();
  EXPECT_EQ(writer.files().front(), path);
  EXPECT_EQ(writer.files().at(1), folder / "take-0002.pcap");
  std::vector<KeptDatagram> together;
  std::uint64_t bytes = 0;
  for (const std::string& file : writer.files()) {
    const auto part = ReadBack(file);
    EXPECT_FALSE(part.empty());
    if (part.size() > 1) {
      EXPECT_LE(std::filesystem::file_size(file), 5000U);
    }
    bytes += std::filesystem::file_size(file);
    together.insert(together.end(), part.begin(), part.end());
  }
  EXPECT_EQ(together, written);
  EXPECT_EQ(writer.bytes(), bytes);
  EXPECT_EQ(folder.Names().size(), writer.files().size());
}

TEST(PcapWriter, ReplacesFilesOnlyWhenForced) {
  TempFolder folder;
  const std::string path = folder / "take.pcap";
  std::ofstream(path) << "dear";
  EXPECT_THAT(ErrorOf([&] { PcapWriter({path}); }),
              AllOf(HasSubstr(path), HasSubstr("exists"), HasSubstr("--force")));
  EXPECT_EQ(std::filesystem::file_size(path), 4U);
  PcapWriter({path, 0, true}).Close();
  EXPECT_EQ(ReadBack(path).size(), 0U);

  // Numbered ones of an earlier recording would seem to be part of this one.
  std::filesystem::remove(path);
  std::ofstream(folder / "take-0002.pcap") << "dear";
  EXPECT_THAT(ErrorOf([&] { PcapWriter({path, 1000, false}); }), HasSubstr("take-0002.pcap"));
  EXPECT_EQ(folder.Names(), std::vector<std::string>{"take-0002.pcap"});
  PcapWriter({path, 1000, true}).Close();
  EXPECT_EQ(folder.Names(), std::vector<std::string>{"take.pcap"});
}

TEST(PcapWriter, ReportsWhyAFileCannotBeCreated) {
  TempFolder folder;
  EXPECT_THAT(ErrorOf([&] { PcapWriter({folder / "none/take.pcap"}); }),
              AllOf(HasSubstr("none/take.pcap"), HasSubstr("create its folder first")));
  EXPECT_THAT(ErrorOf([&] { PcapWriter({folder.path()}); }), HasSubstr("is a folder"));
}

TEST(PcapWriter, ReportsAFullDevice) {
  EXPECT_THAT(
      ErrorOf([] { PcapWriter({"/dev/full"}); }),
      AllOf(HasSubstr("/dev/full"), HasSubstr("No space left"), HasSubstr("nothing was recorded")));
}

TEST(PcapWriter, KeepsCompletePacketsWhenTheDiskIsFull) {
  // Wherever in a packet the disk ends.
  for (std::uint64_t limit = 90'000; limit < 90'800; limit += 97) {
    TempFolder folder;
    const std::string path = folder / "take.pcap";
    PcapWriter writer({path});
    std::uint32_t added = 0;
    std::string error;
    {
      const SmallFilesOnly full(limit);
      error = ErrorOf([&] {
        for (; added < 1000; ++added) Write(writer, Datagram(added));
      });
    }
    ASSERT_LT(added, 1000U) << "the disk never got full";
    ::testing::internal::CaptureStdout();
    const auto kept = ReadBack(path);
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "") << "the reader warns of a cut packet";
    ASSERT_FALSE(kept.empty());
    for (std::uint32_t i = 0; i < kept.size(); ++i) EXPECT_EQ(kept[i], Datagram(i));
    EXPECT_EQ(kept.size(), writer.datagrams());
    // As many as fit.
    const std::uint64_t packet = 16 + 28 + Datagram(0).bytes.size();
    EXPECT_EQ(kept.size(), (limit - 24) / packet);
    EXPECT_THAT(error, AllOf(HasSubstr(path), HasSubstr("recording stopped"),
                             HasSubstr("kept and readable: " + std::to_string(kept.size()))));
  }
}

TEST(PcapWriter, LeavesNoEmptyFileWhenTheDiskIsFullAtARotation) {
  TempFolder folder;
  const std::string path = folder / "take.pcap";
  PcapWriterSettings settings{path};
  settings.rotate_bytes = 5000;
  PcapWriter writer(settings);
  std::uint32_t added = 0;
  while (writer.bytes() + 2000 < 5000) {
    Write(writer, Datagram(added++));
    writer.Flush();
  }
  std::string error;
  {
    const SmallFilesOnly full(0);  // not even the header of the next one
    error = ErrorOf([&] {
      for (int i = 0; i < 10; ++i) Write(writer, Datagram(added++));
    });
  }
  EXPECT_EQ(folder.Names(), std::vector<std::string>{"take.pcap"});
  EXPECT_EQ(ReadBack(path).size(), writer.datagrams());
  EXPECT_THAT(error, HasSubstr("kept and readable"));
}

// The thread. --------------------------------------------------------------------------------

TEST(PcapRecorder, WritesToTheFileWithinSeconds) {
  TempFolder folder;
  const std::string path = folder / "take.pcap";
  PcapRecorder recorder({path}, PcapRecorder::WhenFull::kDrop);
  EXPECT_EQ(ReadBack(path).size(), 0U) << "it is a capture from the beginning";
  const auto before = std::chrono::steady_clock::now();
  recorder.OnDatagram(View(Datagram(1)));
  while (recorder.counters().datagrams == 0) {
    ASSERT_LT(std::chrono::steady_clock::now() - before, kinescope::testing::kPatience);
    std::this_thread::yield();
  }
  EXPECT_THAT(ReadBack(path), ElementsAre(Datagram(1)));
  recorder.Finish();
}

// A pipe that takes 64 kB and then nothing until somebody reads: a disk that stalls.
class StalledPipe {
 public:
  explicit StalledPipe(const TempFolder& folder) : path_(folder / "pipe") {
    mkfifo(path_.c_str(), 0600);
    reader_ = open(path_.c_str(), O_RDONLY | O_NONBLOCK);
  }
  ~StalledPipe() { close(reader_); }

  const std::string& path() const { return path_; }

  // All that comes until the other end is closed.
  std::string ReadAll() const {
    std::string all;
    std::array<char, 4096> buffer{};
    for (;;) {
      pollfd wanted{reader_, POLLIN, 0};
      poll(&wanted, 1, -1);
      const ssize_t count = read(reader_, buffer.data(), buffer.size());
      if (count <= 0) return all;
      all.append(buffer.data(), static_cast<std::size_t>(count));
    }
  }

 private:
  std::string path_;
  int reader_ = -1;
};

TEST(PcapRecorder, LosesNothingWhileTheDiskIsSlow) {
  TempFolder folder;
  const StalledPipe disk(folder);
  PcapRecorder recorder({disk.path()}, PcapRecorder::WhenFull::kDrop);
  // Ten seconds of one person at 240 Hz with type 02, of which 64 kB are taken.
  constexpr std::uint32_t kCount = 2400;
  for (std::uint32_t i = 0; i < kCount; ++i) recorder.OnDatagram(View(Datagram(i)));
  std::string file;
  std::thread reader([&] { file = disk.ReadAll(); });  // it goes on
  recorder.Finish();
  const auto counters = recorder.counters();
  reader.join();
  EXPECT_EQ(counters.datagrams, kCount);
  EXPECT_EQ(counters.dropped, 0U);
  PcapDatagrams source(FileOf(file), "pipe");
  const auto recorded = ReadToEnd(source).datagrams;
  ASSERT_EQ(recorded.size(), kCount);
  for (std::uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(recorded[i], Datagram(i));
}

TEST(PcapRecorder, CountsDatagramsThatDoNotFitIntoItsQueue) {
  TempFolder folder;
  const StalledPipe disk(folder);
  constexpr std::size_t kQueue = 100'000;
  PcapRecorder recorder({disk.path()}, PcapRecorder::WhenFull::kDrop, kQueue);
  constexpr std::uint32_t kCount = 2400;
  for (std::uint32_t i = 0; i < kCount; ++i) recorder.OnDatagram(View(Datagram(i)));
  recorder.OnDatagram({kRecordedSuit, kRecorder, std::string(kMaxUdpPayload + 1, 'x'), {}});
  std::string file;
  std::thread reader([&] { file = disk.ReadAll(); });
  recorder.Finish();
  reader.join();
  const auto counters = recorder.counters();
  EXPECT_GT(counters.dropped, 0U);
  EXPECT_EQ(counters.datagrams + counters.dropped, kCount);
  EXPECT_EQ(counters.too_long, 1U);
  PcapDatagrams source(FileOf(file), "pipe");
  EXPECT_EQ(ReadToEnd(source).datagrams.size(), counters.datagrams);
}

TEST(PcapRecorder, DelaysAFileSourceInsteadOfDroppingDatagrams) {
  TempFolder folder;
  const StalledPipe disk(folder);
  std::string file;
  std::thread reader([&] { file = disk.ReadAll(); });
  PcapRecorder recorder({disk.path()}, PcapRecorder::WhenFull::kWait, 10'000);
  for (std::uint32_t i = 0; i < 2400; ++i) recorder.OnDatagram(View(Datagram(i)));
  recorder.Finish();
  reader.join();
  EXPECT_EQ(recorder.counters().dropped, 0U);
  EXPECT_EQ(recorder.counters().datagrams, 2400U);
}

TEST(PcapRecorder, ReportsAFullDiskToItsOwner) {
  TempFolder folder;
  const SmallFilesOnly full(100'000);
  const std::string path = folder / "take.pcap";
  for (const auto when_full : {PcapRecorder::WhenFull::kDrop, PcapRecorder::WhenFull::kWait}) {
    PcapRecorder recorder({path, 0, true}, when_full, 50'000);
    const std::string error = ErrorOf([&] {
      for (std::uint32_t i = 0;; ++i) recorder.OnDatagram(View(Datagram(i)));
    });
    EXPECT_THAT(error, HasSubstr("recording stopped"));
    EXPECT_THAT(ErrorOf([&] { recorder.Check(); }), HasSubstr("recording stopped"));
    EXPECT_THAT(ErrorOf([&] { recorder.Finish(); }), HasSubstr("recording stopped"));
    EXPECT_EQ(ReadBack(path).size(), recorder.counters().datagrams);
  }
}

// Played again. ------------------------------------------------------------------------------

// Everything of every sample, as text that differs when a bit does.
class SerialisingSink : public SampleSink {
 public:
  void OnCharacter(const Character& character) override {
    text_ << "character " << character.id << ' ' << character.name << '\n';
  }
  void OnSample(const BodySample& sample) override {
    text_ << std::hexfloat << sample.character << ' ' << sample.counter << ' '
          << sample.time_code_millis << ' ' << sample.stamp_nanos << ' ' << sample.arrival_nanos;
    for (const SegmentState& segment : sample.segments) {
      text_ << ' ' << segment.position.transpose() << ' '
            << segment.orientation.coeffs().transpose() << ' ' << segment.velocity.transpose()
            << ' ' << segment.acceleration.transpose() << ' '
            << segment.angular_velocity.transpose() << ' '
            << segment.angular_acceleration.transpose();
    }
    if (sample.com) text_ << " com " << sample.com->position.transpose();
    if (sample.streamed_angles_deg) {
      for (const auto& angles : *sample.streamed_angles_deg) text_ << ' ' << angles.transpose();
    }
    text_ << '\n';
    ++samples;
  }

  std::string text() const { return text_.str(); }
  int samples = 0;

 private:
  std::ostringstream text_;
};

TEST(Record, GivesIdenticalSamplesOnEveryPlayback) {
  TempFolder folder;
  const std::string path = folder / "take.pcap";
  RandomValues random(41);
  PcapWriter writer({path});
  std::int64_t time = kRecordNoon;
  for (std::uint32_t counter = 0; counter < 200; ++counter) {
    for (int person = 0; person < 2; ++person) {
      BodySample sample = RandomSample(random, counter);
      sample.character = person;
      for (const std::string& datagram : EncodeSample(sample)) {
        time += random.Integer(1, 1'500'000);  // jitter
        if (random.Coin(0.02)) continue;       // losses
        Write(writer, {kRecordedSuit, kRecorder, datagram, {time, time}});
      }
    }
  }
  writer.Close();
  for (const Stamps stamps : {Stamps::kFitted, Stamps::kArrival}) {
    std::vector<std::string> played;
    for (int round = 0; round < 2; ++round) {
      StreamSettings settings;
      settings.stamps = stamps;
      const auto source = OpenStream(OpenDatagrams(path), settings);
      SerialisingSink sink;
      while (source->Poll({}, sink) == Source::State::kMore) {
      }
      EXPECT_GT(sink.samples, 350);
      played.push_back(sink.text());
    }
    EXPECT_TRUE(played[0] == played[1]);
  }
}

}  // namespace
}  // namespace kinescope::mvn
