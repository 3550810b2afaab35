#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <mutex>
#include <string>
#include <vector>

#include "core/system/clocks.h"
#include "server/http/hub.h"
#include "server/http/protocol.h"
#include "tests/server/http/past_message.h"
#include "tests/server/http/test_server.h"

namespace kinescope::http::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

double SentMicros(const WsClient::Message& state) {
  double value = 0;
  std::memcpy(&value, state.bytes.data() + 16, sizeof value);
  return value;
}

std::uint32_t ClientsIn(const WsClient::Message& state) {
  std::uint32_t count = 0;
  std::memcpy(&count, state.bytes.data() + 52, sizeof count);
  return count;
}

// Publishes state `number` and waits until `client` has it: the hub has then offered it to all.
void PublishAndSee(TestServer& site, WsClient& client, std::uint64_t number) {
  site.PublishState(number);
  while (client.ReceiveState().state_number() != number) {
  }
}

std::string Refusal(const std::function<void()>& connect) {
  try {
    connect();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "let in";
}

TEST(WebSocket, SendsDetailsAndTheNewestStateAtFirst) {
  TestServer site;
  site.PublishState(5);
  WsClient client(site.server.port());
  const auto details = client.ReceiveText("details")["details"];
  EXPECT_EQ(details["source"], "udp://0.0.0.0:9763");
  EXPECT_EQ(details["camera"], "front");
  EXPECT_EQ(details["has_pictures"], true);
  EXPECT_EQ(details["people"][0]["loads"][0]["channel"], "flexion");
  EXPECT_EQ(client.ReceiveState().state_number(), 5u);
  EXPECT_EQ(site.server.clients(), 1);
}

TEST(WebSocket, ReportsNoDataBeforeTheFirstSample) {
  TestServer site;
  WsClient client(site.server.port());
  const WsClient::Message state = client.ReceiveState();
  EXPECT_EQ(state.bytes.size(), kStateHeaderBytes);
  EXPECT_EQ(state.bytes[2], 0);
}

TEST(WebSocket, SendsEachStateInOrder) {
  TestServer site;
  WsClient client(site.server.port());
  for (std::uint64_t number = 1; number <= 50; ++number) PublishAndSee(site, client, number);
}

TEST(WebSocket, RepeatsAnOldStateSoThatClientsDetectADeadServer) {
  TestServer site;
  site.PublishState(5);
  WsClient client(site.server.port());
  double last = SentMicros(client.ReceiveState());
  for (int i = 0; i < 3; ++i) {
    const WsClient::Message again = client.ReceiveState();
    EXPECT_EQ(again.state_number(), 5u);
    const double gap = SentMicros(again) - last;
    EXPECT_GT(gap, 0);
    EXPECT_LT(gap, 1e6) << "a page calls the server dead after 1.5 s";
    last = SentMicros(again);
  }
}

TEST(WebSocket, ShowsFormerStatesToThoseWhoAsk) {
  TestServer site;
  WsClient viewer(site.server.port());
  for (std::uint64_t number = 5; number <= 300; ++number) site.PublishState(number);
  const auto look = [&](const std::string& wanted) {
    viewer.Send(R"({"look": {)" + wanted + "}}");
    PastMessage past(viewer.ReceivePast().bytes);
    EXPECT_EQ(past.states.size(), 1u);
    return past;
  };
  const PastMessage past = look(R"("id": 17, "number": 20)");
  EXPECT_EQ(past.id, 17u);
  EXPECT_EQ(past.states[0].number, 20u);
  const auto details = nlohmann::json::parse(past.states[0].details)["details"];
  EXPECT_EQ(details["people"][0]["loads"][0]["channel"], "flexion");
  // By the time that it says of itself.
  const std::string micros = nlohmann::json(past.states[0].made_micros).dump();
  EXPECT_EQ(look(R"("id": 18, "micros": )" + micros).states[0].number, 20u);
  EXPECT_EQ(look(R"("id": 19, "micros": 0)").states[0].number, 5u) << "the oldest";
  EXPECT_EQ(look(R"("id": 20, "number": 1000)").states[0].number, 300u) << "the newest";
  site.PublishState(301);
  while (viewer.ReceiveState().state_number() != 301) {
  }
  EXPECT_EQ(site.HttpCounters()["past_states_encoded"], 4);
}

TEST(WebSocket, SendsARunOfFormerStatesInOneMessage) {
  TestServer site;
  WsClient viewer(site.server.port());
  for (std::uint64_t number = 1; number <= 300; ++number) site.PublishState(number);
  viewer.Send(R"({"look": {"id": 1, "micros": 0, "until_micros": 8e15, "every_micros": 0}})");
  const PastMessage run(viewer.ReceivePast().bytes);
  EXPECT_EQ(run.id, 1u);
  ASSERT_EQ(run.states.size(), 64u) << "so many at most";
  for (std::size_t i = 1; i < run.states.size(); ++i) {
    EXPECT_GT(run.states[i].number, run.states[i - 1].number);
    EXPECT_EQ(run.states[i].details, "") << "as before";
  }
  EXPECT_EQ(run.until_micros, run.states.back().made_micros);
}

TEST(WebSocket, SendsClientsThatAskForTooManyFormerStatesOneAtATime) {
  TestServer site;
  WsClient greedy(site.server.port()), other(site.server.port());
  for (std::uint64_t number = 1; number <= 300; ++number) site.PublishState(number);
  const auto ask = [](WsClient& client) {
    client.Send(R"({"look": {"id": 1, "micros": 0, "until_micros": 8e15, "every_micros": 0}})");
    return PastMessage(client.ReceivePast().bytes).states.size();
  };
  const auto start = std::chrono::steady_clock::now();
  std::size_t states = 0;
  constexpr std::size_t kAsked = 50;
  for (std::size_t i = 0; i < kAsked; ++i) states += ask(greedy);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LE(static_cast<double>(states),
            Hub::kPastStatesAtOnce + Hub::kPastStatesPerSecond * took.count() + kAsked);
  EXPECT_EQ(ask(other), 64u) << "each client has a share of its own";
}

TEST(WebSocket, RefusesMomentsThatAreNone) {
  TestServer site;
  WsClient viewer(site.server.port());
  for (const char* look : {R"({"id": 1, "number": 1})",
                           R"({"id": 1, "micros": 1, "until_micros": 2, "every_micros": 0})"}) {
    viewer.Send(std::string(R"({"look": )") + look + "}");
    EXPECT_THAT(viewer.ReceiveText("error")["error"], HasSubstr("none came yet"));
  }
  for (const char* look :
       {R"(5)",
        R"({})",
        R"({"id": 1})",
        R"({"id": -1, "number": 5})",
        R"({"id": 1, "number": -5})",
        R"({"id": 1, "micros": "now"})",
        R"({"id": 1, "micros": 1e30})",
        R"({"id": 1, "micros": 5, "number": 5})",
        R"({"id": 4294967296, "number": 5})",
        R"({"id": 1, "micros": 5, "until_micros": 6})",
        R"({"id": 1, "micros": 5, "every_micros": 6})",
        R"({"id": 1, "micros": 5, "until_micros": 4, "every_micros": 0})",
        R"({"id": 1, "micros": 5, "until_micros": 6, "every_micros": -1})",
        R"({"id": 1, "micros": 5, "until_micros": 1e30, "every_micros": 0})",
        R"({"id": 1, "micros": 5, "until_micros": 6, "every_micros": 1e30})",
        R"({"id": 1, "micros": 5, "until_micros": "6", "every_micros": 0})",
        R"({"id": 1, "micros": 5, "until_micros": 6, "most": 7})",
        R"({"id": 1, "until_micros": 6, "every_micros": 0})",
        R"({"id": 1, "number": 5, "until_micros": 6, "every_micros": 0})",
        R"({"id": 1, "micros": 5, "until_micros": 6, "every_micros": 0, "most": 7})"}) {
    viewer.Send(std::string(R"({"look": )") + look + "}");
    EXPECT_THAT(viewer.ReceiveText("error")["error"], HasSubstr("look: expected")) << look;
  }
  site.PublishState(2);
  viewer.Send(R"({"look": {"id": 1, "number": 1}})");
  EXPECT_EQ(PastMessage(viewer.ReceivePast().bytes).Numbers(), std::vector<std::uint64_t>{2});
}

TEST(WebSocket, SendsFewStatesToThoseWhoWantFew) {
  TestServer site;
  WsClient few(site.server.port()), all(site.server.port());
  few.Send(R"({"few_states": true, "ping": 1})");
  few.ReceiveText("pong");
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t number = 1; number <= 100; ++number) PublishAndSee(site, all, number);
  // It wants all again, and gets the newest at once.
  few.Send(R"({"few_states": false})");
  std::size_t received = 1;
  while (few.ReceiveState().state_number() != 100) ++received;
  const auto intervals = (std::chrono::steady_clock::now() - start) / Hub::kFewInterval;
  EXPECT_LE(received, static_cast<std::size_t>(intervals) + 3) << "one at first, one at last";
  PublishAndSee(site, few, 101);
}

