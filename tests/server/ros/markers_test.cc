#include "server/ros/markers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/palette.h"
#include "tests/server/ros/test_person.h"

namespace kinescope::ros_bridge {
namespace {

using visualization_msgs::Marker;

PersonState MarkedPerson() {
  return testing::MakePerson(testing::MakeModel("skeleton", 1.6), testing::Posture(1), 5, 7);
}

visualization_msgs::MarkerArray Of(const PersonState& person,
                                   MarkerFrames frames = MarkerFrames::kReference) {
  visualization_msgs::MarkerArray message;
  FillMarkers(person, PersonNames("skeleton"), "world", frames, 0, message);
  return message;
}

void ExpectColor(const Rgb& rgb, const Marker& marker) {
  EXPECT_FLOAT_EQ(marker.color.r, static_cast<float>(rgb[0]));
  EXPECT_FLOAT_EQ(marker.color.g, static_cast<float>(rgb[1]));
  EXPECT_FLOAT_EQ(marker.color.b, static_cast<float>(rgb[2]));
  EXPECT_EQ(marker.color.a, 1);
}

TEST(Markers, ShowEveryLoadAsThePictureDoes) {
  const PersonState person = MarkedPerson();
  const auto message = Of(person);
  ASSERT_EQ(message.markers.size(), person.loads.size() + 2);
  for (std::size_t i = 0; i < person.loads.size(); ++i) {
    const kinescope::JointLoad& load = person.loads[i];
    const Marker& marker = message.markers[i];
    EXPECT_EQ(marker.ns, "loads");
    EXPECT_EQ(marker.id, load.joint);
    EXPECT_EQ(marker.type, Marker::SPHERE);
    EXPECT_EQ(marker.scale.x, 2 * SphereRadius(load.joint, load.load_class, *person.model));
    EXPECT_EQ(marker.scale.x, marker.scale.z);
    EXPECT_EQ(marker.pose.position.y, load.position.y());
    EXPECT_EQ(marker.pose.orientation.w, 1);
    EXPECT_EQ(marker.header.frame_id, "world");
    ExpectColor(ColorOf(load.load_class), marker);
  }
}

TEST(Markers, AreAtTheSamePlacesIfLockedToLinks) {
  PersonState person = MarkedPerson();
  person.forces.hands[urdf::kLeft].mass_kg = 5;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    HandForce& hand = person.forces.hands[side];
    const urdf::Pose& link = person.links[At(urdf::HandSegmentOf(side))];
    hand.point = hand.grip = link.position + link.orientation * Eigen::Vector3d(0, 0, -0.1);
  }
  const PersonNames names("skeleton");
  const auto free = Of(person, MarkerFrames::kReference);
  const auto locked = Of(person, MarkerFrames::kLinks);
  ASSERT_EQ(free.markers.size(), locked.markers.size());
  for (std::size_t i = 0; i < free.markers.size(); ++i) {
    const Marker& marker = locked.markers[i];
    const auto& p = marker.pose.position;
    const auto turn_of = [](const Marker& of) {
      const auto& q = of.pose.orientation;
      return Eigen::Quaterniond(q.w, q.x, q.y, q.z);
    };
    Eigen::Vector3d position(p.x, p.y, p.z);
    Eigen::Quaterniond turn = turn_of(marker);
    EXPECT_EQ(marker.frame_locked, marker.ns != "cop");
    EXPECT_FALSE(free.markers[i].frame_locked);
    if (marker.frame_locked) {
      const auto link = std::find(names.links.begin(), names.links.end(), marker.header.frame_id);
      ASSERT_NE(link, names.links.end()) << marker.header.frame_id;
      const urdf::Pose& pose = person.links[static_cast<std::size_t>(link - names.links.begin())];
      position = pose.position + pose.orientation * position;
      turn = pose.orientation * turn;
      EXPECT_EQ(marker.ns == "hand_loads", *link == "skeleton_left_hand") << marker.ns;
    }
    EXPECT_LT(turn.angularDistance(turn_of(free.markers[i])), 1e-7);
    const auto& expected = free.markers[i].pose.position;
    EXPECT_TRUE(position.isApprox(Eigen::Vector3d(expected.x, expected.y, expected.z), 1e-12));
  }
  EXPECT_EQ(locked.markers[0].header.frame_id, "skeleton_l5") << "the child of jL5S1";
  EXPECT_EQ(locked.markers.back().ns, "hand_loads");
}

TEST(Markers, HaveALifetimeSoThatOldOnesDisappear) {
  const auto message = Of(MarkedPerson());
  for (const Marker& marker : message.markers) {
    EXPECT_EQ(marker.action, Marker::ADD);
    EXPECT_EQ(marker.lifetime.toSec(), kMarkerLifetime);
  }
}

TEST(Markers, AreNotKeptFromAnEarlierSample) {
  PersonState person = MarkedPerson();
  auto message = Of(person);
  person.cop.reset();
  person.loads.pop_back();
  FillMarkers(person, PersonNames("skeleton"), "world", MarkerFrames::kReference, 0, message);
  ASSERT_EQ(message.markers.size(), person.loads.size() + 2);
  EXPECT_EQ(message.markers[person.loads.size()].ns, "com");
  EXPECT_EQ(message.markers.back().ns, "cop");
  EXPECT_EQ(message.markers.back().action, Marker::DELETE);
  FillMarkers(person, PersonNames("skeleton"), "world", MarkerFrames::kReference, 0, message);
  EXPECT_EQ(message.markers.size(), person.loads.size() + 1) << "it is deleted once";
}

// RViz showed the arrow of a foot on the floor until its lifetime was over, half a step behind.
TEST(Markers, OfAFootAreDeletedWhenItLifts) {
  PersonState person = MarkedPerson();
  for (FootForce& foot : person.forces.feet) {
    foot.force = {0, 0, 400};
    foot.cop = {1, 2, 0};
  }
  auto message = Of(person);
  const auto arrows = [&](int action) {
    std::vector<int> ids;
    for (const Marker& marker : message.markers) {
      if (marker.ns == "foot_forces" && marker.action == action) ids.push_back(marker.id);
    }
    return ids;
  };
  EXPECT_EQ(arrows(Marker::ADD), (std::vector<int>{urdf::kRight, urdf::kLeft}));
  person.forces.feet[urdf::kLeft].force.setZero();
  FillMarkers(person, PersonNames("skeleton"), "world", MarkerFrames::kReference, 0, message);
  EXPECT_EQ(arrows(Marker::ADD), (std::vector<int>{urdf::kRight}));
  EXPECT_EQ(arrows(Marker::DELETE), (std::vector<int>{urdf::kLeft}));
  person.forces.feet[urdf::kLeft].force = {0, 0, 400};
  FillMarkers(person, PersonNames("skeleton"), "world", MarkerFrames::kReference, 0, message);
  EXPECT_EQ(arrows(Marker::ADD), (std::vector<int>{urdf::kRight, urdf::kLeft}));
  EXPECT_TRUE(arrows(Marker::DELETE).empty());
}

TEST(Markers, LiveLongerThanTwoSamplesOfASlowStream) {
  EXPECT_EQ(MarkerLifetime(0), kMarkerLifetime);
  EXPECT_EQ(MarkerLifetime(1.0 / 60), kMarkerLifetime);
  EXPECT_EQ(MarkerLifetime(2), 5);
}

TEST(Markers, AreDeletedWithTheirNamesAndNumbers) {
  auto message = Of(MarkedPerson());
  const auto before = message;
  MakeDeleted(message);
  ASSERT_EQ(message.markers.size(), before.markers.size());
  for (std::size_t i = 0; i < message.markers.size(); ++i) {
    EXPECT_EQ(message.markers[i].action, Marker::DELETE);
    EXPECT_EQ(message.markers[i].ns, before.markers[i].ns);
    EXPECT_EQ(message.markers[i].id, before.markers[i].id);
  }
}

TEST(Markers, AreGreySmallAndPermanentAfterTheStreamStopped) {
  const PersonState person = MarkedPerson();
  auto message = Of(person);
  MakeStale(*person.model, message);
  for (const Marker& marker : message.markers) {
    ExpectColor(ColorOf(LoadClass::kUnknown), marker);
    EXPECT_EQ(marker.lifetime.toSec(), 0);
    EXPECT_EQ(marker.action, marker.ns == "cop" ? Marker::DELETE : Marker::ADD);
    if (marker.ns != "loads") continue;
    EXPECT_EQ(marker.scale.y, 2 * SphereRadius(marker.id, LoadClass::kUnknown, *person.model));
  }
  FillMarkers(person, PersonNames("skeleton"), "world", MarkerFrames::kReference, 0,
              message);  // the stream came back
  ExpectColor(ColorOf(person.loads[0].load_class), message.markers[0]);
  EXPECT_EQ(message.markers.back().action, Marker::ADD);
}

}  // namespace
}  // namespace kinescope::ros_bridge
