// Rigged people of the user's, read from GLBs that the tests make: fitted to people as the built-in
// skin is, and refused by name.
#include "urdf/rig/rigged_skin.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/urdf/rig/rig_samples.h"
#include "urdf/rig/rig.h"
#include "urdf/rig/usual_names.h"
#include "urdf/skin/frames.h"
#include "urdf/skin/occlusion.h"
#include "urdf/skin/person_skin.h"

namespace kinescope::rig {
namespace {

using Eigen::Vector3d;
using nlohmann::json;
using skin::PersonSkin;
using skin::SkinTemplate;
using testing::BoneNames;
using testing::RigGlb;
using testing::RigSample;
using urdf::At;

SkinTemplate Read(const RigSample& sample = {}) { return SkinOf(ReadRig(RigGlb(sample))); }

std::string WhyRefused(const std::string& glb) {
  try {
    SkinOf(ReadRig(glb));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

RigSample Edited(std::function<void(json& document, std::string& binary)> edit) {
  RigSample sample;
  sample.edit = std::move(edit);
  return sample;
}

// Largest distance of a vertex of one skin to the nearest of the other, m.
double Farthest(const SkinTemplate& a, const SkinTemplate& b) {
  float most = 0;
  for (const auto& [of, among] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    constexpr std::size_t kStep = 5;  // a sample is enough
    for (std::size_t i = 0; i < of->size(); i += kStep) {
      const Eigen::Vector3f& p = of->corners[0][i];
      float least = std::numeric_limits<float>::infinity();
      for (const Eigen::Vector3f& other : among->corners[0]) {
        least = std::min(least, (other - p).squaredNorm());
      }
      most = std::max(most, least);
    }
  }
  return std::sqrt(static_cast<double>(most));
}

// Mean distance of the vertices of `limb` from the line along its bone, relative to the person, m.
double Thickness(const SkinTemplate& of, const PersonSkin::Surface& surface,
                 const urdf::LinkPoses& links, int segment, const Vector3d& end) {
  double sum = 0;
  int count = 0;
  const Vector3d from = links[At(segment)].position, along = (end - from).normalized();
  for (std::size_t i = 0; i < of.size(); ++i) {
    if (skin::Frames()[of.weights[i].frames[0]].segment != segment) continue;
    const Vector3d p = surface.positions[i].cast<double>() - from;
    const double t = p.dot(along);
    if (t < 0.05 || t > (end - from).norm() - 0.05) continue;
    sum += (p - t * along).norm();
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

TEST(RiggedSkin, IsTheSameWhateverNamesItsBonesHave) {
  RigSample sample;
  sample.names = BoneNames::kMixamo;
  const SkinTemplate mixamo = Read(sample);
  EXPECT_GT(mixamo.size(), 1000u);
  sample.names = BoneNames::kVrm0;
  EXPECT_LT(Farthest(mixamo, Read(sample)), 1e-4);
  sample.names = BoneNames::kVrm1;
  EXPECT_LT(Farthest(mixamo, Read(sample)), 1e-4);
  sample.names = BoneNames::kMvn;
  EXPECT_LT(Farthest(mixamo, Read(sample)), 1e-4);
}

TEST(RiggedSkin, IsTheSameWhateverItsUnitSizeAndAxesAre) {
  const SkinTemplate one = Read();
  RigSample sample;
  sample.units_per_metre = 100;
  EXPECT_LT(Farthest(one, Read(sample)), 1e-4) << "in centimetres";
  sample.units_per_metre = 1;
  sample.height = 1.1;
  EXPECT_LT(Farthest(one, Read(sample)), 0.03) << "a child: mixed parts are relatively longer";
  sample = {};
  sample.axes = Eigen::Matrix3d::Identity();
  EXPECT_LT(Farthest(one, Read(sample)), 1e-4) << "z up, x forward";
  sample.axes = Eigen::AngleAxisd(2, Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_LT(Farthest(one, Read(sample)), 1e-4) << "z up, askew";
}

TEST(RiggedSkin, BringsTheArmsOfAnAPoseToTheBindPose) {
  const SkinTemplate t_pose = Read();
  RigSample sample;
  sample.arms_down_deg = 45;
  const SkinTemplate a_pose = Read(sample);
  EXPECT_LT(Farthest(t_pose, a_pose), 0.012) << "m, where the tubes meet the trunk";
  sample.arms_down_deg = 48;  // already in the bind pose
  sample.arm_stretch = 1.3;
  EXPECT_LT(Farthest(Read(sample), a_pose), 0.03) << "the stretch of the arms is undone";
}

// For people of many sizes: limbs end at their joints, and keep their girth.
TEST(RiggedSkin, FitsTheMeasuredLengths) {
  const SkinTemplate rigged = Read();
  for (const double height : {0.9, 1.75, 2.2}) {
    const urdf::Skeleton skeleton = urdf::DefaultSkeleton(height);
    const PersonSkin person(rigged, {}, skeleton);
    PersonSkin::Surface surface;
    const urdf::LinkPoses links = urdf::ForwardKinematics(skeleton, {}, {});
    person.Pose(links, {}, surface);
    const double thickness =
        Thickness(rigged, surface, links, urdf::kLeftForeArm, links[urdf::kLeftHand].position);
    EXPECT_NEAR(thickness, 0.04 * height / 1.75, 0.006 * height / 1.75) << height;
    double lowest = 10, highest = -10;
    for (const Eigen::Vector3f& p : surface.positions) {
      lowest = std::min(lowest, static_cast<double>(p.z()));
      highest = std::max(highest, static_cast<double>(p.z()));
    }
    EXPECT_NEAR(highest - lowest, height, 0.05 * height);
    EXPECT_NEAR(lowest, urdf::LowestSolePoint(skeleton, links), 0.01 * height);
  }
}

TEST(RiggedSkin, KeepsTheGirthOfABentElbow) {
  const SkinTemplate rigged = Read();
  const PersonSkin person(rigged, {}, urdf::DefaultSkeleton());
  urdf::JointAngles angles{};
  angles[urdf::jLeftElbow].y() = -M_PI / 2;
  PersonSkin::Surface straight, bent;
  person.Pose(urdf::ForwardKinematics(urdf::DefaultSkeleton(), {}, {}), {}, straight);
  person.Pose(urdf::ForwardKinematics(urdf::DefaultSkeleton(), {}, angles), {}, bent);
  const auto volume = [&](const PersonSkin::Surface& of) {
    double sum = 0;
    for (const skin::Triangle& t : rigged.triangles) {
      const auto p = [&](int i) { return of.positions[t[At(i)]].cast<double>(); };
      sum += Vector3d(p(0)).dot(Vector3d(p(1)).cross(Vector3d(p(2)))) / 6;
    }
    return sum;
  };
  EXPECT_GT(volume(straight), 0.02) << "triangles face outwards";
  EXPECT_NEAR(volume(bent) / volume(straight), 1, 0.004);
}

TEST(RiggedSkin, HasWholeWeightsAndFewRunsOfLimbs) {
  const SkinTemplate rigged = Read();
  for (const skin::VertexWeights& vertex : rigged.weights) {
    int sum = 0;
    for (const int weight : vertex.weights) sum += weight;
    ASSERT_EQ(sum, 255);
    for (const int frame : vertex.frames) ASSERT_LT(At(frame), skin::Frames().size());
  }
  EXPECT_LE(skin::LimbRunsOf(rigged.weights).size(), static_cast<std::size_t>(skin::kLimbs));
  ASSERT_EQ(rigged.colors.size(), rigged.size());
  EXPECT_NEAR(rigged.colors[0][2], 203, 1) << "0.6, linear, as sRGB";
}

TEST(RiggedSkin, TakesRigsWithoutClavicleNeckAndToes) {
  RigSample sample;
  sample.missing = {2, 3, 4, 6, 13, 14, 21};
  const SkinTemplate whole = Read(), lacking = Read(sample);
  EXPECT_LT(Farthest(whole, lacking), 0.12);
}

using Names = std::vector<std::pair<std::string, std::string>>;

// A rig whose bones have other names than Mixamo's: each beginning is replaced by the first pair
// that fits.
SkinTemplate ReadRenamed(const Names& names, const std::string& left, const std::string& right) {
  return Read(Edited([=](json& document, std::string&) {
    for (json& node : document["nodes"]) {
      const std::string name = node["name"];
      for (const auto& [mixamo, other] : names) {
        if (name == "mixamorig:" + mixamo) node["name"] = other;
        if (name == "mixamorig:Left" + mixamo)
          node["name"] = std::string(other).replace(other.find('?'), 1, left);
        if (name == "mixamorig:Right" + mixamo)
          node["name"] = std::string(other).replace(other.find('?'), 1, right);
      }
    }
  }));
}

TEST(RiggedSkin, TakesNamesThatBlenderMaxAndUnrealGive) {
  const SkinTemplate mixamo = Read();
  const Names unreal = {
      {"Hips", "pelvis"},         {"Spine", "spine_01"}, {"Spine1", "spine_02"},
      {"Spine2", "spine_03"},     {"Neck", "neck_01"},   {"Head", "head"},
      {"Shoulder", "clavicle_?"}, {"Arm", "upperarm_?"}, {"ForeArm", "lowerarm_?"},
      {"Hand", "hand_?"},         {"UpLeg", "thigh_?"},  {"Leg", "calf_?"},
      {"Foot", "foot_?"},         {"ToeBase", "ball_?"}};
  EXPECT_LT(Farthest(mixamo, ReadRenamed(unreal, "l", "r")), 1e-4);
  const Names max = {
      {"Hips", "Bip01 Pelvis"},         {"Spine", "Bip01 Spine"},    {"Spine1", "Bip01 Spine1"},
      {"Spine2", "Bip01 Spine2"},       {"Neck", "Bip01 Neck"},      {"Head", "Bip01 Head"},
      {"Shoulder", "Bip01 ? Clavicle"}, {"Arm", "Bip01 ? UpperArm"}, {"ForeArm", "Bip01 ? Forearm"},
      {"Hand", "Bip01 ? Hand"},         {"UpLeg", "Bip01 ? Thigh"},  {"Leg", "Bip01 ? Calf"},
      {"Foot", "Bip01 ? Foot"},         {"ToeBase", "Bip01 ? Toe0"}};
  EXPECT_LT(Farthest(mixamo, ReadRenamed(max, "L", "R")), 1e-4);
  const Names blender = {
      {"Hips", "DEF-spine"},          {"Spine", "DEF-spine.001"}, {"Spine1", "DEF-spine.002"},
      {"Spine2", "DEF-spine.003"},    {"Neck", "DEF-spine.004"},  {"Head", "DEF-spine.006"},
      {"Shoulder", "DEF-shoulder.?"}, {"Arm", "DEF-upper_arm.?"}, {"ForeArm", "DEF-forearm.?"},
      {"Hand", "DEF-hand.?"},         {"UpLeg", "DEF-thigh.?"},   {"Leg", "DEF-shin.?"},
      {"Foot", "DEF-foot.?"},         {"ToeBase", "DEF-toe.?"}};
  EXPECT_LT(Farthest(mixamo, ReadRenamed(blender, "L", "R")), 1e-4);
}

TEST(UsualName, IsThatOfABoneOfTheBodyOnly) {
  EXPECT_EQ(rig::UsualName("CC_Base_L_Upperarm"), "leftupperarm");
  EXPECT_EQ(rig::UsualName("B_Knee_Right"), "rightlowerleg");
  EXPECT_EQ(rig::UsualName("ValveBiped.Bip01_Head"), "head");
  for (const char* const other :
       {"upperarm_twist_01_l", "DEF-upper_arm.L.001", "ik_hand_r", "HindLeg_L_01", "Eye_Left", "",
        "Left_hand_Right", "spine_0001", "root"}) {
    EXPECT_EQ(rig::UsualName(other), "") << other;
  }
  EXPECT_EQ(rig::UsualName(std::string(1000, 'l')), "");
}

TEST(RiggedSkin, NamesTheMissingBones) {
  RigSample sample;
  sample.missing = {8, 12};
  const std::string why = WhyRefused(RigGlb(sample));
  EXPECT_THAT(why, ::testing::HasSubstr("leftLowerArm (Mixamo: LeftForeArm, MVN: LeftForeArm)"));
  EXPECT_THAT(why, ::testing::HasSubstr("leftFoot"));
  EXPECT_THAT(why, ::testing::HasSubstr("its bones are 'mixamorig:Hips'"));
  EXPECT_THAT(why, ::testing::Not(::testing::HasSubstr("rightFoot")));
}

TEST(RiggedSkin, NamesBonesOfNoLength) {
  const auto why_refused = [](const std::string& bone) {
    return WhyRefused(RigGlb(Edited([&](json& document, std::string&) {
      for (json& node : document["nodes"]) {
        if (node["name"] == "mixamorig:" + bone) node["translation"] = {0, 0, 0};
      }
    })));
  };
  for (const auto& [parent, bone] : {std::pair("LeftArm", "LeftForeArm"),
                                     {"LeftFoot", "LeftToeBase"},
                                     {"Spine2", "Neck"},
                                     {"Neck", "Head"}}) {
    EXPECT_THAT(why_refused(bone),
                ::testing::HasSubstr(
                    fmt::format("'mixamorig:{}' and 'mixamorig:{}' are at the", parent, bone)));
  }
}

TEST(RiggedSkin, RefusesExchangedSidesAndTwoPeople) {
  RigSample sample = Edited([](json& document, std::string&) {
    for (json& node : document["nodes"]) {
      std::string name = node["name"];
      const auto at = name.find("Left");
      const auto other = name.find("Right");
      if (at != std::string::npos) name.replace(at, 4, "Right");
      if (other != std::string::npos) name.replace(other, 5, "Left");
      node["name"] = name;
    }
  });
  EXPECT_THAT(WhyRefused(RigGlb(sample)), ::testing::HasSubstr("left and right are exchanged"));
  sample =
      Edited([](json& document, std::string&) { document["nodes"][5]["name"] = "other:Neck"; });
  EXPECT_THAT(WhyRefused(RigGlb(sample)), ::testing::HasSubstr("two bones"));
}

TEST(RiggedSkin, RefusesEveryTruncation) {
  RigSample sample;
  sample.rings = 3;
  const std::string whole = RigGlb(sample);
  ASSERT_EQ(WhyRefused(whole), "");
  for (std::size_t size = 0; size < whole.size(); size += size < 200 ? 1 : 97) {
    EXPECT_NE(WhyRefused(whole.substr(0, size)), "") << size << " of " << whole.size() << " bytes";
  }
}

TEST(RiggedSkin, RefusesLyingLengthsAndWhatIsNoGlb) {
  const std::string whole = RigGlb();
  const auto altered = [&](std::size_t at, std::uint32_t word) {
    std::string bytes = whole;
    std::memcpy(bytes.data() + at, &word, 4);
    return WhyRefused(bytes);
  };
  EXPECT_THAT(altered(0, 1), ::testing::HasSubstr("does not begin with 'glTF'"));
  EXPECT_THAT(altered(4, 1), ::testing::HasSubstr("GLB version 1; expected 2"));
  EXPECT_THAT(altered(8, 0xffffffff), ::testing::HasSubstr("it declares 4294967295 bytes"));
  EXPECT_THAT(altered(12, 0x7fffffff), ::testing::HasSubstr("2147483647 of JSON"));
  EXPECT_THAT(altered(20, 0x20202020), ::testing::HasSubstr("is not an object"));
  std::string deep(300, '[');
  EXPECT_THAT(WhyRefused(testing::RigWriter::Pack(json::parse("{}"), "")),
              ::testing::HasSubstr("has no rig"));
}

TEST(RiggedSkin, RefusesWhatItWouldHaveToReadElsewhereOrUnpack) {
  EXPECT_THAT(WhyRefused(RigGlb(Edited([](json& document, std::string&) {
                document["buffers"][0]["uri"] = "../../etc/passwd";
              }))),
              ::testing::HasSubstr("in another file, '../../etc/passwd': export it as one GLB"));
  EXPECT_THAT(WhyRefused(RigGlb(Edited([](json& document, std::string&) {
                document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
              }))),
              ::testing::HasSubstr("'KHR_draco_mesh_compression', which is not supported"));
  EXPECT_THAT(WhyRefused(RigGlb(Edited([](json& document, std::string&) {
                document["accessors"][0]["sparse"] = {{"count", 1}};
              }))),
              ::testing::HasSubstr("sparse"));
}

TEST(RiggedSkin, RefusesCountsBeforeItAllocates) {
  // Indices that exist, ten million triangles of them.
  const std::string why = WhyRefused(RigGlb(Edited([](json& document, std::string& binary) {
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", 30'000'000}});
    binary.append(30'000'000, '\0');
    document["accessors"][3] = {
        {"bufferView", 5}, {"componentType", 5121}, {"count", 30'000'000}, {"type", "SCALAR"}};
  })));
  EXPECT_THAT(why, ::testing::HasSubstr("10000000 triangles"));
  EXPECT_THAT(why, ::testing::HasSubstr("at most 250000: reduce the mesh"));
  EXPECT_THAT(WhyRefused(RigGlb(Edited([](json& document, std::string&) {
                document["accessors"][0]["count"] = 4'000'000'000u;
              }))),
              ::testing::HasSubstr("an accessor declares 4000000000 elements"));
  EXPECT_THAT(WhyRefused(RigGlb(Edited([](json& document, std::string&) {
                document["bufferViews"][0]["byteLength"] = 18446744073709551615u;
              }))),
              ::testing::HasSubstr("byteLength"));
}

// The first vertex has the weights that are written.
std::string WithWeights(const std::array<float, 4>& weights) {
  return WhyRefused(RigGlb(Edited([&](json& document, std::string& binary) {
    const std::size_t at = document["bufferViews"][2]["byteOffset"];
    std::memcpy(binary.data() + at, weights.data(), sizeof weights);
  })));
}

TEST(RiggedSkin, RefusesNumbersThatCannotBe) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_THAT(WithWeights({0, 0, 0, 0}), ::testing::HasSubstr("vertex 0: its weights sum up to 0"));
  EXPECT_THAT(WithWeights({nan, 0, 0, 0}), ::testing::HasSubstr("a weight is nan"));
  EXPECT_THAT(WithWeights({infinity, 0, 0, 0}), ::testing::HasSubstr("a weight is inf"));
  EXPECT_THAT(WithWeights({-1, 2, 0, 0}), ::testing::HasSubstr("a weight is -1"));
  EXPECT_EQ(WithWeights({2, 2, 0, 0}), "") << "weights are normalised";
  for (const float wrong : {nan, infinity}) {
    EXPECT_THAT(WhyRefused(RigGlb(Edited([&](json& document, std::string& binary) {
                  const std::size_t at = document["bufferViews"][0]["byteOffset"];
                  std::memcpy(binary.data() + at, &wrong, sizeof wrong);
                }))),
                ::testing::HasSubstr("mesh 'Body', vertex 0: its position is not finite"));
  }
  EXPECT_THAT(WhyRefused(RigGlb(Edited([](json& document, std::string&) {
                document["nodes"][0]["translation"] = {"a", 0, 0};
              }))),
              ::testing::HasSubstr("'translation' is not a list of 3 numbers"));
}

TEST(RiggedSkin, RefusesARigWithoutBonesAndNodesInACircle) {
  EXPECT_THAT(WhyRefused(RigGlb(Edited(
                  [](json& document, std::string&) { document["nodes"].back().erase("skin"); }))),
              ::testing::HasSubstr("has no rig"));
  EXPECT_THAT(WhyRefused(RigGlb(Edited(
                  [](json& document, std::string&) { document["nodes"][5]["children"] = {0}; }))),
              ::testing::HasSubstr("nested too deeply"));
}

}  // namespace
}  // namespace kinescope::rig
