#include "server/http/forwarded.h"

#include <gtest/gtest.h>

#include <string>

#include "core/system/ip_networks.h"
#include "tests/server/http/test_server.h"

namespace kinescope::http {
namespace {

using boost::asio::ip::make_address;

const IpNetworks kLab("127.0.0.0/8,10.0.0.0/8");

TEST(Forwarded, IsNotBelievedOfStrangers) {
  EXPECT_EQ(ClientBehind({}, make_address("127.0.0.1"), "192.0.2.1"), "127.0.0.1");
  EXPECT_EQ(ClientBehind(kLab, make_address("192.0.2.7"), "192.0.2.1"), "192.0.2.7");
  EXPECT_FALSE(Believes({}, make_address("127.0.0.1")));
  EXPECT_FALSE(Believes(kLab, make_address("2001:db8::1")));
  EXPECT_TRUE(Believes(kLab, make_address("::ffff:10.1.2.3")));
}

TEST(Forwarded, TheLastAddressThatIsNoProxyIsTheClient) {
  const auto proxy = make_address("127.0.0.1");
  EXPECT_EQ(ClientBehind(kLab, proxy, "192.0.2.1"), "192.0.2.1");
  EXPECT_EQ(ClientBehind(kLab, proxy, "192.0.2.1, 10.0.0.2"), "192.0.2.1");
  EXPECT_EQ(ClientBehind(kLab, proxy, "198.51.100.9, 192.0.2.1 ,10.0.0.2"), "192.0.2.1")
      << "the first was written by the client";
  EXPECT_EQ(ClientBehind(kLab, proxy, "10.0.0.3,10.0.0.2"), "10.0.0.3");
  EXPECT_EQ(ClientBehind(kLab, proxy, "192.0.2.1:4711"), "192.0.2.1");
  EXPECT_EQ(ClientBehind(kLab, proxy, "[2001:db8:1:2:3::4]:4711"), "2001:db8:1:2::/64");
  EXPECT_EQ(ClientBehind(kLab, proxy, "2001:db8:1:2:3::4"), "2001:db8:1:2::/64");
}

TEST(Forwarded, WhatIsNoAddressIsNotFollowed) {
  const auto proxy = make_address("127.0.0.1");
  for (const char* wrong : {"", " ", ",", "unknown", "_hidden", "[", "[]", "192.0.2.1;x", "1.2.3",
                            "\x80\xFF", "192.0.2.1,", "<script>"}) {
    EXPECT_EQ(ClientBehind(kLab, proxy, wrong), "127.0.0.1") << wrong;
  }
  EXPECT_EQ(ClientBehind(kLab, proxy, "192.0.2.1, unknown, 10.0.0.2"), "10.0.0.2");
  EXPECT_EQ(ClientBehind(kLab, proxy, std::string(8000, ',')), "127.0.0.1");
}

TEST(Forwarded, WrongTokensAreCountedByTheClientBehindTheProxy) {
  testing::TestServer site("0perator-of-the-lab", true, "", {},
                           [](HttpConfig& config) { config.trusted_proxies = kLab; });
  const auto guess = [&](const std::string& client, int number) {
    return site
        .Get("/api/v1/state",
             {{"X-Forwarded-For", client},
              {"Authorization", "Bearer wrong-token-of-" + std::to_string(number)}})
        .status;
  };
  for (int number = 0; number < 10; ++number) EXPECT_EQ(guess("192.0.2.1", number), 401);
  EXPECT_EQ(guess("192.0.2.1", 10), 429);
  EXPECT_EQ(guess("198.51.100.9, 192.0.2.1", 11), 429) << "a made-up client before its own address";
  EXPECT_EQ(guess("192.0.2.2", 12), 401);
  const testing::Headers encrypted = {{"X-Forwarded-Proto", "https"}};
  const auto cookie = [&](testing::TestServer& server) {
    return server.Get("/?token=0perator-of-the-lab", encrypted).headers.at("set-cookie");
  };
  EXPECT_NE(cookie(site).find("; Secure"), std::string::npos);
  testing::TestServer alone("0perator-of-the-lab");
  EXPECT_EQ(cookie(alone).find("; Secure"), std::string::npos);
}

}  // namespace
}  // namespace kinescope::http
