#include "urdf/body_parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <map>

namespace kinescope::urdf {
namespace {

TEST(BodyParameters, EqualThoseOfTheReferencePerson) {  // joint-loads.md 6.1: male, 75 kg, R75
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
  EXPECT_LT((body[kRightUpperArm].inertia_about_com.diagonal() - upper_arm).norm(), 2e-5);
  EXPECT_LT((body[kHead].inertia_about_com.diagonal() - head).norm(), 2e-5);
}

TEST(BodyParameters, AddUpToTheBodyMassOfAWoman) {
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

constexpr BodyTable kEveryTable[] = {BodyTable::kDeLeva, BodyTable::kWinter, BodyTable::kDumas,
                                     BodyTable::kIit};

BodyDescription Described(BodyTable table, Sex sex) {
  BodyDescription body;
  body.table = table;
  body.sex = sex;
  return body;
}

TEST(BodyParameters, ArePhysicallyPossible) {  // triangle inequality of every inertia tensor
  for (const BodyTable table : kEveryTable) {
    for (const Sex sex : {Sex::kMale, Sex::kFemale}) {
      for (const double height : {1.2, 1.75, 2.1}) {
        BodyDescription body = Described(table, sex);
        body.added_masses = {{kHead, 1.5, {0.03, 0, 0.1}}, {kT8, 20, {-0.2, 0.01, 0}}};
        for (const SegmentInertia& s : MakeBodyParameters(body, DefaultSkeleton(height))) {
          const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(s.inertia_about_com);
          const Eigen::Vector3d i = solver.eigenvalues();
          EXPECT_GT(i.minCoeff(), 0);
          EXPECT_LE(2 * i.maxCoeff(), i.sum() * (1 + 1e-9)) << Name(table);
        }
      }
    }
  }
}

TEST(BodyParameters, AddUpToTheBodyMassAndAreSymmetricInEveryTable) {
  for (const BodyTable table : kEveryTable) {
    for (const Sex sex : {Sex::kMale, Sex::kFemale}) {
      const BodyParameters body = MakeBodyParameters(Described(table, sex), DefaultSkeleton());
      EXPECT_NEAR(TotalMass(body), 75, 1e-9) << Name(table);
      for (const int right : {kRightShoulder, kRightUpperArm, kRightForeArm, kRightHand,
                              kRightUpperLeg, kRightLowerLeg, kRightFoot, kRightToe}) {
        if (table == BodyTable::kDumas && right == kRightShoulder) continue;  // as published
        const SegmentInertia &one = body[At(right)], &other = body[At(right + 4)];
        EXPECT_NEAR(one.mass, other.mass, 1e-12);
        const Eigen::Vector3d mirrored = other.com_in_link.cwiseProduct(Eigen::Vector3d(1, -1, 1));
        EXPECT_LT((one.com_in_link - mirrored).norm(), 1e-12)
            << Name(table) << " " << kSegments[At(right)].link_name;
      }
    }
  }
}

// joint-loads.md 1.5 quotes it of every table, in percent: it decides the lumbar moment.
TEST(BodyParameters, HaveTheMassAboveTheLumbarJointOfTheirSources) {
  const auto above = [](BodyTable table, Sex sex) {
    const BodyParameters body = MakeBodyParameters(Described(table, sex), DefaultSkeleton());
    double mass = 0;
    for (int i = kL5; i <= kLeftHand; ++i) mass += body[At(i)].mass;
    return 100 * mass / TotalMass(body);
  };
  EXPECT_NEAR(above(BodyTable::kDeLeva, Sex::kMale), 49.4, 0.06);
  EXPECT_NEAR(above(BodyTable::kDeLeva, Sex::kFemale), 48.8, 0.06);
  EXPECT_NEAR(above(BodyTable::kDumas, Sex::kMale), 49.3, 0.06);
  EXPECT_NEAR(above(BodyTable::kDumas, Sex::kFemale), 45.1, 0.06);
  EXPECT_NEAR(above(BodyTable::kWinter, Sex::kMale), 53.6, 0.06);
  EXPECT_NEAR(above(BodyTable::kIit, Sex::kFemale), 56.8, 0.06);
}

// Where the coarser tables give one CoM for what are several segments of ours.
TEST(BodyParameters, HaveTheCentresOfMassOfTheirTables) {
  const Skeleton skeleton = DefaultSkeleton();
  const auto origin = NPoseOrigins(skeleton);
  const auto common = [&](const BodyParameters& body, std::initializer_list<int> segments) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double mass = 0;
    for (const int i : segments) {
      sum += body[At(i)].mass * (origin[At(i)] + body[At(i)].com_in_link);
      mass += body[At(i)].mass;
    }
    return Eigen::Vector3d(sum / mass);
  };
  const BodyParameters dumas =
      MakeBodyParameters(Described(BodyTable::kDumas, Sex::kMale), skeleton);
  const double thorax = (origin[kNeck] - origin[kT12]).norm();
  const Eigen::Vector3d thorax_com =
      common(dumas, {kT12, kT8, kRightShoulder, kLeftShoulder}) - origin[kNeck];
  EXPECT_LT((thorax_com / thorax - Eigen::Vector3d(0, 0.004, -0.555)).norm(), 1e-9);
  const double abdomen = (origin[kT12] - origin[kL5]).norm();
  EXPECT_LT(
      ((common(dumas, {kL5, kL3}) - origin[kT12]) / abdomen - Eigen::Vector3d(0.173, 0.003, -0.361))
          .norm(),
      1e-9);
  // The right palm looks at the body: what ISB calls forward of the hand is our +y.
  EXPECT_LT((dumas[kRightHand].com_in_link / 0.190 - Eigen::Vector3d(0.032, 0.035, -0.357)).norm(),
            1e-9);
  const double foot = skeleton.origin_in_parent[kRightToe].norm();
  EXPECT_LT(((common(dumas, {kRightFoot, kRightToe}) - origin[kRightFoot]) / foot -
             Eigen::Vector3d(0.382, -0.026, -0.151))
                .norm(),
            1e-9);
  const BodyParameters winter =
      MakeBodyParameters(Described(BodyTable::kWinter, Sex::kMale), skeleton);
  EXPECT_NEAR(winter[kRightUpperLeg].com_in_link.z(), -0.433 * 0.465, 1e-12);
  EXPECT_NEAR(winter[kRightUpperLeg].inertia_about_com(0, 0), 7.5 * 0.323 * 0.323 * 0.465 * 0.465,
              1e-9);
}

TEST(BodyParameters, IncludeAddedMasses) {
  BodyDescription body;
  body.added_masses = {{kHead, 1.5, {0, 0, 0.2}}, {kHead, 0.5, {0.1, 0, 0.1}}};
  const BodyParameters bare = MakeBodyParameters({}, DefaultSkeleton());
  const BodyParameters worn = MakeBodyParameters(body, DefaultSkeleton());
  EXPECT_NEAR(TotalMass(worn), 77, 1e-9);
  const SegmentInertia &before = bare[kHead], &after = worn[kHead];
  EXPECT_NEAR(after.mass, before.mass + 2, 1e-12);
  const Eigen::Vector3d moment = before.mass * before.com_in_link +
                                 1.5 * Eigen::Vector3d(0, 0, 0.2) +
                                 0.5 * Eigen::Vector3d(0.1, 0, 0.1);
  EXPECT_LT((after.mass * after.com_in_link - moment).norm(), 1e-12);
  // About the link's origin inertias simply add up (the trace of a point's is 2 m r^2).
  const auto about_origin = [](const SegmentInertia& s) {
    return s.inertia_about_com.trace() + 2 * s.mass * s.com_in_link.squaredNorm();
  };
  EXPECT_NEAR(about_origin(after) - about_origin(before), 2 * (1.5 * 0.04 + 0.5 * 0.02), 1e-12);
  EXPECT_EQ(worn[kT8].mass, bare[kT8].mass);
}

TEST(BodyParameters, RejectImpossibleAddedMassesByName) {
  const auto defect = [](AddedMass added) {
    BodyDescription body;
    body.added_masses = {added};
    return FindDefect(body);
  };
  EXPECT_EQ(defect({kHead, 1.5, {0, 0, 0.1}}), "");
  EXPECT_THAT(defect({kHead, -1, {0, 0, 0}}), ::testing::HasSubstr("-1 kg on head"));
  EXPECT_THAT(defect({kHead, std::nan(""), {0, 0, 0}}), ::testing::HasSubstr("nan kg on head"));
  EXPECT_THAT(defect({kPelvis, 500, {0, 0, 0}}), ::testing::HasSubstr("500 kg on pelvis"));
  EXPECT_THAT(defect({kT8, 5, {0, 30, 0}}), ::testing::HasSubstr("within 2 m"));
  EXPECT_THAT(defect({kT8, 5, {0, std::nan(""), 0}}), ::testing::HasSubstr("within 2 m"));
  EXPECT_THAT(defect({23, 5, {0, 0, 0}}), ::testing::HasSubstr("segment 23"));
  BodyDescription many;
  many.added_masses.assign(kMaxAddedMasses + 1, {kHead, 1, {0, 0, 0}});
  EXPECT_THROW(MakeBodyParameters(many, DefaultSkeleton()), std::invalid_argument);
}

TEST(AddedMass, IsReadFromTextOrRejectedWithTheExpectedFormat) {
  const AddedMass helmet = ParseAddedMass("Head:1.5@0.01,0,0.12");
  EXPECT_EQ(helmet.segment, kHead);
  EXPECT_EQ(helmet.mass_kg, 1.5);
  EXPECT_EQ(helmet.position_in_link, Eigen::Vector3d(0.01, 0, 0.12));
  EXPECT_EQ(ParseAddedMass("right_forearm:0.3").segment, kRightForeArm);
  for (const char* text :
       {"", "head", "head:", ":1", "hat:1", "head:1kg", "head:-1", "head:nan", "head:1@",
        "head:1@1,2", "head:1@0,0,0,0", "head:1@0,0,x", "head:1@0,0,9", "head:500"}) {
    try {
      ParseAddedMass(text);
      ADD_FAILURE() << "took '" << text << "'";
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("expected SEGMENT:KG or SEGMENT:KG@X,Y,Z"));
    }
  }
}

TEST(BodyParameters, RejectImpossibleBodyMasses) {
  for (const double mass : {0.0, -70.0, 19.9, 301.0, std::nan("")}) {
    EXPECT_THROW(MakeBodyParameters({Sex::kMale, mass, false}, DefaultSkeleton()),
                 std::invalid_argument)
        << mass;
  }
}

}  // namespace
}  // namespace kinescope::urdf