TEST(WebSocket, ShowsThoseWhoWantFewStatesThatTheServerRuns) {
  TestServer site;
  site.PublishState(5);
  WsClient few(site.server.port());
  few.Send(R"({"few_states": true})");
  double last = SentMicros(few.ReceiveState());
  for (int i = 0; i < 3; ++i) {
    const double sent = SentMicros(few.ReceiveState());
    EXPECT_LT(sent - last, 1e6) << "a page calls the server dead after 1.5 s";
    last = sent;
  }
}

TEST(WebSocket, LimitsTheRateOfStates) {
  TestServer site;
  const auto start = std::chrono::steady_clock::now();
  WsClient client(site.server.port());
  client.ReceiveState();
  std::size_t sent = 0;
  for (std::uint64_t number = 1; number <= 400; ++number) site.PublishState(number);
  for (std::uint64_t newest = 0; newest < 400; ++sent)
    newest = client.ReceiveState().state_number();
  // Each was sent within this time, however late it was received.
  const auto intervals = (std::chrono::steady_clock::now() - start) / Hub::kMinStateInterval;
  EXPECT_LE(sent, static_cast<std::size_t>(intervals) + 1);
}

TEST(WebSocket, SendsPicturesOnlyToSubscribers) {
  TestServer site;
  WsClient viewer(site.server.port()), other(site.server.port());
  viewer.Send(R"({"pictures": true})");
  ASSERT_TRUE(site.feed.WaitForViewers(1));
  site.PublishPicture(8, 1000);
  const WsClient::Message picture = viewer.ReceivePicture();
  EXPECT_EQ(picture.state_number(), 8u);
  EXPECT_EQ(picture.bytes.size(), 1024u);
  other.Send(R"({"ping": 1})");
  while (true) {  // everything before the pong is what `other` was sent until now
    const WsClient::Message message = other.Receive();
    EXPECT_FALSE(message.IsPicture());
    if (message.is_text && message.json().contains("pong")) break;
  }
  viewer.Send(R"({"pictures": false})");
  EXPECT_TRUE(site.feed.WaitForViewers(0)) << "nothing is drawn for nobody";
}

