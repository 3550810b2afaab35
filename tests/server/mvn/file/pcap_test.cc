#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "server/mvn/file/pcap_datagrams.h"
#include "tests/server/mvn/file/capture_builder.h"
#include "tests/server/mvn/file/datagram_sink.h"
#include "tests/server/mvn/mvn_testing.h"

namespace kinescope::mvn {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int64_t kNoon = 1'700'000'000 * kNanosPerSecond + 123'456'789;

const Endpoint kSuit = Ipv4(20, 50'001);
const Endpoint kUs = Ipv4(10, 8001);  // not MVN's own port, which needs no telling

// A type 02 of `segments` segments: 63 are a body with gloves, longer than a packet.
std::string PosePacket(std::uint32_t counter, int segments = 23) {
  RawDatagram raw;
  raw.counter = counter;
  raw.items = segments;
  raw.payload = PoseItems(1, segments);
  return raw.Bytes();
}

struct Reading {
  KeepingSink sink;
  TransportCounters counters;
};

Reading Read(const std::string& file) {
  PcapDatagrams source(FileOf(file), "test.pcap");
  EXPECT_FALSE(source.is_live());
  Reading reading{ReadToEnd(source), source.counters()};
  EXPECT_EQ(source.Poll({}, reading.sink), DatagramSource::State::kEnded) << "it stays so";
  return reading;
}

std::string ErrorOfCapture(const std::string& file) {
  try {
    Read(file);
  } catch (const SourceError& error) {
    return error.what();
  }
  return "";
}

struct Link {
  const char* name;
  std::uint32_t type;
  std::string (*wrap)(const std::string& ip);
  bool has_ipv4 = true;
  bool has_ipv6 = true;
};

class PcapLink : public ::testing::TestWithParam<Link> {};
INSTANTIATE_TEST_SUITE_P(
    All, PcapLink,
    ::testing::Values(
        Link{"Ethernet", kLinkEthernet, [](const std::string& ip) { return Ethernet(ip); }},
        Link{"Vlan", kLinkEthernet, [](const std::string& ip) { return Ethernet(ip, 1); }},
        Link{"VlanInVlan", kLinkEthernet, [](const std::string& ip) { return Ethernet(ip, 2); }},
        Link{"Cooked", kLinkCooked, LinuxCooked}, Link{"Cooked2", kLinkCooked2, LinuxCooked2},
        Link{"Raw", kLinkRaw, [](const std::string& ip) { return ip; }},
        Link{"Ipv4", kLinkIpv4, [](const std::string& ip) { return ip; }, true, false},
        Link{"Ipv6", kLinkIpv6, [](const std::string& ip) { return ip; }, false, true},
        Link{"Null", kLinkNull, Loopback}, Link{"Loop", kLinkLoop, Loopback}),
    [](const auto& link) { return link.param.name; });

TEST_P(PcapLink, ReturnsUdpDatagramsWithAddressesAndTime) {
  const Link& link = GetParam();
  const std::string v4 = link.wrap(Udp(kSuit, kUs, PosePacket(1)));
  const std::string v6 = link.wrap(Udp(Ipv6(1, 1), Ipv6(2, 2), PosePacket(2)));
  PcapBuilder pcap(link.type);
  PcapNgBuilder pcapng(link.type);
  std::vector<KeptDatagram> expected;
  if (link.has_ipv4) {
    pcap.Add(kNoon, v4);
    pcapng.Add(kNoon, v4);
    expected.push_back({kSuit, kUs, PosePacket(1), {kNoon, kNoon}});
  }
  if (link.has_ipv6) {
    pcap.Add(kNoon + 1, v6);
    pcapng.AddOther("a comment").Add(kNoon + 1, v6);
    expected.push_back({Ipv6(1, 1), Ipv6(2, 2), PosePacket(2), {kNoon + 1, kNoon + 1}});
  }
  for (const std::string& file : {pcap.bytes(), pcapng.bytes()}) {
    const Reading reading = Read(file);
    EXPECT_EQ(reading.sink.datagrams, expected);
    EXPECT_EQ(reading.counters.other_packets, 0U);
    EXPECT_EQ(reading.counters.incomplete_packets, 0U);
  }
}

TEST(Pcap, ReadsTimesInMicroseconds) {
  const Reading reading =
      Read(PcapBuilder(kLinkRaw, false).Add(kNoon, Udp(kSuit, kUs, PosePacket(1))).bytes());
  EXPECT_EQ(reading.sink.datagrams.at(0).arrival.wall_nanos, kNoon / 1000 * 1000);
}

TEST(Pcap, ReadsOnlyPacketsToThePortOfTheStream) {
  const std::string json = R"({"type":"transport","value":"record"})";
  const Endpoint name_server = Ipv4(1, 53);
  const Reading reading = Read(PcapBuilder(kLinkEthernet)
                                   .Add(kNoon, Ethernet(Udp(kUs, name_server, "who is suit?")))
                                   .Add(kNoon, Ethernet(Udp(kSuit, kUs, PosePacket(1))))
                                   .Add(kNoon, Ethernet(Udp(kSuit, kUs, json)))
                                   .Add(kNoon, Ethernet(Udp(kSuit, Ipv4(10, 9763), json)))
                                   .Add(kNoon, Ethernet(Udp(kSuit, Ipv4(10, 8002), json)))
                                   .Add(kNoon, std::string(60, '\x08'))  // no EtherType of IP
                                   .bytes());
  EXPECT_THAT(reading.sink.Brief(), ElementsAreArray(Brief({PosePacket(1), json, json})));
  EXPECT_EQ(reading.counters.other_packets, 3U);
}

TEST(Pcap, SkipsIpOptionsAndExtensionHeaders) {
  std::string v4 = Udp(kSuit, kUs, PosePacket(1));
  v4[0] = 0x47;  // 7 words
  v4.insert(20, 8, '\1');
  v4.replace(2, 2, std::string{static_cast<char>(v4.size() >> 8), static_cast<char>(v4.size())});
  std::string v6 = Udp(Ipv6(1, 1), Ipv6(2, 8001), PosePacket(2));
  const std::string options = FromHex(
      "3c00 0104 0000 0000" /* hop by hop, then destination */
      "1101 0104 0000 0000 0000 0000 0000 0000" /* then UDP */);
  v6[6] = 0;
  v6.insert(40, options);
  const std::size_t size = v6.size() - 40;
  v6.replace(4, 2, std::string{static_cast<char>(size >> 8), static_cast<char>(size)});
  const Reading reading = Read(PcapBuilder(kLinkRaw).Add(kNoon, v4).Add(kNoon, v6).bytes());
  EXPECT_THAT(reading.sink.Brief(), ElementsAreArray(Brief({PosePacket(1), PosePacket(2)})));
}

TEST(Pcap, JoinsIpFragmentsInAnyOrder) {
  std::mt19937 random(5);
  for (const bool is_v6 : {false, true}) {
    const Endpoint from = is_v6 ? Ipv6(1, 1) : kSuit;
    const Endpoint to = is_v6 ? Ipv6(2, 2) : kUs;
    PcapBuilder pcap(kLinkRaw);
    std::vector<std::string> expected;
    std::vector<std::string> pieces;
    for (std::uint32_t i = 0; i < 20; ++i) {
      expected.push_back(PosePacket(i, 63));
      for (auto& piece : Fragments(Udp(from, to, expected.back()), 496, static_cast<int>(i))) {
        pieces.push_back(piece);
      }
      pieces.push_back(pieces.back());  // the network may double one
    }
    std::shuffle(pieces.begin(), pieces.end(), random);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      pcap.Add(kNoon + static_cast<std::int64_t>(i), pieces[i]);
    }
    const Reading reading = Read(pcap.bytes());
    EXPECT_THAT(reading.sink.Brief(), ::testing::UnorderedElementsAreArray(Brief(expected)));
    for (std::size_t i = 1; i < reading.sink.datagrams.size(); ++i) {
      EXPECT_GT(reading.sink.datagrams[i].arrival.wall_nanos,
                reading.sink.datagrams[i - 1].arrival.wall_nanos)
          << "the time of the piece that completed it";
    }
  }
}

TEST(Pcap, CountsPacketsWithMissingFragments) {
  const auto lost = Fragments(Udp(kSuit, kUs, PosePacket(1, 63)), 1024, 1);
  const auto late = Fragments(Udp(kSuit, kUs, PosePacket(2, 63)), 1024, 2);
  const auto good = Fragments(Udp(kSuit, kUs, PosePacket(3, 63)), 1024, 3);
  const std::int64_t too_late = kNoon + IpFragments::kPatienceNanos + 1;
  const Reading reading = Read(PcapBuilder(kLinkRaw)
                                   .Add(kNoon, lost[0])
                                   .Add(kNoon, late[0])
                                   .Add(kNoon, good[0])
                                   .Add(kNoon, good[1])
                                   .Add(too_late, late[1])
                                   .bytes());
  EXPECT_THAT(reading.sink.Brief(), ElementsAre(Brief(PosePacket(3, 63))));
  // lost, late, and the second half of late for which a new packet began.
  EXPECT_EQ(reading.counters.incomplete_packets, 3U);
}

TEST(Pcap, CountsManyInvalidFragmentsAsIncompletePackets) {
  PcapBuilder pcap(kLinkRaw);
  constexpr int kCount = 2000;
  for (int id = 0; id < kCount; ++id) {
    // The far end of a packet of 64 kB, of which nothing else ever comes.
    pcap.Add(kNoon, Ipv4Packet(kSuit, kUs, kProtocolUdp, id, 0x1F00, "12345678"));
  }
  pcap.Add(kNoon, Ipv4Packet(kSuit, kUs, kProtocolUdp, 1, 0x1FFF, std::string(64, 'x')));
  pcap.Add(kNoon, Ipv4Packet(kSuit, kUs, kProtocolUdp, 1, 0x2000, "not in eights"));
  EXPECT_EQ(Read(pcap.bytes()).counters.incomplete_packets, kCount + 2U);
}

// TCP. ---------------------------------------------------------------------------------------

// A connection from the suit to port 9763, in segments of `size` bytes that cut datagrams anywhere.
struct Connection {
  std::vector<std::string> datagrams;
  std::vector<std::string> segments;  // SYN first, FIN last

