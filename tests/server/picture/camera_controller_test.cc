#include "server/picture/camera_controller.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <memory>
#include <string>

#include "core/person_outline.h"
#include "core/system/errors.h"
#include "server/scene/scene_builder.h"
#include "server/subject/subject.h"
#include "tests/render/test_scene.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kAspect = 16.0 / 9;
const render::ViewShape kShape{kAspect, {{0, 0.07, 1, 1}, {}}};  // a title

SceneState SceneAt(double secs, double x) {
  SceneState state =
      kinescope::testing::SceneWith(kinescope::testing::Posture::kStanding, LoadClass::kLow, x, 0);
  state.stamp_nanos = 5'000'000'000 + std::llround(1e9 * secs);
  return state;
}

// The error of making one; "" where there is none.
std::string Complaint(const std::string& camera) {
  try {
    CameraController controller(ParseCamera(camera), {});
    return "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(CameraController, FollowsWithTheSameLagAtAnyRate) {
  CameraOptions options;
  options.follow = 0.5;
  const auto x_after_a_second = [&](int pictures) {
    CameraController controller(ParseCamera("front"), options);
    double x = controller.Aim(SceneAt(0, 0), kAspect).target.x();
    for (int k = 1; k <= pictures; ++k) {
      x = controller.Aim(SceneAt(static_cast<double>(k) / pictures, 2), kAspect).target.x();
    }
    return x;
  };
  const double start =
      CameraController(ParseCamera("front"), options).Only(SceneAt(0, 0), 0, kAspect).target.x();
  EXPECT_NEAR(x_after_a_second(10) - start, 2 * (1 - std::exp(-1 / 0.5)), 1e-6);
  EXPECT_NEAR(x_after_a_second(120), x_after_a_second(10), 1e-6);
  options.follow = 0.0;
  EXPECT_NEAR(x_after_a_second(1) - start, 2, 1e-9) << "no lag at all";
}

TEST(CameraController, KeepsACameraGivenByCoordinatesFixedOrFollowsThePerson) {
  CameraOptions options;
  options.fov = 40.0;
  CameraController still(ParseCamera("3,-2,1.5:0,0,1"), options);
  still.Aim(SceneAt(0, 0), kAspect);
  const render::Camera camera = still.Aim(SceneAt(1, 2), kAspect);
  EXPECT_EQ(camera.position, Vector3d(3, -2, 1.5));
  EXPECT_EQ(camera.target, Vector3d(0, 0, 1));
  EXPECT_NEAR(camera.vertical_fov_rad, 40 * M_PI / 180, 1e-12);
  options.follow = 0.0;
  CameraController along(ParseCamera("3,-2,1.5:0,0,1"), options);
  along.Aim(SceneAt(0, 0), kAspect);
  EXPECT_NEAR((along.Aim(SceneAt(1, 2), kAspect).position - Vector3d(5, -2, 1.5)).norm(), 0, 1e-9);
}

// A person at the origin who has turned to the left.
SceneState TurnedScene(double degrees, double secs = 0) {
  SceneState state = SceneAt(secs, 0);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(degrees * M_PI / 180, Vector3d::UnitZ()));
  for (urdf::Pose& link : state.people[0].links) {
    link = {turn * link.position, turn * link.orientation};
  }
  return state;
}

// From which the camera sees its target, degrees about z.
double Side(const render::Camera& camera) {
  const Vector3d away = camera.position - camera.target;
  return std::atan2(away.y(), away.x()) * 180 / M_PI;
}

TEST(CameraController, SeesTheFaceOfAPersonWhoTurnedBeforeTheFirstPicture) {
  CameraController controller(ParseCamera("front"), {});
  EXPECT_NEAR(Side(controller.Aim(TurnedScene(130), kAspect)), 130, 0.5);
  EXPECT_NEAR(Side(controller.Aim(TurnedScene(20, 1), kAspect)), 130, 0.5) << "it stays there";
  EXPECT_NEAR(Side(controller.Only(TurnedScene(-60), 0, kAspect)), -60, 0.5) << "one alone";
  EXPECT_NEAR(Side(CameraController(ParseCamera("left"), {}).Aim(TurnedScene(130), kAspect)),
              130 + 90 - 360, 0.5);
  CameraController nearly(ParseCamera("front"), {});
  EXPECT_NEAR(Side(nearly.Aim(TurnedScene(95), kAspect)), 90, 1e-6) << "along the floor's lines";
}

