#include "core/system/input_file.h"

#include <archive.h>
#include <archive_entry.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "core/system/errors.h"
#include "server/mvn/file/mvnx_source.h"
#include "server/mvn/file/raw_file_datagrams.h"
#include "server/mvn/file/recording.h"
#include "server/mvn/open.h"
#include "tests/heap_in_use.h"
#include "tests/server/mvn/file/capture_builder.h"
#include "tests/server/mvn/file/datagram_sink.h"
#include "tests/server/mvn/file/synthetic_mvnx.h"
#include "tests/server/mvn/mvn_testing.h"
#include "tests/shared_data.h"
#include "tests/temp_folder.h"

namespace kinescope::mvn {
namespace {

using namespace testing;
using kinescope::testing::HeapInUse;
using kinescope::testing::SharedData;
using kinescope::testing::TempFolder;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;

std::filesystem::path Write(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

// `content` as gzip, xz and so on make it of a file.
std::string Packed(const std::string& content, int (*add_filter)(archive*)) {
  std::string packed;
  archive* const writer = archive_write_new();
  add_filter(writer);
  archive_write_set_format_raw(writer);
  archive_write_set_bytes_in_last_block(writer, 1);
  archive_write_open(
      writer, &packed, nullptr,
      [](archive*, void* to, const void* bytes, std::size_t size) -> la_ssize_t {
        static_cast<std::string*>(to)->append(static_cast<const char*>(bytes), size);
        return static_cast<la_ssize_t>(size);
      },
      nullptr);
  archive_entry* const entry = archive_entry_new();
  archive_entry_set_filetype(entry, AE_IFREG);
  archive_write_header(writer, entry);
  archive_write_data(writer, content.data(), content.size());
  archive_entry_free(entry);
  archive_write_close(writer);
  archive_write_free(writer);
  return packed;
}

std::string ReadAll(InputFile& file) {
  std::string content;
  std::array<char, 1000> buffer{};
  while (const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), file.get())) {
    content.append(buffer.data(), size);
  }
  return content;
}

// Longer than any buffer on the way, and with nothing in it that repeats.
std::string Content() {
  RandomValues random(31);
  std::string content = "MXTP02";
  while (content.size() < 300'000) content.push_back(static_cast<char>(random.Integer(0, 255)));
  return content;
}

struct Packing {
  const char* name;
  int (*add_filter)(archive*);
};

constexpr Packing kPlain{"plain", archive_write_add_filter_none};
constexpr Packing kPackings[] = {{"gzip", archive_write_add_filter_gzip},
                                 {"xz", archive_write_add_filter_xz},
                                 {"zstd", archive_write_add_filter_zstd},
                                 {"bzip2", archive_write_add_filter_bzip2},
                                 {"lz4", archive_write_add_filter_lz4}};

std::string NameOf(const ::testing::TestParamInfo<Packing>& packing) { return packing.param.name; }

class AnyInput : public ::testing::TestWithParam<Packing> {};
INSTANTIATE_TEST_SUITE_P(Plain, AnyInput, ::testing::Values(kPlain), NameOf);
INSTANTIATE_TEST_SUITE_P(Packed, AnyInput, ::testing::ValuesIn(kPackings), NameOf);

class PackedInput : public ::testing::TestWithParam<Packing> {};
INSTANTIATE_TEST_SUITE_P(All, PackedInput, ::testing::ValuesIn(kPackings), NameOf);

TEST_P(AnyInput, IsReadWithAnyName) {
  TempFolder folder;
  const std::string content = Content();
  const std::string packed = Packed(content, GetParam().add_filter);
  InputFile file = OpenInputFile(Write(folder / "take.txt", packed));
  EXPECT_EQ(file.head(), content.substr(0, file.head().size()));
  EXPECT_EQ(KindOf(file.head()), RecordingKind::kDatagrams);
  EXPECT_TRUE(ReadAll(file) == content);
  EXPECT_EQ(file.failure(), "");
}

TEST_P(AnyInput, IsReadFromAPipe) {
  TempFolder folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string content = Content();
  std::thread writer([&] { Write(pipe, Packed(content, GetParam().add_filter)); });
  InputFile file = OpenInputFile(pipe);
  EXPECT_TRUE(ReadAll(file) == content);
  writer.join();
}

TEST_P(PackedInput, ReportsWhyItIsTruncated) {
  TempFolder folder;
  const std::string packed = Packed(Content(), GetParam().add_filter);
  for (const std::size_t size : {packed.size() / 2, packed.size() - 200}) {
    const std::string path = Write(folder / "take", packed.substr(0, size));
    std::string said = ErrorOf([&] {  // at once, where the first block is cut already
      InputFile file = OpenInputFile(path);
      const std::string content = ReadAll(file);
      EXPECT_NE(std::ferror(file.get()), 0) << "ends as if that were all: " << content.size();
      throw SourceError(file.failure());
    });
    EXPECT_NE(said, "");
  }
}

// libarchive looks at no check sum of gzip and writes none for zstd: of these a damaged byte may
// come through as it is, and the end may come early.
bool HasCheckSum(const Packing& packing) {
  return packing.name != std::string("gzip") && packing.name != std::string("zstd");
}

TEST_P(PackedInput, ReportsDamageThatChangesItsContent) {
  TempFolder folder;
  const std::string content = Content().substr(0, 80'000);
  const std::string packed = Packed(content, GetParam().add_filter);
  RandomValues random(32);
  int failed = 0, harmed = 0;
  for (int i = 0; i < 20; ++i) {
    constexpr int kDamagedBytes = 5;
    std::string damaged = packed;
    for (int k = 0; k < kDamagedBytes; ++k) {
      damaged[static_cast<std::size_t>(random.Integer(0, 2000))] =
          static_cast<char>(random.Integer(0, 255));
    }
    std::string read;
    const std::string error = ErrorOf([&] {
      InputFile file = OpenInputFile(Write(folder / "take", damaged));
      read = ReadAll(file);
      EXPECT_EQ(std::ferror(file.get()) != 0, !file.failure().empty());
      if (!file.failure().empty()) throw SourceError(file.failure());
    });
    if (!error.empty()) {
      ++failed;
    } else if (read != content &&
               read != damaged) {  // the latter: it does not look packed any more
      ++harmed;
      ASSERT_LE(read.size(), content.size());
      int different = 0;
      for (std::size_t at = 0; at < read.size(); ++at) different += read[at] != content[at];
      EXPECT_LE(different, kDamagedBytes);
    }
  }
  if (!HasCheckSum(GetParam())) return;
  EXPECT_GT(failed, 0);
  EXPECT_EQ(harmed, 0) << "taken for whole";
}

TEST(InputFile, NeedsLittleMemoryForADecompressionBomb) {
  TempFolder folder;
  const std::string zeros(1 << 20, '\0');
  // gzip in gzip: 256 MB in a few hundred bytes.
  std::string once;
  for (int i = 0; i < 256; ++i) once += Packed(zeros, archive_write_add_filter_gzip);
  const std::string path =
      Write(folder / "bomb", Packed(once, archive_write_add_filter_gzip)).string();
  ASSERT_LT(std::filesystem::file_size(path), 20'000U);
  const std::size_t before = HeapInUse();
  RawFileDatagrams source(OpenInputFile(path), "bomb");
  std::size_t most = 0;
  KeepingSink sink;
  while (source.Poll({}, sink) != DatagramSource::State::kEnded) {
    most = std::max(most, HeapInUse());
  }
  EXPECT_LT(sink.datagrams.size(), 10U);
  EXPECT_LT(most, before + (1 << 20));
}

TEST(InputFile, ReportsTheErrorOfAPath) {
  TempFolder folder;
  const auto error_of = [](const std::string& path) {
    return ErrorOf([&] { OpenInputFile(path); });
  };
  EXPECT_THAT(error_of("/nowhere/take.pcap"),
              AllOf(HasSubstr("/nowhere/take.pcap"), HasSubstr("No such file"),
                    HasSubstr("check the path")));
  EXPECT_THAT(error_of(folder.path()), HasSubstr("is a folder"));
  const std::string broken_at_once = Packed(Content(), archive_write_add_filter_xz).substr(0, 20);
  EXPECT_THAT(error_of(Write(folder / "take.xz", broken_at_once)),
              AllOf(HasSubstr("take.xz: cannot read the file"), HasSubstr("copy it again")));
  if (geteuid() == 0) return;  // root may read anything
  const std::string secret = Write(folder / "secret", "MXTP02");
  chmod(secret.c_str(), 0);
  EXPECT_THAT(error_of(secret), AllOf(HasSubstr("secret"), HasSubstr("Permission denied")));
}

TEST(InputFile, RecognisesARecordingByItsContent) {
  EXPECT_EQ(KindOf(""), RecordingKind::kEmpty);
  EXPECT_EQ(KindOf(PcapBuilder(kLinkRaw).bytes()), RecordingKind::kPcap);
  EXPECT_EQ(KindOf(PcapBuilder(kLinkRaw, false).bytes()), RecordingKind::kPcap);
  EXPECT_EQ(KindOf(PcapNgBuilder(kLinkRaw).bytes()), RecordingKind::kPcap);
  EXPECT_EQ(KindOf("#ROSBAG V2.0\n"), RecordingKind::kRosBag);
  EXPECT_EQ(KindOf("\xef\xbb\xbf<?xml"), RecordingKind::kMvnx);
  EXPECT_EQ(KindOf("\n  <mvnx version=\"4\">"), RecordingKind::kMvnx);
  EXPECT_EQ(KindOf("the end of one MXTP02 and so on"), RecordingKind::kDatagrams);
  EXPECT_EQ(KindOf("MXTP is an id string"), RecordingKind::kUnknown);
  EXPECT_EQ(KindOf("<sync/>MXTP02"), RecordingKind::kDatagrams);
}

TEST(OpenDatagrams, AcceptsOnlyRecordingsOfDatagrams) {
  TempFolder folder;
  const auto open = [&](const std::string& bytes) {
    return OpenDatagrams(Write(folder / "take.xyz", bytes).string());
  };
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  EXPECT_EQ(OpenDatagrams("demo:lift"), nullptr);
  EXPECT_EQ(open(WriteMvnx(4, 60, skeleton, SwingingArms(skeleton, 1))), nullptr);
  EXPECT_EQ(open("#ROSBAG V2.0\n"), nullptr);
  EXPECT_NE(open(PcapBuilder(kLinkRaw).bytes()), nullptr);
  EXPECT_NE(open(RawDatagram().Bytes()), nullptr);
  EXPECT_THAT(ErrorOf([&] { open("PK\x03\x04 and so on"); }), HasSubstr("zip"));
  EXPECT_THAT(ErrorOf([&] { open("Dear diary, today I lifted a box"); }),
              AllOf(HasSubstr("take.xyz"), HasSubstr("unknown file format"), HasSubstr("pcap")));
  EXPECT_THAT(ErrorOf([&] { open(""); }), HasSubstr("is empty"));
  EXPECT_THAT(ErrorOf([] { OpenDatagrams("/nowhere/x.pcap"); }), HasSubstr("No such file"));
}

TEST(OpenDatagrams, ReportsADamagedArchiveInEveryReader) {
  TempFolder folder;
  const auto cut = [&](const std::string& content) {
    const std::string packed = Packed(content, archive_write_add_filter_gzip);
    return Write(folder / "take.gz", packed.substr(0, packed.size() / 2)).string();
  };
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  PcapBuilder pcap(kLinkRaw);
  std::string raw;
  RandomValues random(33);
  for (std::uint32_t i = 0; i < 500; ++i) {
    RawDatagram datagram;
    datagram.counter = i;
    datagram.items = 23;
    datagram.payload = Items(1, 23, 7, random.Number(1), 3);
    raw += datagram.Bytes();
    pcap.Add(i, Udp(Ipv4(1, 1), Ipv4(2, 9763), datagram.Bytes()));
  }
  for (const auto& [content, phrase] :
       {std::pair(raw, "reading stopped"), std::pair(pcap.bytes(), "is truncated after")}) {
    const std::string path = cut(content);
    EXPECT_THAT(ErrorOf([&] { ReadToEnd(*OpenDatagrams(path)); }),
                AllOf(HasSubstr("take.gz"), HasSubstr(phrase), HasSubstr("truncated gzip")));
  }
  const std::string mvnx = cut(WriteMvnx(4, 60, skeleton, SwingingArms(skeleton, 50)));
  EXPECT_THAT(
      ErrorOf([&] {
        const auto source = OpenMvnx(mvnx);
        testing::RecordingSink sink;
        while (source->Poll({}, sink) == Source::State::kMore) {
        }
      }),
      AllOf(HasSubstr("take.gz:"), HasSubstr("truncated here"), HasSubstr("truncated gzip")));
}

// Raw datagrams. -----------------------------------------------------------------------------

std::vector<std::int64_t> TimesOf(const std::vector<std::optional<std::uint32_t>>& time_codes) {
  TimeCodeClock clock;
  std::vector<std::int64_t> millis;
  for (const auto& code : time_codes) {
    millis.push_back((clock.Advance(code) - TimeCodeClock::kStartNanos) / 1'000'000);
  }
  return millis;
}

TEST(TimeCodeClock, FollowsTheSenderAndNeverGoesBack) {
  using ::testing::ElementsAre;
  EXPECT_THAT(TimesOf({100, 104, {}, 108, 104, 112}), ElementsAre(0, 4, 4, 8, 8, 12));
  // A damaged datagram moves nothing.
  EXPECT_THAT(TimesOf({100, 4'000'000'000, 104, 5, 108}), ElementsAre(0, 0, 4, 4, 8));
  // Started over: goes on from there. A pause: is one.
  EXPECT_THAT(TimesOf({90'000, 0, 4, 8}), ElementsAre(0, 0, 0, 4));
  EXPECT_THAT(TimesOf({0, 60'000, 60'004, 60'008}), ElementsAre(0, 0, 60'004, 60'008));
  // Meta data before the first sample wait for nothing.
  EXPECT_THAT(TimesOf({{}, {}, 7'000, 7'004}), ElementsAre(0, 0, 0, 4));
  // The code wraps after 49 days.
  EXPECT_THAT(TimesOf({0xFFFFFFFFU, 3, 7}), ElementsAre(0, 0, 0));
}

TEST(RawFile, ReturnsDatagramsWithTheTimeOfTheSender) {
  std::string stream;
  for (std::uint32_t i = 0; i < 100; ++i) {
    RawDatagram raw;
    raw.counter = i;
    raw.time_code_millis = 10 * i;
    raw.items = 23;
    raw.payload = PoseItems(1, 23);
    stream += raw.Bytes();
  }
  RawFileDatagrams source(FileOf(stream), "take.bin");
  const KeepingSink sink = ReadToEnd(source);
  ASSERT_EQ(sink.datagrams.size(), 100U);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(sink.datagrams[i].bytes, stream.substr(i * 760, 760));
    EXPECT_EQ(sink.datagrams[i].arrival.wall_nanos,
              TimeCodeClock::kStartNanos + static_cast<std::int64_t>(i) * 10'000'000);
    EXPECT_EQ(sink.datagrams[i].arrival.monotonic_nanos, sink.datagrams[i].arrival.wall_nanos);
  }
  EXPECT_EQ(source.counters().resyncs, 0U);
}

TEST(RawFile, ReadsTheRecordedTrackerStream) {
  const char* const kFile = "udp/mxtp23_lowerbody_000-149.bin";
  KINESCOPE_NEEDS_SHARED_DATA(kFile);
  const auto source = OpenDatagrams(SharedData(kFile));
  const KeepingSink sink = ReadToEnd(*source);
  ASSERT_EQ(sink.datagrams.size(), 150U);
  const std::string whole = kinescope::testing::ReadFile(SharedData(kFile));
  for (std::size_t i = 0; i < sink.datagrams.size(); ++i) {
    EXPECT_EQ(sink.datagrams[i].bytes, whole.substr(500 * i, 500));
    if (i == 0) continue;
    const std::int64_t step =
        sink.datagrams[i].arrival.wall_nanos - sink.datagrams[i - 1].arrival.wall_nanos;
    EXPECT_GE(step, 9'000'000);  // as the recording's description has it
    EXPECT_LE(step, 100'000'000);
  }
}

class RealDatagram : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, RealDatagram,
                         ::testing::Values("mxtp01", "mxtp02", "mxtp12", "mxtp13"),
                         [](const auto& name) { return name.param; });

TEST_P(RealDatagram, IsReadAsOneDatagram) {
  const std::string file = std::string("udp/") + GetParam() + ".bin";
  KINESCOPE_NEEDS_SHARED_DATA(file);
  const auto source = OpenDatagrams(SharedData(file));
  const KeepingSink sink = ReadToEnd(*source);
  ASSERT_EQ(sink.datagrams.size(), 1U);
  EXPECT_EQ(sink.datagrams[0].bytes, kinescope::testing::ReadFile(SharedData(file)));
}

}  // namespace
}  // namespace kinescope::mvn