TEST(WebSocket, RemovesViewersThatDisconnect) {
  TestServer site;
  {
    WsClient viewer(site.server.port());
    viewer.Send(R"({"pictures": true})");
    ASSERT_TRUE(site.feed.WaitForViewers(1));
  }
  EXPECT_TRUE(site.feed.WaitForViewers(0));
  EXPECT_EQ(site.server.clients(), 0);
}

TEST(WebSocket, SendsTheCurrentPictureToASecondViewerAtOnce) {
  TestServer site;
  WsClient first(site.server.port()), second(site.server.port());
  first.Send(R"({"pictures": true})");
  ASSERT_TRUE(site.feed.WaitForViewers(1));
  site.PublishPicture(8, 1000);
  first.ReceivePicture();
  second.Send(R"({"pictures": true})");
  EXPECT_EQ(second.ReceivePicture().state_number(), 8u);
}

TEST(WebSocket, SendsAPictureOnceThoughItsSubscriberSubscribesAgain) {
  TestServer site;
  WsClient viewer(site.server.port());
  viewer.Send(R"({"pictures": true})");
  ASSERT_TRUE(site.feed.WaitForViewers(1));
  site.PublishPicture(8, 1000);
  viewer.ReceivePicture();
  for (int i = 0; i < 5; ++i) viewer.Send(R"({"pictures": true})");
  viewer.Send(R"({"ping": 1})");
  while (true) {
    const WsClient::Message message = viewer.Receive();
    EXPECT_FALSE(message.IsPicture());
    if (message.is_text && message.json().contains("pong")) break;
  }
}

