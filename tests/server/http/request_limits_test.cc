// Requests whose body is refused, without an end, or framed in a way that a proxy reads
// differently.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/server/http/test_server.h"

namespace kinescope::http::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr char kSecret[] = "s3cret-of-the-lab";

PatienceLimits Impatient() {
  PatienceLimits limits;
  limits.header = limits.body = limits.next_request = std::chrono::milliseconds(50);
  return limits;
}

std::string HeaderOf(const std::string& request_line, const std::string& lines) {
  return request_line + " HTTP/1.1\r\nHost: localhost\r\n" + lines + "\r\n";
}

std::string PostHeader(const std::string& lines, const std::string& token = kSecret) {
  return HeaderOf(
      "POST /api/v1/hand_load",
      "Content-Type: application/json\r\nAuthorization: Bearer " + token + "\r\n" + lines);
}

int AnswersIn(const std::string& text) {
  int count = 0;
  for (std::size_t at = text.find("HTTP/1.1 "); at != std::string::npos;
       at = text.find("HTTP/1.1 ", at + 1)) {
    ++count;
  }
  return count;
}

TEST(RequestLimits, AreJudgedByTheHeaderBeforeAnyOfTheBodyIsRead) {
  const TestServer site(kSecret, true, "", Impatient());
  struct Case {
    std::string header, status;
  };
  const std::string length = "Content-Length: 20\r\n", chunked = "Transfer-Encoding: chunked\r\n";
  for (const auto& [header, status] : std::vector<Case>{
           {PostHeader(length, "wrong-wrong-wrong"), "401"},
           {PostHeader(chunked, "wrong-wrong-wrong"), "401"},
           {HeaderOf("GET /api/v1/state", chunked), "401"},
           {HeaderOf("GET /api/v1/ws", chunked), "401"},
           {PostHeader("Origin: http://evil.example\r\n" + length), "403"},
           {HeaderOf("PUT /api/v1/hand_load?token=s3cret-of-the-lab", length), "405"},
           {HeaderOf("POST /api/v1/hand_load?token=s3cret-of-the-lab", length), "415"},
           {HeaderOf("GET /nothing?token=s3cret-of-the-lab", chunked), "404"},
           {HeaderOf("GET /api/v1/state?token=s3cret-of-the-lab", length), "200"}}) {
    const std::string answer = OpenConnection(site.server.port(), header).ReadToEnd();
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 " + status)) << header;
    EXPECT_THAT(answer, HasSubstr("Connection: close")) << "the body is never read: " << header;
  }
}

