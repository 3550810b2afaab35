// Bags that were damaged on the way: hundreds of seeded damages, none of which may end the process,
// take memory without limit, or deliver a sample that cannot be drawn.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "core/system/errors.h"
#include "server/ros/source/bag_source.h"
#include "server/ros/transforms.h"
#include "tests/captured_log.h"
#include "tests/fuzz/invariants.h"
#include "tests/heap_in_use.h"
#include "tests/recording_sink.h"
#include "tests/server/ros/test_person.h"
#include "tests/shared_data.h"
#include "tests/temp_folder.h"

namespace kinescope::ros_bridge {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kFirstNanos = 1'700'000'000'000'000'000;
constexpr std::int64_t kPeriodNanos = 10'000'000;
constexpr int kSamplesOfTheBag = 8;
// Bytes, however large the bag says that it is.
constexpr std::size_t kMostMemory = 32 << 20;
constexpr std::size_t kLargestAllocation = 17 << 20;

// Repeatable on every machine, unlike the distributions of the standard library.
class Damage {
 public:
  explicit Damage(std::uint32_t seed) : random_(seed) {}

  std::string Of(std::string bag) {
    switch (Below(8)) {
      case 0:
        for (std::size_t i = 0, count = 1 + Below(8); i < count; ++i) {
          bag[Below(bag.size())] ^= static_cast<char>(1U << Below(8));
        }
        break;
      case 1: bag.resize(Below(bag.size())); break;
      case 2:
        for (std::size_t i = 0, count = 1 + Below(4); i < count; ++i) SetALength(bag);
        break;
      case 3: {  // a block that the disk lost
        const std::size_t at = Below(bag.size());
        std::fill_n(bag.begin() + static_cast<std::ptrdiff_t>(at),
                    std::min<std::size_t>(bag.size() - at, 1 + Below(4096)), '\0');
        break;
      }
      case 4: {  // a piece that is missing
        const std::size_t at = Below(bag.size());
        bag.erase(at, 1 + Below(600));
        break;
      }
      default: SetAFieldOfARecord(bag); break;
    }
    return bag;
  }

 private:
  std::size_t Below(std::size_t limit) { return random_() % limit; }

  // Maximises what is a length by its looks: a number of 4 bytes below 64 KiB.
  void SetALength(std::string& bag) {
    for (std::size_t at = Below(bag.size()); at + 4 <= bag.size(); ++at) {
      const std::uint32_t value = NumberAt(bag, at);
      if (value == 0 || value > 0xFFFF) continue;
      std::memcpy(bag.data() + at, &kLengths[Below(std::size(kLengths))], sizeof(value));
      return;
    }
  }

  // A number in a record: of its lengths, its header, or the index that it holds.
  void SetAFieldOfARecord(std::string& bag) {
    std::vector<std::size_t> numbers;
    for (std::size_t at = 13; at + 4 <= bag.size();) {
      const auto header = NumberAt(bag, at);
      const auto data = NumberAt(bag, at + 4 + header);
      const bool is_chunk = data > 4096;
      const std::size_t end = at + 8 + header + data;
      for (std::size_t i = at; i < end && i + 4 <= bag.size(); i += 2) {
        if (i < at + 8 + header || !is_chunk) numbers.push_back(i);
      }
      at = end;
    }
    const std::uint32_t value = Below(2) == 0 ? kLengths[Below(std::size(kLengths))]
                                              : static_cast<std::uint32_t>(Below(1U << 20U));
    std::memcpy(bag.data() + numbers[Below(numbers.size())], &value, sizeof(value));
  }

  static std::uint32_t NumberAt(const std::string& bag, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bag.data() + at, sizeof(value));
    return value;
  }

  static constexpr std::uint32_t kLengths[] = {0xFFFFFFFF, 0x7FFFFFFF, 0x7FFFFFF0, 0x10000000, 0};
  std::mt19937 random_;
};

class DamagedBagTest : public ::testing::TestWithParam<rosbag::CompressionType> {
 protected:
  // Several chunks, several topics.
  std::string WholeBag(std::uint32_t chunk_bytes = 8192, std::size_t text_bytes = 100) const {
    const auto model = kinescope::testing::MakeModel("skeleton");
    const std::string path = folder_ / "whole.bag";
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    bag.setCompression(GetParam());
    bag.setChunkThreshold(chunk_bytes);
    for (int n = 0; n < kSamplesOfTheBag; ++n) {
      const std::int64_t now = kFirstNanos + n * kPeriodNanos;
      tf2_msgs::TFMessage message;
      FillTransforms(kinescope::testing::MakePerson(model, kinescope::testing::Posture(0.05 * n),
                                                    static_cast<std::uint32_t>(n), now),
                     PersonNames(model->human.model_name), "world", TfShape::kFlat, message);
      ros::Time time;
      time.fromNSec(static_cast<std::uint64_t>(now));
      std_msgs::String text;
      text.data = std::string(text_bytes, 'x');
      bag.write("/chatter", time, text);
      bag.write("/tf", time, message);
    }
    bag.close();
    return kinescope::testing::ReadFile(path);
  }

  kinescope::testing::TempFolder folder_;
};