TEST(WebSocket, SendsTheNewestStateWhenAClientReadsAgain) {
  TestServer site;
  WsClient stalled(site.server.port(), "/api/v1/ws", {}, /*receive_buffer_bytes=*/4096);
  WsClient other(site.server.port());
  stalled.Send(R"({"pictures": true})");
  ASSERT_TRUE(site.feed.WaitForViewers(1));
  // More than the kernel takes: the server is stuck in the middle of this picture from here on.
  constexpr std::size_t kHuge = 16u << 20;
  site.PublishPicture(1, kHuge);
  constexpr std::uint64_t kLast = 100;
  for (std::uint64_t number = 1; number <= kLast; ++number) {
    PublishAndSee(site, other, number);
    if (number % 20 == 0) site.PublishPicture(number, 5000);
  }
  const auto counters = site.HttpCounters();
  ASSERT_EQ(counters["clients"].size(), 2u);
  std::uint64_t dropped = 0;
  for (const auto& client : counters["clients"])
    dropped += client["states_dropped"].get<std::uint64_t>();
  EXPECT_GE(dropped, kLast - 10) << counters.dump();
  EXPECT_LE(counters["states_encoded"], kLast + 100) << "encoded once, not once per client";

  EXPECT_EQ(stalled.ReceivePicture().bytes.size(), kHuge + 24);
  const WsClient::Message next_picture = stalled.ReceivePicture();
  EXPECT_EQ(next_picture.state_number(), kLast) << "of the later pictures only the newest was kept";
  PublishAndSee(site, stalled, kLast + 1);
}

TEST(WebSocket, KeepsOnlyOneStateForAStalledClient) {
  TestServer site;
  WsClient stalled(site.server.port(), "/api/v1/ws", {}, 4096), other(site.server.port());
  stalled.ReceiveState();
  stalled.Send(R"({"pictures": true})");
  ASSERT_TRUE(site.feed.WaitForViewers(1));
  site.PublishPicture(1, 16u << 20);
  for (std::uint64_t number = 1; number <= 30; ++number) PublishAndSee(site, other, number);
  stalled.ReceivePicture();
  EXPECT_EQ(stalled.ReceiveState().state_number(), 30u)
      << "the first state after the stall is the newest";
}

TEST(WebSocket, SendsOnlyAFewStatesAheadOfAcknowledgements) {
  TestServer site;
  site.PublishState(1);
  WsClient busy(site.server.port()), other(site.server.port());
  busy.Send(R"({"seen_states": 0, "ping": 1})");
  busy.ReceiveText("pong");
  // `busy` reads nothing: without its word the kernel would take all of these.
  for (std::uint64_t number = 2; number <= 60; ++number) PublishAndSee(site, other, number);
  busy.Send(R"({"ping": 2})");
  std::uint64_t last = 0;
  for (bool is_over = false; !is_over;) {
    const WsClient::Message message = busy.Receive();
    if (message.IsState()) last = message.state_number();
    is_over = message.is_text && message.json().contains("pong");
  }
  EXPECT_LE(last, 14u) << "no more than a dozen were under way";
  busy.Send(R"({"seen_states": 12})");
  EXPECT_EQ(busy.ReceiveState().state_number(), 60u) << "then the newest at once";
}

TEST(WebSocket, RejectsAcknowledgementsOfUnsentMessages) {
  TestServer site;
  WsClient client(site.server.port());
  client.ReceiveState();
  client.Send(R"({"seen_states": 1000})");
  client.ReceiveText("error");
  client.Send(R"({"seen_pictures": 2})");
  client.ReceiveText("error");
}

TEST(WebSocket, AnswersAPingWithTheTimeOfTheServer) {
  TestServer site;
  WsClient client(site.server.port());
  const double before = static_cast<double>(MonotonicNanos()) / 1e3;
  client.Send(R"({"ping": 1234.5})");
  const auto answer = client.ReceiveText("pong");
  const double after = static_cast<double>(MonotonicNanos()) / 1e3;
  EXPECT_EQ(answer["pong"], 1234.5);
  EXPECT_GE(answer["server_micros"], before);
  EXPECT_LE(answer["server_micros"], after);
}

