// Meshes of robots that are on a web server: loaded where it answers, and named where it does not.
#include "server/download/robot_meshes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "core/system/web_address.h"
#include "tests/deadline.h"
#include "tests/web_listener.h"

namespace kinescope::download {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr char kSilence[] = "";  // nothing is answered

std::string Answered(const std::string& body, const std::string& head = "HTTP/1.1 200 OK") {
  return head + "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

// Answers each path with its bytes, and others with 404.
class WebServer {
 public:
  explicit WebServer(std::map<std::string, std::string> answers) : answers_(std::move(answers)) {}

  const std::string& url() const { return listener_.url(); }
  std::vector<std::string> asked() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return asked_;
  }

 private:
  // False: the connection is to end.
  bool Answer(int client) {
    std::string request;
    char buffer[4096];
    while (request.find("\r\n\r\n") == std::string::npos) {
      const ssize_t count = read(client, buffer, sizeof buffer);
      if (count <= 0) return false;
      request.append(buffer, static_cast<std::size_t>(count));
    }
    const std::size_t begin = request.find(' ') + 1;
    const std::string path = request.substr(begin, request.find(' ', begin) - begin);
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      asked_.push_back(path);
    }
    const auto known = answers_.find(path);
    const std::string answer =
        known == answers_.end() ? Answered("none", "HTTP/1.1 404 Not Found") : known->second;
    if (answer == kSilence) return read(client, buffer, sizeof buffer) > 0;  // until it gives up
    for (std::size_t sent = 0; sent < answer.size();) {
      const ssize_t count = send(client, answer.data() + sent, answer.size() - sent, MSG_NOSIGNAL);
      if (count <= 0) return false;
      sent += static_cast<std::size_t>(count);
    }
    return true;
  }

  const std::map<std::string, std::string> answers_;
  mutable std::mutex mutex_;
  std::vector<std::string> asked_;  // guarded by mutex_
  testing::WebListener listener_{[this](int client) {
    while (Answer(client)) {
    }
  }};
};

urdf::RobotModel RobotWith(const std::vector<std::string>& meshes) {
  std::string xml = "<robot name='arm'><link name='base'>";
  for (const std::string& mesh : meshes) {
    xml += "<visual><geometry><mesh filename='" + mesh + "'/></geometry></visual>";
  }
  return urdf::ParseUrdf(xml + "</link></robot>");
}

std::string ReasonOf(const std::string& address, const urdf::MeshSearch& search) {
  const auto found = urdf::FindMesh(address, search);
  const auto* missing = std::get_if<urdf::MeshNotFound>(&found);
  return missing != nullptr ? missing->reason : "";
}

