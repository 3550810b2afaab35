// The meshes of published URDFs, as RViz on another computer reads them.
#include "server/http/mesh_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "tests/mesh_file_on_demand.h"
#include "tests/server/http/test_client.h"

namespace kinescope::http::testing {
namespace {

using kinescope::testing::MeshFileOnDemand;
using ::testing::HasSubstr;

std::shared_ptr<const MeshFiles> Meshes(const std::string& content) {
  return std::make_shared<const MeshFileOnDemand>("/dev/null/head.stl", content);
}

TEST(MeshServer, ServesTheFilesOfASetWithoutWritingThem) {
  MeshServer server;
  const auto files = Meshes("an STL file");
  server.Offer("body-1", files);
  const Response read = Fetch(server.port(), "/body-1/head.stl");
  EXPECT_EQ(read.status, 200);
  EXPECT_EQ(read.body, "an STL file");
  EXPECT_EQ(read.headers.at("content-type"), "model/stl");
  EXPECT_FALSE(std::static_pointer_cast<const MeshFileOnDemand>(files)->is_provided());
  const Response head = Fetch(server.port(), "/body-1/head.stl", {}, "HEAD");
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.headers.at("content-length"), "11");
}

TEST(MeshServer, HasNothingButTheseFiles) {
  MeshServer server;
  const auto files = Meshes("an STL file");
  server.Offer("body-1", files);
  for (const char* target : {"/", "/head.stl", "/body-1", "/body-1/", "/body-1/foot.stl",
                             "/body-2/head.stl", "/body-1/x/head.stl", "/etc/passwd"}) {
    EXPECT_NE(Fetch(server.port(), target).status, 200) << target;
  }
  EXPECT_EQ(Fetch(server.port(), "/body-1/../body-1/head.stl").status, 400);
  EXPECT_EQ(Fetch(server.port(), "/body-1/head.stl", {}, "POST", "{}").status, 405);
  EXPECT_THAT(Fetch(server.port(), "/body-1/foot.stl").body, HasSubstr("no such mesh"));
}

TEST(MeshServer, ServesASetWhileOneWhoHasItIsThere) {
  MeshServer server;
  auto of_one = Meshes("an STL file"), of_the_other = Meshes("an STL file");
  server.Offer("body-1", of_one);
  server.Offer("body-1", of_the_other);
  of_the_other.reset();
  EXPECT_EQ(Fetch(server.port(), "/body-1/head.stl").status, 200);
  of_one.reset();
  EXPECT_EQ(Fetch(server.port(), "/body-1/head.stl").status, 404);
}

}  // namespace
}  // namespace kinescope::http::testing
