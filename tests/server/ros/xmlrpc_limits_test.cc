// A master and callers that send what no XML-RPC library should: to the client with which this
// program and roscpp ask a master, and to the server that roscpp has in every node.
#include "server/ros/xmlrpc_limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcServer.h>
#include <xmlrpcpp/XmlRpcServerMethod.h>

#include <array>
#include <atomic>
#include <string>
#include <thread>
#include <utility>

#include "server/ros/master_answers.h"
#include "server/ros/master_client.h"
#include "tests/free_port.h"
#include "tests/heap_in_use.h"
#include "tests/server/ros/bad_master.h"

namespace kinescope::ros_bridge {
namespace {

using kinescope::testing::Answer;
using kinescope::testing::BadMaster;
using kinescope::testing::Loopback;
using kinescope::testing::Nested;
using kinescope::testing::Send;
using ::testing::HasSubstr;
using XmlRpc::XmlRpcValue;
using namespace std::chrono_literals;

constexpr int kDepth = 80'000;  // of a text below the limit of its size
constexpr std::size_t kMostMemory = 32 << 20;

struct Asked {
  MasterReply reply;
  std::size_t memory = 0;  // more than before
};

Asked Ask(const BadMaster& master, std::chrono::milliseconds timeout = 10s) {
  const std::size_t before = kinescope::testing::HeapInUse();
  Asked asked;
  asked.reply = MasterClient("127.0.0.1", master.port()).Call("getPid", XmlRpcValue(), timeout);
  const std::size_t after = kinescope::testing::HeapInUse();
  asked.memory = after > before ? after - before : 0;
  return asked;
}

TEST(XmlRpcLimits, AnAnswerNestedTooDeepIsRejectedByName) {
  const BadMaster master(
      [](int connection, const std::string&) { Send(connection, Answer(Nested(kDepth))); });
  const Asked asked = Ask(master);
  EXPECT_EQ(asked.reply.code, MasterReply::Code::kNoAnswer);
  EXPECT_THAT(asked.reply.problem, HasSubstr("nested deeper than 32 levels"));
  EXPECT_GE(RejectedXmlRpc()["values nested deeper than 32 levels"], 1U);
}

TEST(XmlRpcLimits, AnAnswerWithoutEndIsRejectedByName) {
  const std::string block(1 << 16, 'x');
  std::size_t sent = 0;
  const BadMaster master([&](int connection, const std::string&) {
    Send(connection, "HTTP/1.1 200 OK\r\nContent-length: 2000000000\r\n\r\n");
    while (sent < 256U << 20U && Send(connection, block)) sent += block.size();
  });
  kinescope::testing::LargestAllocation();
  const Asked asked = Ask(master);
  EXPECT_THAT(asked.reply.problem, HasSubstr("more than 4 MiB"));
  EXPECT_LT(asked.memory, kMostMemory);
  EXPECT_LT(kinescope::testing::LargestAllocation(), kMostMemory);
}

TEST(XmlRpcLimits, AHeaderWithoutEndIsRejectedByName) {
  const std::string line = "X-Header: " + std::string(1000, 'x') + "\r\n";
  std::size_t sent = 0;
  const BadMaster master([&](int connection, const std::string&) {
    Send(connection, "HTTP/1.1 200 OK\r\n");
    while (sent < 16U << 20U && Send(connection, line)) sent += line.size();
  });
  const Asked asked = Ask(master);
  EXPECT_THAT(asked.reply.problem, HasSubstr("HTTP header of more than 64 KiB"));
}

std::string Int(int n) { return "<value><i4>" + std::to_string(n) + "</i4></value>"; }
std::string Text(const std::string& text) { return "<value><string>" + text + "</string></value>"; }
std::string List(const std::string& values) {
  return "<value><array><data>" + values + "</data></array></value>";
}

struct WrongAnswer {
  const char* method;
  std::string answer;
  const char* problem;
};

// What roscpp does with an answer of another type is to end the process.
TEST(XmlRpcLimits, AnAnswerOfAnotherTypeIsAFailedCallOfRoscpp) {
  const std::string flag = "<value><boolean>1</boolean></value>";
  const WrongAnswer answers[] = {
      {"hasParam", List(Int(1) + Text("") + Int(1)),
       "answered hasParam with an int instead of a boolean"},
      {"hasParam", List(Int(1) + Text("") + Text("yes")),
       "answered hasParam with a string instead of a boolean"},
      {"hasParam", List(Int(1) + Text("")),
       "answered hasParam with 2 values instead of [status, message, value]"},
      {"hasParam", flag, "answered hasParam with a boolean instead of [status, message, value]"},
      {"hasParam", List(Text("1") + Text("") + flag),
       "answered hasParam with a string as its status instead of an int"},
      {"hasParam", List(Int(1) + Int(7) + flag),
       "answered hasParam with an int as its message instead of a string"},
      {"registerSubscriber", List(Int(1) + Text("") + Int(1)),
       "answered registerSubscriber with an int instead of an array of strings"},
      {"registerSubscriber", List(Int(1) + Text("") + List(Text("http://a:1/") + Int(1))),
       "answered registerSubscriber with an array of other values instead of an array of strings"},
      {"getTopicTypes", List(Int(1) + Text("") + List(List(Text("/tf")))),
       "answered getTopicTypes with an array of other values instead of an array of pairs of "
       "strings"},
      {"lookupNode", List(Int(1) + Text("") + Int(1)),
       "answered lookupNode with an int instead of a string"},
      {"requestTopic", List(Int(1) + Text("") + Int(1)),
       "answered requestTopic with an int instead of an array"},
  };
  for (const WrongAnswer& wrong : answers) {
    SCOPED_TRACE(wrong.problem);
    const BadMaster master(
        [&](int connection, const std::string&) { Send(connection, Answer(wrong.answer)); });
    XmlRpc::XmlRpcClient client("127.0.0.1", master.port(), "/");
    XmlRpcValue reply;
    EXPECT_TRUE(client.execute(wrong.method, XmlRpcValue(), reply));
    ASSERT_EQ(reply.size(), 3);
    EXPECT_EQ(reply[0], XmlRpcValue(0));
    EXPECT_EQ(TakeXmlRpcProblem(), wrong.problem);
    EXPECT_EQ(RejectedXmlRpc()[wrong.problem], 1U);
  }
}

TEST(XmlRpcLimits, AnAnswerWithTooManyPublishersIsRejected) {
  std::string uris;
  for (int i = 0; i <= kMostPublishers; ++i) uris += Text("http://127.0.0.1:1/");
  const BadMaster master([&](int connection, const std::string&) {
    Send(connection, Answer(List(Int(1) + Text("") + List(uris))));
  });
  MasterClient client("127.0.0.1", master.port());
  const MasterReply reply = client.Call("registerSubscriber", XmlRpcValue(), 10s);
  EXPECT_EQ(reply.code, MasterReply::Code::kNoAnswer);
  EXPECT_THAT(reply.problem, HasSubstr("with more than 512 publishers of a topic"));
}

TEST(XmlRpcLimits, AcceptTheAnswersOfAMaster) {
  const std::pair<const char*, std::string> answers[] = {
      {"hasParam", "<value><boolean>0</boolean></value>"},
      {"getParam", Int(1)},
      {"getPid", Int(1)},
      {"lookupNode", Text("http://127.0.0.1:1/")},
      {"registerSubscriber", List(Text("http://127.0.0.1:1/"))},
      {"getTopicTypes", List(List(Text("/tf") + Text("tf2_msgs/TFMessage")))},
      {"getSystemState", List(List("") + List("") + List(""))},
      {"anUnknownMethod", Int(1)},
  };
  for (const auto& [method, value] : answers) {
    SCOPED_TRACE(method);
    const BadMaster master([&value = value](int connection, const std::string&) {
      Send(connection, Answer(List(Int(1) + Text("") + value)));
    });
    MasterClient client("127.0.0.1", master.port());
    EXPECT_EQ(client.Call(method, XmlRpcValue(), 10s).code, MasterReply::Code::kGood);
    EXPECT_EQ(client.problem(), "");
  }
  const BadMaster master([](int connection, const std::string&) {
    Send(connection, Answer(List(Int(-1) + Text("unknown node") + Int(0))));
  });
  EXPECT_EQ(MasterClient("127.0.0.1", master.port()).Call("lookupNode", XmlRpcValue(), 10s).code,
            MasterReply::Code::kRefused);
}

TEST(XmlRpcLimits, AServerThatIsNotAMasterIsNamed) {
  const std::pair<std::string, const char*> answers[] = {
      {Answer(Int(5)), "answered getPid with an int instead of [status, message, value]"},
      {"HTTP/1.1 404 Not Found\r\nContent-length: 9\r\n\r\nNot Found",
       "answered getPid with something other than XML-RPC"},
      {"SSH-2.0-OpenSSH_9.2\r\n", "answered getPid with something other than XML-RPC"},
      {"HTTP/1.1 200 OK\r\n\r\nhello", "answered getPid with something other than XML-RPC"},
      {"HTTP/1.1 200 OK\r\nContent-length: 150\r\n\r\n<?xml version=\"1.0\"?><methodResponse>"
       "<fault><value><struct><member><name>faultCode</name><value><int>4</int></value></member>"
       "</struct></value></fault></methodResponse>      ",
       "answered getPid with an XML-RPC fault"},
  };
  for (const auto& [answer, problem] : answers) {
    const BadMaster master(
        [&answer = answer](int connection, const std::string&) { Send(connection, answer); });
    EXPECT_EQ(Ask(master).reply.problem, problem);
  }
}

TEST(XmlRpcLimits, ARefusedConnectionIsNoAnswer) {
  const kinescope::testing::FreePort silent;
  const MasterReply reply = MasterClient("127.0.0.1", silent.number()).Call("getPid", {}, 10s);
  EXPECT_EQ(reply.code, MasterReply::Code::kNoAnswer);
  EXPECT_EQ(reply.problem, "");
}

// One byte whenever the connection has been silent for a moment, without end.
void Drip(int connection, const std::string& /*request*/) {
  Send(connection, "HTTP/1.1 200 OK\r\nContent-length: 1000000\r\n\r\n");
  pollfd silent = {connection, POLLIN, 0};
  while (poll(&silent, 1, 1) == 0 && Send(connection, " ")) {
  }
}

TEST(XmlRpcLimits, AnAnswerThatDripsEndsAtTheTimeLimit) {
  const BadMaster master(Drip);
  const MasterReply reply = Ask(master, 50ms).reply;
  EXPECT_EQ(reply.code, MasterReply::Code::kNoAnswer);
  EXPECT_EQ(reply.problem, "did not complete an answer within 50 ms");
}

TEST(XmlRpcLimits, ACallOfRoscppEndsAtTheTimeLimit) {
  const BadMaster master(Drip);
  LimitXmlRpcCalls(50ms);
  XmlRpc::XmlRpcClient client("127.0.0.1", master.port(), "/");
  XmlRpcValue reply;
  EXPECT_FALSE(client.execute("registerPublisher", XmlRpcValue(), reply));
  LimitXmlRpcCalls(-1ms);
}

TEST(XmlRpcLimits, TheLastCallsOfRoscppEndTogether) {
  const std::string answer = Answer(List(Int(1) + Text("") + Int(1)));
  const BadMaster master([&](int connection, const std::string&) {
    pollfd silent = {connection, POLLIN, 0};
    for (int i = 0; i < 300 && poll(&silent, 1, 1) == 0; ++i) {  // until the client gives up
    }
    Send(connection, answer);
  });
  LimitXmlRpcCalls(10s);
  LimitLastXmlRpcCalls(1ms);
  XmlRpcValue reply;
  for (int i = 0; i < 2; ++i) {
    XmlRpc::XmlRpcClient client("127.0.0.1", master.port(), "/");
    EXPECT_FALSE(client.execute("unregisterPublisher", XmlRpcValue(), reply));
  }
  LimitLastXmlRpcCalls(-1ms);
  LimitXmlRpcCalls(-1ms);
}

TEST(XmlRpcLimits, RejectEndTagsThatAreMissing) {
  std::string text = "<value><array><data>";
  for (int i = 0; i < 100; ++i) text += "<value><i4>1</i4>";  // searched for in the rest, each time
  XmlRpcValue value;
  int offset = 0;
  EXPECT_FALSE(value.fromXml(text + "</data></array></value>", &offset));
  EXPECT_THAT(TakeXmlRpcProblem(), HasSubstr("not well-formed"));
  EXPECT_EQ(TakeXmlRpcProblem(), "");
}

TEST(XmlRpcLimits, AcceptWhatXmlRpcAndPythonWrite) {
  XmlRpcValue value;
  value[0] = 1;
  value[1] = std::string("a < b & \"c\"");
  value[2][0]["name"] = true;
  value[2][0]["list"].setSize(0);
  value[2][1] = 1.5;
  value[3] = XmlRpcValue(const_cast<char*>("binary"), 6);
  const std::string xml = value.toXml();
  int offset = 0;
  XmlRpcValue copy;
  EXPECT_TRUE(copy.fromXml(xml, &offset)) << xml;
  EXPECT_EQ(copy, value);
  // xmlrpc.client.dumps(), with its line ends.
  const std::string python =
      "<value><array><data>\n<value><int>1</int></value>\n<value><string></string></value>\n"
      "<value><struct>\n<member>\n<name>run_id</name>\n<value><string>f&lt;g</string></value>\n"
      "</member>\n</struct></value>\n<value><boolean>1</boolean></value>\n</data></array></value>";
  EXPECT_EQ(DefectOfXmlRpcValue("<param>\n" + python + "\n</param>", 7), nullptr);
  EXPECT_EQ(DefectOfXmlRpcValue(Nested(kDeepestXmlRpcValue - 1), 0), nullptr);
  EXPECT_NE(DefectOfXmlRpcValue(Nested(kDeepestXmlRpcValue), 0), nullptr);
  for (std::size_t size = 0; size < python.size(); ++size) {
    EXPECT_NE(DefectOfXmlRpcValue(std::string_view(python).substr(0, size), 0), nullptr) << size;
  }
}

// The server of a node: XmlRpc++'s, as roscpp uses it.
class NodeServer {
 public:
  NodeServer() {
    EXPECT_TRUE(server_.bindAndListen(0));
    thread_ = std::thread([this] {
      while (!stop_) server_.work(0.01);
      server_.shutdown();
    });
  }
  ~NodeServer() {
    stop_ = true;
    thread_.join();
  }
  NodeServer(const NodeServer&) = delete;
  NodeServer& operator=(const NodeServer&) = delete;

