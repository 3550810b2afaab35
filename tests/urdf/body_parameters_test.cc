#include "urdf/body_parameters.h"

#include <gtest/gtest.h>

#include <map>

namespace kinescope::urdf {
namespace {

TEST(BodyParameters, AreThoseOfTheReferencePerson) {  // joint-loads.md 6.1: male, 75 kg, R75
  const BodyParameters body = MakeBodyParameters({}, DefaultSkeleton());
  struct Expected {
    int segment;
    double mass;
    Eigen::Vector3d com;
  };
  const Expected rows[] = {{kPelvis, 8.1600, {0, 0, 0.0432}},
                           {kL5, 5.2200, {0, 0, 0.0495}},
                           {kL3, 6.6450, {0, 0, 0.04212}},
                           {kT12, 5.2425, {0, 0, 0.03726}},
                           {kT8, 4.3350, {0, 0, 0.04988}},
                           {kNeck, 1.0425, {0, 0, 0.047}},
                           {kHead, 4.1625, {0, 0, 0.0855}},
                           {kRightShoulder, 1.49625, {0, -0.075, 0}},
                           {kLeftShoulder, 1.49625, {0, 0.075, 0}},
                           {kRightUpperArm, 2.0325, {0, 0, -0.17316}},
                           {kLeftForeArm, 1.2150, {0, 0, -0.11435}},
                           {kRightHand, 0.4575, {0, 0, -0.06886}},
                           {kLeftUpperLeg, 10.620, {0, 0, -0.19042}},
                           {kRightLowerLeg, 3.2475, {0, 0, -0.19558}},
                           {kLeftFoot, 0.92475, {0.05944, 0, -0.040}},
                           {kRightToe, 0.10275, {0.035, 0, 0}}};
  for (const Expected& row : rows) {
    const SegmentInertia& segment = body[static_cast<std::size_t>(row.segment)];
    EXPECT_NEAR(segment.mass, row.mass, 1e-9) << "segment " << row.segment;
    EXPECT_LT((segment.com_in_link - row.com).norm(), 1e-5) << "segment " << row.segment;
  }
  EXPECT_NEAR(TotalMass(body), 75.0, 1e-9);
  const Eigen::Vector3d upper_arm(.01486, .01324, .00457), head(.01352, .01539, .01636);
  EXPECT_LT((body[kRightUpperArm].inertia_about_com - upper_arm).norm(), 2e-5);
  EXPECT_LT((body[kHead].inertia_about_com - head).norm(), 2e-5);
}

TEST(BodyParameters, OfAWomanAddUpToHerMass) {
  BodyDescription woman;
  woman.sex = Sex::kFemale;
  woman.mass_kg = 60;
  const BodyParameters body = MakeBodyParameters(woman, DefaultSkeleton(1.65));
  const double expected[kSegmentCount] = {5.6406, 4.3804, 4.7945, 4.5665, 3.8464, 0.8041,
                                          3.2043, 1.1581, 1.5302, 0.8281, 0.3360, 1.1581,
                                          1.5302, 0.8281, 0.3360, 8.8689, 2.8863, 0.6967,
                                          0.0774, 8.8689, 2.8863, 0.6967, 0.0774};
  for (std::size_t i = 0; i < body.size(); ++i) EXPECT_NEAR(body[i].mass, expected[i], 6e-5);
  EXPECT_NEAR(TotalMass(body), 60.0, 1e-9);
}

TEST(BodyParameters, AreBodiesThatCanExist) {  // triangle inequality of every inertia tensor
  for (const double height : {1.2, 1.75, 2.1}) {
    for (const SegmentInertia& s : MakeBodyParameters({}, DefaultSkeleton(height))) {
      const Eigen::Vector3d& i = s.inertia_about_com;
      EXPECT_GT(i.minCoeff(), 0);
      EXPECT_LE(2 * i.maxCoeff(), i.sum() * (1 + 1e-9));
    }
  }
}

TEST(BodyParameters, RefuseAMassThatNobodyHas) {
  for (const double mass : {0.0, -70.0, 19.9, 301.0, std::nan("")}) {
    EXPECT_THROW(MakeBodyParameters({Sex::kMale, mass, false}, DefaultSkeleton()),
                 std::invalid_argument)
        << mass;
  }
  EXPECT_THROW(ParseSex("Male"), std::invalid_argument);
  EXPECT_EQ(ParseSex("female"), Sex::kFemale);
}

}  // namespace
}  // namespace kinescope::urdf
