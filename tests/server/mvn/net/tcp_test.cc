// Real connections on the loopback interface; free ports, nothing waits but for the event itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <map>
#include <memory>
#include <thread>

#include "server/mvn/net/tcp_datagrams.h"
#include "tests/sanitized.h"
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
using ::testing::IsEmpty;
using testing::kListenOnLoopback;
using testing::Listener;
using testing::PollUntil;
using testing::Pose;
using testing::RecordingDatagrams;
using State = DatagramSource::State;

TEST(TcpDatagrams, ReportAPortInUseWithARemedy) {
  const TcpDatagrams first(kListenOnLoopback);
  const std::string port = std::to_string(first.port());
  EXPECT_EQ(first.description(), "tcp://127.0.0.1:" + port);
  EXPECT_THAT(ErrorOf([&first] { TcpDatagrams second(first.description() + "?listen"); }),
              AllOf(HasSubstr("port " + port + " is already in use"), HasSubstr("ss -tlpn"),
                    HasSubstr("choose another port")));
  EXPECT_THAT(ErrorOf([] { OpenTcpDatagrams("tcp://203.0.113.1:0?listen"); }),
              AllOf(HasSubstr("not an address of this machine"), HasSubstr("tcp://:0")));
}

TEST(TcpDatagrams, ListenAgainAtOnceDespiteALingeringConnection) {
  auto first = std::make_unique<TcpDatagrams>(kListenOnLoopback);
  const std::string url = first->description() + "?listen";
  Client client(first->description());
  RecordingDatagrams sink;
  ASSERT_TRUE(PollUntil(*first, sink, [&] { return first->counters().connections_open == 1; }));
  first.reset();  // the side that closes first is the one whose address lingers
  EXPECT_EQ(ErrorOf([&url] { TcpDatagrams second(url); }), "");
}

TEST(TcpDatagrams, ReturnWithoutData) {
  TcpDatagrams source("tcp://:0");
  EXPECT_EQ(source.description(), "tcp://0.0.0.0:" + std::to_string(source.port()));
  EXPECT_TRUE(source.is_live());
  RecordingDatagrams sink;
  for (const int wait : {0, -5, 1}) EXPECT_EQ(source.Poll(nanoseconds(wait), sink), State::kIdle);
  EXPECT_THAT(sink.all, IsEmpty());
  EXPECT_EQ(source.counters().connections, 0U);
}

TEST(TcpDatagrams, HaveBothAddressesAndTheReceiveTime) {
  TcpDatagrams source("tcp://:0");
  Client client("tcp://127.0.0.3:" + std::to_string(source.port()));
  RecordingDatagrams sink;
  const Arrival before = ReadClocks();
  client.Send(Pose(1) + Pose(2));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 2; }));
  EXPECT_THAT(sink.bytes(), ElementsAre(Pose(1), Pose(2)));
  for (const auto& received : sink.all) {
    EXPECT_EQ(Format(received.from), Format(client.local()));
    EXPECT_EQ(Format(received.to), Format(client.peer()));
    EXPECT_GE(received.arrival.wall_nanos, before.wall_nanos);
    EXPECT_LE(received.arrival.wall_nanos, ReadClocks().wall_nanos);
    EXPECT_GE(received.arrival.monotonic_nanos, before.monotonic_nanos);
    EXPECT_LE(received.arrival.monotonic_nanos, ReadClocks().monotonic_nanos);
  }
  EXPECT_GT(source.counters().receive_buffer_bytes, 0);
}

TEST(TcpDatagrams, ArriveOverIpv4AndIpv6) {
  if (!testing::HasIpv6()) GTEST_SKIP() << "this machine has no IPv6 loopback address";
  TcpDatagrams source("tcp://[::]:0");
  const std::string port = std::to_string(source.port());
  Client ipv4("tcp://127.0.0.1:" + port);
  Client ipv6("tcp://[::1]:" + port);
  RecordingDatagrams sink;
  ipv4.Send(Pose(4));
  ipv6.Send(Pose(6));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 2; }));
  std::map<std::string, std::string> by_sender;
  for (const auto& received : sink.all) by_sender[Format(received.from)] = received.bytes;
  EXPECT_EQ(by_sender[Format(ipv4.local())], Pose(4));
  EXPECT_EQ(by_sender[Format(ipv6.local())], Pose(6));
}

TEST(TcpDatagrams, OfSeveralConnectionsAreSeparate) {
  TcpDatagrams source(kListenOnLoopback);
  Client one(source.description());
  Client two(source.description());
  RecordingDatagrams sink;
  const std::string first = Pose(1);
  const std::string second = Pose(2);
  std::vector<std::string> from_one;
  std::vector<std::string> from_two;
  // Half of each in turn: mixed up, neither would be a datagram.
  one.Send(first.substr(0, 300));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().connections == 2; }));
  two.Send(second.substr(0, 500));
  one.Send(first.substr(300));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 1; }));
  EXPECT_EQ(sink.all[0].bytes, first);
  EXPECT_EQ(Format(sink.all[0].from), Format(one.local()));
  two.Send(second.substr(500));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 2; }));
  EXPECT_EQ(sink.all[1].bytes, second);
  EXPECT_EQ(Format(sink.all[1].from), Format(two.local()));
  EXPECT_EQ(source.counters().connections_open, 2);
}