struct CheckingSink : SampleSink {
  void OnCharacter(const Character&) override {}
  void OnSample(const BodySample& sample) override {
    fuzz::CheckSample(sample);
    ++samples;
    most = std::max(most, kinescope::testing::HeapInUse());
  }
  int samples = 0;
  std::size_t most = 0;
};

TEST_P(DamagedBagTest, IsReadUpToTheDamageOrRejectedInOneLine) {
  const std::string whole = WholeBag();
  const std::string path = folder_ / "damaged.bag";
  const std::size_t before = kinescope::testing::HeapInUse();
  int read = 0;
  int samples = 0;
  kinescope::testing::LargestAllocation();
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const std::string bytes = Damage(seed).Of(whole);
    std::ofstream(path, std::ios::binary) << bytes;
    SCOPED_TRACE("seed " + std::to_string(seed));
    CheckingSink sink;
    try {
      const auto source = OpenBag(path);
      while (source->Poll({}, sink) != Source::State::kEnded) {
      }
      ++read;
    } catch (const SourceError& error) {
      EXPECT_THAT(error.what(), HasSubstr(path));
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
    samples += sink.samples;
    EXPECT_LT(sink.most, before + kMostMemory);
    EXPECT_LT(kinescope::testing::LargestAllocation(), kLargestAllocation);
    EXPECT_LE(sink.samples, kSamplesOfTheBag);
  }
  EXPECT_GT(read, 50) << "most damages cost some messages, not the bag";
  EXPECT_GT(samples, 50 * kSamplesOfTheBag);
}

// Of the first chunk, with the records of all connections. The index has them again.
TEST_P(DamagedBagTest, WithoutItsFirstChunkHasThePeopleOfTheOthers) {
  std::string bytes = WholeBag();
  const std::size_t topic = bytes.find("compression=");
  ASSERT_NE(topic, std::string::npos);
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(topic) + 40, 200, '\xff');
  const std::string path = folder_ / "damaged.bag";
  std::ofstream(path, std::ios::binary) << bytes;
  CheckingSink sink;
  const kinescope::testing::CapturedLog log;
  const auto source = OpenBag(path);
  while (source->Poll({}, sink) != Source::State::kEnded) {
  }
  EXPECT_GE(sink.samples, kSamplesOfTheBag / 2);
  EXPECT_THAT(log.text(), HasSubstr("left out"));
}

// The stamps and positions of all samples, in text.
struct TextSink : SampleSink {
  void OnCharacter(const Character&) override {}
  void OnSample(const BodySample& sample) override {
    std::string text = std::to_string(sample.stamp_nanos);
    for (const SegmentState& segment : sample.segments) {
      for (const double value : segment.position) text += ' ' + std::to_string(value);
    }
    samples.insert(std::move(text));
  }
  std::set<std::string> samples;
};

using CheckedBagTest = DamagedBagTest;

// rosbag's chunks have checksums. Without looking at them a changed byte is another motion.
TEST_P(CheckedBagTest, HasNoOtherMotionAfterAChangedByte) {
  const std::string path = folder_ / "changed.bag";
  bool is_named = false;
  const auto read = [&](const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
    TextSink sink;
    const auto source = OpenBag(path);
    while (source->Poll({}, sink) != Source::State::kEnded) {
    }
    is_named = !source->counters().rejected.empty();
    return sink.samples;
  };
  constexpr std::uint32_t kOneChunk = 64 << 20;
  constexpr std::size_t kLongText = 1'200'000;  // eight of them are more than a chunk that is kept
  for (const std::string& whole : {WholeBag(), WholeBag(kOneChunk, kLongText)}) {
    const bool is_one_chunk = whole.find("compression=") == whole.rfind("compression=");
    const std::set<std::string> right = read(whole);
    ASSERT_EQ(right.size(), static_cast<std::size_t>(kSamplesOfTheBag));
    const std::size_t trials = is_one_chunk ? 10 : 60;
    std::size_t left_out = 0;
    for (std::size_t n = 0; n < trials; ++n) {
      const std::size_t at = 4200 + n * whole.size() / 2 / trials;  // in the chunks, not the index
      SCOPED_TRACE(at);
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
      std::set<std::string> samples;
      try {
        samples = read(bytes);
      } catch (const SourceError& error) {  // nothing is left of the only chunk
        EXPECT_TRUE(is_one_chunk);
        EXPECT_THAT(error.what(), HasSubstr("left out"));
        ++left_out;
        continue;
      }
      for (const std::string& sample : samples) EXPECT_EQ(right.count(sample), 1U) << sample;
      if (samples.size() == right.size()) continue;
      ++left_out;
      EXPECT_TRUE(is_named);
    }
    EXPECT_GT(left_out, trials / 2);
  }
}

INSTANTIATE_TEST_SUITE_P(Compressions, CheckedBagTest,
                         ::testing::Values(rosbag::compression::BZ2, rosbag::compression::LZ4));

INSTANTIATE_TEST_SUITE_P(Compressions, DamagedBagTest,
                         ::testing::Values(rosbag::compression::Uncompressed,
                                           rosbag::compression::BZ2, rosbag::compression::LZ4));

}  // namespace
}  // namespace kinescope::ros_bridge