std::string ContentOf(const std::string& address, const urdf::MeshSearch& search) {
  const auto found = urdf::FindMesh(address, search);
  const auto* path = std::get_if<std::filesystem::path>(&found);
  if (path == nullptr) return "no file: " + ReasonOf(address, search);
  std::ifstream file(*path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(RobotMeshes, AreFilesOnceTheyAreLoaded) {
  const WebServer server({{"/a/arm.stl", Answered("solid arm")},
                          {"/b/arm.obj?v=2", Answered("mtllib arm.mtl\nmtllib ../other.mtl\nv")},
                          {"/b/arm.mtl", Answered("newmtl red")}});
  const std::string stl = server.url() + "/a/arm.stl", obj = server.url() + "/b/arm.obj?v=2";
  const urdf::RobotModel robot = RobotWith({stl, obj, stl, "/not/of/the/web.stl"});
  EXPECT_EQ(CountRemoteMeshes(robot), 2u);
  std::filesystem::path folder;
  {
    urdf::MeshSearch search;
    EXPECT_THAT(ReasonOf(stl, search), HasSubstr("loaded for robots only"));
    LoadRemoteMeshes(robot, search);
    EXPECT_EQ(ContentOf(stl, search), "solid arm");
    EXPECT_EQ(ContentOf(obj, search), "mtllib arm.mtl\nmtllib ../other.mtl\nv");
    const auto mesh = std::get<std::filesystem::path>(urdf::FindMesh(obj, search));
    EXPECT_EQ(mesh.extension(), ".obj");
    EXPECT_TRUE(std::filesystem::exists(mesh.parent_path() / "arm.mtl"));
    folder = mesh.parent_path();
    const urdf::MeshSearch copy = search;
    search = {};
    EXPECT_TRUE(std::filesystem::exists(folder)) << "the copy still needs it";
  }
  EXPECT_FALSE(std::filesystem::exists(folder));
  EXPECT_THAT(server.asked(), ElementsAre("/a/arm.stl", "/b/arm.obj?v=2", "/b/arm.mtl"))
      << "each once, and nothing above their folder";
}

TEST(RobotMeshes, ThatCannotBeLoadedAreNamedWithTheReason) {
  const WebServer server({{"/large.stl", Answered(std::string(5000, 'x'))},
                          {"/moved.stl",
                           "HTTP/1.1 302 Found\r\nLocation: file:///etc/passwd\r\n"
                           "Content-Length: 0\r\n\r\n"},
                          {"/again.stl",
                           "HTTP/1.1 302 Found\r\nLocation: /good.stl\r\n"
                           "Content-Length: 0\r\n\r\n"},
                          {"/good.stl", Answered("solid")}});
  const auto at = [&](const char* path) { return server.url() + path; };
  urdf::MeshSearch search;
  RobotMeshLimits limits;
  limits.of_file.most_bytes = 4000;
  LoadRemoteMeshes(RobotWith({at("/gone.stl"), at("/large.stl"), at("/moved.stl"), at("/folder/"),
                              at("/again.stl"), at("/good.stl")}),
                   search, nullptr, limits);
  EXPECT_EQ(ReasonOf(at("/gone.stl"), search), "its server answered with status 404");
  EXPECT_THAT(ReasonOf(at("/large.stl"), search), HasSubstr("it has more than 4000 bytes"));
  EXPECT_THAT(ReasonOf(at("/moved.stl"), search), HasSubstr("Unsupported protocol"));
  EXPECT_THAT(ReasonOf(at("/folder/"), search), HasSubstr("expected the name of a file"));
  EXPECT_EQ(ContentOf(at("/again.stl"), search), "solid");
  EXPECT_EQ(ContentOf(at("/good.stl"), search), "solid");
}

TEST(RobotMeshes, OfAServerThatDoesNotAnswerAreAskedForOnce) {
  const WebServer server({{"/a.stl", kSilence}, {"/b.stl", kSilence}, {"/c.stl", kSilence}});
  const auto at = [&](const char* path) { return server.url() + path; };
  urdf::MeshSearch search;
  RobotMeshLimits limits;
  limits.of_file.secs = 0.2;
  LoadRemoteMeshes(RobotWith({at("/a.stl"), at("/b.stl"), at("/c.stl")}), search, nullptr, limits);
  EXPECT_THAT(server.asked(), ElementsAre("/a.stl"));
  EXPECT_THAT(ReasonOf(at("/a.stl"), search), HasSubstr("Timeout was reached"));
  EXPECT_THAT(ReasonOf(at("/c.stl"), search), HasSubstr("Timeout was reached"));
}

TEST(RobotMeshes, AreNotWaitedForWhenTheProgramEnds) {
  const WebServer server({{"/a.stl", kSilence}});
  urdf::MeshSearch search;
  RobotMeshLimits limits;
  limits.of_file.secs = 3600;
  kinescope::testing::WithDeadline([&] {
    LoadRemoteMeshes(
        RobotWith({server.url() + "/a.stl"}), search, [] { return true; }, limits);
  });
  EXPECT_NE(ReasonOf(server.url() + "/a.stl", search), "");
}

TEST(RobotMeshes, AreSoManyAndSoLargeAtMost) {
  const WebServer server({{"/a.stl", Answered("12345")}, {"/b.stl", Answered("12345")}});
  const std::string a = server.url() + "/a.stl", b = server.url() + "/b.stl";
  RobotMeshLimits limits;
  limits.most_files = 1;
  urdf::MeshSearch search;
  LoadRemoteMeshes(RobotWith({a, b}), search, nullptr, limits);
  EXPECT_EQ(ContentOf(a, search), "12345");
  EXPECT_THAT(ReasonOf(b, search), HasSubstr("too many meshes on web servers"));
  limits = {};
  limits.most_bytes_of_all = 5;
  LoadRemoteMeshes(RobotWith({a, b}), search, nullptr, limits);
  EXPECT_THAT(ReasonOf(b, search), HasSubstr("too large together"));
}

TEST(WebAddress, HasAServerAndAFile) {
  EXPECT_TRUE(IsWebAddress("http://robot/arm.stl"));
  EXPECT_TRUE(IsWebAddress("https://robot/arm.stl"));
  EXPECT_FALSE(IsWebAddress("file:///arm.stl"));
  EXPECT_FALSE(IsWebAddress("/http://robot"));
  EXPECT_EQ(ServerOf("http://user:word@robot:8000/a/arm.stl?size=2"), "http://robot:8000");
  EXPECT_EQ(FileNameOf("http://user:word@robot:8000/a/arm.stl?size=/2"), "arm.stl");
  EXPECT_EQ(FileNameOf("http://robot"), "");
  EXPECT_EQ(FileNameOf("http://robot/a/"), "");
}

}  // namespace
}  // namespace kinescope::download
