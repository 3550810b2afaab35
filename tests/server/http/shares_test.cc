// How connections, pixels and guesses are shared between addresses. Time is an argument.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <list>
#include <optional>
#include <string>
#include <vector>

#include "server/http/client_address.h"
#include "server/http/connections.h"
#include "server/http/guess_guard.h"
#include "server/http/pixel_budget.h"

namespace kinescope::http {
namespace {

using std::chrono::seconds;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::StartsWith;

const Clock::time_point kNoon{std::chrono::hours(12)};

// Connections, and which of them were closed.
class Crowd {
 public:
  bool Connect(const std::string& address, int second, bool has_token = false) {
    if (!connections.MakeRoomFor(address, kNoon + seconds(second))) return false;
    Connection& connection = all_.emplace_back();
    connection.address = address;
    connection.has_token = has_token;
    connection.opened = connection.since = kNoon + seconds(second);
    connection.close = [this, address, second] {
      closed.push_back(address + "@" + std::to_string(second));
    };
    connections.Add(connection);
    return true;
  }
  void Set(Connection::Phase phase) {
    for (Connection& connection : all_) connection.phase = phase;
  }
  void Set(Connection::Phase phase, int second) {
    Set(phase);
    Progress(second);
  }
  // The clients whose answers are being sent read a part of them.
  void Progress(int second) {
    for (Connection& connection : all_) {
      if (connection.phase == Connection::Phase::kWriting) {
        connection.since = kNoon + seconds(second);
      }
    }
  }

  Connections connections;
  std::vector<std::string> closed;

 private:
  std::list<Connection> all_;
};

constexpr int kShare = static_cast<int>(Connections::kMaxPerAddress);

TEST(Connections, OfOneAddressCloseItsOldestWaitingOne) {
  Crowd crowd;
  crowd.Connect("b", 0);
  for (int i = 0; i < kShare; ++i) crowd.Connect("a", 1 + i);
  EXPECT_THAT(crowd.closed, IsEmpty());
  EXPECT_TRUE(crowd.Connect("a", 100));
  EXPECT_TRUE(crowd.Connect("a", 101));
  EXPECT_THAT(crowd.closed, ElementsAre("a@1", "a@2"));
  EXPECT_TRUE(crowd.Connect("b", 102));
  EXPECT_EQ(crowd.closed.size(), 2u) << "another address has its own share";
}

TEST(Connections, CloseOneOfTheGreediestAddressIfAllAreUsed) {
  Crowd crowd;
  crowd.Connect("alone", 0);
  for (int i = 0; i < 60; ++i) crowd.Connect("greedy", 10 + i);
  for (int i = 0; crowd.connections.size() < Connections::kMax; ++i) {
    crowd.Connect("other" + std::to_string(i % 20), 1);
  }
  EXPECT_TRUE(crowd.Connect("new", 200));
  EXPECT_THAT(crowd.closed, ElementsAre("greedy@10"));
  EXPECT_EQ(crowd.connections.size(), Connections::kMax);
}

TEST(Connections, OnWhichTheTokenWasSentAreClosedLast) {
  Crowd crowd;
  for (int i = 1; i < kShare; ++i) crowd.Connect("proxy", i, /*has_token=*/true);
  crowd.Connect("proxy", 500);
  EXPECT_TRUE(crowd.Connect("proxy", 501));
  EXPECT_THAT(crowd.closed, ElementsAre("proxy@500")) << "a stranger, though it is the newest";
}

TEST(Connections, WhoseAnswersAreNotReadAreClosedThatWithoutProgressForLongestFirst) {
  Crowd crowd;
  for (int i = 1; i <= kShare; ++i) crowd.Connect("a", i, /*has_token=*/i < 10);
  crowd.Set(Connection::Phase::kWriting);
  EXPECT_TRUE(crowd.Connect("a", 100));
  EXPECT_TRUE(crowd.Connect("b", 100));
  EXPECT_THAT(crowd.closed, ElementsAre("a@10")) << "a stranger before those with the token";
}

TEST(Connections, WhoseAnswersAreBeingReadAreClosedAfterThoseThatWait) {
  Crowd crowd;
  for (int i = 1; i < kShare; ++i) crowd.Connect("a", 90);
  crowd.Set(Connection::Phase::kWriting);
  crowd.Connect("a", 91);
  EXPECT_TRUE(crowd.Connect("a", 90));
  EXPECT_THAT(crowd.closed, ElementsAre("a@91")) << "though it has not waited at all";
  crowd.Set(Connection::Phase::kWriting);
  EXPECT_TRUE(crowd.Connect("a", 90)) << "rather than locking out everyone";
}

TEST(Connections, WhoseSnapshotIsBeingDrawnAreNotClosedBeforeTheirDeadline) {
  Crowd crowd;
  for (int i = 0; i < kShare; ++i) crowd.Connect("a", i);
  crowd.Set(Connection::Phase::kDrawing);
  const int deadline = static_cast<int>(Connections::kLongestDrawing.count());
  EXPECT_FALSE(crowd.Connect("a", deadline - 1));
  EXPECT_TRUE(crowd.Connect("b", deadline - 1));
  EXPECT_THAT(crowd.closed, IsEmpty());
  EXPECT_TRUE(crowd.Connect("a", deadline));
  EXPECT_THAT(crowd.closed, ElementsAre("a@0"));
}

TEST(Connections, OfAFewAddressesThatReadSlowlyAreClosedBeforeTheOnlyOneOfAnother) {
  Crowd crowd;
  for (std::size_t i = 0; i < Connections::kMax; ++i) {
    crowd.Connect("slow" + std::to_string(i % 8), 100);
  }
  crowd.Set(Connection::Phase::kWriting);
  EXPECT_TRUE(crowd.Connect("honest", 100));
  for (int i = 0; i < 40; ++i) EXPECT_TRUE(crowd.Connect("slow" + std::to_string(i % 8), 100));
  EXPECT_TRUE(crowd.Connect("honest", 102)) << "and later, with one that says nothing";
  EXPECT_EQ(crowd.closed.size(), 42u);
  EXPECT_THAT(crowd.closed, Each(StartsWith("slow")));
}

TEST(Connections, ThatAreNewHaveASecondToSendTheirRequest) {
  Crowd crowd;
  for (std::size_t i = 0; i < Connections::kMax; ++i) crowd.Connect("slow" + std::to_string(i), 99);
  crowd.Set(Connection::Phase::kWriting, /*second=*/100);
  EXPECT_TRUE(crowd.Connect("honest", 100));
  EXPECT_TRUE(crowd.Connect("other", 100));
  EXPECT_THAT(crowd.closed, ElementsAre("slow0@99", "slow1@99")) << "the oldest";
  crowd.Set(Connection::Phase::kWriting, /*second=*/101);
  EXPECT_TRUE(crowd.Connect("silent", 101));
  EXPECT_TRUE(crowd.Connect("other", 101));
  crowd.closed.clear();
  crowd.Progress(102);
  EXPECT_TRUE(crowd.Connect("other", 102));
  EXPECT_THAT(crowd.closed, ElementsAre("silent@101"));
}

TEST(Connections, WithTheTokenDoNotSpoilTheNewOneOfTheirAddress) {
  Crowd crowd;
  for (int i = 0; i < 30; ++i) crowd.Connect("office", i, /*has_token=*/true);
  for (std::size_t i = 30; i < Connections::kMax; ++i) crowd.Connect("x" + std::to_string(i), 50);
  EXPECT_TRUE(crowd.Connect("office", 100));
  EXPECT_TRUE(crowd.Connect("office", 100));
  EXPECT_THAT(crowd.closed, ElementsAre("x30@50", "x31@50"));
}

SnapshotRequest OfSize(int width, int height) { return {"", width, height}; }

// Pays for each snapshot that is not rejected.
class Shop {
 public:
  std::optional<Answer> Buy(const std::string& address, const SnapshotRequest& snapshot,
                            Clock::time_point now) {
    auto refusal = budget_.Refuse(address, snapshot, now);
    if (!refusal) budget_.Pay(address, snapshot, now);
    return refusal;
  }

