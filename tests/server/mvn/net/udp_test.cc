// Real sockets on the loopback interface; free ports, nothing waits for a clock.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "server/mvn/encode.h"
#include "server/mvn/net/sender.h"
#include "server/mvn/net/udp_datagrams.h"
#include "server/mvn/open.h"
#include "tests/server/mvn/mvn_testing.h"
#include "tests/server/mvn/net/net_testing.h"

namespace kinescope::mvn {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using ::testing::AllOf;
using testing::Client;
using ::testing::ElementsAre;
using testing::ErrorOf;
using ::testing::HasSubstr;
using testing::PollUntil;
using testing::RandomSample;
using testing::RandomValues;
using testing::RecordingDatagrams;
using testing::RecordingSink;
using State = DatagramSource::State;

TEST(UdpDatagrams, ReportAPortInUseWithARemedy) {
  const UdpDatagrams first("udp://127.0.0.1:0");
  const std::string port = std::to_string(first.port());
  EXPECT_EQ(first.description(), "udp://127.0.0.1:" + port);
  EXPECT_THAT(ErrorOf([&first] { UdpDatagrams second(first.description()); }),
              AllOf(HasSubstr("port " + port + " is already in use"), HasSubstr("ss -ulpn"),
                    HasSubstr("choose another port")));
}

TEST(UdpDatagrams, RejectAnInvalidAddressByName) {
  EXPECT_THAT(ErrorOf([] { OpenUdpDatagrams("udp://203.0.113.1:0"); }),
              AllOf(HasSubstr("203.0.113.1"), HasSubstr("not an address of this machine")));
  EXPECT_THAT(ErrorOf([] { OpenUdpDatagrams("udp://no.such.host:0"); }),
              AllOf(HasSubstr("'no.such.host'"), HasSubstr("numeric address")));
}

TEST(UdpDatagrams, ListenOnAllInterfacesWithALargeBuffer) {
  const UdpDatagrams source("udp://:0");
  EXPECT_EQ(source.description(), "udp://0.0.0.0:" + std::to_string(source.port()));
  EXPECT_TRUE(source.is_live());
  EXPECT_GE(source.counters().receive_buffer_bytes, 128 * 1024);
}

TEST(UdpDatagrams, ReturnWithoutData) {
  UdpDatagrams source("udp://127.0.0.1:0");
  RecordingDatagrams sink;
  EXPECT_EQ(source.Poll(nanoseconds(0), sink), State::kIdle);
  EXPECT_EQ(source.Poll(nanoseconds(-5), sink), State::kIdle);
  EXPECT_EQ(source.Poll(nanoseconds(1), sink), State::kIdle);
  EXPECT_TRUE(sink.all.empty());
}

TEST(UdpDatagrams, HaveBothAddressesAndTheReceiveTime) {
  UdpDatagrams source("udp://:0");
  // Any address of the loopback network is this machine's.
  Client client("udp://127.0.0.3:" + std::to_string(source.port()));
  RecordingDatagrams sink;
  const Arrival before = ReadClocks();
  client.Send("hello");
  ASSERT_TRUE(PollUntil(source, sink, [&] { return !sink.all.empty(); }));
  const Arrival read = ReadClocks();
  const auto& received = sink.all.front();
  EXPECT_EQ(received.bytes, "hello");
  EXPECT_EQ(Format(received.from), Format(client.local()));
  EXPECT_EQ(Format(received.to), Format(client.peer()))
      << "the address it was sent to, not 0.0.0.0";
  // The two clocks are read one after the other, which a busy machine may draw out.
  constexpr std::int64_t kSlack = 100'000'000;
  EXPECT_GE(received.arrival.wall_nanos, before.wall_nanos);
  EXPECT_LE(received.arrival.wall_nanos, read.wall_nanos);
  EXPECT_GE(received.arrival.monotonic_nanos, before.monotonic_nanos - kSlack);
  EXPECT_LE(received.arrival.monotonic_nanos, read.monotonic_nanos + kSlack);
}

TEST(UdpDatagrams, ArriveOverIpv4AndIpv6) {
  if (!testing::HasIpv6()) GTEST_SKIP() << "this machine has no IPv6 loopback address";
  UdpDatagrams source("udp://[::]:0");
  EXPECT_EQ(source.description(), "udp://[::]:" + std::to_string(source.port()));
  const std::string port = std::to_string(source.port());
  Client ipv4("udp://127.0.0.1:" + port);
  Client ipv6("udp://[::1]:" + port);
  RecordingDatagrams sink;
  ipv4.Send("four");
  ipv6.Send("six");
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 2; }));
  EXPECT_THAT(sink.bytes(), ElementsAre("four", "six"));
  EXPECT_EQ(Format(sink.all[0].from), Format(ipv4.local()));
  EXPECT_EQ(Format(sink.all[0].to), "127.0.0.1:" + port);
  EXPECT_TRUE(IsIpv4(sink.all[0].from));
  EXPECT_EQ(Format(sink.all[1].from), Format(ipv6.local()));
  EXPECT_EQ(Format(sink.all[1].to), "[::1]:" + port);
}

