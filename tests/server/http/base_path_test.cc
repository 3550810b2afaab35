#include "server/http/base_path.h"

#include <gtest/gtest.h>

#include "core/system/errors.h"
#include "tests/server/http/test_server.h"

namespace kinescope::http {
namespace {

TEST(BasePath, IsOfPlainSegments) {
  EXPECT_EQ(CheckedBasePath(""), "");
  EXPECT_EQ(CheckedBasePath("/"), "");
  EXPECT_EQ(CheckedBasePath("/lab3"), "/lab3");
  EXPECT_EQ(CheckedBasePath("/tools/kine-scope_1.0~x/"), "/tools/kine-scope_1.0~x");
  for (const char* wrong : {"lab3", "//", "/a//b", "/..", "/a/../b", "/a/.", "/a b", "/a?b", "/%41",
                            "/a;b", "/\"", "/a\r\nX: y", "/\xC3\xA9"}) {
    EXPECT_THROW((void)CheckedBasePath(wrong), UsageError) << wrong;
  }
  EXPECT_THROW((void)CheckedBasePath("/" + std::string(kMaxBasePathBytes, 'a')), UsageError);
}

TEST(BasePath, IsTakenOffTargets) {
  EXPECT_EQ(WithoutBasePath("/lab3/app.js?x=1", "/lab3"), "/app.js?x=1");
  EXPECT_EQ(WithoutBasePath("/lab3/", "/lab3"), "/");
  EXPECT_EQ(WithoutBasePath("/app.js", "/lab3"), "/app.js") << "the proxy took it off";
  EXPECT_EQ(WithoutBasePath("/lab33/app.js", "/lab3"), "/lab33/app.js");
  EXPECT_EQ(WithoutBasePath("/lab3", "/lab3"), std::nullopt);
  EXPECT_EQ(WithoutBasePath("/lab3?token=x", "/lab3"), std::nullopt);
  EXPECT_EQ(WithoutBasePath("/lab3/../secret", "/lab3"), "/../secret") << "rejected by ParseTarget";
  EXPECT_EQ(WithoutBasePath("/lab3", ""), "/lab3");
}

TEST(BasePath, HasThePageTheApiAndItsCookie) {
  testing::TestServer site("0perator-of-the-lab", true, "", {},
                           [](HttpConfig& config) { config.base_path = "/lab3/"; });
  EXPECT_NE(site.server.url().find("/lab3/?token="), std::string::npos) << site.server.url();
  const testing::Response page = site.Get("/lab3/?token=0perator-of-the-lab");
  EXPECT_EQ(page.status, 200);
  EXPECT_NE(page.headers.at("set-cookie").find("; Path=/lab3/;"), std::string::npos)
      << page.headers.at("set-cookie");
  const testing::Response bare = site.Get("/lab3?token=0perator-of-the-lab&view=wall");
  EXPECT_EQ(bare.status, 308);
  EXPECT_EQ(bare.headers.at("location"), "/lab3/?token=0perator-of-the-lab&view=wall");
  const testing::Headers bearer = {{"Authorization", "Bearer 0perator-of-the-lab"}};
  EXPECT_EQ(site.Get("/lab3/api/v1/session", bearer).status, 200);
  EXPECT_EQ(site.Get("/api/v1/session", bearer).status, 200) << "of a proxy that takes it off";
  EXPECT_EQ(site.Get("/lab3/lab3/api/v1/session", bearer).status, 404);
  EXPECT_EQ(site.Get("/lab3/..%2fapi/v1/session", bearer).status, 400);
  site.PublishState(1);
  testing::WsClient socket(site.server.port(), "/lab3/api/v1/ws", bearer);
  EXPECT_EQ(socket.ReceiveState().state_number(), 1u);
}

}  // namespace
}  // namespace kinescope::http