TEST(RequestLimits, OfMemoryHoldForChunksAndTrailersToo) {
  const TestServer site(kSecret, true, "", Impatient());
  std::string trailers = "0\r\n";
  while (trailers.size() < 20'000) trailers += "X: aaaaaaaaaaaaaaaa\r\n";
  for (const std::string& endless : {"5;" + std::string(20'000, 'a'), trailers}) {
    OpenConnection client(site.server.port(), PostHeader("Transfer-Encoding: chunked\r\n"));
    client.Send(endless);
    const std::string answer = client.ReadToEnd();
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 413"));
    EXPECT_THAT(answer, HasSubstr("more than 12288 bytes"));
  }
  OpenConnection large(site.server.port(), PostHeader("Transfer-Encoding: chunked\r\n"));
  for (int i = 0; i < 5; ++i) large.Send("400\r\n" + std::string(0x400, 'a') + "\r\n");
  EXPECT_THAT(large.ReadToEnd(), StartsWith("HTTP/1.1 413"));
}

TEST(RequestLimits, LetABodyInChunksPass) {
  TestServer site(kSecret);
  site.PublishState(1);
  const std::string answer =
      OpenConnection(site.server.port(),
                     PostHeader("Transfer-Encoding: Chunked\r\nConnection: close\r\n") +
                         "8;a=b\r\n{\"right_\r\n7\r\nkg\": 5}\r\n0\r\nOrigin: http://evil\r\n\r\n")
          .ReadToEnd();
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
  EXPECT_EQ(site.Told()[0].mass_kg[urdf::kRight], 5) << "a trailer is no header";
}

TEST(RequestLimits, LetTheNextRequestFollowABody) {
  TestServer site(kSecret);
  site.PublishState(1);
  const std::string answers =
      OpenConnection(
          site.server.port(),
          PostHeader("Content-Length: 15\r\n") + "{\"right_kg\": 5}" +
              HeaderOf("GET /api/v1/state?token=s3cret-of-the-lab", "Connection: close\r\n"))
          .ReadToEnd();
  EXPECT_EQ(AnswersIn(answers), 2) << answers;
}

TEST(RequestLimits, RejectFramingsThatAProxyMayReadDifferently) {
  const TestServer site("", true, "", Impatient());
  const std::string hidden = "0\r\n\r\n" + HeaderOf("GET /api/v1/cameras", "");
  for (const char* coding :
       {"xchunked", "gzip", "identity", "chunked, identity", "gzip, chunked", "\"chunked\"", ""}) {
    const std::string header =
        HeaderOf("GET /api/v1/state", "Transfer-Encoding: " + std::string(coding) + "\r\n");
    const std::string answer = OpenConnection(site.server.port(), header + hidden).ReadToEnd();
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 501")) << coding;
    EXPECT_EQ(AnswersIn(answer), 1) << coding;
  }
  for (const char* second : {"Content-Length: 5", "Transfer-Encoding: identity"}) {
    const std::string header = HeaderOf(
        "GET /api/v1/state", "Transfer-Encoding: chunked\r\n" + std::string(second) + "\r\n");
    const std::string answer = OpenConnection(site.server.port(), header + hidden).ReadToEnd();
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 400")) << second;
    EXPECT_EQ(AnswersIn(answer), 1) << second;
  }
  const std::string old = "POST /api/v1/hand_load HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n";
  EXPECT_THAT(OpenConnection(site.server.port(), old + hidden).ReadToEnd(),
              StartsWith("HTTP/1.0 400"));
}

TEST(RequestLimits, AskForABodyThatWaitsForPermission) {
  TestServer site(kSecret, true, "", Impatient());
  site.PublishState(1);
  const std::string expect = "Content-Length: 15\r\nExpect: 100-Continue\r\nConnection: close\r\n";
  EXPECT_THAT(Exchange(site.server.port(), PostHeader(expect)), StartsWith("HTTP/1.1 100"));
  EXPECT_THAT(Exchange(site.server.port(), PostHeader(expect, "wrong-wrong-wrong")),
              StartsWith("HTTP/1.1 401"));
  const std::string at_once =
      OpenConnection(site.server.port(), PostHeader(expect) + "{\"right_kg\": 5}").ReadToEnd();
  EXPECT_THAT(at_once.substr(at_once.rfind("HTTP/1.1 ")), StartsWith("HTTP/1.1 200"));
}

TEST(RequestLimits, FindTheTokenInAnyCookieHeader) {
  const TestServer site(kSecret);
  const std::string name = "kinescope_" + std::to_string(site.server.port());
  const std::string wrong = "Cookie: " + name + "=wrong\r\n";
  const std::string right = "Cookie: a=b; " + name + "=" + kSecret + "\r\n";
  for (const std::string& cookies : {wrong + right, right + wrong, "Cookie: a=b\r\n" + right}) {
    EXPECT_THAT(Exchange(site.server.port(), HeaderOf("GET /api/v1/state", cookies)),
                StartsWith("HTTP/1.1 200"))
        << cookies;
  }
  EXPECT_THAT(Exchange(site.server.port(), HeaderOf("GET /api/v1/state", wrong + wrong)),
              StartsWith("HTTP/1.1 401"));
}

}  // namespace
}  // namespace kinescope::http::testing