TEST(CameraController, TurnsWithThePersonOrNotAtAllOnRequest) {
  CameraOptions options;
  options.camera_frame = CameraFrame::kWorld;
  EXPECT_NEAR(Side(CameraController(ParseCamera("front"), options).Aim(TurnedScene(130), kAspect)),
              0, 1e-6);
  options.camera_frame = CameraFrame::kPerson;
  CameraController controller(ParseCamera("front"), options);
  EXPECT_NEAR(Side(controller.Aim(TurnedScene(30), kAspect)), 30, 0.5);
  const double soon = Side(controller.Aim(TurnedScene(70, 0.2), kAspect));
  EXPECT_GT(soon, 35);
  EXPECT_LT(soon, 50);
  EXPECT_NEAR(Side(controller.Aim(TurnedScene(70, 9), kAspect)), 70, 0.5);
}

TEST(CameraController, GoesWithAFrameIfItWasPlacedByPoints) {
  const CameraChoice placed = ParseCamera("2,0,1:0,0,1:0,0,2");
  SceneState state = SceneAt(0, 0);
  const auto aimed = [&](const std::string& base) {
    CameraOptions options;
    if (!base.empty()) options.camera_tf.Parse(base);
    return CameraController(placed, options).Aim(state, kAspect);
  };
  const auto expect = [&](const std::string& base, const Vector3d& position, const Vector3d& target,
                          const Vector3d& up) {
    const render::Camera camera = aimed(base);
    EXPECT_LT((camera.position - position).norm(), 1e-9) << base << camera.position.transpose();
    EXPECT_LT((camera.target - target).norm(), 1e-9) << base << camera.target.transpose();
    EXPECT_LT((camera.up.normalized() - up).norm(), 1e-9) << base << camera.up.transpose();
  };
  expect("cart", {2, 0, 1}, {0, 0, 1}, Vector3d::UnitZ());  // it has no place yet
  // Turned to the left, then tipped forward: its x looks down, its z ahead.
  state.camera_base =
      urdf::Pose{{10, 20, 3},
                 Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()) *
                     Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 3, Vector3d::UnitY()))};
  expect("", {2, 0, 1}, {0, 0, 1}, Vector3d::UnitZ());
  expect("cart", {12, 20, 4}, {10, 20, 4}, Vector3d::UnitZ());
  expect("cart:heading", {10, 22, 4}, {10, 20, 4}, Vector3d::UnitZ());
  const double c = std::cos(M_PI / 3), s = std::sin(M_PI / 3);
  expect("cart:pose", {10, 20 + 2 * c + s, 3 - 2 * s + c}, {10, 20 + s, 3 + c}, {0, s, c});
  expect("cart:axes=lab", {10, 20 + 2 * c + s, 3 - 2 * s + c}, {10, 20 + s, 3 + c}, {0, s, c});
  CameraOptions options;
  options.camera_tf.Parse("/cart:axes=/lab");
  EXPECT_EQ(options.camera_tf.ToText(), "cart:axes=lab");
  for (const char* bad : {"cart:axes=", "cart:axes=a b", "cart:axis=lab", ":axes=lab"}) {
    EXPECT_THROW(options.camera_tf.Parse(bad), options::BadValue) << bad;
  }
  options.camera_tf.Parse("cart");
  EXPECT_NEAR(Side(CameraController(ParseCamera("front"), options).Aim(state, kAspect)), 0, 1e-6)
      << "named cameras are of the people";
}

