#include "server/ros/source/told_people.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "server/ros/link_states.h"
#include "server/ros/person_messages.h"
#include "server/ros/raw_message.h"
#include "tests/recording_sink.h"
#include "tests/server/ros/source/written_bag.h"

namespace kinescope::ros_bridge {
namespace {

constexpr double kNotTold = std::numeric_limits<double>::quiet_NaN();

kinescope_ros::Person Told(const std::string& model, double mass, double both_kg) {
  kinescope_ros::Person person;
  person.pelvis_frame = model + "_pelvis";
  person.topics = "/" + model + "/";
  person.body_mass = mass;
  person.hand_load_known = 1;
  person.hand_load.both_kg = both_kg;
  return person;
}

kinescope_ros::PersonArray Told(const std::vector<kinescope_ros::Person>& people) {
  kinescope_ros::PersonArray message;
  message.people = people;
  return message;
}

std::vector<std::uint8_t> BytesOf(const kinescope_ros::PersonArray& message) {
  const ros::SerializedMessage whole = ros::serialization::serializeMessage(message);
  return {whole.message_start, whole.buf.get() + whole.num_bytes};
}

class ToldPeopleTest : public ::testing::Test {
 protected:
  void SetUp() override { people_.SetSink(&sink_); }

  void Sample() {
    BodySample sample;
    sample.arrival_nanos = 7;
    sample.stamp_nanos = now_;
    people_.OnSample(sample);
  }
  bool Take(const std::vector<kinescope_ros::Person>& people) {
    return people_.Take(BytesOf(Told(people)));
  }