TEST(TcpDatagrams, OfALostSenderAreDeliveredAsFarAsReceived) {
  TcpDatagrams source(kListenOnLoopback);
  RecordingDatagrams sink;
  Client dies(source.description());
  dies.Send(Pose(1) + Pose(2).substr(0, 100));
  dies.Close();
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().connections_lost == 1; }));
  EXPECT_THAT(sink.bytes(), ElementsAre(Pose(1), Pose(2).substr(0, 100)));
  EXPECT_EQ(source.counters().connections_open, 0);
  Client comes_again(source.description());
  comes_again.Send(Pose(3));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 3; }));
  EXPECT_EQ(sink.all[2].bytes, Pose(3)) << "the rest of another connection is no part of this one";
  EXPECT_EQ(source.counters().connections, 2U);
}

TEST(TcpDatagrams, CountALostConnectionAfterAReset) {
  TcpDatagrams source(kListenOnLoopback);
  RecordingDatagrams sink;
  Client dies(source.description());
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().connections_open == 1; }));
  const linger at_once{1, 0};
  setsockopt(dies.socket().get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  dies.Close();
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().connections_open == 0; }));
  EXPECT_EQ(source.counters().connections_lost, 1U);
}

TEST(TcpDatagrams, AreFoundBetweenForeignText) {
  TcpDatagrams source(kListenOnLoopback);
  RecordingDatagrams sink;
  Client client(source.description());
  client.Send(R"({"sync":"start"})" + Pose(1) + std::string(3, '\0') + Pose(2));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 3; }));
  EXPECT_THAT(sink.bytes(), ElementsAre(R"({"sync":"start"})", Pose(1), Pose(2)));
  EXPECT_EQ(source.counters().resyncs, 2U);
  EXPECT_EQ(source.counters().skipped_bytes, 3U);
  client.Close();
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().connections_open == 0; }));
  EXPECT_EQ(source.counters().resyncs, 2U) << "counters outlive their connection";
}

TEST(TcpDatagrams, RejectConnectionsBeyondTheirLimit) {
  constexpr std::int64_t kLong = 1'000'000'000'000;  // this machine may be slow
  TcpDatagrams source(kListenOnLoopback, {kLong, kLong, kLong});
  RecordingDatagrams sink;
  std::vector<std::unique_ptr<Client>> clients;
  const auto connect = [&](std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      clients.push_back(std::make_unique<Client>(source.description()));
      clients.back()->Send(Pose(1));
    }
  };
  connect(TcpDatagrams::kMaxConnections);
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 16; }));
  connect(2);
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().connections_refused == 2; }));
  EXPECT_EQ(source.counters().connections_open, static_cast<int>(TcpDatagrams::kMaxConnections));
  char byte = 0;
  EXPECT_LE(recv(clients.back()->socket().get(), &byte, 1, 0), 0) << "the newcomer is told at once";
  clients.front()->Send(Pose(2));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 17; }));
  clients.front()->Close();
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().connections_lost == 1; }));
  Client takes_the_place(source.description());
  takes_the_place.Send(Pose(2));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 18; }));
}

TEST(TcpDatagrams, EndConnectionsThatSendNothing) {
  TcpDatagrams::Patience patience;
  patience.first_datagram = 50'000'000;
  TcpDatagrams source(kListenOnLoopback, patience);
  RecordingDatagrams sink;
  Client silent(source.description()), drips(source.description()), suit(source.description());
  drips.Send("M");
  suit.Send(Pose(1));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().connections_ended == 2; }));
  EXPECT_EQ(source.counters().connections_open, 1);
  suit.Send(Pose(2));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 2; }));
  EXPECT_EQ(source.counters().connections_lost, 0U) << "they did not leave by themselves";
}

TEST(TcpDatagrams, GiveASuitThePlaceOfWhoeverSendsNoBody) {
  TcpDatagrams source(kListenOnLoopback);
  RecordingDatagrams sink;
  Client first_suit(source.description());
  first_suit.Send(Pose(1));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 1; }));
  std::vector<std::unique_ptr<Client>> idle;
  for (std::size_t i = 1; i < TcpDatagrams::kMaxConnections; ++i) {
    idle.push_back(std::make_unique<Client>(source.description()));
  }
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().connections == 16; }));
  Client suit(source.description());
  suit.Send(Pose(2));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 2; }));
  EXPECT_EQ(source.counters().connections_ended, 1U);
  EXPECT_EQ(source.counters().connections_refused, 0U);
  first_suit.Send(Pose(3));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 3; }));
}

