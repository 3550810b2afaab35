// Who is who in a stream: names, skeletons, several characters and senders.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "tests/server/mvn/assembler_fixture.h"

namespace kinescope::mvn {
namespace {

using testing::kPeriod;
using testing::Sender;

class CharactersTest : public testing::AssemblerTest {};

TEST_F(CharactersTest, KeepsSamplesIntactAroundMetaAndScaleData) {
  LearnFrom(5000);
  Character character;
  character.name = "Ines";
  character.skeleton = urdf::DefaultSkeleton(1.8);
  character.landmarks = urdf::LandmarksOf(*character.skeleton);
  for (std::uint32_t counter = 5006; counter < 5010; ++counter) {
    const auto datagrams = Datagrams(counter);
    Send(datagrams[0]);
    Send(EncodeCharacter(character));  // sample counter 0, time code 0, the same part numbers
    for (std::size_t i = 1; i < datagrams.size(); ++i) Send(datagrams[i]);
    Wait(kPeriod);
  }
  EXPECT_EQ(sink_.samples.size(), 4U);
  EXPECT_EQ(counters().restarts, 0U);
  EXPECT_EQ(counters().duplicates, 0U);
  EXPECT_EQ(counters().incomplete, 0U);
  // "" first, then the name, then the skeleton; repetitions say nothing new.
  ASSERT_EQ(sink_.characters.size(), 3U);
  EXPECT_EQ(sink_.characters[0].name, "");
  EXPECT_EQ(sink_.characters[2].name, "Ines");
  ASSERT_TRUE(sink_.characters[2].skeleton);
  EXPECT_NEAR(sink_.characters[2].skeleton->height, 1.8, 1e-6);
  ExpectAllAccountedFor();
}

TEST_F(CharactersTest, RestoresTheSkeletonFromScaleData) {
  Character character;
  character.skeleton = urdf::DefaultSkeleton(1.62);
  character.landmarks = urdf::LandmarksOf(*character.skeleton);
  auto datagrams = EncodeCharacter(character);
  std::swap(datagrams[1], datagrams[3]);  // points overtake segments
  Send(datagrams);
  ASSERT_FALSE(sink_.characters.empty());
  ASSERT_TRUE(sink_.characters.back().skeleton);
  const urdf::Skeleton& back = *sink_.characters.back().skeleton;
  for (int i = 0; i < urdf::kSegmentCount; ++i) {
    EXPECT_LT((urdf::EndOf(back, i) - urdf::EndOf(*character.skeleton, i)).norm(), 1e-6)
        << urdf::kSegments[static_cast<std::size_t>(i)].mvn_name;
  }
  EXPECT_LT((back.heel_in_foot[0] - character.skeleton->heel_in_foot[0]).norm(), 1e-6);
}

TEST_F(CharactersTest, UsesIncompleteScaleDataAfterATimeout) {
  Character character;
  character.skeleton = urdf::DefaultSkeleton();
  const auto datagrams = EncodeCharacter(character);
  Send(datagrams[1]);
  Send(Datagrams(1)[0]);  // nobody appears from a single datagram
  EXPECT_TRUE(sink_.characters.empty());
  Wait(100 * kNanosPerMilli);
  assembler_.Expire(now_, sink_);
  sink_.characters.clear();
  const auto deadline = assembler_.deadline_nanos();
  ASSERT_TRUE(deadline);
  assembler_.Expire(*deadline, sink_);
  ASSERT_EQ(sink_.characters.size(), 1U);
  EXPECT_TRUE(sink_.characters[0].skeleton);
}

TEST_F(CharactersTest, RejectsScaleDataThatAreNotHuman) {
  Message message;
  ScaleMessage scale;
  for (const auto& segment : urdf::kSegments) {
    scale.segments.push_back({std::string(segment.mvn_name), Eigen::Vector3d::Zero()});
  }
  message.body = scale;
  Send(Encode(message));
  scale.segments.pop_back();
  message.body = scale;
  Send(Encode(message));
  EXPECT_EQ(counters().rejected.at(Text(Reason::kScaleNotHuman)), 1U);
  EXPECT_EQ(counters().rejected.at(Text(Reason::kScaleWithoutBody)), 1U);
  EXPECT_TRUE(sink_.characters.empty());
}

TEST_F(CharactersTest, DistinguishesTwoCharactersOfOneSender) {
  for (std::uint32_t counter = 1; counter < 12; ++counter) {
    const auto ines = Datagrams(counter, 0);
    const auto ben = Datagrams(counter + 1000, 1);
    for (std::size_t i = 0; i < ines.size(); ++i) {
      Send(ines[i]);
      Send(ben[i]);
    }
    Wait(kPeriod);
  }
  ExpectAllAccountedFor();
  EXPECT_EQ(counters().samples, 22U);
  EXPECT_EQ(counters().restarts, 0U);
  for (const BodySample& sample : sink_.samples) {
    EXPECT_EQ(sample.character, sample.counter > 1000 ? 1 : 0);
  }
}

TEST_F(CharactersTest, GivesTwoSendersOfTheSameCharacterDifferentIds) {
  for (std::uint32_t counter = 1; counter < 6; ++counter) {
    sender_ = Sender(1);
    Send(Datagrams(counter));
    sender_ = Sender(2);
    Send(Datagrams(counter + 1000));
    Wait(kPeriod);
  }
  for (const BodySample& sample : sink_.samples) {
    EXPECT_EQ(sample.character, sample.counter > 1000 ? 1 : 0);
  }
  EXPECT_EQ(counters().restarts, 0U);
}

TEST_F(CharactersTest, KeepsThePersonOfASenderThatReturnsFromAnotherPort) {
  Character character;
  character.name = "Ines";
  Send(EncodeCharacter(character));
  LearnFrom(5000);
  Wait(1000 * kNanosPerMilli);
  sender_ = Sender(1, 2);
  Send(Datagrams(3));
  ASSERT_FALSE(sink_.samples.empty());
  EXPECT_EQ(sink_.samples.back().character, 0);
  EXPECT_EQ(sink_.samples.back().counter, 3U);
  EXPECT_EQ(counters().restarts, 1U);
}

TEST_F(CharactersTest, KeepsThePersonOfASenderThatRestartsAtOnce) {
  LearnFrom(5000);
  sender_ = Sender(1, 2);  // within a period of the old one's last sample
  for (std::uint32_t counter = 1; counter < 60; ++counter) {
    Send(Datagrams(counter));
    Wait(kPeriod);
  }
  for (const BodySample& sample : sink_.samples) EXPECT_EQ(sample.character, 0);
  EXPECT_EQ(sink_.samples.back().counter, 59U);
  EXPECT_EQ(counters().restarts, 1U);
  EXPECT_GT(counters().rejected.at(Text(Reason::kSecondSender)), 0U);
  ExpectAllAccountedFor();
}

TEST_F(CharactersTest, TreatsTwoActiveSendersOfOneMachineAsTwoPeople) {
  for (std::uint32_t counter = 1; counter < 120; ++counter) {
    sender_ = Sender(1, 1);
    Send(Datagrams(counter));
    sender_ = Sender(1, 2);
    Send(Datagrams(counter + 1000));
    Wait(kPeriod);
  }
  EXPECT_EQ(sink_.samples.back().character, 1);
  for (const BodySample& sample : sink_.samples) {
    EXPECT_EQ(sample.character, sample.counter > 1000 ? 1 : 0);
  }
  EXPECT_EQ(counters().restarts, 0U);
}

TEST_F(CharactersTest, KeepsALimitedNumberOfStreams) {
  const auto rejected = [this] { return counters().rejected[Text(Reason::kTooManyStreams)]; };
  constexpr std::uint64_t kEach = 3 * 5;  // datagrams
  for (std::uint16_t port = 1; port <= 100; ++port) {
    sender_ = Sender(static_cast<std::uint8_t>(port), port);
    for (std::uint32_t counter = 1; counter <= 3; ++counter) Send(Datagrams(counter));
  }
  EXPECT_EQ(rejected(), (100 - Assembler::kMaxStreams) * kEach);
  Wait(4000 * kNanosPerMilli);
  sender_ = Sender(200);
  Send(Datagrams(1)[0]);
  EXPECT_EQ(rejected(), (100 - Assembler::kMaxStreams) * kEach) << "a silent one makes room";
  ExpectAllAccountedFor();
}

class LockOutTest : public testing::AssemblerTest {
 protected:
  // Keeps every place busy with datagrams that have no body.
  void SendFromFalseSenders() {
    for (std::uint8_t i = 0; i < Assembler::kMaxStreams; ++i) {
      sender_ = Sender(9, static_cast<std::uint16_t>(100 + i));
      Character character;
      character.id = i;
      character.name = "nobody";
      Send(EncodeCharacter(character).front());
    }
  }
  // How many of its 60 samples a suit gets through that sends poses only, at 60 Hz, beside
  // `attack`.
  template <class Attack>
  std::size_t SamplesOfASuitBeside(const Attack& attack, const Endpoint& suit = Sender(1)) {
    for (std::uint32_t counter = 1; counter <= 60; ++counter) {
      attack();
      sender_ = suit;
      Send(Datagrams(counter, 77).front());
      Wait(1000 * kNanosPerMilli / 60);
    }
    const auto is_mine = [](const BodySample& sample) { return sample.character == 77; };
    return static_cast<std::size_t>(
        std::count_if(sink_.samples.begin(), sink_.samples.end(), is_mine));
  }
};

TEST_F(LockOutTest, ASuitTakesThePlaceOfSendersWithoutABody) {
  for (int i = 0; i < 500; ++i) {
    SendFromFalseSenders();
    Wait(kPeriod);
  }
  EXPECT_GE(SamplesOfASuitBeside([this] { SendFromFalseSenders(); }), 55U);
  ExpectAllAccountedFor();
}

TEST_F(LockOutTest, ASuitTakesThePlaceOfSendersThatOnceHadABody) {
  for (std::uint32_t counter = 1; counter <= 3; ++counter) {
    for (std::uint8_t i = 0; i < Assembler::kMaxStreams; ++i) {
      sender_ = Sender(9, static_cast<std::uint16_t>(100 + i));
      Send(Datagrams(counter, i));
    }
    Wait(kPeriod);
  }
  for (int i = 0; i < 40; ++i) {
    SendFromFalseSenders();
    Wait(100 * kNanosPerMilli);
  }
  sink_.samples.clear();
  EXPECT_GE(SamplesOfASuitBeside([this] { SendFromFalseSenders(); }), 55U);
}

TEST_F(LockOutTest, ASuitTakesPlaceAmongThousandsOfSendersOfOneDatagramEach) {
  std::uint16_t port = 1000;
  const auto attack = [&] {
    for (int i = 0; i < 80; ++i) {
      sender_ = Sender(9, ++port);
      Send(Datagrams(5).front());
    }
  };
  attack();
  EXPECT_GE(SamplesOfASuitBeside(attack), 55U);
}

TEST_F(LockOutTest, ASuitTakesPlaceBesideOneSenderOfManyCharacters) {
  int character = 0;
  const auto attack = [&] {
    for (int i = 0; i < 40; ++i) {
      sender_ = Sender(9, 5);
      Send(Datagrams(5, ++character % 255).front());
    }
  };
  for (int i = 0; i < 10; ++i) attack();
  EXPECT_GE(SamplesOfASuitBeside(attack), 55U);
  sink_.samples.clear();
  Wait(4000 * kNanosPerMilli);
  for (int i = 0; i < 10; ++i) attack();
  EXPECT_GE(SamplesOfASuitBeside(attack, Sender(9, 6)), 55U) << "of the same machine";
}

TEST_F(LockOutTest, ASuitTakesThePlaceOfOneSenderOfSixteenPeople) {
  std::uint32_t now = 0;
  const auto attack = [&] {
    if (now++ % 60 != 0) return;  // as seldom as possible
    for (std::uint32_t counter = now; counter <= now + 2; ++counter) {
      for (std::uint8_t i = 0; i < Assembler::kMaxStreams; ++i) {
        sender_ = Sender(9, 5);
        Send(Datagrams(counter, i));
      }
    }
  };
  attack();
  EXPECT_GE(SamplesOfASuitBeside(attack), 55U);
}

TEST_F(LockOutTest, TwoSuitsOfOneMachineAreNotDisplacedByManyMachines) {
  std::uint8_t machine = 20;
  for (std::uint32_t counter = 1; counter <= 120; ++counter) {
    for (const int character : {1, 2}) {
      sender_ = Sender(1);
      Send(Datagrams(counter, character));
    }
    for (int i = 0; i < 40; ++i) {
      sender_ = Sender(static_cast<std::uint8_t>(20 + ++machine % 200));
      Send(Datagrams(counter, 9));
    }
    Wait(kPeriod);
  }
  for (const int character : {1, 2}) {
    EXPECT_GE(std::count_if(sink_.samples.begin(), sink_.samples.end(),
                            [&](const BodySample& s) { return s.character == character; }),
              118);
  }
}

TEST_F(LockOutTest, PeopleAreNotReplacedByStrangers) {
  for (std::uint32_t counter = 1; counter <= 120; ++counter) {
    for (std::uint8_t i = 0; i < Assembler::kMaxStreams; ++i) {
      sender_ = Sender(static_cast<std::uint8_t>(10 + i));
      Send(Datagrams(counter, i));
    }
    if (counter > 3) {  // once the people have shown themselves
      sender_ = Sender(99, static_cast<std::uint16_t>(counter));
      Send(Datagrams(1, 200));
    }
    Wait(kPeriod);
  }
  EXPECT_GE(sink_.samples.size(), 118 * Assembler::kMaxStreams);
  for (const BodySample& sample : sink_.samples) {
    EXPECT_LT(sample.character, static_cast<int>(Assembler::kMaxStreams));
  }
}

TEST_F(CharactersTest, AnnouncesACharacterBeforeItsFirstSample) {
  struct OrderSink : SampleSink {
    std::string order;
    void OnCharacter(const Character&) override { order += 'c'; }
    void OnSample(const BodySample&) override { order += 's'; }
  } sink;
  for (std::uint32_t counter = 1; counter < 4; ++counter) {
    for (const auto& datagram : Datagrams(counter)) assembler_.Add(sender_, datagram, now(), sink);
  }
  EXPECT_EQ(sink.order, "css");
}

}  // namespace
}  // namespace kinescope::mvn
