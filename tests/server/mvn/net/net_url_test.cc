#include "server/mvn/net/net_url.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/mvn/net/allowed_senders.h"
#include "server/mvn/net/socket.h"
#include "tests/server/mvn/net/net_testing.h"

namespace kinescope::mvn {
namespace {

using ::testing::AllOf;
using testing::ErrorOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// "udp 127.0.0.1 9763 listen"
std::string Parts(const char* url) {
  const NetUrl parsed = ParseNetUrl(url);
  return std::string(Scheme(parsed.protocol)) + " " + parsed.host + " " +
         std::to_string(parsed.port) +
         (parsed.mode == NetUrl::Mode::kListen ? " listen" : " connect");
}

TEST(NetUrl, ReadsHostAndPort) {
  EXPECT_EQ(Parts("udp://:9763"), "udp  9763 listen");
  EXPECT_EQ(Parts("udp://127.0.0.1:8001"), "udp 127.0.0.1 8001 listen");
  EXPECT_EQ(Parts("udp://[::1]:8001"), "udp ::1 8001 listen");
  EXPECT_EQ(Parts("udp://[::1]"), "udp ::1 9763 listen");
  EXPECT_EQ(Parts("udp://[fe80::1%lo]:1"), "udp fe80::1%lo 1 listen");
  EXPECT_EQ(Parts("udp://localhost"), "udp localhost 9763 listen");
  EXPECT_EQ(Parts("udp://:0"), "udp  0 listen");
  EXPECT_EQ(Parts("udp://"), "udp  9763 listen");
}

TEST(NetUrl, ListensOverTcpUnlessAHostIsGiven) {
  EXPECT_EQ(Parts("tcp://:9763"), "tcp  9763 listen");
  EXPECT_EQ(Parts("tcp://"), "tcp  9763 listen");
  EXPECT_EQ(Parts("tcp://0.0.0.0:9763"), "tcp 0.0.0.0 9763 listen");
  EXPECT_EQ(Parts("tcp://[::]:9763"), "tcp :: 9763 listen");
  EXPECT_EQ(Parts("tcp://[0:0::0]:9763"), "tcp 0:0::0 9763 listen");
  EXPECT_EQ(Parts("tcp://192.168.1.20:9763"), "tcp 192.168.1.20 9763 connect");
  EXPECT_EQ(Parts("tcp://suit-pc"), "tcp suit-pc 9763 connect");
  EXPECT_EQ(Parts("tcp://[::1]"), "tcp ::1 9763 connect");
}

TEST(NetUrl, AcceptsAnExplicitDirectionOfTheConnection) {
  EXPECT_EQ(Parts("tcp://127.0.0.1:9763?listen"), "tcp 127.0.0.1 9763 listen");
  EXPECT_EQ(Parts("tcp://[::1]?listen"), "tcp ::1 9763 listen");
  EXPECT_EQ(Parts("tcp://:9763?listen"), "tcp  9763 listen");
  EXPECT_EQ(Parts("tcp://suit-pc:9763?connect"), "tcp suit-pc 9763 connect");
}

TEST(NetUrl, ReportsInvalidPartsWithTheExpectedFormat) {
  const auto error_of = [](const char* url) { return ErrorOf([url] { ParseNetUrl(url); }); };
  EXPECT_THAT(error_of("udp://:70000"),
              AllOf(StartsWith("udp://:70000: "), HasSubstr("70000"), HasSubstr("1 to 65535")));
  EXPECT_THAT(error_of("udp://:99999999999999999999"), HasSubstr("out of range"));
  EXPECT_THAT(error_of("tcp://:-1"), HasSubstr("out of range"));
  EXPECT_THAT(error_of("udp://:80a"), HasSubstr("invalid port '80a'"));
  EXPECT_THAT(error_of("udp://:"), HasSubstr("invalid port ''"));
  EXPECT_THAT(error_of("http://:9763"), HasSubstr("udp://host:port or tcp://host:port"));
  EXPECT_THAT(error_of("udp:9763"), HasSubstr("udp://host:port"));
  EXPECT_THAT(error_of("tcp://::1:9763"), HasSubstr("brackets: tcp://[::1]:9763"));
  EXPECT_THAT(error_of("udp://[::1"), HasSubstr("not closed"));
  EXPECT_THAT(error_of("udp://[::1]9763"), HasSubstr("after the bracket"));
  EXPECT_THAT(error_of("udp://a/b:1"), HasSubstr("invalid host name 'a/b'"));
  EXPECT_THAT(error_of("tcp://host:1?speak"), AllOf(HasSubstr("'?speak'"), HasSubstr("?listen")));
  EXPECT_THAT(error_of("tcp://host?"), HasSubstr("'?'"));
  EXPECT_THAT(error_of("udp://:9763?listen"), HasSubstr("UDP has no connections"));
  EXPECT_THAT(error_of("tcp://:9763?connect"), HasSubstr("the host is missing"));
  EXPECT_THAT(error_of("tcp://[::]:9763?connect"), HasSubstr("the host is missing"));
}

TEST(NetUrl, AdmitsOnlyTheMachinesItNames) {
  const Endpoint near = EndpointOf(ResolveToListen(ParseNetUrl("udp://192.168.1.20"), ""));
  const Endpoint far = EndpointOf(ResolveToListen(ParseNetUrl("udp://192.168.2.20"), ""));
  const auto from = [](const char* url) { return ParseNetUrl(url).from; };
  EXPECT_TRUE(MaySend(from("udp://:9763"), far));
  EXPECT_TRUE(MaySend(from("udp://:9763?from=192.168.1.20"), near));
  EXPECT_FALSE(MaySend(from("udp://:9763?from=192.168.1.20"), far));
  EXPECT_FALSE(MaySend(from("tcp://[::]?from=fe80::/10&listen"), far));
}

TEST(NetUrl, ReportsSendersThatAreNoAddresses) {
  for (const char* wrong : {"", "suit-pc", "10.0.0.0/33", "10.0.0.0/", "10.0.0.0/8x", "fe80::/129",
                            "10.0.0.1,", "10.0.0.0/-1"}) {
    const std::string url = std::string("udp://:9763?from=") + wrong;
    EXPECT_THAT(ErrorOf([&] { ParseNetUrl(url); }),
                HasSubstr("is not an address or network; expected such as"))
        << url;
  }
  EXPECT_THAT(ErrorOf([&] { ParseNetUrl("tcp://suit-pc?from=10.0.0.1"); }),
              HasSubstr("connects to one machine"));
}

TEST(NetUrl, DistinguishesNetworkAddressesFromFiles) {
  EXPECT_TRUE(IsNetUrl("udp://:9763"));
  EXPECT_TRUE(IsNetUrl("tcp:9763"));
  EXPECT_FALSE(IsNetUrl("tcp.pcap"));
  EXPECT_FALSE(IsNetUrl("/data/udp:1.pcap"));
}

TEST(Addresses, AreTheSameForSenderAndReceiver) {
  const std::string url = "udp://localhost:9763";
  const NetUrl parsed = ParseNetUrl(url);
  EXPECT_EQ(EndpointOf(ResolveToListen(parsed, url)),
            EndpointOf(ResolveToSend(parsed, url).front()));
  EXPECT_EQ(Format(EndpointOf(ResolveToListen(parsed, url))), "127.0.0.1:9763");
}

TEST(Addresses, AreRejectedIfInvalid) {
  const auto send_error = [](const std::string& url) {
    return ErrorOf([&url] { ResolveToSend(ParseNetUrl(url), url); });
  };
  EXPECT_THAT(send_error("udp://:9763"), HasSubstr("the host is missing"));
  EXPECT_THAT(send_error("udp://127.0.0.1:0"), HasSubstr("port 0"));
  EXPECT_THAT(send_error("tcp://no.such.host.invalid:1"),
              AllOf(HasSubstr("'no.such.host.invalid'"), HasSubstr("check the name")));
  const std::string name = "tcp://suit-pc:9763?listen";
  EXPECT_THAT(
      ErrorOf([&name] { ResolveToListen(ParseNetUrl(name), name); }),
      AllOf(HasSubstr("'suit-pc'"), HasSubstr("numeric address"), HasSubstr("tcp://:9763")));
}

TEST(Addresses, AreWrittenInTheUsualForm) {
  const auto written = [](const std::string& url) {
    const NetUrl parsed = ParseNetUrl(url);
    const SocketAddress address = ResolveToListen(parsed, url);
    return FormatUrl(parsed.protocol, address) + " " + Format(EndpointOf(address));
  };
  EXPECT_EQ(written("udp://192.168.1.20:1"), "udp://192.168.1.20:1 192.168.1.20:1");
  EXPECT_EQ(written("tcp://[fe80:0::01]:9763"), "tcp://[fe80::1]:9763 [fe80::1]:9763");
  EXPECT_EQ(written("udp://"), "udp://0.0.0.0:9763 0.0.0.0:9763");
}

}  // namespace
}  // namespace kinescope::mvn
