// What Gazebo makes of our URDF: its own converter (libsdformat) reads it.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sdf/Link.hh>
#include <sdf/Model.hh>
#include <sdf/ParserConfig.hh>
#include <sdf/Root.hh>

#include "tests/system/kinescope_path.h"
#include "tests/system/run_program.h"
#include "tests/temp_folder.h"
#include "urdf/human_urdf.h"

namespace kinescope {
namespace {

struct Simulated {
  std::size_t links = 0, joints = 0;
  double mass = 0;
  double smallest_inertia = 1e9;
};

Simulated InGazebo(const std::string& urdf_file) {
  sdf::ParserConfig config;
  config.SetWarningsPolicy(sdf::EnforcementPolicy::LOG);
  sdf::Root root;
  for (const sdf::Error& error : root.Load(urdf_file, config)) ADD_FAILURE() << error.Message();
  Simulated out;
  const sdf::Model* model = root.Model();
  if (model == nullptr) {
    ADD_FAILURE() << "no model in " << urdf_file;
    return out;
  }
  out.links = model->LinkCount();
  out.joints = model->JointCount();
  for (std::size_t i = 0; i < out.links; ++i) {
    const auto& inertial = model->LinkByIndex(i)->Inertial().MassMatrix();
    EXPECT_TRUE(inertial.IsValid()) << model->LinkByIndex(i)->Name();
    out.mass += inertial.Mass();
    out.smallest_inertia = std::min(out.smallest_inertia, inertial.PrincipalMoments().Min());
  }
  return out;
}

urdf::HumanModel Gloved() {
  urdf::HumanModel human;
  human.skeleton = urdf::DefaultSkeleton();
  human.body = urdf::MakeBodyParameters({}, human.skeleton);
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    human.gloves[side] = urdf::DefaultHand(side, human.skeleton.finger_tip_in_hand[side].norm());
  }
  human.props = 0b1111;
  return human;
}

TEST(Gazebo, KeepsEveryLinkAndTheMassOfAPersonWrittenForGazebo) {
  const testing::TempFolder folder;
  const std::string file = folder / "person.urdf";
  const auto written =
      testing::RunProgram({testing::KinescopePath(), "urdf", "--gazebo", "--body_model",
                           "primitive", "--mass", "81", "--out", file});
  ASSERT_EQ(written.exit_code, 0) << written.err;
  const Simulated person = InGazebo(file);
  EXPECT_EQ(person.links, 67u);
  EXPECT_EQ(person.joints, 66u);
  EXPECT_NEAR(person.mass, 81, 1e-9);
  EXPECT_GT(person.smallest_inertia, 0);
  const auto checked = testing::RunProgram({KINESCOPE_CHECK_URDF, file});
  EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;
}

TEST(Gazebo, KeepsGlovesAndPropsToo) {
  const testing::TempFolder folder;
  urdf::HumanModel human = Gloved();
  human.mass_inside_joints = true;
  std::ofstream(folder / "person.urdf") << urdf::WriteUrdf(human);
  const Simulated person = InGazebo(folder / "person.urdf");
  EXPECT_EQ(person.links, 67u + 2 * 60 + 4 * 6);
  EXPECT_EQ(person.joints, person.links - 1);
  EXPECT_NEAR(person.mass, urdf::TotalMass(human.body), 1e-9);
  EXPECT_GT(person.smallest_inertia, 0);
}

// Why the flag is there; should this ever fail, Gazebo has learnt to do without.
TEST(Gazebo, KeepsOnlyThePelvisOfAPersonWithMasslessLinks) {
  const testing::TempFolder folder;
  std::ofstream(folder / "person.urdf") << urdf::WriteUrdf(Gloved());
  EXPECT_EQ(InGazebo(folder / "person.urdf").links, 1u);
}

}  // namespace
}  // namespace kinescope