TEST(WebSocket, ReportsACameraSelectedByOneClientToAll) {
  TestServer site;
  WsClient chooser(site.server.port()), other(site.server.port());
  other.ReceiveText("details");
  chooser.Send(R"({"camera": "iso"})");
  EXPECT_EQ(other.ReceiveText("details")["details"]["camera"], "iso");
  EXPECT_EQ(site.feed.camera(), "iso");
  EXPECT_EQ(site.Get("/api/v1/cameras").json()["live"], "iso");
  chooser.Send(R"({"camera": "nowhere"})");
  EXPECT_THAT(chooser.ReceiveText("error")["error"].get<std::string>(), HasSubstr("nowhere"));
  EXPECT_EQ(site.Get("/api/v1/cameras").json()["live"], "iso");
}

TEST(WebSocket, ReportsThatThereAreNoPicturesWhoseCameraCouldBeSelected) {
  const TestServer site("", /*with_feed=*/false);
  WsClient client(site.server.port());
  client.Send(R"({"camera": "iso"})");
  EXPECT_THAT(client.ReceiveText("error")["error"].get<std::string>(),
              HasSubstr("renders no pictures (--pictures=off)"));
}

TEST(WebSocket, ReportsInvalidMessagesAndContinues) {
  TestServer site;
  WsClient client(site.server.port());
  client.Send("nonsense");
  client.ReceiveText("error");
  client.SendBinary(std::string("\x00\xFF", 2));
  client.ReceiveText("error");
  client.Send(R"({"ping": 1})");
  client.ReceiveText("pong");
  EXPECT_EQ(site.HttpCounters()["rejected"]["bad message"], 2);
}

TEST(WebSocket, ClosesAfterTextThatIsNoUtf8) {
  TestServer site;
  for (const char* text : {"\xFF\xFE", "{\"camera\": \"\xC3\x28\"}", "\xED\xA0\x80", "\xF0\x9F"}) {
    WsClient client(site.server.port());
    client.Send(text);
    EXPECT_TRUE(client.WaitForClose()) << text;
  }
  WsClient other(site.server.port());
  other.Send(R"({"ping": 1})");
  other.ReceiveText("pong");
}

TEST(WebSocket, ClosesAfterTooLargeOrTooManyMessages) {
  TestServer site;
  WsClient large(site.server.port());
  large.Send(std::string(5000, ' '));
  EXPECT_TRUE(large.WaitForClose());
  WsClient flood(site.server.port());
  try {
    for (int i = 0; i < 1000; ++i) flood.Send(R"({"ping": 1})");
  } catch (const std::exception&) {
    // hung up already
  }
  EXPECT_TRUE(flood.WaitForClose());
  WsClient good(site.server.port());
  good.ReceiveState();
}

TEST(WebSocket, ClosesAfterAFloodOfPingsOrPongs) {
  TestServer site;
  const auto flood = [&](void (WsClient::*send)()) {
    WsClient client(site.server.port());
    try {
      for (int i = 0; i < 1000; ++i) (client.*send)();
    } catch (const std::exception&) {
      // hung up already
    }
    return client.WaitForClose();
  };
  EXPECT_TRUE(flood(&WsClient::SendPing));
  EXPECT_TRUE(flood(&WsClient::SendPong));
  WsClient calm(site.server.port());
  for (int i = 0; i < 5; ++i) calm.SendPing();
  calm.SendPong();
  calm.Send(R"({"ping": 1})");
  calm.ReceiveText("pong");
}

TEST(WebSocket, NeedsTheTokenAndThePageOfThisServer) {
  const TestServer site("s3cret-of-the-lab");
  const int port = site.server.port();
  const std::string host = "127.0.0.1:" + std::to_string(port);
  const Headers cookie = {{"Cookie", "kinescope_" + std::to_string(port) + "=s3cret-of-the-lab"}};
  EXPECT_EQ(Refusal([&] { WsClient(port, "/api/v1/ws"); }), "refused: 401");
  EXPECT_EQ(Refusal([&] { WsClient(port, "/api/v1/ws?token=wrong"); }), "refused: 401");
  EXPECT_EQ(Refusal([&] { WsClient(port, "/api/v1/ws?token=s3cret-of-the-lab"); }), "let in");
  EXPECT_EQ(Refusal([&] { WsClient(port, "/api/v1/ws", cookie); }), "let in");
  Headers from_here = cookie, from_elsewhere = cookie, from_file = cookie;
  from_here["Origin"] = "http://" + host;
  from_elsewhere["Origin"] = "http://evil.example";
  from_file["Origin"] = "null";
  EXPECT_EQ(Refusal([&] { WsClient(port, "/api/v1/ws", from_here); }), "let in");
  EXPECT_EQ(Refusal([&] { WsClient(port, "/api/v1/ws", from_elsewhere); }), "refused: 403");
  EXPECT_EQ(Refusal([&] { WsClient(port, "/api/v1/ws", from_file); }), "refused: 403");
  EXPECT_EQ(Refusal([&] { WsClient(port, "/api/v1/state", cookie); }), "refused: 404");
}