 private:
  PixelBudget budget_{kNoon};
};

TEST(PixelBudget, PostponesLargeSnapshotsAndKeepsAReserveForSmallOnes) {
  Shop shop;
  const auto largest = OfSize(4096, 4096), usual = OfSize(1920, 1080);
  EXPECT_FALSE(shop.Buy("a", largest, kNoon));
  const auto refused = shop.Buy("a", largest, kNoon);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 429);
  EXPECT_THAT(refused->headers,
              ElementsAre(Pair("Cache-Control", "no-store"), Pair("Retry-After", "9")));
  EXPECT_THAT(refused->body, HasSubstr("or request at most 1920x1080"));
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(shop.Buy("a", usual, kNoon)) << i;
  EXPECT_TRUE(shop.Buy("a", usual, kNoon));
  EXPECT_FALSE(shop.Buy("a", usual, kNoon + seconds(1))) << "one per second";
  EXPECT_TRUE(shop.Buy("a", largest, kNoon + seconds(9))) << "the small ones came first";
  EXPECT_FALSE(shop.Buy("a", largest, kNoon + seconds(14)));
}

TEST(PixelBudget, OfOneAddressDoesNotAffectAnotherUntilThatOfAllIsUsedUp) {
  Shop shop;
  EXPECT_FALSE(shop.Buy("a", OfSize(4096, 4096), kNoon));
  EXPECT_FALSE(shop.Buy("b", OfSize(4096, 4096), kNoon));
  const auto refused = shop.Buy("c", OfSize(4096, 4096), kNoon);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 503);
  EXPECT_THAT(refused->body, HasSubstr("all clients"));
  EXPECT_FALSE(shop.Buy("c", OfSize(1920, 1080), kNoon));
}

