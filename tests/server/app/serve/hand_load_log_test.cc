#include "server/app/serve/hand_load_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "core/system/clocks.h"
#include "core/system/latest.h"
#include "server/marks/mark_book.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

HandLoad InRightHand(double kilograms) {
  HandLoad load;
  load.is_known = true;
  load.mass_kg[urdf::kRight] = kilograms;
  return load;
}

class HandLoadMarks : public ::testing::Test {
 protected:
  std::vector<std::string> marks() const {
    std::vector<std::string> lines;
    for (const marks::Mark& mark : book_.ChangedAfter(0, 100)) {
      lines.push_back(mark.role + ": " + mark.text);
    }
    return lines;
  }

  testing::TempFolder folder_;
  marks::MarkBook book_{{folder_ / "marks.jsonl", {}}};
  Latest<SceneState> states_;
  OperatorLog log_{&book_, states_};
  HandLoadLog held_{log_, HandLoad()};
};

TEST_F(HandLoadMarks, OfRosAreMarkedAsThoseOfOperatorsAre) {
  held_.OnOrder(0, "Ann", InRightHand(5), "operator");
  held_.OnRos(0, "Ann", InRightHand(7), kNanosPerSecond);
  EXPECT_THAT(marks(), ElementsAre("operator: hand load of Ann: unknown → 5 kg right",
                                   "ros: hand load of Ann: 5 kg right → 7 kg right"));
  EXPECT_EQ(held_.all().at(0).by, "ROS");
  EXPECT_EQ(held_.Of(0).mass_kg[urdf::kRight], 7);
}

TEST_F(HandLoadMarks, HaveWhatTheNodeOfTheSuitWasToldAsTheValueBefore) {
  held_.OnRos(0, "Ann", InRightHand(9), kNanosPerSecond, InRightHand(2));
  held_.OnOrder(1, "Ben", InRightHand(4), "operator", InRightHand(3));
  held_.OnOrder(1, "Ben", InRightHand(5), "operator", InRightHand(3));
  EXPECT_THAT(marks(), ElementsAre("ros: hand load of Ann: 2 kg right → 9 kg right",
                                   "operator: hand load of Ben: 3 kg right → 4 kg right",
                                   "operator: hand load of Ben: 4 kg right → 5 kg right"));
}

TEST_F(HandLoadMarks, ThatComManyTimesASecondAreMarkedOnceASecondAndTheLastOneIs) {
  for (int i = 1; i <= 250; ++i)
    held_.OnRos(0, "Ann", InRightHand(i), kNanosPerSecond + i * kNanosPerSecond / 100);
  EXPECT_THAT(marks(), ElementsAre("ros: hand load of Ann: unknown → 1 kg right",
                                   "ros: hand load of Ann: 1 kg right → 101 kg right",
                                   "ros: hand load of Ann: 101 kg right → 201 kg right"));
  held_.OnTime(4 * kNanosPerSecond);
  EXPECT_EQ(marks().size(), 3u) << "not a second later";
  held_.OnTime(5 * kNanosPerSecond);
  held_.OnTime(9 * kNanosPerSecond);
  ASSERT_EQ(marks().size(), 4u);
  EXPECT_EQ(marks().back(), "ros: hand load of Ann: 201 kg right → 250 kg right");
}

TEST_F(HandLoadMarks, ThatWaitAreMarkedBeforeThatOfAnOperator) {
  held_.OnRos(0, "Ann", InRightHand(1), kNanosPerSecond);
  held_.OnRos(0, "Ann", InRightHand(2), kNanosPerSecond);
  held_.OnOrder(0, "Ann", InRightHand(3), "operator");
  EXPECT_THAT(marks(), ElementsAre("ros: hand load of Ann: unknown → 1 kg right",
                                   "ros: hand load of Ann: 1 kg right → 2 kg right",
                                   "operator: hand load of Ann: 2 kg right → 3 kg right"));
}

TEST_F(HandLoadMarks, HaveTheSampleAtWhichTheLoadCameNotThatOfTheMark) {
  const auto publish = [&](std::uint64_t number) {
    SceneState state;
    state.number = number;
    state.stamp_nanos = 1;
    states_.Publish(std::make_shared<const SceneState>(state));
  };
  publish(10);
  held_.OnRos(0, "Ann", InRightHand(1), kNanosPerSecond);
  publish(20);
  held_.OnRos(0, "Ann", InRightHand(2), kNanosPerSecond + 1);
  publish(30);
  held_.OnRos(0, "Ann", InRightHand(2), kNanosPerSecond + 2);
  publish(240);
  held_.OnTime(2 * kNanosPerSecond);
  const std::vector<marks::Mark> all = book_.ChangedAfter(0, 100);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[1].at.state, 20u);
}

TEST_F(HandLoadMarks, OfTheNoiseOfALoadCellAreNotMade) {
  held_.OnRos(0, "Ann", InRightHand(5), kNanosPerSecond);
  for (int i = 2; i < 100; ++i)
    held_.OnRos(0, "Ann", InRightHand(5 + 0.0009 * i), i * kNanosPerSecond);
  EXPECT_EQ(marks().size(), 1u);
  held_.OnRos(0, "Ann", InRightHand(5.125), 100 * kNanosPerSecond);
  ASSERT_EQ(marks().size(), 2u);
  EXPECT_EQ(marks().back(), "ros: hand load of Ann: 5 kg right → 5.125 kg right");
}

TEST_F(HandLoadMarks, ThatWaitAreMadeBeforeTheEnd) {
  held_.OnRos(0, "Ann", InRightHand(1), kNanosPerSecond);
  held_.OnRos(0, "Ann", InRightHand(2), kNanosPerSecond);
  held_.Flush();
  EXPECT_EQ(marks().size(), 2u);
}

TEST_F(HandLoadMarks, ThatAreAsBeforeAreNoChange) {
  held_.OnRos(0, "Ann", HandLoad(), kNanosPerSecond);
  EXPECT_THAT(marks(), IsEmpty());
  held_.OnRos(0, "Ann", InRightHand(1), kNanosPerSecond);
  EXPECT_EQ(marks().size(), 1u) << "and nobody waits for it";
}

}  // namespace
}  // namespace kinescope::app