TEST(WebSocket, AgreesOnTheVersionOfItsMessages) {
  const TestServer site;
  const int port = site.server.port();
  const auto connect = [&](const std::string& offered) {
    return WsClient(port, "/api/v1/ws", {{"Sec-WebSocket-Protocol", offered}}).protocol();
  };
  EXPECT_EQ(connect("kinescope.v99, " + SocketProtocol()), SocketProtocol());
  EXPECT_EQ(WsClient(port).protocol(), "") << "offers none";
  EXPECT_EQ(Refusal([&] { connect("kinescope.v99"); }), "refused: 400");
}

TEST(WebSocket, AcceptsClientsUpToItsLimit) {
  TestServer site;
  std::vector<std::unique_ptr<WsClient>> clients;
  const auto connect = [&](const std::string& from) {
    clients.push_back(
        std::make_unique<WsClient>(site.server.port(), "/api/v1/ws", Headers(), 0, from));
    clients.back()->ReceiveState();
  };
  for (int i = 0; i < kMaxClients / 2; ++i) connect("127.0.0.1");
  EXPECT_EQ(Refusal([&] { WsClient(site.server.port()); }), "refused: 503") << "half is its share";
  const Response full = site.Get("/api/v1/ws", {{"Connection", "Upgrade"},
                                                {"Upgrade", "websocket"},
                                                {"Sec-WebSocket-Key", "AAAAAAAAAAAAAAAAAAAAAA=="},
                                                {"Sec-WebSocket-Version", "13"}});
  EXPECT_THAT(full.json()["error"].get<std::string>(),
              AllOf(HasSubstr("64 WebSockets of 127.0.0.1"), HasSubstr("64 of 128 in all"),
                    HasSubstr("Close other pages")));
  for (int i = 0; i < kMaxClients / 4; ++i) connect("127.0.0.2");
  EXPECT_EQ(Refusal([&] { connect("127.0.0.2"); }), "refused: 503") << "half of the rest";
  connect("127.0.0.3");
  EXPECT_EQ(site.server.clients(), 3 * kMaxClients / 4 + 1);
  clients.front()->Send(R"({"pictures": true})");
  ASSERT_TRUE(site.feed.WaitForViewers(1));
  clients.erase(clients.begin(), clients.begin() + kMaxClients / 4);
  ASSERT_TRUE(site.feed.WaitForViewers(0));  // the server has seen the first of them go
  while (ClientsIn(clients.back()->ReceiveState()) > kMaxClients / 2 + 1) {
  }
  WsClient(site.server.port()).ReceiveState();
}

TEST(WebSocket, ClosesWhenTheServerStops) {
  auto site = std::make_unique<TestServer>();
  WsClient client(site->server.port());
  client.ReceiveState();
  site.reset();
  EXPECT_TRUE(client.WaitForClose());
}

TEST(WebSocket, TellsTheHealthOfTheStreamWhenItChangesAndToThoseWhoJoinLater) {
  std::mutex mutex;
  std::string health;  // guarded by mutex
  const auto set = [&](const std::string& text) {
    const std::lock_guard<std::mutex> lock(mutex);
    health = text;
  };
  Latest<SceneState> states;
  Latest<Picture> pictures;
  HttpConfig config = TestServer::MakeConfig("");
  config.stream = [&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return health;
  };
  const HttpServer server(config, states, pictures, nullptr, nullptr);
  WsClient client(server.port());
  set(R"({"lost":1})");
  EXPECT_EQ(client.ReceiveText("stream")["stream"]["lost"], 1);
  WsClient late(server.port());
  EXPECT_EQ(late.ReceiveText("stream")["stream"]["lost"], 1);
  set(R"({"lost":2})");
  EXPECT_EQ(client.ReceiveText("stream")["stream"]["lost"], 2) << "each value once";
}

}  // namespace
}  // namespace kinescope::http::testing
