// Real sockets on the loopback interface; free ports, nothing waits for a clock.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include "server/core/errors.h"
#include "server/mvn/encode.h"
#include "server/mvn/open.h"
#include "server/mvn/sender.h"
#include "server/mvn/udp_source.h"
#include "tests/server/mvn/mvn_testing.h"

namespace kinescope::mvn {
namespace {

using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::RandomSample;
using testing::RandomValues;
using testing::RecordingSink;
using ::testing::StartsWith;

template <class Action>
std::string ErrorOf(const Action& action) {
  try {
    action();
  } catch (const SourceError& error) {
    return error.what();
  }
  return "";
}

TEST(UdpUrl, ReadsHostAndPort) {
  const auto host_and_port = [](const char* url) {
    const UdpUrl parsed = ParseUdpUrl(url);
    return parsed.host + "|" + std::to_string(parsed.port);
  };
  EXPECT_EQ(host_and_port("udp://:9763"), "|9763");
  EXPECT_EQ(host_and_port("udp://127.0.0.1:8001"), "127.0.0.1|8001");
  EXPECT_EQ(host_and_port("udp://[::1]:9763"), "::1|9763");
  EXPECT_EQ(host_and_port("udp://[::1]"), "::1|9763");
  EXPECT_EQ(host_and_port("udp://localhost"), "localhost|9763");
  EXPECT_EQ(host_and_port("udp://:0"), "|0");
  EXPECT_EQ(host_and_port("udp://"), "|9763");
}

TEST(UdpUrl, SaysWhatIsWrongAndWhatWouldBeRight) {
  const auto error_of = [](const char* url) { return ErrorOf([url] { ParseUdpUrl(url); }); };
  EXPECT_THAT(error_of("udp://:70000"),
              AllOf(StartsWith("udp://:70000: "), HasSubstr("70000"), HasSubstr("1 to 65535")));
  EXPECT_THAT(error_of("udp://:99999999999999999999"), HasSubstr("out of range"));
  EXPECT_THAT(error_of("udp://:-1"), HasSubstr("out of range"));
  EXPECT_THAT(error_of("udp://:80a"), HasSubstr("'80a' is no port"));
  EXPECT_THAT(error_of("udp://:"), HasSubstr("'' is no port"));
  EXPECT_THAT(error_of("tcp://:9763"), HasSubstr("udp://host:port"));
  EXPECT_THAT(error_of("udp://::1:9763"), HasSubstr("brackets"));
  EXPECT_THAT(error_of("udp://[::1"), HasSubstr("not closed"));
  EXPECT_THAT(error_of("udp://[::1]9763"), HasSubstr("after the bracket"));
  EXPECT_THAT(error_of("udp://a/b:1"), HasSubstr("no host"));
}

TEST(UdpSource, SaysWhoCouldHoldATakenPort) {
  const UdpSource first("udp://127.0.0.1:0");
  const std::string port = std::to_string(first.port());
  EXPECT_EQ(first.description(), "udp://127.0.0.1:" + port);
  EXPECT_THAT(ErrorOf([&first] { UdpSource second(first.description()); }),
              AllOf(HasSubstr("port " + port + " is taken"), HasSubstr("ss -ulpn"),
                    HasSubstr("choose another port")));
}

TEST(UdpSource, NamesAnAddressItCannotListenOn) {
  EXPECT_THAT(ErrorOf([] { OpenUdp("udp://192.0.2.1:0"); }),
              AllOf(HasSubstr("192.0.2.1"), HasSubstr("not an address of this machine")));
  EXPECT_THAT(ErrorOf([] { OpenUdp("udp://no.such.host:0"); }),
              AllOf(HasSubstr("'no.such.host'"), HasSubstr("in numbers")));
  EXPECT_THAT(ErrorOf([] { OpenUdpSender("udp://:9763"); }), HasSubstr("no host to send to"));
  EXPECT_THAT(ErrorOf([] { OpenUdpSender("udp://127.0.0.1:0"); }), HasSubstr("port 0"));
}

TEST(UdpSource, ListensEverywhereWithALargeBuffer) {
  const UdpSource source("udp://:0");
  EXPECT_EQ(source.description(), "udp://0.0.0.0:" + std::to_string(source.port()));
  EXPECT_TRUE(source.is_live());
  EXPECT_EQ(source.nominal_rate_hz(), 0);
  EXPECT_GE(source.receive_buffer_bytes(), 128 * 1024);
}

TEST(UdpSource, ReturnsWhenNothingComes) {
  UdpSource source("udp://127.0.0.1:0");
  RecordingSink sink;
  EXPECT_EQ(source.Poll(milliseconds(0), sink), Source::State::kMore);
  EXPECT_EQ(source.Poll(milliseconds(-5), sink), Source::State::kMore);
  EXPECT_TRUE(sink.samples.empty());
}

void SendAndReceiveEverySampleOnce(const std::string& listen_url) {
  UdpSource source(listen_url);
  const auto sender = OpenUdpSender(source.description());
  RecordingSink sink;
  RandomValues random(11);
  Character character;
  character.name = "Ines";
  character.skeleton = urdf::DefaultSkeleton(1.68);
  sender->SendCharacter(character);
  constexpr std::uint32_t kSamples = 300;
  std::vector<BodySample> sent;
  for (std::uint32_t counter = 1; counter <= kSamples; ++counter) {
    sent.push_back(RandomSample(random, counter));
    sender->SendSample(sent.back());
    source.Poll(milliseconds(0), sink);
  }
  EXPECT_EQ(sender->datagrams_sent(), 3 + 5 * kSamples);
  // Whatever is on its way arrives now; a bound, so that a loss fails the test and does not hang
  // it.
  for (int i = 0; i < 100 && sink.samples.size() < kSamples; ++i) {
    source.Poll(milliseconds(50), sink);
  }
  ASSERT_EQ(sink.samples.size(), kSamples);
  for (std::size_t i = 0; i < sent.size(); ++i) {
    ASSERT_EQ(sink.samples[i].counter, sent[i].counter);
    EXPECT_EQ(sink.samples[i].segments[5].position, sent[i].segments[5].position);
    EXPECT_GT(sink.samples[i].stamp_nanos, 1'600'000'000'000'000'000);
    EXPECT_GT(sink.samples[i].arrival_nanos, 0);
  }
  const SourceCounters counters = source.counters();
  EXPECT_EQ(counters.datagrams, 3 + 5 * kSamples);
  EXPECT_EQ(counters.samples, kSamples);
  EXPECT_EQ(counters.incomplete + counters.duplicates + counters.late + counters.restarts, 0U);
  EXPECT_TRUE(counters.rejected.empty());
  ASSERT_FALSE(sink.characters.empty());
  EXPECT_EQ(sink.characters.back().name, "Ines");
  ASSERT_TRUE(sink.characters.back().skeleton);
  EXPECT_NEAR(sink.characters.back().skeleton->height, 1.68, 1e-5);
}

TEST(UdpSource, HandsOnEverySampleOfASenderOnce) {
  SendAndReceiveEverySampleOnce("udp://127.0.0.1:0");
}

TEST(UdpSource, SpeaksIpv6) {
  const int probe = ::socket(AF_INET6, SOCK_DGRAM, 0);
  const Socket owner(probe);
  sockaddr_in6 loopback{};
  loopback.sin6_family = AF_INET6;
  loopback.sin6_addr = in6addr_loopback;
  if (bind(probe, reinterpret_cast<sockaddr*>(&loopback), sizeof loopback) != 0) {
    GTEST_SKIP() << "this machine has no IPv6 loopback address";
  }
  SendAndReceiveEverySampleOnce("udp://[::1]:0");
}

class RawSender {
 public:
  explicit RawSender(const UdpSource& source)
      : to_(ResolveToSend(ParseUdpUrl(source.description()), source.description())) {}
  void Send(const std::string& bytes) {
    ASSERT_EQ(sendto(socket_.get(), bytes.data(), bytes.size(), 0, to_.get(), to_.size),
              static_cast<ssize_t>(bytes.size()));
  }

