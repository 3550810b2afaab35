#include "server/mvn/stream_framer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "tests/server/mvn/mvn_testing.h"

namespace kinescope::mvn {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::IsEmpty;
using testing::Items;
using testing::PoseItems;
using testing::RandomValues;
using testing::RawDatagram;

using Pieces = std::vector<std::string>;

struct Framed {
  Pieces pieces;
  std::uint64_t resyncs = 0;
  std::uint64_t skipped = 0;
  std::uint64_t reread = 0;
  std::size_t most_pending = 0;
};

void TakeAll(StreamFramer& framer, Pieces& pieces) {
  while (const auto piece = framer.Next()) pieces.emplace_back(*piece);
}

// The whole stream in pieces of `next_size()` bytes, and its end.
Framed FrameBy(const std::string& stream, const std::function<std::size_t()>& next_size) {
  StreamFramer framer;
  Framed framed;
  std::string_view left = stream;
  while (!left.empty()) {
    const std::size_t size = std::min(next_size(), left.size());
    framer.Append(left.substr(0, size));
    left.remove_prefix(size);
    TakeAll(framer, framed.pieces);
    framed.most_pending = std::max(framed.most_pending, framer.pending_bytes());
  }
  framer.End();
  TakeAll(framer, framed.pieces);
  EXPECT_EQ(framer.pending_bytes(), 0U) << "bytes are left although the stream has ended";
  framed.resyncs = framer.resyncs();
  framed.skipped = framer.skipped_bytes();
  framed.reread = framer.reread_bytes();
  return framed;
}

Framed Frame(const std::string& stream, std::size_t chunk = 1460) {
  return FrameBy(stream, [chunk] { return chunk; });
}

std::string Text(const std::string& text) {
  std::string bytes;
  ByteWriter(bytes).WriteText(text);
  return bytes;
}

std::string MetaData(const std::string& name) {
  RawDatagram raw;
  raw.type = "12";
  raw.items = 1;
  raw.counter = raw.time_code_millis = 0;
  raw.payload = Text("color:e96417\nname:" + name + "\n");
  return raw.Bytes();
}

std::string Scale(const std::string& segment, const std::string& point) {
  RawDatagram raw;
  raw.type = "13";
  raw.counter = raw.time_code_millis = 0;
  ByteWriter out(raw.payload);
  out.Write(2U);
  for (const std::string& name : {std::string("Pelvis"), segment}) {
    out.WriteText(name);
    for (const double number : {0.0, 0.1, 1.05}) out.WriteFloat(number);
  }
  out.Write(1U);
  out.Write(std::uint16_t{1});
  out.Write(std::uint16_t{2});
  out.WriteText(point);
  out.Write(0U);
  for (const double number : {0.0, 0.0, 0.1}) out.WriteFloat(number);
  return raw.Bytes();
}

RawDatagram Raw(const std::string& type, int items, const std::string& payload) {
  RawDatagram raw;
  raw.type = type;
  raw.items = items;
  raw.payload = payload;
  return raw;
}

std::string Numbers(int count) { return Items(1, 1, count, 0.25).substr(4); }

// One of each type, as MVN sends them today.
Pieces OneOfEach() {
  return {Raw("01", 23, Items(1, 23, 6, 12.5)).Bytes(),
          Raw("02", 23, PoseItems(1, 23)).Bytes(),
          Raw("03", 40, Items(257, 40, 3, 90.5)).Bytes(),
          MetaData("Anna"),
          Scale("L5", "jL5S1"),
          Raw("20", 22, Items(258, 22, 4, 0.5)).Bytes(),
          Raw("21", 23, Items(1, 23, 9, -0.5)).Bytes(),
          Raw("22", 23, Items(1, 23, 10, 0.5, 0)).Bytes(),
          Raw("23", 17, Items(1, 17, 16, 0.5, 0)).Bytes(),
          Raw("24", 1, Numbers(9)).Bytes(),
          Raw("25", 1, Text("15:59:46.065")).Bytes()};
}

std::string Joined(const Pieces& pieces) {
  std::string all;
  for (const std::string& piece : pieces) all += piece;
  return all;
}

std::string TypeOf(const std::string& datagram) { return "type " + datagram.substr(4, 2); }

TEST(StreamFramer, DividesAStreamIntoItsDatagrams) {
  const Framed framed = Frame(Joined(OneOfEach()));
  EXPECT_EQ(framed.pieces, OneOfEach());
  EXPECT_EQ(framed.resyncs, 0U);
  EXPECT_EQ(framed.skipped, 0U);
}

TEST(StreamFramer, ReturnsADatagramWithItsLastByte) {
  StreamFramer framer;
  for (const std::string& datagram : OneOfEach()) {
    framer.Append(std::string_view(datagram).substr(0, datagram.size() - 1));
    ASSERT_FALSE(framer.Next()) << TypeOf(datagram) << " came before it was whole";
    framer.Append(std::string_view(datagram).substr(datagram.size() - 1));
    const auto piece = framer.Next();
    ASSERT_TRUE(piece) << TypeOf(datagram) << " waits for more than it needs";
    EXPECT_EQ(*piece, datagram);
    EXPECT_FALSE(framer.Next());
  }
}

TEST(StreamFramer, AcceptsNamesThatLookLikeADatagram) {
  for (const std::string& datagram : {MetaData("MXTP02"), MetaData("MXTP02 MXTP13 and so on"),
                                      Scale("MXTP02", "MXTP13"), Scale("aMXTP22b", "jL5S1")}) {
    StreamFramer framer;
    framer.Append(datagram);
    const auto piece = framer.Next();
    ASSERT_TRUE(piece) << "a good datagram has to wait";
    EXPECT_EQ(*piece, datagram);
    const std::string next = Raw("24", 1, Numbers(9)).Bytes();
    EXPECT_THAT(Frame(datagram + next).pieces, ElementsAre(datagram, next));
  }
}

TEST(StreamFramer, AcceptsTheLargestDatagram) {
  const std::string large = Raw("26", 1, std::string(65535, 'x')).Bytes();
  const std::string next = MetaData("Anna");
  for (const std::size_t chunk : {1, 1460, 200000}) {
    const Framed framed = Frame(large + next, chunk);
    EXPECT_THAT(framed.pieces, ElementsAre(large, next));
    EXPECT_EQ(framed.resyncs, 0U);
  }
}

// What a sender that dies, a cut capture or a broken program leaves: the next one begins early.
TEST(StreamFramer, LosesOnlyTheTruncatedDatagram) {
  const Pieces after = {Raw("02", 23, PoseItems(1, 23)).Bytes(), MetaData("Bob")};
  for (const std::string& damaged : OneOfEach()) {
    for (const std::string& next : {after[0], after[1]}) {
      for (std::size_t size = 1; size < damaged.size(); ++size) {
        const Framed framed = Frame(damaged.substr(0, size) + next + after[0]);
        ASSERT_GE(framed.pieces.size(), 2U) << TypeOf(damaged) << " cut to " << size;
        ASSERT_EQ(framed.pieces.back(), after[0]) << TypeOf(damaged) << " cut to " << size;
        ASSERT_EQ(framed.pieces[framed.pieces.size() - 2], next)
            << TypeOf(damaged) << " cut to " << size << " of " << damaged.size();
        ASSERT_LE(framed.pieces.size(), 3U) << TypeOf(damaged) << " cut to " << size;
        ASSERT_GE(framed.resyncs, 1U) << TypeOf(damaged) << " cut to " << size;
      }
    }
  }
}

TEST(StreamFramer, LosesOnlyTheDatagramWithAWrongSize) {
  const Pieces after = {Raw("02", 23, PoseItems(1, 23)).Bytes(), MetaData("Bob"),
                        Raw("24", 1, Numbers(9)).Bytes()};
  for (const std::string& good : OneOfEach()) {
    const int real = static_cast<int>(good.size() - kHeaderBytes);
    for (const int lie : {1, 4, 12, real / 2, real - 1, real + 1, real + 2, real + 5, real + 6,
                          real + 7, real + 24, 2 * real, 30000, 65535}) {
      if (lie == real) continue;
      std::string damaged = good;
      damaged[22] = static_cast<char>(lie / 256);
      damaged[23] = static_cast<char>(lie % 256);
      const Pieces pieces = Frame(damaged + Joined(after)).pieces;
      ASSERT_GE(pieces.size(), after.size()) << TypeOf(good) << " says " << lie << ", is " << real;
      ASSERT_THAT(Pieces(pieces.end() - 3, pieces.end()), ElementsAreArray(after))
          << TypeOf(good) << " says " << lie << ", is " << real;
    }
  }
}

TEST(StreamFramer, DoesNotWaitForAWrongSize) {
  std::string damaged = Raw("02", 23, PoseItems(1, 23)).Bytes();
  damaged[22] = static_cast<char>(0xFF);
  const std::string next = Raw("24", 1, Numbers(9)).Bytes();
  StreamFramer framer;
  framer.Append(damaged);
  EXPECT_FALSE(framer.Next());
  framer.Append(next);
  Pieces pieces;
  TakeAll(framer, pieces);
  EXPECT_THAT(pieces, ElementsAre(damaged, next));
}

TEST(StreamFramer, FindsTheLengthOfOldDatagramsByTheirContent) {
  Pieces old;
  for (RawDatagram raw :
       {Raw("01", 23, Items(1, 23, 6, 12.5)), Raw("02", 23, PoseItems(1, 23)),
        Raw("03", 40, Items(257, 40, 3, 90.5)), Raw("05", 23, PoseItems(1, 23)),
        Raw("12", 1, MetaData("MXTP02").substr(kHeaderBytes)),
        Raw("13", 0, Scale("MXTP02", "jL5S1").substr(kHeaderBytes)),
        Raw("20", 22, Items(258, 22, 4, 0.5)), Raw("21", 23, Items(1, 23, 9, -0.5)),
        Raw("22", 23, Items(1, 23, 10, 0.5, 0)), Raw("23", 17, Items(1, 17, 16, 0.5, 0)),
        Raw("24", 1, Numbers(9)), Raw("25", 1, Text("15:59:46.065")),
        Raw("25", 1, Text("15:59:46")), Raw("25", 1, "15:59:46.065")}) {
    raw.announced_payload = 0;
    old.push_back(raw.Bytes());
  }
  const Framed framed = Frame(Joined(old));
  EXPECT_EQ(framed.pieces, old);
  EXPECT_EQ(framed.resyncs, 0U);
  for (const std::string& datagram : old) {
    StreamFramer framer;
    framer.Append(datagram);
    const auto piece = framer.Next();
    ASSERT_TRUE(piece) << TypeOf(datagram) << " waits for more than it needs";
    EXPECT_EQ(*piece, datagram);
  }
}

// 23 and 24 have had two sizes; where the header says nothing, only the next datagram can.
TEST(StreamFramer, LearnsWhichOfTwoSizesAnOldSenderUses) {
  for (const bool is_long : {false, true}) {
    Pieces old;
    for (RawDatagram raw :
         {Raw("23", 17, Items(1, 17, is_long ? 16 : 10, 0.5, 0)),
          Raw("24", 1, Numbers(is_long ? 9 : 3)), Raw("02", 23, PoseItems(1, 23))}) {
      raw.announced_payload = 0;
      old.push_back(raw.Bytes());
    }
    EXPECT_EQ(Frame(Joined(old) + Joined(old)).pieces,
              Pieces({old[0], old[1], old[2], old[0], old[1], old[2]}));
    StreamFramer framer;
    framer.Append(Joined(old));
    Pieces pieces;
    TakeAll(framer, pieces);
    EXPECT_EQ(pieces, old);
    framer.Append(old[1]);
    TakeAll(framer, pieces);
    EXPECT_EQ(pieces.size(), 4U) << "waits although the size is known by now";
    EXPECT_EQ(framer.resyncs(), 0U);
  }
}

TEST(StreamFramer, FindsTheShortSizeAtTheEndOfTheStream) {
  RawDatagram raw = Raw("24", 1, Numbers(3));
  raw.announced_payload = 0;
  EXPECT_THAT(Frame(raw.Bytes()).pieces, ElementsAre(raw.Bytes()));
}

TEST(StreamFramer, FindsTheEndOfOldDatagramsOfUnknownContent) {
  const std::string next = MetaData("Anna");
  for (const auto* type : {"04", "10", "11", "77"}) {
    RawDatagram raw = Raw(type, 3, std::string(100, '\x01'));
    raw.announced_payload = 0;
    EXPECT_THAT(Frame(raw.Bytes() + next).pieces, ElementsAre(raw.Bytes(), next));
  }
}

TEST(StreamFramer, ReturnsForeignTextAndCountsSkippedBytes) {
  const Pieces good = OneOfEach();
  const std::string json = R"({"type":"transport","value":"record","name":"José"})";
  const std::string xml = "<CaptureStart><Name VALUE=\"a\"/></CaptureStart>\r\n";
  const std::string binary("\x01\x02MXT\x00MXTPab\xFF", 13);
  const Framed framed =
      Frame(json + good[0] + xml + good[1] + binary + good[2] + "plain text" + good[3] + binary);
  EXPECT_THAT(framed.pieces,
              ElementsAre(json, good[0], xml, good[1], good[2], "plain text", good[3]));
  EXPECT_EQ(framed.skipped, 2 * binary.size());
  EXPECT_EQ(framed.resyncs, 5U);
  EXPECT_EQ(framed.reread, 0U);
}

TEST(StreamFramer, KeepsAtMostOneDatagramOfAnyInput) {
  RandomValues random(3);
  std::string noise;
  for (int i = 0; i < 1'000'000; ++i) noise.push_back(static_cast<char>(random.Integer(0, 255)));
  std::string lies;  // each claims more than there will ever be
  for (int i = 0; i < 2000; ++i) {
    RawDatagram raw = Raw(i % 2 == 0 ? "12" : "13", 0, std::string(i % 700, 'x'));
    raw.announced_payload = 0;
    lies += raw.Bytes();
  }
  const std::string text(500'000, ' ');
  constexpr std::size_t kLargest = 24 + 65535 + 6;
  for (const std::string& stream : {noise, lies, text}) {
    EXPECT_LE(Frame(stream).most_pending, kLargest);
  }
  EXPECT_EQ(Joined(Frame(text).pieces), text);
  EXPECT_THAT(Frame(noise + MetaData("Anna")).pieces, Contains(MetaData("Anna")));
}

// Foreign bytes and old datagrams around the sizes at which they are cut into pieces.
TEST(StreamFramer, FindsTheNextDatagramAfterAFullBuffer) {
  const std::string next = MetaData("Anna");
  for (const int around : {65536, 65535 + 24}) {
    for (int size = around - 40; size <= around + 40; ++size) {
      const auto bytes = static_cast<std::size_t>(size);
      RawDatagram meta = Raw("12", 1, Text(std::string(bytes - kHeaderBytes - 4, 'x')));
      RawDatagram scale = Raw("13", 0, "");
      RawDatagram unknown = Raw("77", 0, std::string(bytes - kHeaderBytes, '\1'));
      ByteWriter out(scale.payload);
      out.Write(1U);
      out.WriteText(std::string(bytes - kHeaderBytes - 24, 'x'));
      scale.payload += Numbers(3) + std::string(4, '\0');
      meta.announced_payload = scale.announced_payload = unknown.announced_payload = 0;
      for (const std::string& stream : {std::string(bytes, '\0'), std::string(bytes, 'x'),
                                        meta.Bytes(), scale.Bytes(), unknown.Bytes()}) {
        ASSERT_EQ(stream.size(), bytes);
        const Framed whole = Frame(stream + next, bytes + next.size());
        ASSERT_FALSE(whole.pieces.empty());
        ASSERT_EQ(whole.pieces.back(), next) << size << " bytes before it";
        for (const std::size_t chunk : {1460, 65536}) {
          const Framed cut = Frame(stream + next, chunk);
          ASSERT_EQ(cut.pieces, whole.pieces) << size << " bytes before it, in pieces of " << chunk;
          ASSERT_EQ(cut.resyncs, whole.resyncs);
        }
      }
    }
  }
}

TEST(StreamFramer, ReturnsNothingForAnEmptyStream) {
  StreamFramer framer;
  EXPECT_FALSE(framer.Next());
  framer.Append("");
  framer.End();
  EXPECT_FALSE(framer.Next());
  EXPECT_THAT(Frame("").pieces, IsEmpty());
}

// A stream with all that can be wrong with one.
std::string BadStream(RandomValues& random) {
  const Pieces good = OneOfEach();
  std::string stream;
  for (int i = 0; i < 60; ++i) {
    std::string piece =
        good[static_cast<std::size_t>(random.Integer(0, static_cast<int>(good.size()) - 1))];
    const auto anywhere = [&] {
      return static_cast<std::size_t>(random.Integer(0, static_cast<int>(piece.size()) - 1));
    };
    switch (random.Integer(0, 9)) {
      case 0: piece.resize(anywhere()); break;
      case 1: piece[22] = piece[23] = 0; break;
      case 2: piece[22] = static_cast<char>(random.Integer(0, 255)); break;
      case 3: piece[23] = static_cast<char>(random.Integer(0, 255)); break;
      case 4: piece[anywhere()] = static_cast<char>(random.Integer(0, 255)); break;
      case 5: piece = R"({"sync":"start"})"; break;
      case 6: piece.insert(anywhere(), "MXTP02"); break;
      case 7: piece = MetaData("MXTP02"); break;
      case 8: piece.erase(0, anywhere()); break;
      default: break;
    }
    stream += piece;
  }
  return stream;
}

TEST(StreamFramer, ReturnsTheSamePiecesForAnyPartitionOfTheBytes) {
  RandomValues random(7);
  for (int round = 0; round < 40; ++round) {
    const std::string stream = BadStream(random);
    const Framed whole = Frame(stream, stream.size());
    std::size_t handed_out = 0;
    for (const std::string& piece : whole.pieces) handed_out += piece.size();
    EXPECT_EQ(handed_out + whole.skipped, stream.size() + whole.reread);
    const auto expect_same = [&](const Framed& framed, const std::string& how) {
      ASSERT_EQ(framed.pieces, whole.pieces) << "round " << round << ", " << how;
      EXPECT_EQ(framed.resyncs, whole.resyncs) << "round " << round << ", " << how;
      EXPECT_EQ(framed.skipped, whole.skipped) << "round " << round << ", " << how;
      EXPECT_EQ(framed.reread, whole.reread) << "round " << round << ", " << how;
    };
    for (const std::size_t chunk : {1, 7, 1460}) {
      expect_same(Frame(stream, chunk), "pieces of " + std::to_string(chunk));
    }
    expect_same(FrameBy(stream,
                        [&] {
                          return static_cast<std::size_t>(
                              random.Coin(0.5) ? random.Integer(1, 30) : random.Integer(1, 3000));
                        }),
                "random pieces");
  }
}

}  // namespace
}  // namespace kinescope::mvn