  std::int64_t now_ = kNanosPerSecond;
  kinescope::testing::RecordingSink sink_;
  ToldPeople people_{[](int) { return ToldPeople::Key{"anna_pelvis", ""}; }};
};

TEST_F(ToldPeopleTest, ArePassedOnBeforeTheNextSampleWhenSomethingChanged) {
  Character anna;
  anna.name = "anna";
  people_.OnCharacter(anna);
  Sample();
  ASSERT_TRUE(Take({Told("ben", 60, 0)}));
  Sample();
  ASSERT_EQ(sink_.characters.size(), 1U) << "nothing was told about her";
  EXPECT_FALSE(sink_.characters[0].told_hand_load.is_known);
  ASSERT_TRUE(Take({Told("ben", 60, 0), Told("anna", 70, 5)}));
  ASSERT_EQ(sink_.characters.size(), 1U);
  Sample();
  ASSERT_TRUE(Take({Told("anna", 70, 5)}));
  Sample();
  ASSERT_EQ(sink_.characters.size(), 2U) << "once for a change";
  EXPECT_EQ(sink_.characters[1].name, "anna");
  EXPECT_EQ(sink_.characters[1].told.mass_kg, 70);
  EXPECT_FALSE(sink_.characters[1].told.sex);
  EXPECT_EQ(sink_.characters[1].told_hand_load.both_kg, 5);
  ASSERT_TRUE(Take({Told("anna", kNotTold, 8)}));
  people_.OnCharacter(anna);  // with other lengths
  Sample();
  ASSERT_EQ(sink_.characters.size(), 3U);
  EXPECT_FALSE(sink_.characters[2].told.mass_kg);
  EXPECT_EQ(sink_.characters[2].told_hand_load.both_kg, 8);
  EXPECT_EQ(sink_.samples.size(), 5U);
}

TEST_F(ToldPeopleTest, AreThoseOfTheNodeThatToldLast) {
  people_.OnCharacter({});
  kinescope_ros::Person other = Told("anna", 90, 0);
  other.topics = "/another_node/";
  ASSERT_TRUE(Take({Told("anna", 70, 0)}));
  ASSERT_TRUE(Take({other}));
  Sample();
  EXPECT_EQ(sink_.characters.back().told.mass_kg, 90);
  ASSERT_TRUE(Take({Told("anna", 71, 0)}));
  Sample();
  EXPECT_EQ(sink_.characters.back().told.mass_kg, 71);
}

TEST_F(ToldPeopleTest, NeitherTakeWhatIsNoMessageNorGrowWithoutLimit) {
  people_.OnCharacter({});
  ASSERT_TRUE(Take({Told("anna", 70, 0)}));
  for (int n = 0; n < 1000; ++n) {
    ++now_;
    ASSERT_TRUE(Take({Told("robot_" + std::to_string(n), 60, 0), Told("anna", 70, 0)}));
  }
  std::vector<std::uint8_t> bytes = BytesOf(Told({Told("anna", 80, 0)}));
  bytes.pop_back();
  EXPECT_FALSE(people_.Take(bytes));
  EXPECT_FALSE(people_.Take({255, 255, 255, 255}));
  kinescope_ros::Person odd = Told("anna", 70, 0);
  odd.sex = 7;
  ASSERT_TRUE(Take({odd}));
  Sample();
  EXPECT_FALSE(sink_.characters.back().told.sex);
  Sample();
  EXPECT_EQ(sink_.characters.back().told.mass_kg, 70);
}

// Its person may be told of by another node now, or by none.
TEST_F(ToldPeopleTest, AreForgottenWithTheNodeThatTold) {
  people_.OnCharacter({});
  kinescope_ros::Person other = Told("anna", 60, 0);
  other.topics = "/another_node/";
  ASSERT_TRUE(Take({Told("anna", 55, 0)}));
  ASSERT_TRUE(Take({other}));
  const auto go_on = [&](double secs, const std::vector<kinescope_ros::Person>& heard) {
    for (const std::int64_t end = now_ + static_cast<std::int64_t>(secs * kNanosPerSecond);
         now_ < end; now_ += kNanosPerSecond / 2) {
      if (!heard.empty()) ASSERT_TRUE(Take(heard));
      Sample();
    }
  };
  go_on(4, {Told("anna", 55, 0)});
  EXPECT_EQ(sink_.characters.back().told.mass_kg, 60);
  go_on(3, {Told("anna", 55, 0)});
  EXPECT_EQ(sink_.characters.back().told.mass_kg, 55) << "the other one has gone";
  now_ += 60 * kNanosPerSecond;  // the suit is off, and on again before its node tells
  Sample();
  EXPECT_EQ(sink_.characters.back().told.mass_kg, 55);
  go_on(8, {});
  EXPECT_FALSE(sink_.characters.back().told.mass_kg);
  EXPECT_FALSE(sink_.characters.back().told_hand_load.is_known);
}

// A bag that is replayed, and a clock that is set, are no reason: all here counts by stamps.
TEST_F(ToldPeopleTest, AreKeptWhenTheClockOfTheSamplesIsSet) {
  people_.OnCharacter({});
  ASSERT_TRUE(Take({Told("anna", 55, 0)}));
  for (const double secs : {0.0, 100.0, -200.0, 0.5, 0.5}) {
    now_ += static_cast<std::int64_t>(secs * kNanosPerSecond);
    Sample();
    EXPECT_EQ(sink_.characters.back().told.mass_kg, 55) << "after " << secs << " s";
  }
  ASSERT_EQ(sink_.characters.size(), 2U) << "before and after it was told";
  for (int n = 0; n < 12; ++n) {
    now_ += kNanosPerSecond / 2;
    Sample();
  }
  EXPECT_FALSE(sink_.characters.back().told.mass_kg) << "not heard since the clock was set back";
}

TEST(PersonMessages, HaveWhatWasToldOfAPerson) {
  PersonState person = PersonAt(0, "anna");
  kinescope_ros::Person message;
  FillPerson(person, PersonNames(person.model->human), "/kinescope/", message);
  EXPECT_EQ(message.pelvis_frame, "anna_pelvis");
  EXPECT_EQ(message.topics, "/kinescope/");
  EXPECT_TRUE(std::isnan(message.body_mass));
  EXPECT_TRUE(ToldOf(message).is_empty());
  EXPECT_FALSE(message.hand_load_known);
  const kinescope_ros::Person before = message;

  auto model = std::make_shared<PersonModel>(*person.model);
  model->description.mass_kg = 66;
  model->description.mass_is_assumed = false;
  model->description.sex = urdf::Sex::kFemale;
  model->description.sex_is_assumed = false;
  person.model = model;
  person.forces.stated_hand_load = {true, {1, 2}, 3, {std::nullopt, Eigen::Vector3d(0, 0, -0.2)}};
  FillPerson(person, PersonNames(person.model->human), "/kinescope/", message);
  EXPECT_TRUE(AreEqual(before, before)) << "with a number that is none";
  EXPECT_FALSE(AreEqual(before, message));
  EXPECT_EQ(ToldOf(message).mass_kg, 66);
  EXPECT_EQ(ToldOf(message).sex, urdf::Sex::kFemale);
  HandLoad load;
  EXPECT_EQ(ReadHandLoad(message.hand_load, load), "");
  EXPECT_EQ(load.mass_kg, (std::array<double, 2>{1, 2}));
  EXPECT_EQ(load.both_kg, 3);
  EXPECT_FALSE(load.com_in_hand[urdf::kRight]);
  EXPECT_EQ(load.com_in_hand[urdf::kLeft], Eigen::Vector3d(0, 0, -0.2));
  message.hand_load.right_com = {1, 2};
  EXPECT_NE(ReadHandLoad(message.hand_load, load), "");
}

// Of a bag that was cut, the first words that it has may be a change.
TEST_F(BagTest, HasNotWhatWasToldLongAfterItsBeginning) {
  const ReadPeople read = ReadBag(Bag([](rosbag::Bag& bag) {
    for (int n = 0; n < 300; ++n) {
      const ros::Time now = RosTimeOf(kBagStart + n * kBagPeriod);
      bag.write("/tf", now, TransformsOf(PersonAt(n % 10, "anna")));
      if (n == 200) bag.write("/kinescope/people", now, Told({Told("anna", 70, 5)}));
    }
  }));
  ASSERT_GE(read.characters.size(), 2U);
  EXPECT_FALSE(read.characters.front().told.mass_kg);
  EXPECT_EQ(read.characters.back().told.mass_kg, 70);
}

TEST_F(BagTest, HasWhatWasToldOfItsPeopleFromTheFirstSampleOn) {
  const auto write = [](bool has_tf) {
    return [has_tf](rosbag::Bag& bag) {
      for (int n = 0; n < 20; ++n) {
        const ros::Time now = RosTimeOf(kBagStart + n * kBagPeriod);
        const PersonState person = PersonAt(n, "anna");
        if (has_tf) bag.write("/tf", now, TransformsOf(person));
        xsens_mvn_ros_msgs::LinkStateArray states;
        FillLinkStates(person, "world", states);
        if (!has_tf) bag.write("/anna/link_states", now, states);
        // A recorder may write the first pose before.
        if (n == 0) bag.write("/kinescope/people", now, Told({Told("anna", 70, 5)}));
        if (n == 10) bag.write("/kinescope/people", now, Told({Told("anna", 70, 8)}));
      }
    };
  };
  for (const bool has_tf : {true, false}) {
    const ReadPeople read = ReadBag(Bag(write(has_tf)));
    ASSERT_EQ(read.samples.size(), 20U);
    EXPECT_TRUE(read.counters.ignored.empty());
    std::vector<double> told;
    for (const Character& character : read.characters) {
      EXPECT_EQ(character.told.mass_kg, 70);
      told.push_back(character.told_hand_load.both_kg);
    }
    EXPECT_EQ(told.front(), 5) << has_tf;
    EXPECT_EQ(told.back(), 8) << has_tf;
  }
}

// The bag begins with a robot; also later than people are looked for at first.
TEST_F(BagTest, HasWhatWasToldOfPeopleWhoCameLate) {
  for (const int secs : {3, 20}) {
    const ReadPeople read = ReadBag(Bag([&](rosbag::Bag& bag) {
      tf2_msgs::TFMessage robot;
      robot.transforms.resize(1);
      robot.transforms[0].header.frame_id = "world";
      robot.transforms[0].child_frame_id = "arm_base";
      robot.transforms[0].transform.rotation.w = 1;
      bag.write("/tf_static", RosTimeOf(kBagStart), robot);
      for (int n = 0; n < 20; ++n) {
        const std::int64_t now = kBagStart + secs * kNanosPerSecond + n * kBagPeriod;
        bag.write("/tf", RosTimeOf(now), TransformsOf(PersonAt(n, "anna")));
        const double both_kg = n < 10 ? 5 : 8;
        if (n % 10 == 0) {
          bag.write("/kinescope/people", RosTimeOf(now + 1000), Told({Told("anna", 70, both_kg)}));
        }
      }
    }));
    ASSERT_EQ(read.samples.size(), 20U);
    ASSERT_GE(read.characters.size(), 2U);
    EXPECT_EQ(read.characters.front().told.mass_kg, 70) << secs;
    EXPECT_EQ(read.characters.front().told_hand_load.both_kg, 5) << secs;
    EXPECT_EQ(read.characters.back().told_hand_load.both_kg, 8) << secs;
  }
}

// What is told of the first one when the second comes is a change.
TEST_F(BagTest, HasNotWhatWasToldOfOthersWhenSomebodyCame) {
  const ReadPeople read = ReadBag(Bag([](rosbag::Bag& bag) {
    for (int n = 0; n < 20; ++n) {
      const ros::Time now = RosTimeOf(kBagStart + n * kBagPeriod);
      bag.write("/tf", now, TransformsOf(PersonAt(n, "anna")));
      if (n >= 10) bag.write("/tf", now, TransformsOf(PersonAt(n, "ben")));
      if (n == 0) bag.write("/kinescope/people", now, Told({Told("anna", 70, 5)}));
      if (n == 10) {
        bag.write("/kinescope/people", now, Told({Told("anna", 70, 8), Told("ben", 60, 2)}));
      }
    }
  }));
  std::map<int, std::vector<double>> held;
  for (const Character& character : read.characters) {
    held[character.id].push_back(character.told_hand_load.both_kg);
  }
  ASSERT_EQ(held.size(), 2U);
  EXPECT_EQ(held[0].front(), 5);
  EXPECT_EQ(held[0].back(), 8);
  EXPECT_EQ(held[1].front(), 2);
}

}  // namespace
}  // namespace kinescope::ros_bridge