TEST(CameraController, SaysHowItIsTurnedForAPersonWhoDoesNotStand) {
  const auto person = [](double degrees, const Vector3d& axis) {
    SceneState state = SceneAt(0, 0);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(degrees * M_PI / 180, axis));
    for (urdf::Pose& link : state.people.front().links) {
      link.position = turn * link.position;
      link.orientation = turn * link.orientation;
    }
    return state;
  };
  const SceneState on_back = person(-90, Vector3d::UnitY()),
                   on_side = person(90, Vector3d::UnitX()),
                   upside_down = person(180, Vector3d::UnitY());
  CameraController front(ParseCamera("front"), {});
  EXPECT_EQ(front.HeadingNote(person(30, Vector3d::UnitZ())), "");
  EXPECT_THAT(front.HeadingNote(on_back), HasSubstr("on the back or the belly"));
  EXPECT_THAT(front.HeadingNote(on_side), HasSubstr("on a side"));
  EXPECT_THAT(front.HeadingNote(upside_down), HasSubstr("axes of the world"));
  EXPECT_NEAR(Side(front.Only(upside_down, 0, kAspect)), 0, 1e-6) << "as it says";
  EXPECT_NEAR(std::abs(Side(front.Only(on_back, 0, kAspect))), 90, 0.5) << "as it says";
  CameraOptions world;
  world.camera_frame = CameraFrame::kWorld;
  EXPECT_EQ(CameraController(ParseCamera("front"), world).HeadingNote(on_back), "");
  EXPECT_EQ(CameraController(ParseCamera("0,-4,1:0,0,1"), {}).HeadingNote(on_back), "");
}

TEST(CameraController, TurnsLivePicturesByTheHeadingThatThePageHas) {
  SceneState state = TurnedScene(130);
  state.view_heading = 40 * M_PI / 180;
  CameraController controller(ParseCamera("front"), {});
  EXPECT_NEAR(Side(controller.AimLive(state, kShape)), 40, 1e-6);
  EXPECT_NEAR(Side(controller.OnlyLive(state, kShape)), 40, 1e-6);
  EXPECT_NEAR(Side(controller.AimLive(state, kShape, render::ViewShape{0.5, {}})), 40, 1e-6)
      << "a narrow snapshot";
  CameraOptions options;
  options.camera_frame = CameraFrame::kWorld;
  CameraController in_world(ParseCamera("front"), options);
  EXPECT_NEAR(Side(in_world.AimLive(state, kShape)), 0, 1e-6);
  EXPECT_NEAR(Side(in_world.OnlyLive(state, kShape)), 0, 1e-6);
}

// Of a picture, as shares of its height and width.
struct Span {
  double top = 1, bottom = 0, left = 1, right = 0;
  double height() const { return bottom - top; }
};

Span SpanOf(const SceneState& state, const render::Camera& camera) {
  Span span;
  for (const Ball& ball : BallsOf(state.people[0])) {
    const render::Projected at = render::Project(ball.center, camera, 1280, 720);
    const double radius = at.px_per_m * ball.radius;
    span.top = std::min(span.top, (at.y_px - radius) / 720);
    span.bottom = std::max(span.bottom, (at.y_px + radius) / 720);
    span.left = std::min(span.left, (at.x_px - radius) / 1280);
    span.right = std::max(span.right, (at.x_px + radius) / 1280);
  }
  return span;
}

// A take of several built-in motions, one after another.
class LiveTake {
 public:
  explicit LiveTake(const std::string& camera, const CameraOptions& options = {})
      : controller_(ParseCamera(camera), options) {}

  /// @param check of each picture: the time since the motion began, what it shows and its height
  void Play(const std::string& motion, double secs,
            const std::function<void(double, const Span&, double)>& check) {
    std::shared_ptr<const SceneState> newest;
    SceneBuilder builder({}, "", 0, [&](const auto& state) { newest = state; });
    const auto subject = subject::MakeMotion(motion);
    builder.OnCharacter(subject->character());
    for (double at = 0; at < secs; at += 0.1, secs_ += 0.1) {
      builder.OnSample(subject->At(at));
      SceneState state = *newest;
      state.stamp_nanos = 5'000'000'000 + std::llround(1e9 * secs_);
      const render::Camera camera = controller_.AimLive(state, kShape);
      check(at, SpanOf(state, camera), render::ShownHeight(camera));
    }
  }

 private:
  CameraController controller_;
  double secs_ = 0;
};