TEST(UdpDatagrams, MayHaveAnySize) {
  UdpDatagrams source("udp://127.0.0.1:0");
  Client client(source.description());
  RecordingDatagrams sink;
  constexpr std::size_t kLargestOverIpv4 = 65507;
  client.Send("");
  client.Send(std::string(kLargestOverIpv4, 'x'));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 2; }));
  EXPECT_THAT(sink.bytes(), ElementsAre("", std::string(kLargestOverIpv4, 'x')));
}

TEST(UdpDatagrams, AreDeliveredInLimitedBatches) {
  UdpDatagrams source("udp://127.0.0.1:0");
  Client client(source.description());
  RecordingDatagrams sink;
  constexpr std::size_t kMany = 2000;
  for (std::size_t i = 0; i < kMany; ++i) client.Send(std::to_string(i));
  int polls = 0;
  while (source.Poll(nanoseconds(0), sink) == State::kMore) ++polls;
  EXPECT_GE(polls, 1);
  ASSERT_EQ(sink.all.size(), kMany);
  for (std::size_t i = 0; i < kMany; ++i) ASSERT_EQ(sink.all[i].bytes, std::to_string(i));
}

TEST(UdpDatagrams, AreCountedIfTheKernelDropsThem) {
  UdpDatagrams source("udp://127.0.0.1:0");
  Client client(source.description());
  RecordingDatagrams sink;
  const std::string large(60000, 'x');
  const auto to_fill =
      static_cast<std::uint64_t>(source.counters().receive_buffer_bytes) / large.size() + 50;
  std::uint64_t sent = 0;
  for (; sent < to_fill; ++sent) client.Send(large);
  while (source.Poll(nanoseconds(0), sink) == State::kMore) {
  }
  EXPECT_GT(source.counters().kernel_drops, 0U) << "silence follows";
  EXPECT_EQ(sink.all.size() + source.counters().kernel_drops, sent)
      << "each datagram was read or counted as dropped";
}

TEST(UdpDatagrams, KeepTheirReceiveTimeWhenTheReaderIsLate) {
  UdpDatagrams source("udp://127.0.0.1:0");
  Client client(source.description());
  RecordingDatagrams sink;
  client.Send("old");
  const Arrival sent = ReadClocks();
  std::this_thread::sleep_for(milliseconds(300));  // the reader is busy elsewhere
  client.Send("new");
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 2; }));
  // On a busy machine time passes between the readings of the two clocks.
  constexpr std::int64_t kHalfOfThat = 150'000'000;
  EXPECT_LT(sink.all[0].arrival.monotonic_nanos, sent.monotonic_nanos + kHalfOfThat);
  EXPECT_LT(sink.all[0].arrival.wall_nanos, sent.wall_nanos + kHalfOfThat);
  EXPECT_GT(sink.all[1].arrival.monotonic_nanos, sent.monotonic_nanos + kHalfOfThat);
}