TEST(TcpDatagrams, KeepTheirReceiveTimeWhenTheReaderIsLate) {
  TcpDatagrams source(kListenOnLoopback);
  RecordingDatagrams sink;
  Client client(source.description());
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().connections == 1; }));
  client.Send(Pose(1));
  const Arrival sent = ReadClocks();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the reader is busy elsewhere
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 1; }));
  // On a busy machine time passes between the readings of the two clocks.
  constexpr std::int64_t kHalfOfThat = 150'000'000;
  EXPECT_LT(sink.all[0].arrival.monotonic_nanos, sent.monotonic_nanos + kHalfOfThat);
}

TEST(TcpDatagrams, OfStrangersAreNotReadIfOnlySomeMachinesMaySend) {
  TcpDatagrams source("tcp://127.0.0.1:0?listen&from=10.0.0.0/8");
  RecordingDatagrams sink;
  Client stranger(source.description());
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().strangers == 1; }));
  EXPECT_EQ(source.counters().connections, 0U);
}

TEST(TcpDatagrams, OfAFastSenderAreReadInLimitedBatches) {
  TcpDatagrams source(kListenOnLoopback);
  Client client(source.description());
  RecordingDatagrams sink;
  std::string many;
  constexpr std::uint32_t kMany = 300;
  for (std::uint32_t i = 0; i < kMany; ++i) many += Pose(i);
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().connections_open == 1; }));
  client.Send(many);
  std::size_t before = 0;
  bool had_more = false;
  ASSERT_TRUE(PollUntil(source, sink, [&] {
    EXPECT_LE(sink.all.size() - before, 65536 / Pose(0).size() + 1) << "in one call";
    before = sink.all.size();
    had_more |= source.Poll(nanoseconds(0), sink) == State::kMore;
    EXPECT_LE(sink.all.size() - before, 65536 / Pose(0).size() + 1) << "in one call";
    before = sink.all.size();
    return sink.all.size() >= kMany;
  }));
  EXPECT_TRUE(had_more);
  for (std::uint32_t i = 0; i < kMany; ++i) ASSERT_EQ(sink.all[i].bytes, Pose(i));
}

TEST(TcpDatagrams, WaitWithoutBusyLoopIfNoDescriptorIsFree) {
  if (kinescope::testing::kIsSanitized) {
    GTEST_SKIP() << "the sanitizer needs descriptors of its own to look at memory";
  }
  TcpDatagrams source(kListenOnLoopback);
  Client client(source.description());
  RecordingDatagrams sink;
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit none_left{3, before.rlim_max};  // what is open stays open
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none_left), 0);
  // Wakes for the newcomer, who cannot be let in.
  EXPECT_EQ(source.Poll(std::chrono::seconds(20), sink), State::kIdle);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(source.Poll(milliseconds(100), sink), State::kIdle);
  const auto waited = std::chrono::steady_clock::now() - start;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_GE(waited, milliseconds(100)) << "the newcomer wakes us again and again";
  EXPECT_EQ(source.counters().connections, 0U);
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().connections == 1; }));
}

// The receiver connects; a plain listening socket plays the sender.
void SendTo(const Socket& socket, const std::string& bytes) {
  ASSERT_EQ(send(socket.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(bytes.size()));
}

TEST(TcpDatagrams, AreReceivedFromAListeningSender) {
  const Listener listener;
  TcpDatagrams source(listener.url());
  EXPECT_EQ(source.description(), listener.url());
  RecordingDatagrams sink;
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().connections_open == 1; }));
  const Socket connection = listener.Accept();
  SendTo(connection, Pose(1));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 1; }));
  EXPECT_EQ(sink.all[0].bytes, Pose(1));
  EXPECT_EQ("tcp://" + Format(sink.all[0].from), listener.url());
}

TEST(TcpDatagrams, ConnectAgainWhenTheConnectionIsLost) {
  const Listener listener;
  TcpDatagrams source(listener.url());
  RecordingDatagrams sink;
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().connections == 1; }));
  Socket connection = listener.Accept();
  SendTo(connection, Pose(1));
  connection = Socket();
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().connections == 2; }));
  EXPECT_EQ(source.counters().connections_lost, 1U);
  SendTo(listener.Accept(), Pose(2));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 2; }));
  EXPECT_THAT(sink.bytes(), ElementsAre(Pose(1), Pose(2)));
}

TEST(TcpDatagrams, WaitForASenderThatStartsLater) {
  std::string url;
  {
    const Listener gone;
    url = gone.url();
  }
  TcpDatagrams source(url);
  RecordingDatagrams sink;
  EXPECT_EQ(source.Poll(milliseconds(0), sink), State::kIdle);
  EXPECT_EQ(source.counters().connections, 0U);
  const Listener comes(url + "?listen");
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().connections == 1; }));
  SendTo(comes.Accept(), Pose(1));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 1; }));
}

TEST(TcpDatagrams, RejectAnUnknownHost) {
  EXPECT_THAT(ErrorOf([] { OpenTcpDatagrams("tcp://no.such.host.invalid:9763"); }),
              AllOf(HasSubstr("no.such.host.invalid"), HasSubstr("check the name")));
}

}  // namespace
}  // namespace kinescope::mvn
