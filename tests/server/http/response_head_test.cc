#include "server/http/response_head.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

namespace kinescope::http {
namespace {

constexpr char kUsual[] =
    "X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n";

int CountOf(const std::string& part, const std::string& text) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

TEST(ResponseHead, IsStatusLineAndHeadersAndAnEmptyLine) {
  const std::string head = ResponseHead(JsonAnswer("{}"), {11, 2, true});
  EXPECT_EQ(head.rfind("HTTP/1.1 200 OK\r\nServer: kinescope\r\nContent-Type: application/json\r\n"
                       "Content-Security-Policy: default-src 'none'; ",
                       0),
            0u)
      << head;
  EXPECT_NE(head.find(kUsual), std::string::npos) << head;
  EXPECT_TRUE(EndsWith(head, "\r\nContent-Length: 2\r\n\r\n")) << head;
}

TEST(ResponseHead, NamesTheReasonOfAStatus) {
  EXPECT_EQ(ResponseHead(ErrorAnswer(404, "no"), {}).rfind("HTTP/1.1 404 Not Found\r\n", 0), 0u);
  EXPECT_EQ(ResponseHead(ErrorAnswer(431, "no"), {}).rfind("HTTP/1.1 431 Request Header", 0), 0u);
}

TEST(ResponseHead, TellsTheConnectionOnlyWhereItDiffersFromTheVersionsRule) {
  const Answer answer = JsonAnswer("{}");
  EXPECT_EQ(CountOf("Connection:", ResponseHead(answer, {11, 2, true})), 0);
  EXPECT_EQ(CountOf("\r\nConnection: close\r\n", ResponseHead(answer, {11, 2, false})), 1);
  EXPECT_EQ(CountOf("\r\nConnection: keep-alive\r\n", ResponseHead(answer, {10, 2, true})), 1);
  EXPECT_EQ(CountOf("Connection:", ResponseHead(answer, {10, 2, false})), 0);
  EXPECT_EQ(ResponseHead(answer, {10, 2, false}).rfind("HTTP/1.0 200 OK\r\n", 0), 0u);
}

TEST(ResponseHead, OfNotModifiedHasNeitherTypeNorLength) {
  Answer answer;
  answer.status = 304;
  answer.headers.emplace_back("ETag", "\"a\"");
  const std::string head = ResponseHead(answer, {11, std::nullopt, true});
  EXPECT_EQ(head.rfind("HTTP/1.1 304 Not Modified\r\n", 0), 0u);
  EXPECT_EQ(CountOf("Content-Type", head), 1) << head;  // that of X-Content-Type-Options
  EXPECT_EQ(CountOf("Content-Length", head), 0) << head;
  EXPECT_EQ(CountOf("\r\nETag: \"a\"\r\n", head), 1) << head;
}

TEST(ResponseHead, HasOneLineOfAName) {
  Answer answer = JsonAnswer("{}");
  answer.headers.emplace_back("content-security-policy", "default-src 'self'");
  answer.headers.emplace_back("Cache-Control", "no-store");
  answer.headers.emplace_back("Cache-Control", "no-cache");
  const std::string head = ResponseHead(answer, {11, 2, true});
  EXPECT_EQ(CountOf("ecurity-Policy: ", head), 1) << head;
  EXPECT_EQ(CountOf("ecurity-Policy: default-src 'self'\r\n", head), 1) << head;
  EXPECT_EQ(CountOf("Cache-Control", head), 1) << head;
  EXPECT_EQ(CountOf("Cache-Control: no-cache\r\n", head), 1) << head;
}

}  // namespace
}  // namespace kinescope::http