constexpr double kFreeHeight = 0.93;  // of the picture, below the title

TEST(CameraController, FillsALivePictureInEveryPosture) {
  for (const char* camera : {"front", "left", "three_quarter"}) {
    LiveTake take(camera);
    for (const char* motion : {"n_pose", "squat", "n_pose", "overhead", "sit", "t_pose"}) {
      SCOPED_TRACE(std::string(camera) + " " + motion);
      take.Play(motion, 9, [&](double secs, const Span& span, double) {
        constexpr double kRoomMade = 1, kSettled = 6;  // s
        if (secs > kRoomMade) {
          EXPECT_GT(span.top, 0.05) << secs;
          EXPECT_LT(span.bottom, 1) << secs;
          EXPECT_GT(span.left, 0) << secs;
          EXPECT_LT(span.right, 1) << secs;
        }
        if (secs < kSettled) return;
        EXPECT_GT(span.height() / kFreeHeight, 0.58) << secs;
        EXPECT_LT(span.height() / kFreeHeight, 0.88) << secs;
      });
    }
  }
}

TEST(CameraController, DoesNotZoomWhileAPersonWalks) {
  CameraOptions options;
  options.follow = 0.5;  // else a camera that stands still shows all the ground they walked on
  LiveTake take("three_quarter", options);
  double least = 1e9, most = 0;
  take.Play("walk", 20, [&](double secs, const Span&, double height) {
    if (secs < 1) return;
    least = std::min(least, height);
    most = std::max(most, height);
  });
  EXPECT_LT(most / least, 1.03);
}

TEST(CameraController, CutsNothingOffAPersonWhoLiftsABoxAgainAndAgain) {
  LiveTake take("front");
  take.Play("lift", 40, [&](double secs, const Span& span, double) {
    EXPECT_GT(span.top, 0.05) << secs;
    EXPECT_LT(span.bottom, 1.01) << secs;
  });
}

TEST(CameraController, MakesOneRevolutionPerClip) {
  CameraOptions options;
  options.orbit.Parse("turn");
  CameraController controller(ParseCamera("front"), options);
  ASSERT_TRUE(controller.needs_prescan());
  for (const double secs : {0.0, 2.0, 4.0}) controller.Prescan(SceneAt(secs, 0));
  const render::Camera first = controller.Aim(SceneAt(0, 0), kAspect);
  const render::Camera quarter = controller.Aim(SceneAt(1, 0), kAspect);
  const render::Camera last = controller.Aim(SceneAt(4, 0), kAspect);
  const Vector3d from = first.position - first.target;
  const Vector3d turned(-from.y(), from.x(), from.z());
  EXPECT_NEAR((quarter.position - quarter.target - turned).norm(), 0, 1e-9);
  EXPECT_NEAR((last.position - first.position).norm(), 0, 1e-9);
}

void ExpectAllShown(const SceneState& state, const render::Camera& camera) {
  for (const urdf::Pose& link : state.people[0].links) {
    const render::Projected at = render::Project(link.position, camera, 1600, 900);
    EXPECT_TRUE(at.x_px > 0 && at.x_px < 1600 && at.y_px > 0 && at.y_px < 900);
  }
}

TEST(CameraController, FramesTheWholeClipWithACameraThatStandsStill) {
  CameraOptions options;
  options.fit = Fit::kClip;
  CameraController controller(ParseCamera("left"), options);
  for (const double x : {-0.4, 0.0, 0.5}) controller.Prescan(SceneAt(x + 2, x));
  const render::Camera camera = controller.Aim(SceneAt(0, -0.4), kAspect);
  EXPECT_EQ(controller.Aim(SceneAt(5, 0.5), kAspect).position, camera.position);
  for (const double x : {-0.4, 0.5}) ExpectAllShown(SceneAt(0, x), camera);
}

