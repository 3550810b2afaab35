#include "core/system/ip_networks.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>

#include <string>

namespace kinescope {
namespace {

IpAddress At(const std::string& text) {
  IpAddress address{};
  EXPECT_EQ(inet_pton(AF_INET6, text.c_str(), address.data()), 1) << text;
  return address;
}

TEST(IpNetworks, HasWhatItNames) {
  const IpAddress near = At("::ffff:192.168.1.20"), far = At("::ffff:192.168.2.20");
  const IpAddress local = At("fe80::17"), global = At("2001:db8::17");
  EXPECT_TRUE(IpNetworks().empty());
  EXPECT_FALSE(IpNetworks().Has(near));
  EXPECT_TRUE(IpNetworks("192.168.1.20").Has(near));
  EXPECT_FALSE(IpNetworks("192.168.1.20").Has(far));
  EXPECT_TRUE(IpNetworks("10.0.0.0/8,192.168.0.0/22").Has(far));
  EXPECT_FALSE(IpNetworks("10.0.0.0/8,192.168.0.0/23").Has(far));
  EXPECT_TRUE(IpNetworks("0.0.0.0/0").Has(far));
  EXPECT_FALSE(IpNetworks("0.0.0.0/0").Has(global)) << "every IPv4 address";
  EXPECT_TRUE(IpNetworks("::/0").Has(far));
  EXPECT_TRUE(IpNetworks("fe80::/10").Has(local));
  EXPECT_FALSE(IpNetworks("fe80::/10").Has(global));
}

}  // namespace
}  // namespace kinescope
