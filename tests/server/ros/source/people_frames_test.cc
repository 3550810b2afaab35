#include "server/ros/source/people_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace kinescope::ros_bridge {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

std::vector<std::string> NamesOf(const PeopleFrames& frames) {
  std::vector<std::string> names;
  for (const PersonFrames& person : frames.people()) names.push_back(person.name);
  return names;
}

TEST(PeopleFrames, PreferTheLongestCommonSuffixAndTheShortestName) {
  PeopleFrames frames;
  for (const urdf::SegmentInfo& segment : urdf::kSegments) {
    frames.Add(std::string(segment.link_name) + "_of_suit");
    frames.Add("lab/" + std::string(segment.link_name));
  }
  for (const char* other : {"head", "left_hand", "lab/left_hand_marker", "heading_of_suit"}) {
    frames.Add(other);
  }
  frames.Find();
  EXPECT_THAT(NamesOf(frames), UnorderedElementsAre("of_suit", "lab"));
  EXPECT_EQ(frames.PlaceOf("left_hand").person, -1);
  EXPECT_EQ(frames.PlaceOf("lab/left_hand_marker").person, -1);
  EXPECT_EQ(frames.PlaceOf("lab/left_hand").slot, urdf::kLeftHand);
  EXPECT_EQ(frames.PlaceOf("heading_of_suit").person, -1) << "a head is a word of its own";
}

TEST(PeopleFrames, FindNoPersonInTwentyTwoSegments) {
  PeopleFrames frames;
  for (int segment = 1; segment < urdf::kSegmentCount; ++segment) {
    frames.Add("a_" + std::string(urdf::kSegments[urdf::At(segment)].link_name));
  }
  frames.Find();
  EXPECT_THAT(frames.people(), IsEmpty());
  frames.Add("a_pelvis");
  frames.Find();
  EXPECT_THAT(NamesOf(frames), ElementsAre("a"));
}

TEST(PeopleFrames, KeepALimitedNumberOfNames) {
  PeopleFrames frames;
  for (int i = 0; i < 3 * static_cast<int>(PeopleFrames::kMaxNames); ++i) {
    frames.Add("p" + std::to_string(i) + "_pelvis");
  }
  EXPECT_FALSE(frames.IsCandidate("p" + std::to_string(2 * PeopleFrames::kMaxNames) + "_pelvis"));
  EXPECT_FALSE(frames.Add(std::string(300, 'x') + "_pelvis"));
  frames.Find();
  EXPECT_THAT(frames.people(), IsEmpty());
}

}  // namespace
}  // namespace kinescope::ros_bridge
