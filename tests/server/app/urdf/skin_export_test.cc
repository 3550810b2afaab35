// The surface that a GLB shows, against that of pictures (render/vtk/skin_actor.cc).
#include "server/app/urdf/skin_export.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdint>

#include "server/scene/scene_builder.h"
#include "server/scene/scene_reader.h"
#include "urdf/rig/rig.h"
#include "urdf/skin/person_skin.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;

// What does not depend on the order of the triangles.
struct Extent {
  Eigen::AlignedBox3d box;
  Vector3d mean = Vector3d::Zero();  // of the corners of all triangles
};

Extent DrawnExtent(const PersonState& person) {
  const urdf::HumanModel& human = person.model->human;
  const urdf::BodyDescription& description = person.model->description;
  const skin::PersonSkin fitted(skin::BuiltInSkin(),
                                skin::BuildOf(description.sex == urdf::Sex::kFemale,
                                              human.skeleton.height, description.mass_kg),
                                human.skeleton);
  skin::PersonSkin::Surface surface;
  fitted.Pose(person.links, {}, surface);
  Extent extent;
  for (const skin::Triangle& triangle : fitted.triangles()) {
    for (const std::uint16_t corner : triangle) {
      const Eigen::Vector3f& p = surface.positions[corner];
      const Vector3d in_file(p.y(), p.z(), p.x());
      extent.box.extend(in_file);
      extent.mean += in_file / (3.0 * static_cast<double>(fitted.triangles().size()));
    }
  }
  return extent;
}

Extent ExtentOf(const rig::Rig& rig) {
  Extent extent;
  for (const auto& triangle : rig.triangles) {
    for (const std::uint32_t corner : triangle) {
      extent.box.extend(rig.vertices[corner].position);
      extent.mean +=
          rig.vertices[corner].position / (3.0 * static_cast<double>(rig.triangles.size()));
    }
  }
  return extent;
}

TEST(SkinExport, ShowsThePersonOfThatMomentInTheSuit) {
  SceneOptions options;
  options.body.sex = urdf::Sex::kFemale;
  SceneReader reader("demo:lift", options);
  SceneTimeline timeline(reader);
  for (const double secs : {0.0, 0.704}) {
    const PersonState person = timeline.At(secs)->people.front();
    const rig::Rig rig = rig::ReadRig(PosedSkinGlbOf(person));
    EXPECT_GE(rig.colors.size(), 4u) << "head and hands, top, trousers, shoes";
    const Extent drawn = DrawnExtent(person), of_file = ExtentOf(rig);
    constexpr double kClose = 0.002;  // m
    EXPECT_LT((of_file.box.min() - drawn.box.min()).norm(), kClose) << secs << " s";
    EXPECT_LT((of_file.box.max() - drawn.box.max()).norm(), kClose) << secs << " s";
    EXPECT_LT((of_file.mean - drawn.mean).norm(), kClose) << secs << " s";
  }
}

}  // namespace
}  // namespace kinescope::app
