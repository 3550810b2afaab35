// The server when memory runs out for a moment: a connection is lost, the page is not.
#include <gtest/gtest.h>

#include <exception>

#include "tests/allocations.h"
#include "tests/server/http/test_server.h"

namespace kinescope::http::testing {
namespace {

TEST(HttpServerWithoutMemory, AcceptsConnectionsAfterAFailedAllocation) {
  const TestServer site;
  ASSERT_EQ(site.Get("/api/v1/state").status, 200);
  // Of what the idle server's threads allocate, only a new connection is so large.
  kinescope::testing::FailNextAllocationElsewhere(512);
  EXPECT_THROW(site.Get("/api/v1/state"), std::exception) << "nothing has failed";
  EXPECT_EQ(site.Get("/api/v1/state").status, 200);
  EXPECT_EQ(site.HttpCounters().at("failures"), 1);
}

}  // namespace
}  // namespace kinescope::http::testing