  explicit Connection(std::size_t size, std::uint32_t first_sequence = 1000, int count = 12) {
    std::string stream;
    for (int i = 0; i < count; ++i) {
      datagrams.push_back(PosePacket(static_cast<std::uint32_t>(i), 20 + i % 3));
      stream += datagrams.back();
    }
    segments.push_back(Tcp(kSuit, to, first_sequence, kSyn, ""));
    for (std::size_t at = 0; at < stream.size(); at += size) {
      segments.push_back(Tcp(kSuit, to, first_sequence + 1 + static_cast<std::uint32_t>(at), kAck,
                             stream.substr(at, size)));
    }
    segments.push_back(Tcp(kSuit, to,
                           first_sequence + 1 + static_cast<std::uint32_t>(stream.size()),
                           kAck | kFin, ""));
  }

  const Endpoint to = Ipv4(10, 9763);
};

std::string CaptureOf(const std::vector<std::string>& segments) {
  PcapBuilder pcap(kLinkEthernet);
  std::int64_t time = kNoon;
  for (const std::string& segment : segments) pcap.Add(time += 1'000'000, Ethernet(segment));
  return pcap.bytes();
}

TEST(PcapTcp, ReadsTheDatagramsOfAConnection) {
  const Connection connection(333);
  const Reading reading = Read(CaptureOf(connection.segments));
  EXPECT_EQ(reading.sink.Brief(), Brief(connection.datagrams));
  EXPECT_EQ(reading.sink.datagrams.at(0).from, kSuit);
  EXPECT_EQ(reading.sink.datagrams.at(0).to, connection.to);
  EXPECT_EQ(reading.counters.connections, 1U);
  EXPECT_EQ(reading.counters.resyncs, 0U);
  EXPECT_EQ(reading.counters.incomplete_packets, 0U);
}

TEST(PcapTcp, OrdersSegmentsAndReadsEachByteOnce) {
  std::mt19937 random(6);
  for (int round = 0; round < 20; ++round) {
    // The sequence number wraps in the middle.
    Connection connection(251, 0xFFFFE000U);
    auto& segments = connection.segments;
    for (std::size_t i = 1; i + 4 < segments.size(); i += 4) {  // SYN and FIN stay
      std::shuffle(segments.begin() + static_cast<std::ptrdiff_t>(i),
                   segments.begin() + static_cast<std::ptrdiff_t>(i + 4), random);
    }
    segments.insert(segments.begin() + 9, segments[3]);   // retransmitted
    segments.insert(segments.begin() + 11, segments[0]);  // even the SYN
    const Reading reading = Read(CaptureOf(segments));
    EXPECT_EQ(reading.sink.Brief(), Brief(connection.datagrams)) << "round " << round;
    EXPECT_EQ(reading.counters.incomplete_packets, 0U);
  }
}

TEST(PcapTcp, ReadsOnlyTheNewBytesOfALongerRetransmission) {
  const Connection connection(300);
  std::vector<std::string> segments = connection.segments;
  const Connection coarse(900);  // the same bytes, other cuts
  segments.insert(segments.begin() + 3, coarse.segments[1]);
  EXPECT_EQ(Read(CaptureOf(segments)).sink.Brief(), Brief(connection.datagrams));
}

TEST(PcapTcp, ContinuesAfterAGapWithTheNextCompleteDatagram) {
  const Connection connection(300);
  std::vector<std::string> segments = connection.segments;
  segments.erase(segments.begin() + 5);  // bytes 1200 to 1500: of the second and third datagram
  const Reading reading = Read(CaptureOf(segments));
  std::vector<std::string> whole;
  const std::vector<std::string> all = Brief(connection.datagrams);
  for (const std::string& datagram : reading.sink.Brief()) {
    if (std::count(all.begin(), all.end(), datagram) > 0) {
      whole.push_back(datagram);
    }
  }
  std::vector<std::string> expected = connection.datagrams;
  const auto size_of = [&](std::size_t i) { return expected[i].size(); };
  ASSERT_TRUE(size_of(0) < 1200 && size_of(0) + size_of(1) > 1200 &&
              size_of(0) + size_of(1) + size_of(2) > 1500);
  expected.erase(expected.begin() + 1, expected.begin() + (size_of(0) + size_of(1) > 1500 ? 2 : 3));
  EXPECT_EQ(whole, Brief(expected));
  EXPECT_EQ(reading.counters.incomplete_packets, 1U) << "one gap";
  EXPECT_GE(reading.counters.resyncs, 1U);
}

TEST(PcapTcp, StartsInTheMiddleOfAConnection) {
  Connection connection(300);
  const std::vector<std::string> tail(connection.segments.begin() + 4, connection.segments.end());
  const Reading reading = Read(CaptureOf(tail));
  // The piece before the first datagram that is whole is no datagram.
  ASSERT_GE(reading.sink.datagrams.size(), 10U);
  EXPECT_EQ(reading.sink.Brief().back(), Brief(connection.datagrams.back()));
}

TEST(PcapTcp, TreatsANewConnectionOfTheSamePortsSeparately) {
  Connection first(300);
  const Connection second(400, 77'777);
  std::vector<std::string> segments(first.segments.begin(), first.segments.end() - 1);  // no FIN
  segments.insert(segments.end(), second.segments.begin(), second.segments.end());
  const Reading reading = Read(CaptureOf(segments));
  EXPECT_EQ(reading.sink.datagrams.size(), first.datagrams.size() + second.datagrams.size());
  EXPECT_EQ(reading.counters.connections, 2U);
}

TEST(PcapTcp, IgnoresAnyNumberOfOtherConnections) {
  const Connection connection(300);
  std::vector<std::string> segments;
  std::uint64_t web_packets = 0;
  for (std::size_t i = 0; i < connection.segments.size(); ++i) {
    segments.push_back(connection.segments[i]);
    for (std::uint16_t k = 0; k < 40; ++k, ++web_packets) {
      segments.push_back(Tcp(Ipv4(30, static_cast<std::uint16_t>(1000 + 40 * i + k)), Ipv4(10, 80),
                             9, kAck, "GET / HTTP/1.1\r\n\r\n"));
    }
  }
  const Reading reading = Read(CaptureOf(segments));
  EXPECT_EQ(reading.sink.Brief(), Brief(connection.datagrams));
  EXPECT_EQ(reading.counters.other_packets, web_packets);
}

TEST(PcapTcp, WaitsForAMissingSegmentWithLimitedMemoryAndTime) {
  // After the gap nothing is missing, but megabytes come in the seconds after it.
  const Connection connection(1400, 1000, 6000);
  std::vector<std::string> segments = connection.segments;
  constexpr std::size_t kMissing = 5;
  segments.erase(segments.begin() + kMissing);
  PcapDatagrams source(FileOf(CaptureOf(segments)), "test.pcap");
  KeepingSink sink;
  for (std::size_t i = 0; i < kMissing; ++i) {
    ASSERT_NE(source.Poll({}, sink), DatagramSource::State::kEnded);
  }
  const std::size_t before = sink.datagrams.size();
  ASSERT_GT(before, 0U);
  std::size_t waited_packets = 0;
  while (sink.datagrams.size() == before) {
    ASSERT_EQ(source.Poll({}, sink), DatagramSource::State::kMore);
    ++waited_packets;
  }
  EXPECT_LE(waited_packets * 1400, CapturedTcp::kMaxWaitingBytes + 10 * 1400);
  EXPECT_EQ(source.counters().incomplete_packets, 1U);
}

// Files that are wrong. ----------------------------------------------------------------------

TEST(Pcap, EndsWithAWarningAtATruncatedPacket) {
  for (const bool is_ng : {false, true}) {
    std::string whole, shorter;
    if (is_ng) {
      PcapNgBuilder pcapng(kLinkRaw);
      shorter = pcapng.Add(kNoon, Udp(kSuit, kUs, PosePacket(1))).bytes();
      whole = pcapng.Add(kNoon, Udp(kSuit, kUs, PosePacket(2))).bytes();
    } else {
      PcapBuilder pcap(kLinkRaw);
      shorter = pcap.Add(kNoon, Udp(kSuit, kUs, PosePacket(1))).bytes();
      whole = pcap.Add(kNoon, Udp(kSuit, kUs, PosePacket(2))).bytes();
    }
    for (std::size_t size = shorter.size(); size < whole.size(); size += 7) {
      ::testing::internal::CaptureStdout();
      const Reading reading = Read(whole.substr(0, size));
      const std::string said = ::testing::internal::GetCapturedStdout();
      EXPECT_THAT(reading.sink.Brief(), ElementsAre(Brief(PosePacket(1))));
      if (size == shorter.size()) {
        EXPECT_EQ(said, "") << "that one is whole";
      } else {
        EXPECT_THAT(said, AllOf(HasSubstr("test.pcap"), HasSubstr("1 complete packets")));
        EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
      }
    }
  }
}

TEST(Pcap, CountsPacketsThatTheCaptureTruncated) {
  const Reading reading = Read(PcapBuilder(kLinkEthernet)
                                   .Add(kNoon, Ethernet(Udp(kSuit, kUs, PosePacket(1))), 96)
                                   .Add(kNoon, Ethernet(Udp(kSuit, kUs, PosePacket(2))))
                                   .bytes());
  EXPECT_THAT(reading.sink.Brief(), ElementsAre(Brief(PosePacket(2))));
  EXPECT_EQ(reading.counters.incomplete_packets, 1U);
}

TEST(Pcap, RejectsPacketsWithWrongLengthFields) {
  const std::string good = Udp(kSuit, kUs, PosePacket(1));
  PcapBuilder pcap(kLinkRaw);
  for (std::size_t at = 0; at < 28; ++at) {  // every byte of IP and UDP header at its worst
    std::string bad = good;
    bad[at] = '\xFF';
    pcap.Add(kNoon, bad);
  }
  for (std::size_t size = 0; size < 60; ++size) pcap.Add(kNoon, good.substr(0, size));
  // What is still a UDP packet has lied about nothing that matters here: addresses, a port, times.
  for (const KeptDatagram& datagram : Read(pcap.bytes()).sink.datagrams) {
    EXPECT_EQ(datagram.bytes, PosePacket(1));
  }
}

TEST(Pcap, RejectsFilesThatAreNoCapturesOfIpPackets) {
  EXPECT_THAT(ErrorOfCapture("this is no capture at all, but a text that is long enough"),
              AllOf(HasSubstr("test.pcap: not a readable capture file"), HasSubstr("capinfos")));
  EXPECT_THAT(ErrorOfCapture(PcapBuilder(kLinkRaw).bytes().substr(0, 20)),
              HasSubstr("not a readable capture file"));
  EXPECT_THAT(ErrorOfCapture(PcapBuilder(kLinkWifi).bytes()),
              AllOf(HasSubstr("IEEE802_11"), HasSubstr("expected Ethernet")));
}

TEST(Pcap, ReportsTheNumberOfPacketsBeforeTheDamage) {
  std::string file = PcapBuilder(kLinkRaw).Add(kNoon, Udp(kSuit, kUs, PosePacket(1))).bytes();
  const std::string header_of_a_giant = FromHex("60000000 00000000 7fffffff 7fffffff");
  EXPECT_THAT(ErrorOfCapture(file + header_of_a_giant + "x"),
              AllOf(HasSubstr("test.pcap: the capture is truncated after 1 packets"),
                    HasSubstr("record or copy it again")));
}

TEST(Pcap, ReturnsTimesThatNeverDecrease) {
  const auto packet = [](std::uint32_t counter) { return Udp(kSuit, kUs, PosePacket(counter)); };
  PcapBuilder pcap(kLinkRaw);
  pcap.Add(kNoon, packet(1))
      .Add(kNoon + 5000, packet(2))
      .Add(kNoon + 3000, packet(3))  // out of order
      .Add(kNoon + 9000, packet(4))
      .Add(kNoon + 9000 - 3600 * kNanosPerSecond, packet(5))  // the clock was set
      .Add(kNoon + 10'000 - 3600 * kNanosPerSecond, packet(6));
  std::vector<std::int64_t> times;
  for (const KeptDatagram& datagram : Read(pcap.bytes()).sink.datagrams) {
    times.push_back(datagram.arrival.monotonic_nanos - kNoon);
    EXPECT_EQ(datagram.arrival.monotonic_nanos, datagram.arrival.wall_nanos);
  }
  EXPECT_THAT(times, ElementsAre(0, 5000, 5000, 9000, 9000, 10'000));
}

TEST(Pcap, KeepsTheLastTimeOnOverflow) {
  const std::int64_t late =
      0xFFFFFFF0LL * kNanosPerSecond;  // 2106, the last that the format can say
  PcapBuilder pcap(kLinkRaw);
  std::uint32_t counter = 0;
  for (const std::int64_t time : {late, kNanosPerSecond, late, 2 * kNanosPerSecond, late}) {
    pcap.Add(time, Udp(kSuit, kUs, PosePacket(++counter)));
  }
  std::vector<std::int64_t> times;
  for (const KeptDatagram& datagram : Read(pcap.bytes()).sink.datagrams) {
    times.push_back(datagram.arrival.wall_nanos - late);
  }
  EXPECT_THAT(times, ElementsAre(0, 0, 0, kNanosPerSecond, kNanosPerSecond));
}

TEST(Pcap, ReportsACaptureWithoutMvnDatagrams) {
  ::testing::internal::CaptureStdout();
  const Reading reading = Read(
      PcapBuilder(kLinkEthernet).Add(kNoon, Ethernet(Udp(kSuit, Ipv4(1, 53), "a name"))).bytes());
  EXPECT_THAT(reading.sink.datagrams, IsEmpty());
  EXPECT_THAT(::testing::internal::GetCapturedStdout(),
              AllOf(HasSubstr("1 packets, but no MVN datagram"), HasSubstr("port")));
}

}  // namespace
}  // namespace kinescope::mvn
