// Files as answers: they are sent in parts, each read when the one before is sent.
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "server/http/plain_server.h"
#include "server/http/server.h"
#include "tests/server/http/test_client.h"
#include "tests/temp_folder.h"

namespace kinescope::http::testing {
namespace {

constexpr std::size_t kPart = 64 << 10;  // that is read at once
constexpr char kRequest[] = "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n";
constexpr char kLastRequest[] = "GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";

// Answers every request with one file.
class FileServer {
 public:
  explicit FileServer(const std::string& content)
      : server_(Listener(Config()), [this](const Request&) { return FileAnswer(); }) {
    std::ofstream(file(), std::ios::binary) << content;
    thread_ = std::thread([this] { server_.Serve([this] { return is_over_.load(); }); });
  }
  ~FileServer() {
    is_over_ = true;
    thread_.join();
  }

  int port() const { return server_.port(); }
  std::filesystem::path file() const { return folder_.path() / "file"; }

 private:
  static HttpConfig Config() {
    HttpConfig config;
    config.port = 0;
    return config;
  }
  Answer FileAnswer() const {
    Answer answer;
    answer.file = file();
    return answer;
  }

  const kinescope::testing::TempFolder folder_;
  PlainServer server_;
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

// Each byte tells its place.
std::string Content(std::size_t size) {
  std::string content(size, '\0');
  for (std::size_t i = 0; i < size; ++i) content[i] = static_cast<char>(i * 7 + (i >> 8) * 13);
  return content;
}

TEST(FileResponse, IsTheWholeFileWhateverItsSize) {
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, kPart - 1, kPart, kPart + 1, 2 * kPart, 5 * kPart + 1234}) {
    const std::string content = Content(size);
    const FileServer server(content);
    const Response response = Fetch(server.port(), "/");
    EXPECT_EQ(response.headers.at("content-length"), std::to_string(size));
    EXPECT_TRUE(response.body == content) << size;
    const Response head = Fetch(server.port(), "/", {}, "HEAD");
    EXPECT_EQ(head.headers.at("content-length"), std::to_string(size));
    EXPECT_EQ(head.body, "");
  }
}

TEST(FileResponse, IsFollowedByTheNextOneOfItsConnection) {
  const std::string content = Content(3 * kPart + 1);
  const FileServer server(content);
  OpenConnection connection(server.port(), std::string(kRequest) + kLastRequest);
  const std::string received = connection.ReadToEnd();
  const std::size_t first = received.find("\r\n\r\n") + 4;
  ASSERT_GT(received.size(), first + content.size());
  EXPECT_TRUE(received.compare(first, content.size(), content) == 0);
  EXPECT_EQ(received.compare(first + content.size(), 9, "HTTP/1.1 "), 0);
  EXPECT_TRUE(received.compare(received.size() - content.size(), content.size(), content) == 0);
}

TEST(FileResponse, EndsWithTheConnectionIfTheFileBecomesShorter) {
  const FileServer server("");
  constexpr std::uintmax_t kSize = 256 << 20;  // more than the kernel keeps for a client
  std::filesystem::resize_file(server.file(), kSize);
  OpenConnection connection(server.port(), kRequest, /*receive_buffer_bytes=*/2304);
  std::string received = connection.Read(4096);
  EXPECT_NE(received.find("Content-Length: " + std::to_string(kSize)), std::string::npos);
  std::filesystem::resize_file(server.file(), 0);
  received += connection.ReadToEnd();
  EXPECT_LT(received.size(), kSize);
  EXPECT_EQ(Fetch(server.port(), "/").headers.at("content-length"), "0") << "others are served";
}

}  // namespace
}  // namespace kinescope::http::testing