TEST(CameraController, GoesAtOneDistanceWithPeopleWhoWouldBeMuchSmallerOtherwise) {
  CameraController controller(ParseCamera("left"), {}, Fit::kClip);
  for (double x = -3; x < 9; x += 0.1) controller.Prescan(SceneAt(x + 3, x));
  const render::Camera first = controller.Aim(SceneAt(0, -3), kAspect);
  for (double x = -3; x < 9; x += 0.1) {
    const SceneState scene = SceneAt(x + 3, x);
    const render::Camera camera = controller.Aim(scene, kAspect);
    EXPECT_NEAR(render::ShownHeight(camera), render::ShownHeight(first), 1e-9);
    ExpectAllShown(scene, camera);
  }
  EXPECT_LT(render::ShownHeight(first), 3);
}

SceneState WithoutPeople(double secs, const Vector3d& lowest, const Vector3d& highest) {
  SceneState state;
  state.stamp_nanos = 5'000'000'000 + std::llround(1e9 * secs);
  state.extent = {lowest, highest};
  return state;
}

void ExpectShown(const Eigen::AlignedBox3d& box, const render::Camera& camera, int width) {
  for (int i = 0; i < 8; ++i) {
    const Vector3d corner = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
    const render::Projected at = render::Project(corner, camera, width, 900);
    EXPECT_TRUE(at.x_px > 0 && at.x_px < width && at.y_px > 0 && at.y_px < 900) << i;
  }
}

TEST(CameraController, ShowsWhatThereIsWithoutPeople) {
  for (const Vector3d& highest : {Vector3d(0.2, 0.1, 0.3), Vector3d(40, 30, 5)}) {
    const SceneState scene = WithoutPeople(0, Vector3d::Zero(), highest);
    for (const int width : {1600, 500}) {
      const double aspect = width / 900.0;
      CameraController controller(ParseCamera("iso"), {}, Fit::kNow);
      ExpectShown(scene.extent, controller.Only(scene, 0, aspect), width);
      ExpectShown(scene.extent, controller.Aim(scene, aspect), width);
      ExpectShown(scene.extent, controller.AimLive(scene, {aspect, {}}, std::nullopt), width);
    }
  }
}

TEST(CameraController, StandsStillInAClipWithoutPeople) {
  CameraController controller(ParseCamera("left"), {}, Fit::kClip);
  SceneState nothing = WithoutPeople(0, Vector3d::Zero(), Vector3d::Zero());
  nothing.extent.setEmpty();
  const SceneState early = WithoutPeople(1, {0, 0, 0}, {1, 1, 1}),
                   late = WithoutPeople(2, {3, 0, 0}, {4, 1, 1});
  for (const SceneState& scene : {nothing, early, late}) controller.Prescan(scene);
  const render::Camera camera = controller.Aim(nothing, kAspect);
  ExpectShown(early.extent.merged(late.extent), camera, 1600);
  EXPECT_EQ(controller.Aim(late, kAspect).position, camera.position);
}

TEST(CameraController, FitsByItselfOnlyWhatIsNamed) {
  const SceneState scene = SceneAt(0, 0);
  CameraOptions off;
  off.fit = Fit::kOff;
  const render::Camera far = CameraController(ParseCamera("front"), off).Only(scene, 0, kAspect);
  const render::Camera near =
      CameraController(ParseCamera("front"), {}, Fit::kNow).Only(scene, 0, kAspect);
  EXPECT_LT(render::ShownHeight(near), 0.95 * render::ShownHeight(far));
  const CameraController placed(ParseCamera("9,8,7:0,0,1"), {}, Fit::kNow);
  EXPECT_EQ(placed.Only(scene, 0, kAspect).position, Vector3d(9, 8, 7));
}

TEST(CameraController, KeepsBesideThePersonWhatIsAddedToThePicture) {
  const SceneState scene = SceneAt(0, 0);
  const CameraController controller(ParseCamera("front"), {}, Fit::kNow);
  const render::Camera alone = controller.Only(scene, 0, kAspect);
  const render::Camera both = controller.Only(scene, 0, kAspect, {{Vector3d(0, 0, 3), 0.1}});
  EXPECT_GT(render::ShownHeight(both), 1.4 * render::ShownHeight(alone));
}