TEST(PixelBudget, LimitsTinySnapshotsOfTwoAddressesToTheShareOfAll) {
  Shop shop;
  constexpr int kSeconds = 20;
  int drawn = 0;
  for (int tick = 0; tick < 100 * kSeconds; ++tick) {
    const auto now = kNoon + std::chrono::milliseconds(10 * tick);
    for (const char* address : {"a", "b"}) drawn += shop.Buy(address, OfSize(16, 16), now) ? 0 : 1;
  }
  const double at_once = 2 * (PixelBudget::kLargestPixels + 4 * PixelBudget::kSmallPixels);
  const double most = at_once + kSeconds * PixelBudget::kPixelsPerSecondInAll;
  EXPECT_LE(drawn * PixelBudget::kLeastPixels, most);
  EXPECT_GT(drawn * PixelBudget::kLeastPixels, most / 2) << "and they are not locked out";
}

TEST(PixelBudget, LeavesAPartToAddressesThatDrewLittleLately) {
  Shop shop;
  int drawn = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const auto now = kNoon + std::chrono::milliseconds(10 * tick);
    for (const char* address : {"greedy", "another"}) shop.Buy(address, OfSize(16, 16), now);
    if (tick % 200 == 199) drawn += shop.Buy("honest", OfSize(1280, 720), now) ? 0 : 1;
  }
  EXPECT_EQ(drawn, 10);
}

TEST(PixelBudget, IsNotUsedByASnapshotThatWasNotPaid) {
  PixelBudget budget(kNoon);
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(budget.Refuse("a", OfSize(4096, 4096), kNoon)) << i;
}

TEST(ClientAddress, IsOneForEachNetworkOfIpV6AndEachAddressOfIpV4) {
  const auto of = [](const char* text) {
    return ClientAddress(boost::asio::ip::make_address(text));
  };
  EXPECT_EQ(of("2001:db8:1:2:3:4:5:6"), "2001:db8:1:2::/64");
  EXPECT_EQ(of("2001:db8:1:2::1"), "2001:db8:1:2::/64");
  EXPECT_EQ(of("2001:db8:1:3::1"), "2001:db8:1:3::/64");
  EXPECT_EQ(of("fe80::1%1"), "fe80::/64");
  EXPECT_EQ(of("::ffff:10.0.0.7"), "10.0.0.7");
  EXPECT_EQ(of("10.0.0.7"), "10.0.0.7");
  EXPECT_EQ(of("127.0.0.2"), "127.0.0.2");
  EXPECT_EQ(of("::1"), "::1");
}

TEST(GuessGuard, LetsAnAddressGuessTenTimesInAnyMinute) {
  GuessGuard guard(nullptr);
  auto guess = [&, number = 0](const std::string& address, int secs) mutable {
    return guard.OnWrong(address, std::to_string(++number), kNoon + seconds(secs));
  };
  for (int i = 0; i < 10; ++i) EXPECT_EQ(guess("a", 3 * i), 0) << i;
  EXPECT_EQ(guess("a", 27), 33) << "the first of the ten is a minute old then";
  EXPECT_EQ(guess("b", 27), 0) << "another address";
  EXPECT_EQ(guess("a", 59), 1);
  EXPECT_EQ(guess("a", 60), 0);
  EXPECT_EQ(guess("a", 60), 3) << "the second of the ten";
  int accepted = 0;
  for (int secs = 200; secs < 260; ++secs) accepted += guess("a", secs) == 0 ? 1 : 0;
  EXPECT_EQ(accepted, 10);
}

TEST(GuessGuard, CountsTheSameWrongTokenOnce) {
  GuessGuard guard(nullptr);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(guard.OnWrong("a", "the cookie of yesterday", kNoon), 0) << i;
  }
  EXPECT_EQ(guard.OnWrong("a", "another", kNoon), 0);
}

TEST(GuessGuard, ReportsAllGuessesOfAMinuteInOneLineWithoutThem) {
  std::vector<std::string> log;
  GuessGuard guard([&](const std::string& line) { log.push_back(line); });
  EXPECT_EQ(guard.OnWrong("a", "first", kNoon), 0);
  for (int i = 0; i < 3000; ++i) {
    const std::string address = "10.0." + std::to_string(i % 3) + ".1";
    static_cast<void>(guard.OnWrong(address, "guess" + std::to_string(i), kNoon));
    guard.Report(kNoon);
  }
  guard.Report(kNoon + seconds(59));
  EXPECT_THAT(log, ElementsAre("page: 1 wrong token from a"));
  guard.Report(kNoon + seconds(60));
  guard.Report(kNoon + seconds(180));
  EXPECT_THAT(log, ElementsAre("page: 1 wrong token from a",
                               "page: 3000 wrong tokens from 3 addresses, the last from 10.0.2.1"));
}

TEST(PerAddress, HasBoundedMemory) {
  PerAddress<int> addresses;
  const auto at = [&](int i) -> int& {
    return addresses.At(
        std::to_string(i), [] { return 0; }, [](int value) { return value == 0; });
  };
  at(0) = 5;
  for (int i = 1; i < 5000; ++i) at(i);
  EXPECT_LE(addresses.size(), PerAddress<int>::kMaxAddresses);
  EXPECT_EQ(at(0), 5) << "idle ones are forgotten first";
}

}  // namespace
}  // namespace kinescope::http