  // Sends `request`, until `more` ends or the server closes the connection, and reads its answer.
  std::string Ask(const std::string& request, const std::string& more = "") {
    const int connection = socket(AF_INET, SOCK_STREAM, 0);
    const sockaddr_in address = Loopback(server_.get_port());
    EXPECT_EQ(connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    bool is_open = Send(connection, request);
    while (is_open && !more.empty()) is_open = Send(connection, more);
    std::array<char, 4096> answer;
    const ssize_t size = recv(connection, answer.data(), answer.size(), 0);
    close(connection);
    return {answer.data(), size > 0 ? static_cast<std::size_t>(size) : 0};
  }

  static std::string Request(const std::string& method, const std::string& value) {
    const std::string body = "<?xml version=\"1.0\"?><methodCall><methodName>" + method +
                             "</methodName><params><param>" + value +
                             "</param></params></methodCall>";
    return "POST / HTTP/1.1\r\nContent-length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
  }

  bool Answers() {
    return Ask(Request("echo", "<value>hello</value>")).find("hello") != std::string::npos;
  }

 private:
  struct Echo : XmlRpc::XmlRpcServerMethod {
    explicit Echo(XmlRpc::XmlRpcServer& server) : XmlRpcServerMethod("echo", &server) {}
    void execute(XmlRpcValue& arguments, XmlRpcValue& answer) override { answer = arguments; }
  };

  std::atomic<bool> stop_{false};
  XmlRpc::XmlRpcServer server_;
  Echo echo_{server_};
  std::thread thread_;
};

TEST(XmlRpcLimits, ANodeSurvivesRequestsNestedTooDeep) {
  NodeServer node;
  ASSERT_TRUE(node.Answers());
  node.Ask(NodeServer::Request("echo", Nested(kDepth)));
  EXPECT_TRUE(node.Answers());
}

TEST(XmlRpcLimits, ANodeSurvivesRequestsThatCallThemselves) {
  NodeServer node;
  node.Ask(NodeServer::Request(
      "system.multicall",
      "<value><array><data><value><struct><member><name>methodName</name><value>system.multicall"
      "</value></member><member><name>params</name><value><array><data></data></array></value>"
      "</member></struct></value></data></array></value>"));
  EXPECT_TRUE(node.Answers());
}

TEST(XmlRpcLimits, ANodeRejectsAnUpdateWithTooManyPublishers) {
  NodeServer node;
  std::string uris;
  for (int i = 0; i <= kMostPublishers; ++i) uris += Text("http://127.0.0.1:1/");
  node.Ask(NodeServer::Request(
      "publisherUpdate",
      Text("/master") + "</param><param>" + Text("/tf") + "</param><param>" + List(uris)));
  EXPECT_EQ(RejectedXmlRpc()["publisherUpdate with more than 512 publishers of a topic"], 1U);
  EXPECT_TRUE(node.Answers());
}

TEST(XmlRpcLimits, ANodeClosesConnectionsWithoutEnd) {
  NodeServer node;
  kinescope::testing::LargestAllocation();
  EXPECT_EQ(node.Ask("POST / HTTP/1.1\r\n", "X-Header: " + std::string(1000, 'x') + "\r\n"), "");
  EXPECT_EQ(
      node.Ask("POST / HTTP/1.1\r\nContent-length: 2000000000\r\n\r\n", std::string(1 << 16, 'x')),
      "");
  EXPECT_LT(kinescope::testing::LargestAllocation(), kMostMemory);
  EXPECT_TRUE(node.Answers());
}

}  // namespace
}  // namespace kinescope::ros_bridge