TEST(UdpDatagrams, OfStrangersAreCountedIfOnlySomeMachinesMaySend) {
  UdpDatagrams open("udp://127.0.0.1:0?from=192.168.1.7,127.0.0.0/8");
  UdpDatagrams closed("udp://127.0.0.1:0?from=192.168.1.7");
  for (UdpDatagrams* source : {&open, &closed}) {
    Client client(source->description());
    RecordingDatagrams sink;
    client.Send("hello");
    const bool is_open = source == &open;
    ASSERT_TRUE(PollUntil(*source, sink,
                          [&] { return sink.all.size() + source->counters().strangers == 1; }));
    EXPECT_EQ(sink.all.size(), is_open ? 1U : 0U);
  }
}

TEST(UdpSender, ReportsInvalidDestinations) {
  EXPECT_THAT(ErrorOf([] { OpenSender("udp://:9763"); }), HasSubstr("the host is missing"));
  EXPECT_THAT(ErrorOf([] { OpenSender("udp://127.0.0.1:0"); }), HasSubstr("port 0"));
  EXPECT_THAT(ErrorOf([] { OpenSender("out.pcap"); }), HasSubstr("udp://host:port"));
}

TEST(UdpSender, RejectsADatagramThatIsTooLong) {
  const UdpDatagrams source("udp://127.0.0.1:0");
  const auto sender = OpenSender(source.description());
  EXPECT_THAT(ErrorOf([&] { sender->Send(std::string(65508, 'x')); }),
              AllOf(HasSubstr("65508 bytes"), HasSubstr("65507")));
  EXPECT_EQ(sender->datagrams_sent(), 0U);
}

TEST(UdpSender, ContinuesWithoutReceiver) {
  std::string url;
  {
    const UdpDatagrams gone("udp://127.0.0.1:0");
    url = gone.description();
  }
  const auto sender = OpenSender(url);
  EXPECT_EQ(sender->description(), url);
  for (int i = 0; i < 5; ++i) sender->Send("nobody hears this");
  EXPECT_EQ(sender->datagrams_sent() + sender->datagrams_unsent(), 5U);
}

void SendAndReceiveEverySampleOnce(const std::string& listen_url) {
  auto datagrams = OpenDatagrams(listen_url);
  const auto sender = OpenSender(datagrams->description());
  const auto source = OpenStream(std::move(datagrams));
  RecordingSink sink;
  RandomValues random(11);
  Character character;
  character.name = "Ines";
  character.skeleton = urdf::DefaultSkeleton(1.68);
  character.landmarks = urdf::LandmarksOf(*character.skeleton);
  for (const std::string& datagram : EncodeCharacter(character)) sender->Send(datagram);
  constexpr std::uint32_t kSamples = 300;
  std::vector<BodySample> sent;
  for (std::uint32_t counter = 1; counter <= kSamples; ++counter) {
    sent.push_back(RandomSample(random, counter));
    for (const std::string& datagram : EncodeSample(sent.back())) sender->Send(datagram);
    ASSERT_EQ(source->Poll(milliseconds(0), sink), Source::State::kMore);
  }
  EXPECT_EQ(sender->datagrams_unsent(), 0U);
  ASSERT_TRUE(PollUntil(*source, sink, [&] { return sink.samples.size() >= kSamples; }));
  ASSERT_EQ(sink.samples.size(), kSamples);
  for (std::size_t i = 0; i < sent.size(); ++i) {
    ASSERT_EQ(sink.samples[i].counter, sent[i].counter);
    EXPECT_EQ(sink.samples[i].segments[5].position, sent[i].segments[5].position);
    EXPECT_GT(sink.samples[i].stamp_nanos, 1'600'000'000'000'000'000);
    EXPECT_GT(sink.samples[i].arrival_nanos, 0);
  }
  const SourceCounters counters = source->counters();
  EXPECT_EQ(counters.datagrams, sender->datagrams_sent());
  EXPECT_EQ(counters.samples, kSamples);
  EXPECT_EQ(counters.incomplete + counters.duplicates + counters.late + counters.restarts, 0U);
  EXPECT_TRUE(counters.rejected.empty());
  ASSERT_FALSE(sink.characters.empty());
  EXPECT_EQ(sink.characters.back().name, "Ines");
  ASSERT_TRUE(sink.characters.back().skeleton);
  EXPECT_NEAR(sink.characters.back().skeleton->height, 1.68, 1e-5);
}