 private:
  SocketAddress to_;
  Socket socket_{::socket(AF_INET, SOCK_DGRAM, 0)};
};

TEST(UdpSource, CountsForeignTextAndGoesOn) {
  UdpSource source("udp://127.0.0.1:0");
  RawSender sender(source);
  RecordingSink sink;
  sender.Send(R"({"sync":"start"})");
  sender.Send("");
  sender.Send(std::string(60000, 'x'));
  for (const auto& datagram : EncodeSample(BodySample())) sender.Send(datagram);
  for (int i = 0; i < 100 && sink.samples.empty(); ++i) source.Poll(milliseconds(50), sink);
  EXPECT_EQ(sink.samples.size(), 1U);
  EXPECT_EQ(source.counters().rejected.size(), 3U);
  EXPECT_EQ(source.counters().datagrams, 4U);
}

TEST(UdpSource, CountsWhatTheKernelDropped) {
  UdpSource source("udp://127.0.0.1:0");
  RawSender sender(source);
  RecordingSink sink;
  const std::string large(60000, 'x');
  std::uint64_t sent = 0;
  for (; sent < static_cast<std::uint64_t>(source.receive_buffer_bytes()) / 60000 + 50; ++sent) {
    sender.Send(large);
  }
  const auto seen = [&source] { return source.counters().datagrams + source.kernel_drops(); };
  // The kernel tells its count with the next datagram that it keeps.
  for (int i = 0; i < 100 && seen() != sent; ++i) {
    source.Poll(milliseconds(50), sink);
    sender.Send("x");
    ++sent;
    source.Poll(milliseconds(50), sink);
  }
  EXPECT_GT(source.kernel_drops(), 0U);
  EXPECT_EQ(seen(), sent) << "each datagram was read or counted as dropped";
  EXPECT_EQ(source.counters().rejected.at("dropped by the kernel (receive buffer full)"),
            source.kernel_drops());
}

}  // namespace
}  // namespace kinescope::mvn
