#include "server/ros/marker_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nav_msgs/OccupancyGrid.h>
#include <nav_msgs/Path.h>
#include <ros/message_traits.h>

#include <cmath>
#include <limits>
#include <optional>

#include "core/system/clocks.h"
#include "server/ros/topic_markers.h"

namespace kinescope::ros_bridge {
namespace {

using ::testing::HasSubstr;
using visualization_msgs::Marker;

Marker Cube(int id, double x = 0) {
  Marker marker;
  marker.header.frame_id = "cart";
  marker.ns = "walls";
  marker.id = id;
  marker.type = Marker::CUBE;
  marker.pose.position.x = x;
  marker.scale.x = marker.scale.y = marker.scale.z = 0.1;
  marker.color.a = 1;
  return marker;
}

Marker Of(int type) {
  Marker marker = Cube(type);
  marker.type = type;
  marker.points.resize(6);
  for (std::size_t i = 0; i < marker.points.size(); ++i)
    marker.points[i].x = static_cast<double>(i);
  marker.colors.resize(6, marker.color);
  if (type == Marker::ARROW) {
    marker.points.resize(2);
    marker.colors.clear();
  }
  marker.text = "here";
  marker.mesh_resource = "package://walls/door.stl";
  return marker;
}

// A graph with one frame, a cart at x metres; where it is not known, nothing is.
struct Cart {
  std::optional<double> x = 1;
  std::int64_t newest_nanos = std::numeric_limits<std::int64_t>::max();  // of its transforms
  mutable std::vector<std::int64_t> asked;
  MarkerStore::FindFrame Find() const {
    return [this](const std::string& frame, std::int64_t stamp) -> std::optional<FramePlace> {
      asked.push_back(stamp);
      if (frame != "cart" || !x) return std::nullopt;
      const urdf::Pose pose{{*x, 0, 0}, Eigen::Quaterniond::Identity()};
      return FramePlace{pose, stamp > newest_nanos};
    };
  }
};

double X(const MarkerStore& store, std::size_t index = 0) {
  return store.markers().at(index)->pose.position.x();
}

TEST(MarkerInput, ReadsEveryTypeWithItsRelevantFields) {
  for (int type = Marker::ARROW; type <= Marker::TRIANGLE_LIST; ++type) {
    const auto marker = ToSceneMarker(Of(type));
    ASSERT_TRUE(marker) << type << ": " << marker.error().text;
    EXPECT_EQ(static_cast<int>(marker->type), type);
    EXPECT_EQ(marker->text, type == Marker::TEXT_VIEW_FACING ? "here" : "");
    EXPECT_EQ(marker->mesh_uri.empty(), type != Marker::MESH_RESOURCE);
    const bool has_points = type == Marker::ARROW || type == Marker::TRIANGLE_LIST ||
                            (type >= Marker::LINE_STRIP && type <= Marker::POINTS);
    EXPECT_EQ(!marker->points.empty(), has_points) << type;
  }
}

TEST(MarkerInput, TakesWhatRvizDraws) {
  Marker cube = Cube(1);
  cube.color.r = 255;
  cube.color.b = -1;
  cube.scale.x = -0.5;
  cube.scale.z = 0;
  const auto marker = ToSceneMarker(cube);
  ASSERT_TRUE(marker);
  EXPECT_EQ(marker->color, Eigen::Vector4d(1, 0, 0, 1));
  EXPECT_EQ(marker->scale.x(), 0.5);
  EXPECT_NEAR(marker->scale.z(), 0, 1e-4) << "flat";
  Marker arrow = Of(Marker::ARROW);
  arrow.points.clear();
  arrow.scale.x = -2;
  const auto back = ToSceneMarker(arrow);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->scale.x(), 2);
  EXPECT_NEAR((back->pose.orientation * Eigen::Vector3d::UnitX()).x(), -1, 1e-12);
  arrow = Of(Marker::ARROW);
  arrow.scale.y = arrow.scale.z = 0;
  EXPECT_TRUE(ToSceneMarker(arrow)) << "without a head";
  Marker text = Of(Marker::TEXT_VIEW_FACING);
  text.text.clear();
  for (std::size_t i = 0; i < kMaxMarkerText; ++i) text.text += "\u00b5";
  const auto shortened = ToSceneMarker(text);
  ASSERT_TRUE(shortened);
  EXPECT_LE(shortened->text.size(), kMaxMarkerText);
  EXPECT_EQ(shortened->text.substr(shortened->text.size() - 5), "\u00b5\u2026");
  cube.scale.x = cube.scale.y = 0;
  EXPECT_FALSE(ToSceneMarker(cube));
}

TEST(MarkerInput, TreatsAnUnsetOrientationAsIdentity) {
  const auto marker = ToSceneMarker(Cube(1));
  ASSERT_TRUE(marker);
  EXPECT_EQ(marker->pose.orientation.w(), 1);
  Marker turned = Cube(1);
  turned.pose.orientation.z = turned.pose.orientation.w = 3;
  EXPECT_NEAR(ToSceneMarker(turned)->pose.orientation.z(), std::sqrt(0.5), 1e-12);
}

// As the rings of interactive markers have them.
TEST(MarkerInput, TrianglesMayHaveOneColorEach) {
  Marker triangles = Of(Marker::TRIANGLE_LIST);
  triangles.points.resize(6);
  triangles.points[1].x = triangles.points[2].y = triangles.points[4].x = triangles.points[5].z = 1;
  triangles.colors.resize(2);
  for (auto& color : triangles.colors) color.a = 1;
  triangles.colors[1].g = 1;
  const auto marker = ToSceneMarker(triangles);
  ASSERT_TRUE(marker) << marker.error().text;
  ASSERT_EQ(marker->colors.size(), 6u);
  EXPECT_EQ(marker->colors[2].y(), 0);
  EXPECT_EQ(marker->colors[3].y(), 1);
  triangles.colors.resize(3);
  EXPECT_FALSE(ToSceneMarker(triangles));
}

TEST(MarkerInput, RejectsInvalidMarkersByNameAndReason) {
  MarkerStore store;
  Marker bad = Cube(7);
  bad.pose.position.y = std::nan("");
  auto refusal = store.Apply(0, bad, 0);
  ASSERT_TRUE(refusal);
  EXPECT_NE(refusal->text.find("walls/7"), std::string::npos) << refusal->text;
  bad = Of(Marker::LINE_LIST);
  bad.points.pop_back();
  EXPECT_TRUE(store.Apply(0, bad, 0));
  bad = Of(Marker::POINTS);
  bad.points.resize(kMaxMarkerPoints + 1);
  refusal = store.Apply(0, bad, 0);
  ASSERT_TRUE(refusal);
  EXPECT_STREQ(refusal->kind, "its colors");
  bad = Cube(1);
  bad.type = 12;
  EXPECT_TRUE(store.Apply(0, bad, 0));
  bad = Cube(1);
  bad.action = 9;
  refusal = store.Apply(0, bad, 0);
  ASSERT_TRUE(refusal);
  EXPECT_STREQ(refusal->kind, "unknown action");
  EXPECT_FALSE(store.Update(0, Cart().Find()));
}

TEST(MarkerInput, OfTooManyPointsHasAsManyThroughout) {
  MarkerStore store;
  Marker lines = Of(Marker::LINE_LIST);
  lines.points.resize(3 * kMaxMarkerPoints);
  for (std::size_t i = 0; i < lines.points.size(); ++i) {
    lines.points[i].x = 1e-3 * static_cast<double>(i / 2);
    lines.points[i].y = static_cast<double>(i % 2);
  }
  lines.colors.assign(lines.points.size(), lines.color);
  const auto some = store.Apply(0, lines, 0);
  ASSERT_TRUE(some);
  EXPECT_TRUE(some->is_partial);
  EXPECT_THAT(some->text, HasSubstr("100000 of 300000 points are drawn"));
  ASSERT_TRUE(store.Update(0, Cart().Find()));
  const SceneMarker& drawn = *store.markers().at(0);
  ASSERT_EQ(drawn.points.size(), kMaxMarkerPoints);
  EXPECT_EQ(drawn.colors.size(), kMaxMarkerPoints);
  for (std::size_t i = 0; i < drawn.points.size(); i += 2) {
    ASSERT_EQ(drawn.points[i].x(), drawn.points[i + 1].x()) << "both ends of a line";
  }
  EXPECT_GT(drawn.points.back().x(), 149.9);
}

TEST(MarkerStore, HasTranslucentAxes) {
  ShownTopic axes;
  axes.is_frame = true;
  axes.name = "cart";
  axes.style.alpha = 0.25;
  MarkerStore store;
  store.AddOfFrame(0, axes);
  ASSERT_TRUE(store.Update(0, Cart().Find()));
  for (const Eigen::Vector4d& color : store.markers().at(0)->colors) EXPECT_EQ(color.w(), 0.25);
}

// RViz draws a grid in its fixed frame whether TF knows that or not.
TEST(MarkerStore, HasGridsInTheirFrameOrThatOfTheScene) {
  ShownTopic grid;
  grid.is_frame = grid.is_grid = true;
  grid.name = "cart";
  MarkerStore strict, lenient;
  strict.AddOfFrame(0, grid);
  grid.style.stands_in_scene = true;
  lenient.AddOfFrame(0, grid);
  Cart cart;
  cart.x.reset();
  EXPECT_FALSE(strict.Update(0, cart.Find()));
  ASSERT_TRUE(lenient.Update(0, cart.Find()));
  EXPECT_EQ(X(lenient), 0);
  EXPECT_EQ(lenient.markers()[0]->ns, kNamespaceOfGrids);
  EXPECT_TRUE(lenient.markers()[0]->is_in_pixels) << "as RViz's style Lines";
  cart.x = 3;
  ASSERT_TRUE(strict.Update(1'000'000'000, cart.Find()));
  ASSERT_TRUE(lenient.Update(1'000'000'000, cart.Find()));
  EXPECT_EQ(X(strict), 3);
  EXPECT_EQ(X(lenient), 3);
}

TEST(MarkerStore, AddsChangesAndDeletesByTopicNamespaceAndNumber) {
  MarkerStore store;
  const Cart cart;
  EXPECT_FALSE(store.Apply(0, Cube(1, 0.5), 0));
  EXPECT_FALSE(store.Apply(1, Cube(1, 0.7), 0));
  ASSERT_TRUE(store.Update(0, cart.Find()));
  ASSERT_EQ(store.markers().size(), 2u);
  EXPECT_DOUBLE_EQ(X(store), 1.5);
  EXPECT_FALSE(store.Apply(0, Cube(1, 0.6), 0));
  ASSERT_TRUE(store.Update(0, cart.Find()));
  EXPECT_DOUBLE_EQ(X(store), 1.6);
  Marker gone = Cube(1);
  gone.action = Marker::DELETE;
  EXPECT_FALSE(store.Apply(0, gone, 0));
  ASSERT_TRUE(store.Update(0, cart.Find()));
  ASSERT_EQ(store.markers().size(), 1u);
  EXPECT_DOUBLE_EQ(X(store), 1.7) << "the other topic's stays";
  EXPECT_FALSE(store.Apply(0, gone, 0)) << "who is not there is no fault";
  EXPECT_FALSE(store.Apply(1, Cube(-5), 0));
  gone.action = Marker::DELETEALL;
  EXPECT_FALSE(store.Apply(1, gone, 0));
  ASSERT_TRUE(store.Update(0, cart.Find()));
  EXPECT_TRUE(store.markers().empty());
}

TEST(MarkerStore, KeepsTheObjectOfARepeatedMarker) {
  MarkerStore store;
  const Cart cart;
  EXPECT_FALSE(store.Apply(0, Cube(1), 0));
  ASSERT_TRUE(store.Update(0, cart.Find()));
  const auto first = store.markers().at(0);
  EXPECT_FALSE(store.Apply(0, Cube(1), 0));
  EXPECT_FALSE(store.Update(0, cart.Find()));
  EXPECT_EQ(store.markers().at(0), first);
}

TEST(MarkerStore, RemovesMarkersAfterTheirLifetimeUnlessTheyAreSentAgain) {
  MarkerStore store;
  const Cart cart;
  Marker brief = Cube(1);
  brief.lifetime = ros::Duration(2);
  EXPECT_FALSE(store.Apply(0, brief, 0));
  ASSERT_TRUE(store.Update(0, cart.Find()));
  EXPECT_FALSE(store.Apply(0, brief, kNanosPerSecond));
  EXPECT_FALSE(store.Update(2 * kNanosPerSecond, cart.Find()));
  EXPECT_EQ(store.markers().size(), 1u);
  ASSERT_TRUE(store.Update(3 * kNanosPerSecond, cart.Find()));
  EXPECT_TRUE(store.markers().empty());
}

// A bag that is played slowly, or a simulator that stands still.
TEST(MarkerStore, CountsLifetimesByTheClockOfTheGraph) {
  MarkerStore store;
  const Cart cart;
  const auto at = [](double secs, double of_graph) {
    return Now(static_cast<std::int64_t>(secs * kNanosPerSecond),
               static_cast<std::int64_t>(of_graph * kNanosPerSecond));
  };
  Marker brief = Cube(1);
  brief.lifetime = ros::Duration(2);
  EXPECT_FALSE(store.Apply(0, brief, at(50, 100)));
  ASSERT_TRUE(store.Update(at(50, 100), cart.Find()));
  EXPECT_FALSE(store.Update(at(90, 101.9), cart.Find()));
  ASSERT_TRUE(store.Update(at(90.1, 102), cart.Find()));
  EXPECT_TRUE(store.markers().empty());
}

TEST(MarkerStore, ForgetsTheLastRoundOfARecordingThatBeginsAgain) {
  MarkerStore store;
  const Cart cart;
  ShownTopic axes;
  axes.is_frame = true;
  axes.name = "cart";
  store.AddOfFrame(7, axes);
  const auto cube_at = [&](int id, double stamp, double secs, double of_graph) {
    Marker cube = Cube(id);
    cube.header.stamp = ros::Time(stamp);
    EXPECT_FALSE(store.Apply(0, cube,
                             {static_cast<std::int64_t>(secs * kNanosPerSecond),
                              static_cast<std::int64_t>(of_graph * kNanosPerSecond)}));
  };
  cube_at(1, 10, 50, 10);
  cube_at(2, 19.99, 59.95, 19.99);  // the last one of the round
  cube_at(3, 10.01, 59.99, 20);     // the next round, of which the clock is heard a little later
  ASSERT_TRUE(store.Update(60 * kNanosPerSecond, cart.Find()));
  EXPECT_EQ(store.markers().size(), 4U);
  store.StartAgain({60 * kNanosPerSecond, 10 * kNanosPerSecond});
  ASSERT_TRUE(store.Update({60 * kNanosPerSecond, 10 * kNanosPerSecond}, cart.Find()));
  ASSERT_EQ(store.markers().size(), 2U) << "the third, and the axes";
  EXPECT_EQ(store.markers().front()->id, 3);
}

TEST(MarkerStore, MovesOnlyLockedMarkersWithTheirFrame) {
  MarkerStore store;
  Cart cart;
  Marker locked = Cube(1);
  locked.frame_locked = 1;
  locked.header.stamp = ros::Time(5);
  Marker still = Cube(2);
  still.header.stamp = ros::Time(5);
  EXPECT_FALSE(store.Apply(0, locked, 0));
  EXPECT_FALSE(store.Apply(0, still, 0));
  ASSERT_TRUE(store.Update(0, cart.Find()));
  EXPECT_EQ(cart.asked, (std::vector<std::int64_t>{0, 5 * kNanosPerSecond}));
  cart.x = 4;
  ASSERT_TRUE(store.Update(0, cart.Find()));
  EXPECT_DOUBLE_EQ(X(store, 0), 4);
  EXPECT_DOUBLE_EQ(X(store, 1), 1);
  EXPECT_FALSE(store.Update(0, cart.Find())) << "nothing has moved";
}

// A scan comes before the transform of its time.
TEST(MarkerStore, PlacesAMarkerAgainUntilItsTimeIsKnown) {
  MarkerStore store;
  Cart cart;
  cart.newest_nanos = 4 * kNanosPerSecond;
  Marker scan = Cube(1);
  scan.header.stamp = ros::Time(5);
  const auto update = [&](int millis) {
    return store.Update(millis * kNanosPerMilli, cart.Find());
  };
  EXPECT_FALSE(store.Apply(0, scan, 0));
  EXPECT_FALSE(update(0)) << "it may come soon";
  EXPECT_FALSE(update(499));
  ASSERT_TRUE(update(501));
  EXPECT_DOUBLE_EQ(X(store), 1) << "by the newest transform, for now";
  cart.x = 4;
  ASSERT_TRUE(update(502));
  EXPECT_DOUBLE_EQ(X(store), 4);
  cart.newest_nanos = 6 * kNanosPerSecond;
  cart.x = 3;
  ASSERT_TRUE(update(503));
  EXPECT_DOUBLE_EQ(X(store), 3) << "at its own time";
  cart.x = 9;
  EXPECT_FALSE(update(504)) << "for good";
}

// As RViz, which keeps messages until their transforms have come: of a marker that changes thirty
// times a second, in a frame with ten transforms.
TEST(MarkerStore, ShowsTheNewestThatHasItsTransforms) {
  MarkerStore store;
  Cart cart;
  for (int i = 0; i < 60; ++i) {
    const std::int64_t now = i * 33 * kNanosPerMilli, stamp = kNanosPerSecond + now;
    if (i % 3 == 0) cart.newest_nanos = stamp - 10 * kNanosPerMilli;  // later than the one before
    Marker cube = Cube(1, i);
    cube.header.stamp.fromNSec(static_cast<std::uint64_t>(stamp));
    EXPECT_FALSE(store.Apply(0, cube, now));
    static_cast<void>(store.Update(now, cart.Find()));
    ASSERT_EQ(store.markers().size(), i < 3 ? 0u : 1u) << i << ": the one before stays";
    if (i >= 3) EXPECT_DOUBLE_EQ(X(store), 1 + (i / 3 * 3 - 1)) << i;
  }
}

// As RViz: also if that is shorter than its transforms are late.
TEST(MarkerStore, CountsALifetimeFromWhenTheMarkerIsShown) {
  MarkerStore store;
  Cart cart;
  cart.newest_nanos = 4 * kNanosPerSecond;
  const auto update = [&](int millis) {
    return store.Update(millis * kNanosPerMilli, cart.Find());
  };
  Marker scan = Cube(1);
  scan.header.stamp = ros::Time(5);
  scan.lifetime = ros::Duration(0.1);
  EXPECT_FALSE(store.Apply(0, scan, 0));
  for (const int millis : {0, 60, 190}) EXPECT_FALSE(update(millis)) << millis;
  cart.newest_nanos = 6 * kNanosPerSecond;
  EXPECT_TRUE(update(200));
  EXPECT_EQ(store.markers().size(), 1u);
  EXPECT_FALSE(update(299));
  EXPECT_TRUE(update(301));
  EXPECT_TRUE(store.markers().empty());
}

// Of a sender whose clock is ahead.
TEST(MarkerStore, DoesNotWaitForATimeThatDoesNotCome) {
  MarkerStore store;
  Cart cart;
  cart.newest_nanos = 4 * kNanosPerSecond;
  Marker scan = Cube(1);
  for (int millis = 0; millis < 2000; millis += 100) {
    scan.header.stamp = ros::Time(1000, static_cast<std::uint32_t>(millis));
    EXPECT_FALSE(store.Apply(0, scan, millis * kNanosPerMilli));
    cart.x = millis;
    static_cast<void>(store.Update(millis * kNanosPerMilli, cart.Find()));
    EXPECT_EQ(store.markers().empty(), millis < 500) << millis;
    if (millis >= 500) EXPECT_DOUBLE_EQ(X(store), millis);
  }
  cart.x = 9;
  EXPECT_FALSE(store.Update(13 * kNanosPerSecond, cart.Find())) << "ten seconds are enough";
}

TEST(MarkerStore, LeavesOutPointsThatAreNotFiniteAndSaysHowMany) {
  MarkerStore store;
  const Cart cart;
  Marker lines = Of(Marker::LINE_LIST);
  lines.points[3].y = std::nan("");
  const auto said = store.Apply(0, lines, 0);
  ASSERT_TRUE(said);
  EXPECT_EQ(said->text,
            "marker walls/5: points that are not finite, or are beyond 100 km, are left out: 2 of "
            "6");
  ASSERT_TRUE(store.Update(0, cart.Find()));
  const auto& points = store.markers().at(0)->points;
  ASSERT_EQ(points.size(), 4u) << "with the other end of its line";
  EXPECT_EQ(points[2].x(), 4);
  EXPECT_EQ(store.markers()[0]->colors.size(), 4u);
  for (geometry_msgs::Point& point : lines.points) point.x = 1e9;
  const auto refused = store.Apply(0, lines, 0);
  ASSERT_TRUE(refused);
  EXPECT_STREQ(refused->kind, "its points");
}

TEST(MarkerStore, ColoursPointsByTheirPlaceInTheScene) {
  MarkerStore store;
  Marker points = Of(Marker::POINTS);
  points.colors.clear();
  points.frame_locked = 1;
  ShownStyle style;
  style.scale = PointScale{};
  style.scale->by = "z";
  style.scale->from = 0;
  style.scale->to = 10;
  style.alpha = 0.5;
  EXPECT_FALSE(store.Apply(0, points, 0, style));
  EXPECT_FALSE(store.Apply(1, points, 0));
  // The cart stands on its end: its x points up.
  urdf::Pose cart{
      {0, 0, 0},
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ())};
  const auto find = [&](const std::string&, std::int64_t) {
    return std::make_optional(FramePlace{cart});
  };
  ASSERT_TRUE(store.Update(0, find));
  const auto& colors = store.markers().at(0)->colors;
  ASSERT_EQ(colors.size(), 6u);
  EXPECT_LT((colors.at(0) - Eigen::Vector4d(1, 0, 0, 0.5)).norm(), 1e-6) << "0 m: red";
  EXPECT_LT((colors.at(4) - Eigen::Vector4d(0, 1, 0, 0.5)).norm(), 1e-6) << "4 of 10 m: green";
  EXPECT_TRUE(store.markers().at(1)->colors.empty()) << "that topic has no scale";
  cart.position.z() = 10;
  ASSERT_TRUE(store.Update(kNanosPerSecond, find));
  EXPECT_LT((store.markers().at(0)->colors.at(0) - Eigen::Vector4d(1, 0, 1, 0.5)).norm(), 1e-6)
      << "10 m: magenta";
}

// A turn of a quarter, and a way of 2 m, within a second.
std::optional<FramePlace> OfATurningCart(std::int64_t newest_nanos, std::int64_t stamp) {
  const double secs = Secs(std::min(stamp, newest_nanos));
  return FramePlace{
      {{2 * secs, 0, 0},
       Eigen::Quaterniond(Eigen::AngleAxisd(M_PI_2 * secs, Eigen::Vector3d::UnitZ()))},
      stamp > newest_nanos};
}

std::vector<Eigen::Vector3d> PlacesOf(const SceneMarker& marker) {
  std::vector<Eigen::Vector3d> all;
  for (const Eigen::Vector3d& point : marker.points) {
    all.push_back(marker.pose.position + marker.pose.orientation * point);
  }
  return all;
}

TEST(MarkerStore, PlacesThePointsOfASweepWhereTheFrameWasThen) {
  Marker points = Of(Marker::POINTS);
  points.header.stamp.fromSec(1);
  points.points.resize(3);
  for (auto& point : points.points) point.x = 1;
  points.colors.clear();
  const auto sweep = std::make_shared<const Sweep>(Sweep{1, {0, 0.5F, 1}});
  std::int64_t newest_nanos = 1'500'000'000;
  const auto find = [&](const std::string&, std::int64_t stamp) {
    return OfATurningCart(newest_nanos, stamp);
  };
  MarkerStore store;
  ASSERT_FALSE(store.Apply(0, points, 0, {}, {}, sweep));
  EXPECT_FALSE(store.Update(0, find)) << "it waits for the transforms of its last point";
  newest_nanos = 2'000'000'000;
  ASSERT_TRUE(store.Update(100 * kNanosPerMilli, find));
  const auto places = PlacesOf(*store.markers().at(0));
  ASSERT_EQ(places.size(), 3U);
  EXPECT_TRUE(places[0].isApprox(Eigen::Vector3d(2, 1, 0))) << places[0].transpose();
  EXPECT_TRUE(places[1].isApprox(Eigen::Vector3d(3 - M_SQRT1_2, M_SQRT1_2, 0)))
      << places[1].transpose();
  EXPECT_TRUE(places[2].isApprox(Eigen::Vector3d(3, 0, 0))) << places[2].transpose();
}

TEST(MarkerStore, KeepsASweepWithoutThePointsThatAreTooFar) {
  Marker points = Of(Marker::POINTS);
  points.header.stamp.fromSec(1);
  points.points.resize(3);
  points.points[0].x = 2 * kFarthestMarker;
  points.points[1].x = points.points[2].x = 1;
  points.colors.clear();
  const auto sweep = std::make_shared<const Sweep>(Sweep{1, {0, 0.5F, 1}});
  const auto find = [](const std::string&, std::int64_t stamp) {
    return OfATurningCart(10 * kNanosPerSecond, stamp);
  };
  MarkerStore store;
  const auto some = store.Apply(0, points, 0, {}, {}, sweep);
  ASSERT_TRUE(some);
  EXPECT_TRUE(some->is_partial);
  ASSERT_TRUE(store.Update(0, find));
  const auto places = PlacesOf(*store.markers().at(0));
  ASSERT_EQ(places.size(), 2U);
  EXPECT_TRUE(places[1].isApprox(Eigen::Vector3d(3, 0, 0))) << places[1].transpose();
}

TEST(MarkerStore, SizesSquaresOfATopicInPixels) {
  MarkerStore store;
  const Cart cart;
  ShownStyle style;
  style.size_px = 3;
  style.scale = PointScale{};
  style.scale->by = "x";
  EXPECT_FALSE(store.Apply(0, Of(Marker::CUBE_LIST), 0, style));
  EXPECT_FALSE(store.Apply(0, Of(Marker::POINTS), 0, style));
  EXPECT_FALSE(store.Apply(1, Of(Marker::POINTS), 0));
  ASSERT_TRUE(store.Update(0, cart.Find()));
  const SceneMarker &cubes = *store.markers().at(0), &points = *store.markers().at(1),
                    &others = *store.markers().at(2);
  EXPECT_TRUE(points.is_in_pixels);
  EXPECT_EQ(points.scale.x(), 3);
  EXPECT_EQ(points.scale.y(), 3);
  EXPECT_EQ(points.colors.size(), 6u);
  EXPECT_NE(points.colors.front(), points.colors.back()) << "by their place, too";
  for (const SceneMarker* in_metres : {&cubes, &others}) {
    EXPECT_FALSE(in_metres->is_in_pixels);
    EXPECT_EQ(in_metres->scale.x(), 0.1);
  }
}

TEST(MarkerStore, DrawsLinesOfMarkersAsOpaqueAsTheirColourIs) {
  MarkerStore store;
  const Cart cart;
  Marker lines = Of(Marker::LINE_LIST);
  lines.colors[0].a = 0.3f;
  EXPECT_FALSE(store.Apply(0, lines, 0));
  lines.color.a = 0;
  EXPECT_FALSE(store.Apply(1, lines, 0));
  MarkerLook converted;
  converted.is_converted = true;
  lines.color.a = 1;
  EXPECT_FALSE(store.Apply(2, lines, 0, {}, converted));
  ASSERT_TRUE(store.Update(0, cart.Find()));
  EXPECT_EQ(store.markers().at(0)->colors[0].w(), 1) << "as RViz, which blends none of them";
  EXPECT_NEAR(store.markers().at(1)->colors[0].w(), 0.3, 1e-6);
  EXPECT_NEAR(store.markers().at(2)->colors[0].w(), 0.3, 1e-6) << "ours are as they say";
}

TEST(MarkerStore, FadesTheColoursOfTrianglesWithThatOfAllOfThem) {
  MarkerStore store;
  const Cart cart;
  Marker triangles = Of(Marker::TRIANGLE_LIST);
  for (auto& color : triangles.colors) color.a = 0.8f;
  for (const int topic : {0, 1, 2}) {
    triangles.color.a = 0.5f * static_cast<float>(topic);
    EXPECT_FALSE(store.Apply(static_cast<std::size_t>(topic), triangles, 0));
  }
  ASSERT_TRUE(store.Update(0, cart.Find()));
  EXPECT_NEAR(store.markers().at(0)->colors[0].w(), 0.8, 1e-6);
  EXPECT_NEAR(store.markers().at(1)->colors[0].w(), 0.4, 1e-6);
  EXPECT_NEAR(store.markers().at(2)->colors[0].w(), 0.8, 1e-6);
}

TEST(MarkerStore, LaysMapsOnTheGroundAndDrawsPathsWithLinesOfAPixel) {
  MarkerStore store;
  const Cart cart;
  const auto look_of = [](const std::string& type, bool is_behind = false, bool is_thin = false) {
    ShownStyle style;
    style.is_behind = is_behind;
    if (is_thin) style.size_px = 1;
    return TopicMarkers::LookOf(type, style);
  };
  const std::string map = ros::message_traits::md5sum<nav_msgs::OccupancyGrid>(),
                    path = ros::message_traits::md5sum<nav_msgs::Path>();
  EXPECT_FALSE(store.Apply(0, Of(Marker::TRIANGLE_LIST), 0, {}, look_of(map)));
  EXPECT_FALSE(store.Apply(1, Of(Marker::TRIANGLE_LIST), 0, {}, look_of(map, true)));
  EXPECT_FALSE(store.Apply(2, Of(Marker::LINE_STRIP), 0, {}, look_of(path, false, true)));
  EXPECT_FALSE(store.Apply(3, Of(Marker::LINE_STRIP), 0, {}, look_of(path)));
  EXPECT_FALSE(store.Apply(4, Of(Marker::TRIANGLE_LIST), 0));
  ASSERT_TRUE(store.Update(0, cart.Find()));
  EXPECT_EQ(store.markers().at(0)->ground, GroundLayer::kMap);
  EXPECT_EQ(store.markers().at(1)->ground, GroundLayer::kFirstMap);
  EXPECT_TRUE(store.markers().at(2)->is_in_pixels);
  EXPECT_FALSE(store.markers().at(3)->is_in_pixels);
  EXPECT_EQ(store.markers().at(4)->ground, GroundLayer::kNone) << "a marker of another node";
}

TEST(MarkerStore, TellsThreePixelsFromThreeMetres) {
  MarkerStore store;
  const Cart cart;
  Marker points = Of(Marker::POINTS);
  points.scale.x = points.scale.y = 3;
  EXPECT_FALSE(store.Apply(0, points, 0));
  ASSERT_TRUE(store.Update(0, cart.Find()));
  ShownStyle style;
  style.size_px = 3;
  EXPECT_FALSE(store.Apply(0, points, 0, style));
  EXPECT_TRUE(store.Update(0, cart.Find()));
  EXPECT_TRUE(store.markers().at(0)->is_in_pixels);
}

TEST(MarkerStore, WaitsForAnUnknownFrameAndNamesItOnce) {
  MarkerStore store;
  Cart cart;
  cart.x.reset();
  EXPECT_FALSE(store.Apply(3, Cube(1), 0));
  EXPECT_FALSE(store.Update(0, cart.Find()));
  EXPECT_FALSE(store.Update(0, cart.Find()));
  const auto lost = store.TakeLost();
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_EQ(lost[0].topic, 3u);
  EXPECT_EQ(lost[0].frame, "cart");
  EXPECT_EQ(cart.asked.size(), 1u) << "not at every sample";
  cart.x = 2;
  ASSERT_TRUE(store.Update(kNanosPerSecond, cart.Find()));
  EXPECT_DOUBLE_EQ(X(store), 2);
  EXPECT_TRUE(store.TakeLost().empty());
}

TEST(MarkerStore, LooksUpAFrameOnceForAllItsMarkers) {
  MarkerStore store;
  const Cart cart;
  for (int id = 0; id < 100; ++id) {
    Marker marker = Cube(id);
    marker.frame_locked = 1;
    EXPECT_FALSE(store.Apply(0, marker, 0));
    marker.header.frame_id = "nowhere";
    marker.header.stamp = ros::Time(id);
    marker.frame_locked = 0;
    EXPECT_FALSE(store.Apply(1, marker, 0));
  }
  EXPECT_TRUE(store.Update(0, cart.Find()));
  EXPECT_EQ(cart.asked.size(), 2u);
  EXPECT_EQ(store.markers().size(), 100u);
}

// A cloud that a stranger locks to a frame that moves must not cost the stream its time.
TEST(MarkerStore, MovesManyLockedPointsLessOften) {
  MarkerStore store;
  Cart cart;
  Marker cloud = Of(Marker::POINTS);
  cloud.colors.clear();
  cloud.points.resize(kMaxMarkerPoints);
  cloud.frame_locked = 1;
  EXPECT_FALSE(store.Apply(0, cloud, 0));
  EXPECT_TRUE(store.Update(0, cart.Find()));
  cart.x = 2;
  EXPECT_FALSE(store.Update(4'000'000, cart.Find())) << "the next sample at 240 Hz";
  EXPECT_TRUE(store.Update(100'000'000, cart.Find()));
}

TEST(MarkerStore, LimitsTheNumbersOfMarkersAndPoints) {
  MarkerStore store;
  for (int id = 0; id < static_cast<int>(kMaxMarkers); ++id) {
    ASSERT_FALSE(store.Apply(0, Cube(id), 0)) << id;
  }
  EXPECT_TRUE(store.Apply(0, Cube(-1), 0));
  EXPECT_FALSE(store.Apply(0, Cube(5, 1), 0)) << "a change of one that is there";
  Marker all = Cube(0);
  all.action = Marker::DELETEALL;
  EXPECT_FALSE(store.Apply(0, all, 0));
  Marker cloud = Of(Marker::POINTS);
  cloud.colors.clear();
  cloud.points.resize(kMaxMarkerPoints);
  const int most = static_cast<int>(kMaxPointsOfAll / kMaxMarkerPoints);
  for (cloud.id = 0; cloud.id < most; ++cloud.id) ASSERT_FALSE(store.Apply(0, cloud, 0));
  EXPECT_TRUE(store.Apply(0, cloud, 0));
  cloud.id = 0;
  EXPECT_FALSE(store.Apply(0, cloud, 0)) << "in place of its own points";
}

}  // namespace
}  // namespace kinescope::ros_bridge