TEST(UdpStream, DeliversEverySampleOfASenderOnce) {
  SendAndReceiveEverySampleOnce("udp://127.0.0.1:0");
}

TEST(UdpStream, GivesWholeSamplesOfASenderThatPausesWithinThem) {
  auto datagrams = OpenDatagrams("udp://127.0.0.1:0");
  const auto sender = OpenSender(datagrams->description());
  const auto source = OpenStream(std::move(datagrams));
  RecordingSink sink;
  RandomValues random(17);
  for (std::uint32_t counter = 1; counter <= 12; ++counter) {
    int sent = 0;
    for (const std::string& datagram : EncodeSample(RandomSample(random, counter))) {
      sender->Send(datagram);
      ASSERT_EQ(source->Poll(milliseconds(0), sink), Source::State::kMore);
      if (counter != 10 || ++sent != 2) continue;
      for (int i = 0; i < 10; ++i) {  // the pause
        ASSERT_EQ(source->Poll(milliseconds(20), sink), Source::State::kMore);
      }
    }
  }
  ASSERT_TRUE(PollUntil(*source, sink, [&] { return sink.samples.size() >= 12; }));
  EXPECT_EQ(source->counters().incomplete + source->counters().late, 0U);
}

TEST(UdpStream, FlushesTheSampleThatWaits) {
  auto datagrams = OpenDatagrams("udp://127.0.0.1:0");
  const auto sender = OpenSender(datagrams->description());
  const auto source = OpenStream(std::move(datagrams));
  RecordingSink sink;
  RandomValues random(19);
  sender->Send(EncodeSample(RandomSample(random, 1))[0]);
  ASSERT_TRUE(PollUntil(*source, sink, [&] { return source->counters().datagrams == 1; }));
  EXPECT_TRUE(sink.samples.empty());
  source->Flush(sink);
  EXPECT_EQ(sink.samples.size(), 1U);
}

TEST(UdpStream, ReceivesOverIpv6) {
  if (!testing::HasIpv6()) GTEST_SKIP() << "this machine has no IPv6 loopback address";
  SendAndReceiveEverySampleOnce("udp://[::1]:0");
}

TEST(UdpStream, CountsForeignTextAndContinues) {
  auto datagrams = OpenDatagrams("udp://127.0.0.1:0");
  Client client(datagrams->description());
  const auto source = OpenStream(std::move(datagrams));
  RecordingSink sink;
  client.Send(R"({"sync":"start"})");
  client.Send("");
  client.Send(std::string(60000, 'x'));
  RandomValues random(13);
  constexpr std::uint32_t kSamples = 4;
  std::uint64_t good = 0;
  for (std::uint32_t counter = 1; counter <= kSamples; ++counter) {
    for (const std::string& datagram : EncodeSample(RandomSample(random, counter))) {
      client.Send(datagram);
      ++good;
    }
  }
  ASSERT_TRUE(PollUntil(*source, sink, [&] { return sink.samples.size() >= kSamples; }));
  EXPECT_EQ(sink.samples.size(), kSamples);
  EXPECT_EQ(source->counters().rejected.size(), 3U);
  EXPECT_EQ(source->counters().datagrams, 3U + good);
}

}  // namespace
}  // namespace kinescope::mvn
