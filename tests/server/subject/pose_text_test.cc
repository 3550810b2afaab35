#include "server/subject/pose_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/system/errors.h"
#include "server/subject/subject.h"

namespace kinescope::subject {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string Complaint(const std::string& text) {
  try {
    ParsePose(text);
  } catch (const SourceError& error) {
    return error.what();
  }
  return "";
}

std::size_t CountWritten(const WrittenPose& pose) {
  return static_cast<std::size_t>(std::count_if(
      pose.values.begin(), pose.values.end(), [](const auto& value) { return value.has_value(); }));
}

TEST(PoseText, HasABaseAndAnglesOfJoints) {
  const WrittenPose pose = ParsePose(
      "t_pose,right_elbow=90,left_hip_abduction=-12.5,l5_s1_axial_rotation=+5,"
      "vertical_pelvis=10,heading=-45,x=1e0,y=.5");
  EXPECT_EQ(pose.base, "t_pose");
  EXPECT_EQ(pose.values[AngleOf(urdf::jRightElbow, 2)], 90) << "a joint alone is its flexion";
  EXPECT_EQ(pose.values[AngleOf(urdf::jLeftHip, 0)], -12.5);
  EXPECT_EQ(pose.values[AngleOf(urdf::jL5S1, 1)], 5);
  EXPECT_EQ(pose.values[kPelvisFlexion], 10);
  EXPECT_EQ(pose.values[kHeading], -45);
  EXPECT_EQ(pose.values[kPlaceX], 1);
  EXPECT_EQ(pose.values[kPlaceY], 0.5);
  EXPECT_EQ(CountWritten(pose), 7u);
  EXPECT_EQ(ParsePose("right_knee_flexion=3").base, "n_pose");
  for (const std::string& base : StaticPoseNames()) EXPECT_EQ(ParsePose(base).base, base);
}

// As YAML folds a long line, or keeps its breaks.
TEST(PoseText, MayHaveBlanksAndLineBreaks) {
  const WrittenPose pose = ParsePose(" t_pose,\n  right_elbow = 90,\r\n\tleft_knee=\t45 \n");
  EXPECT_EQ(pose.text, "t_pose,right_elbow=90,left_knee=45");
  EXPECT_EQ(ParsePose(pose.text).text, pose.text);
  EXPECT_EQ(CountWritten(pose), 2u);
  EXPECT_THAT(Complaint("right elbow=90"), HasSubstr("nearest: right_elbow"));
}

TEST(PoseText, TakesEveryAngleOnce) {
  for (const char* twice :
       {"right_knee=45,right_knee_flexion=30", "heading=1,left_knee=2,heading=1"}) {
    EXPECT_THAT(Complaint(twice), HasSubstr("was written before, as ")) << twice;
  }
  EXPECT_EQ(Complaint("right_knee=45,right_knee_rotation=5,left_knee=45"), "");
  EXPECT_THAT(Complaint("right_knee=45,left_knee=1,right_knee_flexion=30"),
              AllOf(HasSubstr("entry 3, 'right_knee_flexion=30'"), HasSubstr("'right_knee=45'")));
}

TEST(PoseText, NamesTheNearestJointOrAxis) {
  EXPECT_EQ(Complaint("right_knee=4,rigth_elbow=90"),
            "pose: entry 2, 'rigth_elbow=90': unknown joint; nearest: right_elbow");
  EXPECT_THAT(Complaint("jRightElbow=90"), HasSubstr("nearest: right_elbow"));
  EXPECT_THAT(Complaint("left_hip_abductoin=9"),
              AllOf(HasSubstr("unknown axis of left_hip; expected abduction, rotation or flexion"),
                    HasSubstr("; nearest: abduction")));
  EXPECT_THAT(Complaint("t1_c7_abduction=9"), HasSubstr("lateral_bending, axial_rotation or"));
  EXPECT_THAT(Complaint("vertical_pelvis_axial_rotation=9"),
              HasSubstr("expected lateral_bending or flexion"));
  EXPECT_THAT(Complaint("thumb_of_the_third_hand=9"),
              AllOf(HasSubstr("l5_s1"), HasSubstr("left_ballfoot"), HasSubstr("heading")));
  EXPECT_THAT(Complaint("=9"), HasSubstr("unknown joint"));
}

TEST(PoseText, RejectsNumbersOutsideTheRangeOfTheJoint) {
  EXPECT_EQ(Complaint("right_knee=171"),
            "pose: entry 1, 'right_knee=171': expected -20 to 170 degrees");
  EXPECT_EQ(Complaint("right_knee=170,left_knee=-20"), "");
  for (const char* bad : {"nan", "inf", "-inf", "1e999", "", "9O", "90deg", "--9", "+-9", "0x9"}) {
    EXPECT_THAT(Complaint("right_knee=" + std::string(bad)),
                HasSubstr("not a number; expected -20 to 170 degrees"))
        << bad;
  }
  EXPECT_THAT(Complaint("x=101"), HasSubstr("expected -100 to 100 m"));
  EXPECT_THAT(Complaint("vertical_pelvis=90"), HasSubstr("expected -85 to 85 degrees"));
}

TEST(PoseText, HasItsBaseFirst) {
  EXPECT_THAT(Complaint("lift"), AllOf(HasSubstr("is a motion"), HasSubstr("n_pose")));
  EXPECT_THAT(Complaint("tpose"), AllOf(HasSubstr("unknown pose"), HasSubstr("nearest: t_pose")));
  EXPECT_THAT(Complaint("right_knee=4,t_pose"), HasSubstr("is the first entry"));
  EXPECT_THAT(Complaint("t_pose,right_knee"), HasSubstr("expected JOINT=DEGREES"));
  for (const char* empty : {"", " \n"})
    EXPECT_THAT(Complaint(empty), HasSubstr("nothing is written"));
  for (const char* comma : {"t_pose,", ",t_pose", "right_knee=4,,left_knee=4"}) {
    EXPECT_THAT(Complaint(comma), HasSubstr("remove one of the commas")) << comma;
  }
}

TEST(PoseText, IsBounded) {
  const std::string longest = "n_pose" + std::string(kMaxPoseChars - 6, ' ');
  EXPECT_EQ(Complaint(longest), "");
  EXPECT_THAT(Complaint(longest + " "), HasSubstr("4097 bytes; expected at most 4096"));
  EXPECT_LT(Complaint(std::string(kMaxPoseChars, 'x')).size(), 400u);
}

// Errors are written to terminals and logs.
TEST(PoseText, CannotSteerATerminal) {
  EXPECT_THAT(Complaint("a\x1b[2J\nb=1"), AllOf(Not(HasSubstr("\x1b")), Not(HasSubstr("\n"))));
}

}  // namespace
}  // namespace kinescope::subject