TEST(CameraController, AcceptsNamedCamerasInKeyframes) {
  const kinescope::testing::TempFolder folder;
  const std::string path = folder.path() / "keys.yaml";
  std::ofstream(path) << "keys:\n"
                         "  - {time: 0, camera: front, ease: linear}\n"
                         "  - time: 2\n"
                         "    position: [1, -4, 2]\n"
                         "    target: [1, 0, 1]\n"
                         "    fov: 50\n";
  const CameraController controller(ParseCamera(path), {});
  const SceneState scene = SceneAt(0, 1);
  EXPECT_EQ(controller.Only(scene, 0, kAspect).position,
            render::NamedCamera("front", scene).position);
  const render::Camera last = controller.Only(scene, 7, kAspect);
  EXPECT_EQ(last.position, Vector3d(1, -4, 2));
  EXPECT_NEAR(last.vertical_fov_rad, 50 * M_PI / 180, 1e-12);
  EXPECT_EQ(controller.name(), "keys.yaml");
}

TEST(CameraController, ReportsFileAndLineOfAnInvalidKeyframe) {
  const kinescope::testing::TempFolder folder;
  const std::string path = folder.path() / "keys.yaml";
  const auto complaint = [&](const std::string& keys) {
    std::ofstream(path) << "keys:\n" << keys;
    return Complaint(path);
  };
  EXPECT_EQ(complaint("  - {time: 0, camera: top}\n"), "");
  EXPECT_THAT(complaint("  - {time: 0, camera: top}\n  - {time: 0, camera: top}\n"),
              AllOf(HasSubstr("keys.yaml: line 3"), HasSubstr("more than 0")));
  EXPECT_THAT(complaint("  - {time: 0, camera: botom}\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("botom"), HasSubstr("three_quarter")));
  EXPECT_THAT(complaint("  - {time: .nan, camera: top}\n"), HasSubstr("time: .nan"));
  EXPECT_THAT(complaint("  - {time: 1, position: [0, 0, 1]}\n"), HasSubstr("target"));
  EXPECT_THAT(complaint("  - {time: 1, position: [0, 1], target: [0, 0, 0]}\n"),
              HasSubstr("position: expected [x, y, z]"));
  EXPECT_THAT(complaint("  - {time: 1, position: [0, 0, 1], target: [0, 0, 1]}\n"),
              HasSubstr("position that differs from the target"));
  EXPECT_THAT(complaint("  - {time: 1, camera: top, speed: 3}\n"), HasSubstr("'speed'"));
  EXPECT_THAT(complaint("  - [1, 2\n"), HasSubstr("line"));
  EXPECT_THAT(complaint(""), HasSubstr("'keys:'"));
  EXPECT_THAT(Complaint(folder.path() / "none.yaml"), HasSubstr("none.yaml"));
}

TEST(CameraController, RejectsInvalidCameraOptions) {
  EXPECT_THAT(Complaint("1,2,3:1,2"), HasSubstr("X,Y,Z"));
  EXPECT_THAT(Complaint("1,2,3:1,2,nan"), HasSubstr("X,Y,Z"));
  EXPECT_THAT(Complaint("1,2,3:1,2,3"), HasSubstr("position that differs from the target"));
  EXPECT_THAT(Complaint("1,2,3:"), HasSubstr("X,Y,Z"));
  const auto error = [](const char* name, const char* text) {
    CameraOptions options;
    options::OptionList list;
    options.List(list);
    try {
      list.Set(*list.Find(name), name, {text}, options::Channel::kCommandLine);
    } catch (const UsageError& refusal) {
      return std::string(refusal.what());
    }
    return std::string();
  };
  EXPECT_THAT(error("orbit", "fast"), AllOf(HasSubstr("--orbit=fast"), HasSubstr("turn")));
  EXPECT_THAT(error("fov", "200"), HasSubstr("from 1 to 150 degrees"));
  EXPECT_THAT(error("follow", "-1"), HasSubstr("--follow=-1"));
  EXPECT_THAT(error("projection", "fisheye"), HasSubstr("perspective or orthographic"));
  EXPECT_THAT(error("fit", "tight"), HasSubstr("auto, off, now or clip"));
}

}  // namespace
}  // namespace kinescope::app
