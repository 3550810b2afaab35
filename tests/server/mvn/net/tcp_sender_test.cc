// Real connections on the loopback interface; free ports, nothing waits but for the event itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "server/mvn/encode.h"
#include "server/mvn/net/sender.h"
#include "server/mvn/net/tcp_datagrams.h"
#include "server/mvn/open.h"
#include "tests/server/mvn/mvn_testing.h"
#include "tests/server/mvn/net/net_testing.h"

namespace kinescope::mvn {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using testing::Client;
using ::testing::ElementsAre;
using testing::ErrorOf;
using ::testing::HasSubstr;
using testing::kListenOnLoopback;
using testing::Listener;
using testing::PollUntil;
using testing::Pose;
using testing::RandomSample;
using testing::RandomValues;
using testing::RecordingDatagrams;
using testing::RecordingSink;
using State = DatagramSource::State;

TEST(TcpSender, SendsItsFirstDatagramToAWaitingReceiver) {
  TcpDatagrams source(kListenOnLoopback);
  const auto sender = OpenSender(source.description());
  EXPECT_EQ(sender->description(), source.description());
  sender->Send(Pose(1));
  EXPECT_EQ(sender->datagrams_sent(), 1U);
  EXPECT_EQ(sender->datagrams_unsent(), 0U);
  RecordingDatagrams sink;
  ASSERT_TRUE(PollUntil(source, sink, [&] { return sink.all.size() == 1; }));
  EXPECT_EQ(sink.all[0].bytes, Pose(1));
}

TEST(TcpSender, CountsDatagramsWithoutReceiver) {
  std::string url;
  {
    const Listener gone;
    url = gone.url();
  }
  const auto sender = OpenSender(url);
  for (std::uint32_t i = 0; i < 5; ++i) sender->Send(Pose(i));
  EXPECT_EQ(sender->datagrams_sent(), 0U);
  EXPECT_EQ(sender->datagrams_unsent(), 5U);
}

TEST(TcpSender, ConnectsAgainWhenTheReceiverReturns) {
  auto receiver = std::make_unique<TcpDatagrams>(kListenOnLoopback);
  const std::string url = receiver->description();
  const auto sender = OpenSender(url);
  RecordingDatagrams before;
  sender->Send(Pose(1));
  ASSERT_TRUE(PollUntil(*receiver, before, [&] { return before.all.size() == 1; }));
  receiver.reset();
  const auto deadline = testing::TestDeadline();
  while (sender->datagrams_unsent() == 0 && std::chrono::steady_clock::now() < deadline) {
    sender->Send(Pose(2));
  }
  ASSERT_GT(sender->datagrams_unsent(), 0U) << "the loss was not noticed";
  TcpDatagrams again(url + "?listen");
  RecordingDatagrams after;
  std::uint32_t counter = 2;
  ASSERT_TRUE(PollUntil(again, after, [&] {
    sender->Send(Pose(++counter));
    return !after.all.empty();
  }));
  ASSERT_GE(after.all[0].bytes.size(), kHeaderBytes);
  EXPECT_GE(ParseHeader(after.all[0].bytes)->sample_counter, 3U)
      << "what was sent while nobody was there is gone";
}

TEST(TcpSender, SendsToAllConnectedReceivers) {
  const auto sender = OpenSender(kListenOnLoopback);
  sender->Send(Pose(0));
  EXPECT_EQ(sender->datagrams_unsent(), 1U) << "nobody has connected yet";
  TcpDatagrams one(sender->description());
  TcpDatagrams two(sender->description());
  RecordingDatagrams sink_one;
  RecordingDatagrams sink_two;
  ASSERT_TRUE(PollUntil(one, sink_one, [&] { return one.counters().connections == 1; }));
  ASSERT_TRUE(PollUntil(two, sink_two, [&] { return two.counters().connections == 1; }));
  sender->Send(Pose(1));
  sender->Send(Pose(2));
  EXPECT_EQ(sender->datagrams_sent(), 2U);
  ASSERT_TRUE(PollUntil(one, sink_one, [&] { return sink_one.all.size() == 2; }));
  ASSERT_TRUE(PollUntil(two, sink_two, [&] { return sink_two.all.size() == 2; }));
  EXPECT_THAT(sink_one.bytes(), ElementsAre(Pose(1), Pose(2)));
  EXPECT_THAT(sink_two.bytes(), ElementsAre(Pose(1), Pose(2)));
}

TEST(TcpSender, DropsOnlyCompleteDatagramsForASlowReceiver) {
  TcpDatagrams source(kListenOnLoopback);
  auto sender = OpenSender(source.description());
  std::uint32_t sent = 0;
  const auto deadline = testing::TestDeadline();
  while (sender->datagrams_unsent() < 1000 && std::chrono::steady_clock::now() < deadline) {
    sender->Send(Pose(sent++));
  }
  ASSERT_EQ(sender->datagrams_unsent(), 1000U) << "nobody reads, and yet all is sent";
  const std::uint64_t taken = sender->datagrams_sent();
  EXPECT_EQ(taken + 1000, sent);
  RecordingDatagrams sink;
  ASSERT_TRUE(PollUntil(source, sink, [&] {
    sender->Send(Pose(sent++));
    return sender->datagrams_sent() > taken + 100;  // it goes on as soon as there is room
  }));
  const std::uint64_t expected = sender->datagrams_sent();
  ASSERT_TRUE(PollUntil(source, sink, [&] {
    if (sink.all.size() + 2000 < expected) return false;
    sender.reset();  // waits for what is queued
    return true;
  }));
  ASSERT_TRUE(PollUntil(source, sink, [&] { return source.counters().connections_lost == 1; }));
  EXPECT_EQ(sink.all.size(), expected);
  EXPECT_EQ(source.counters().resyncs, 0U) << "parts of datagrams were lost";
  for (const auto& received : sink.all) ASSERT_EQ(received.bytes.size(), Pose(0).size());
}

TEST(TcpSender, IsNotDelayedByASlowReceiver) {
  const auto sender = OpenSender(kListenOnLoopback);
  Client slow(sender->description());
  TcpDatagrams fast(sender->description());
  RecordingDatagrams sink;
  ASSERT_TRUE(PollUntil(fast, sink, [&] { return fast.counters().connections == 1; }));
  std::uint32_t sent = 0;
  ASSERT_TRUE(PollUntil(fast, sink, [&] {
    for (int i = 0; i < 100; ++i) sender->Send(Pose(sent++));
    while (fast.Poll(nanoseconds(0), sink) == State::kMore) {
    }
    return sender->datagrams_unsent() >= 1000;
  }));
  ASSERT_TRUE(PollUntil(fast, sink, [&] { return sink.all.size() >= sent; }));
  EXPECT_EQ(sink.all.size(), sent);
  EXPECT_EQ(fast.counters().resyncs, 0U);
}

TEST(TcpSender, RejectsMessagesThatExceedTheLongestDatagram) {
  const auto sender = OpenSender(kListenOnLoopback);
  EXPECT_THAT(ErrorOf([&] { sender->Send(std::string(70000, 'x')); }), HasSubstr("70000 bytes"));
}

TEST(TcpSender, ReportsInvalidDestinations) {
  EXPECT_THAT(ErrorOf([] { OpenSender("tcp://127.0.0.1:0"); }), HasSubstr("port 0"));
  EXPECT_THAT(ErrorOf([] { OpenSender("tcp://no.such.host.invalid:1"); }),
              HasSubstr("check the name"));
  const Listener listener;
  EXPECT_THAT(ErrorOf([&] { OpenSender(listener.url() + "?listen"); }),
              HasSubstr("is already in use"));
}

TEST(TcpStream, DeliversEverySampleOfASenderOnce) {
  auto datagrams = OpenDatagrams(kListenOnLoopback);
  const auto sender = OpenSender(datagrams->description());
  const auto source = OpenStream(std::move(datagrams));
  RecordingSink sink;
  RandomValues random(12);
  constexpr std::uint32_t kSamples = 300;
  std::vector<BodySample> sent;
  for (std::uint32_t counter = 1; counter <= kSamples; ++counter) {
    sent.push_back(RandomSample(random, counter));
    for (const std::string& datagram : EncodeSample(sent.back())) sender->Send(datagram);
    ASSERT_EQ(source->Poll(milliseconds(0), sink), Source::State::kMore);
  }
  ASSERT_TRUE(PollUntil(*source, sink, [&] { return sink.samples.size() >= kSamples; }));
  ASSERT_EQ(sink.samples.size(), kSamples);
  for (std::size_t i = 0; i < sent.size(); ++i) {
    ASSERT_EQ(sink.samples[i].counter, sent[i].counter);
    EXPECT_EQ(sink.samples[i].segments[5].position, sent[i].segments[5].position);
  }
  EXPECT_TRUE(source->counters().rejected.empty());
  EXPECT_EQ(source->counters().datagrams, sender->datagrams_sent());
}

}  // namespace
}  // namespace kinescope::mvn
