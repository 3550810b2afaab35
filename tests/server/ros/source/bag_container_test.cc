// The container of bags: chunks, compression, an index that is missing, an end that is cut off,
// damage of known places.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "server/ros/source/transform_people.h"
#include "tests/captured_log.h"
#include "tests/heap_in_use.h"
#include "tests/server/ros/source/written_bag.h"
#include "tests/shared_data.h"
#include "tests/system/run_program.h"

namespace kinescope::ros_bridge {
namespace {

using kinescope::testing::HeapInUse;
using kinescope::testing::RunProgram;
using kinescope::testing::SharedData;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

TEST_F(BagTest, RejectsUnreadableFilesWithNameAndRemedy) {
  EXPECT_THAT(RefusalOf("no/such.bag"), HasSubstr("no/such.bag: cannot open the file"));
  EXPECT_THAT(RefusalOf(folder_.path()), HasSubstr("is a folder"));
  const std::string text = folder_ / "text.bag";
  std::ofstream(text) << "MXTP02, or anything that is no bag";
  EXPECT_THAT(RefusalOf(text), HasSubstr("not a ROS 1 bag"));
  ASSERT_EQ(RunProgram({"/bin/gzip", text}).exit_code, 0);
  EXPECT_THAT(RefusalOf(text + ".gz"), HasSubstr("not a ROS 1 bag"));

  const std::string nobody = Bag([](rosbag::Bag& out) {
    tf2_msgs::TFMessage message = TransformsOf(PersonAt(0));
    message.transforms.resize(20);
    out.write("/tf", RosTimeOf(kBagStart), message);
  });
  EXPECT_THAT(RefusalOf(nobody), AllOf(HasSubstr(nobody), HasSubstr("no person found on /tf"),
                                       HasSubstr("skeleton_pelvis")));
  const std::string no_tf = Bag(
      [](rosbag::Bag& out) { out.write("/chatter", RosTimeOf(kBagStart), std_msgs::String()); });
  EXPECT_THAT(RefusalOf(no_tf), HasSubstr("contains neither /tf nor link_states"));
  const std::string empty = Bag([](rosbag::Bag&) {});
  EXPECT_THAT(RefusalOf(empty), HasSubstr("contains neither /tf nor link_states"));
}

std::string Gzip(const std::string& path) {
  EXPECT_EQ(RunProgram({"/bin/gzip", path}).exit_code, 0);
  return path + ".gz";
}

void ExpectEqual(const std::vector<BodySample>& got, const std::vector<BodySample>& expected) {
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_EQ(got[i].stamp_nanos, expected[i].stamp_nanos) << "sample " << i;
    EXPECT_EQ(got[i].character, expected[i].character);
    for (std::size_t segment = 0; segment < got[i].segments.size(); ++segment) {
      EXPECT_EQ(got[i].segments[segment].position, expected[i].segments[segment].position);
      EXPECT_EQ(got[i].segments[segment].orientation.coeffs(),
                expected[i].segments[segment].orientation.coeffs());
    }
  }
}

// The samples of the same bag as rosbag reads it.
std::vector<BodySample> SamplesOfRosbag(const std::string& path) {
  const rosbag::Bag bag(path, rosbag::bagmode::Read);
  rosbag::View view(bag, rosbag::TopicQuery(std::vector<std::string>{"/tf", "/tf_static"}));
  TransformPeople people(0);
  for (const rosbag::MessageInstance& instance : view) {
    const auto message = instance.instantiate<tf2_msgs::TFMessage>();
    for (const auto& transform : message->transforms) people.AddName(transform.child_frame_id);
  }
  people.FindPeople();
  kinescope::testing::RecordingSink sink;
  SourceCounters counters;
  for (const rosbag::MessageInstance& instance : view) {
    const auto message = instance.instantiate<tf2_msgs::TFMessage>();
    if (instance.getTopic() == "/tf_static") {
      people.TakeStatic(*message, counters);
    } else {
      people.Take(*message, {static_cast<std::int64_t>(instance.getTime().toNSec()), 0}, counters,
                  sink);
    }
  }
  return sink.samples;
}

// 20 samples in several chunks, the transforms of a sample one by one.
void WriteInChunks(rosbag::Bag& out) {
  out.setChunkThreshold(4096);
  for (int n = 0; n < 20; ++n) {
    std::int64_t recorded_at = kBagStart + n * kBagPeriod;
    for (const auto& transform : TransformsOf(PersonAt(n)).transforms) {
      tf2_msgs::TFMessage single;
      single.transforms.push_back(transform);
      out.write("/tf", RosTimeOf(recorded_at), single);
      recorded_at += 10'000;
    }
  }
}

class CompressedBagTest : public BagTest,
                          public ::testing::WithParamInterface<rosbag::CompressionType> {};

INSTANTIATE_TEST_SUITE_P(Compressions, CompressedBagTest,
                         ::testing::Values(rosbag::compression::Uncompressed,
                                           rosbag::compression::BZ2, rosbag::compression::LZ4));

TEST_P(CompressedBagTest, HasTheSamplesThatRosbagReads) {
  const std::string bag = Bag(WriteInChunks, GetParam());
  const std::vector<BodySample> samples = ReadBag(bag).samples;
  EXPECT_EQ(samples.size(), 20U);
  ExpectEqual(samples, SamplesOfRosbag(bag));
}

TEST_F(BagTest, HasTheSamplesThatRosbagReadsOfARealRecording) {
  KINESCOPE_NEEDS_SHARED_DATA("ros1/2018-05-28-17-34-45.bag.xz");
  const std::string packed = SharedData("ros1/2018-05-28-17-34-45.bag.xz");
  std::filesystem::copy(packed, path() + ".xz");
  ASSERT_EQ(RunProgram({"/usr/bin/xz", "-d", path() + ".xz"}).exit_code, 0);
  const std::vector<BodySample> samples = ReadBag(packed).samples;
  ExpectEqual(samples, SamplesOfRosbag(path()));
  ExpectEqual(samples, ReadBag(path()).samples);
}

// As a script writes it that appends one bag to another, and as threads do that record.
TEST_F(BagTest, PutsMessagesInTheOrderOfTheirRecordedTime) {
  const std::string bag = Bag([](rosbag::Bag& out) {
    out.setChunkThreshold(4096);
    for (const char* name : {"anna", "ben"}) {
      for (int n = 0; n < 10; ++n) {
        const int swapped = n ^ 1;
        out.write("/tf", RosTimeOf(kBagStart + swapped * kBagPeriod),
                  TransformsOf(PersonAt(swapped, name)));
      }
    }
  });
  const std::vector<BodySample> samples = ReadBag(bag).samples;
  ASSERT_EQ(samples.size(), 20U);
  for (std::size_t i = 0; i < samples.size(); ++i) EXPECT_EQ(samples[i].counter, i / 2);
  const std::string sorted = Bag([](rosbag::Bag& out) {
    for (int n = 0; n < 10; ++n) {
      for (const char* name : {"anna", "ben"}) {
        out.write("/tf", RosTimeOf(kBagStart + n * kBagPeriod), TransformsOf(PersonAt(n, name)));
      }
    }
  });
  ExpectEqual(samples, SamplesOfRosbag(sorted));
}

TEST_P(CompressedBagTest, ReadsEveryTruncationUpToItsEnd) {
  const std::string bag = Bag(
      [](rosbag::Bag& out) {
        for (int n = 0; n < 3; ++n)
          out.write("/tf", RosTimeOf(kBagStart + n), TransformsOf(PersonAt(n)));
      },
      GetParam());
  const std::string whole = kinescope::testing::ReadFile(bag);
  const std::string cut = folder_ / "cut.bag";
  std::size_t most = 0;
  for (std::size_t size = 1; size < whole.size(); size += 409) {
    std::ofstream(cut, std::ios::binary).write(whole.data(), static_cast<std::streamsize>(size));
    SCOPED_TRACE(std::to_string(size) + " of " + std::to_string(whole.size()) + " bytes");
    try {
      const std::vector<BodySample> samples = ReadBag(cut).samples;
      EXPECT_GE(samples.size(), most) << "fewer samples in more bytes";
      most = samples.size();
      for (const BodySample& sample : samples) {
        ExpectPoses(sample, PersonAt(static_cast<int>(sample.counter)));
      }
    } catch (const SourceError& error) {
      EXPECT_EQ(most, 0U) << error.what();
      EXPECT_THAT(error.what(), HasSubstr(cut));
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(most, 3U);
}

// As a recorder leaves it that was killed: without index, the last chunk without its sizes.
TEST_P(CompressedBagTest, ReadsABagThatWasNotClosed) {
  const std::string copy = folder_ / "recording.bag.active";
  Bag(
      [&](rosbag::Bag& out) {
        WriteInChunks(out);
        std::filesystem::copy(path(), copy);
      },
      GetParam());
  const kinescope::testing::CapturedLog log;
  const std::vector<BodySample> samples = ReadBag(copy).samples;
  ASSERT_GE(samples.size(), 5U);
  for (const BodySample& sample : samples) {
    ExpectPoses(sample, PersonAt(static_cast<int>(sample.counter)));
  }
  EXPECT_THAT(log.text(), HasSubstr("was not closed or is truncated"));
}

TEST_F(BagTest, CountsTheRecordThatIsCutOffByTheEnd) {
  const std::string bag = Bag(WriteInChunks);
  std::filesystem::resize_file(bag, std::filesystem::file_size(bag) / 2);
  const SourceCounters counters = ReadBag(bag).counters;
  EXPECT_GE(counters.samples, 5U);
  EXPECT_THAT(counters.rejected,
              ::testing::Contains(Pair("record that is cut off by the end of the bag", 1)));
}

TEST_P(CompressedBagTest, SkipsAndCountsADamagedChunk) {
  const std::string bag = Bag(WriteInChunks, GetParam());
  std::string bytes = kinescope::testing::ReadFile(bag);
  std::size_t chunk = 0;
  for (int n = 0; n < 4; ++n) chunk = bytes.find("compression=", chunk + 1);
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(chunk) + 200, 40, '\x7f');
  std::ofstream(bag, std::ios::binary) << bytes;
  const kinescope::testing::CapturedLog log;
  const ReadPeople recorded = ReadBag(bag);
  EXPECT_THAT(log.text(), HasSubstr("left out (")) << "also without `inspect`";
  EXPECT_GE(recorded.samples.size(), 15U);
  EXPECT_LT(recorded.samples.size(), 20U);
  const auto& rejected = recorded.counters.rejected;
  EXPECT_GE(rejected.count("chunk that fails its checksum or cannot be decompressed, with all of "
                           "its messages") +
                rejected.count("record with a damaged header"),
            1U)
      << ::testing::PrintToString(rejected);
}

// As after a power failure.
TEST_P(CompressedBagTest, IsReadUpToAnEndOfZeros) {
  const std::string bag = Bag(WriteInChunks, GetParam());
  std::string bytes = kinescope::testing::ReadFile(bag);
  const std::size_t chunk = bytes.find("compression=", bytes.size() / 2);
  std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(chunk) - 8, bytes.end(), '\0');
  std::ofstream(bag, std::ios::binary) << bytes;
  const kinescope::testing::CapturedLog log;
  EXPECT_GE(ReadBag(bag).samples.size(), 5U);
  EXPECT_THAT(log.text(), HasSubstr("is damaged after"));
}

// The length of a chunk's header, of its data, and of the index behind it.
TEST_P(CompressedBagTest, GoesOnWithTheNextChunkAfterADamagedLength) {
  const std::string bag = Bag(WriteInChunks, GetParam());
  const std::string whole = kinescope::testing::ReadFile(bag);
  std::size_t chunk = 0;
  for (int n = 0; n < 4; ++n) chunk = whole.find("compression=", chunk + 1);
  const std::size_t sizes = whole.find("size=", chunk);
  for (const std::size_t length_at :
       {chunk - 8, sizes + 5, sizes + 9, whole.find("ver=", chunk) + 8}) {
    for (const char* value : {"\x7f\x7f\x7f\x7f", "\x09"}) {
      std::string bytes = whole;
      bytes.replace(length_at, std::strlen(value), value);
      std::ofstream(bag, std::ios::binary) << bytes;
      const ReadPeople recorded = ReadBag(bag);
      EXPECT_GE(recorded.samples.size(), 14U) << length_at - chunk << ", " << value;
      EXPECT_FALSE(recorded.counters.rejected.empty()) << length_at - chunk << ", " << value;
    }
  }
}

TEST_P(CompressedBagTest, NeedsNoIndex) {
  const std::string bag = Bag(WriteInChunks, GetParam());
  std::string bytes = kinescope::testing::ReadFile(bag);
  const auto index = static_cast<std::ptrdiff_t>(bytes.rfind("message_definition"));
  std::fill(bytes.begin() + index, bytes.end(), '\x7f');
  std::ofstream(bag, std::ios::binary) << bytes;
  EXPECT_EQ(ReadBag(bag).samples.size(), 20U);
}

TEST_F(BagTest, RejectsALargeMessageWithoutTakingMemoryForIt) {
  const std::string bag = Bag(
      [](rosbag::Bag& out) {
        out.write("/tf", RosTimeOf(kBagStart), TransformsOf(PersonAt(0)));
        AnyBytes large;
        large.bytes.resize(100 << 20);
        out.write("/tf", RosTimeOf(kBagStart + 1), large);
        AnyBytes::datatype = "sensor_msgs/Image";
        out.write("/camera", RosTimeOf(kBagStart + 1), large);
        out.write("/tf", RosTimeOf(kBagStart + kBagPeriod), TransformsOf(PersonAt(1)));
      },
      rosbag::compression::LZ4);
  struct : SampleSink {
    void OnCharacter(const Character&) override {}
    void OnSample(const BodySample&) override { most = std::max(most, HeapInUse()); }
    std::size_t most = 0;
  } sink;
  const std::size_t before = HeapInUse();
  const auto source = OpenBag(bag);
  while (source->Poll({}, sink) != Source::State::kEnded) {
  }
  EXPECT_LT(sink.most, before + (16U << 20U));
  EXPECT_EQ(source->counters().samples, 2U);
  EXPECT_THAT(source->counters().rejected,
              ElementsAre(Pair("transforms that are truncated or have a wrong length field", 1)));
}

TEST_F(BagTest, ReadsATruncatedCompressedBagUpToItsEnd) {
  const std::string bag = Gzip(Bag(WriteInChunks));
  std::filesystem::resize_file(bag, std::filesystem::file_size(bag) / 2);
  kinescope::testing::RecordingSink sink;
  const auto source = OpenBag(bag);
  try {
    while (source->Poll({}, sink) != Source::State::kEnded) {
    }
    FAIL() << "ended as if it were complete";
  } catch (const SourceError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr(bag), HasSubstr("truncated gzip input"),
                                    HasSubstr("copy it again")));
  }
  EXPECT_GE(sink.samples.size(), 5U);
}

TEST_F(BagTest, ReadsACompressedBagWithoutTemporaryFiles) {
  const std::string bag = Gzip(Bag(
      [](rosbag::Bag& out) { out.write("/tf", RosTimeOf(kBagStart), TransformsOf(PersonAt(0))); }));
  const char* before = std::getenv("TMPDIR");
  const std::string kept = before == nullptr ? "" : before;
  setenv("TMPDIR", "/no/such/folder", 1);
  EXPECT_EQ(ReadBag(bag).samples.size(), 1U);
  if (before == nullptr) {
    unsetenv("TMPDIR");
  } else {
    setenv("TMPDIR", kept.c_str(), 1);
  }
}

TEST_F(BagTest, RejectsAnOldVersionOfTheFormat) {
  std::ofstream(path()) << "#ROSBAG V1.2\n";
  EXPECT_THAT(RefusalOf(path()), AllOf(HasSubstr("expected 2.0"), HasSubstr("rosbag filter")));
}

}  // namespace
}  // namespace kinescope::ros_bridge
