#include "render/renderer.h"

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <link.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <future>
#include <limits>
#include <mutex>
#include <thread>

#include "core/person_links.h"
#include "core/system/errors.h"
#include "render/camera/spheres.h"
#include "render/image/compare.h"
#include "render/watchdog.h"
#include "tests/render/test_scene.h"
#include "urdf/body_surface.h"

namespace kinescope::render {
namespace {

using kinescope::testing::MakePersonModel;
using kinescope::testing::MixedScene;
using kinescope::testing::Posture;
using kinescope::testing::SceneWith;

PictureSpec SmallView(bool overlays = false) {
  PictureSpec spec;
  spec.width = 640;
  spec.height = 360;
  spec.overlays = overlays;
  return spec;
}

SceneState EmptyScene() {
  SceneState state;
  state.liveness = Liveness::kLive;
  return state;
}

// Largest channel difference between two pictures where `point` lies.
int DifferenceAt(const Image& a, const Image& b, const Camera& camera,
                 const Eigen::Vector3d& point) {
  const Projected at = Project(point, camera, a.width, a.height);
  const std::size_t pixel =
      4 * (static_cast<std::size_t>(at.y_px) * static_cast<std::size_t>(a.width) +
           static_cast<std::size_t>(at.x_px));
  int largest = 0;
  for (std::size_t i = pixel; i < pixel + 3; ++i) {
    largest = std::max(largest, std::abs(a.rgba.at(i) - b.rgba.at(i)));
  }
  return largest;
}

// The smooth body's meshes, in memory.
class SmoothBody : public MeshFiles {
 public:
  explicit SmoothBody(const urdf::Skeleton& skeleton) : skeleton_(skeleton) {}
  std::shared_ptr<const std::string> Content(const std::string& name) const override {
    for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
      if (name != std::to_string(segment) + ".stl") continue;
      return std::make_shared<const std::string>(
          urdf::ToBinaryStl(urdf::SegmentMesh(skeleton_, segment)));
    }
    return nullptr;
  }
  bool Provide() const override { return false; }

 private:
  const urdf::Skeleton skeleton_;
};

SceneState SceneWithSmoothBody() {
  SceneState state = MixedScene(Posture::kArmsForward);
  auto model = std::make_shared<PersonModel>(*state.people[0].model);
  const std::vector<std::string> names = VisibleLinks(model->human);
  for (urdf::Link& link : model->robot.links) {
    const auto name = std::find(names.begin(), names.end(), link.name);
    link.visuals.clear();
    if (name == names.end()) continue;
    urdf::Visual visual;
    visual.geometry.kind = urdf::Geometry::Kind::kMesh;
    visual.geometry.mesh_uri = "file:///" + std::to_string(name - names.begin()) + ".stl";
    visual.geometry.size = {1, 1, 1};
    link.visuals.push_back(visual);
  }
  model->mesh_files = std::make_shared<SmoothBody>(model->human.skeleton);
  state.people[0].model = model;
  return state;
}

// Without spheres and marks, so that only the body can be what is seen.
SceneState BareScene(Posture posture, double x = 0, double y = 0) {
  SceneState state = SceneWith(posture, LoadClass::kLow, x, y);
  state.people[0].loads.clear();
  state.people[0].com.reset();
  state.people[0].cop.reset();
  return state;
}

TEST(Renderer, ShowsThePersonAtThePositionOfTheState) {
  const auto renderer = MakeRenderer();
  for (const Posture posture : {Posture::kStanding, Posture::kDeepBend, Posture::kArmsForward}) {
    const SceneState state = BareScene(posture, 1.5, -0.5);
    for (const std::string& name : CameraNames()) {
      const Camera camera = NamedCamera(name, state);
      const Image picture = renderer->Render(state, camera, SmallView());
      const Image floor = renderer->Render(EmptyScene(), camera, SmallView());
      const urdf::Skeleton& skeleton = state.people[0].model->human.skeleton;
      for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
        const urdf::Pose& pose = state.people[0].links[static_cast<std::size_t>(segment)];
        const Eigen::Vector3d middle =
            pose.position + pose.orientation * (0.5 * urdf::EndOf(skeleton, segment));
        EXPECT_GT(DifferenceAt(picture, floor, camera, middle), 6)
            << name << ": nothing is drawn at "
            << urdf::kSegments[static_cast<std::size_t>(segment)].link_name;
      }
      const Eigen::Vector3d right = (camera.target - camera.position).cross(camera.up).normalized();
      for (const double side : {-1.3, 1.3}) {
        EXPECT_EQ(DifferenceAt(picture, floor, camera, camera.target + side * right), 0)
            << name << ": something is drawn where nobody is";
      }
    }
  }
}

TEST(Renderer, RendersTheSameBytesForTheSameStateAfterAnyOtherPicture) {
  const SceneState state = MixedScene(Posture::kDeepBend);
  const Camera camera = NamedCamera("three_quarter", state);
  PictureSpec spec = SmallView(true);
  spec.title = "trial";
  for (const int supersample : {1, 2}) {
    spec.supersample = supersample;
    const auto first = MakeRenderer();
    const auto second = MakeRenderer();
    const Image picture = first->Render(state, camera, spec);
    // The second and third find the floor unchanged and take it from memory.
    EXPECT_EQ(first->Render(state, camera, spec).rgba, picture.rgba);
    EXPECT_EQ(first->Render(state, camera, spec).rgba, picture.rgba);
    EXPECT_EQ(second->Render(state, camera, spec).rgba, picture.rgba);
    const SceneState other = SceneWith(Posture::kStanding, LoadClass::kHigh);
    second->Render(other, NamedCamera("top", other), SmallView());
    second->Render(SceneState(), NamedCamera("top", other), SmallView());
    EXPECT_EQ(second->Render(state, camera, spec).rgba, picture.rgba);
    EXPECT_EQ(first->Render(state, camera, spec).rgba, picture.rgba);
  }
}

TEST(Renderer, RendersTheSameBytesInEightThreads) {
  const SceneState state = MixedScene(Posture::kStanding);
  const Camera camera = NamedCamera("iso", state);
  PictureSpec spec = SmallView(true);
  spec.width = 160;
  spec.height = 90;
  const Image expected = MakeRenderer()->Render(state, camera, spec);
  std::array<Image, 8> pictures;
  std::array<std::thread, 8> threads;
  for (std::size_t i = 0; i < threads.size(); ++i) {
    threads[i] = std::thread([&, i] {
      const auto renderer = MakeRenderer();
      for (int k = 0; k < 5; ++k) pictures[i] = renderer->Render(state, camera, spec);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const Image& picture : pictures) EXPECT_EQ(picture.rgba, expected.rgba);
}

// Recordings without leg sensors have the pelvis near z = 0 and the floor below it.
TEST(Renderer, ShowsTheSamePictureAtAnyFloorHeight) {
  SceneState here = MixedScene(Posture::kStanding);
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    PersonState& person = here.people.at(0);
    HandForce& hand = person.forces.hands[side];
    hand.mass_kg = 8;
    hand.grip = hand.point = person.links[urdf::At(urdf::HandSegmentOf(side))].position;
    person.forces.feet[side].force = {0, 0, 400};
    person.forces.feet[side].cop = {0.1, side == urdf::kRight ? -0.1 : 0.1, 0};
  }
  SceneState lower = here;
  lower.floor_z = -0.75;  // a power of two and a half: no rounding
  const Eigen::Vector3d down(0, 0, lower.floor_z);
  PersonState& person = lower.people.at(0);
  for (urdf::Pose& link : person.links) link.position += down;
  for (JointLoad& load : person.loads) load.position += down;
  *person.com += down;
  *person.cop += down;
  for (HandForce& hand : person.forces.hands) {
    hand.grip += down;
    hand.point += down;
  }
  for (FootForce& foot : person.forces.feet) foot.cop += down;
  const auto renderer = MakeRenderer();
  PictureSpec spec;
  spec.width = 320;
  spec.height = 180;
  const Image a = renderer->Render(here, NamedCamera("front", here), spec);
  const Image b = renderer->Render(lower, NamedCamera("front", lower), spec);
  EXPECT_LE(Compare(a, b).pixels, 5) << Describe(Compare(a, b), b);  // of 57600; edges may round
}

TEST(Renderer, RendersOpaquePixelsOnly) {
  const Image image =
      MakeRenderer()->Render(MixedScene(Posture::kStanding), Camera(), SmallView(true));
  for (std::size_t at = 3; at < image.rgba.size(); at += 4) ASSERT_EQ(image.rgba[at], 255);
}

TEST(Renderer, ReusesTheMemoryOfAPictureOfAnySize) {
  const auto renderer = MakeRenderer();
  const SceneState state = MixedScene(Posture::kStanding);
  PictureSpec spec = SmallView();
  const Image expected = renderer->Render(state, Camera(), spec);
  Image image;
  spec.width = 900;
  renderer->RenderInto(image, state, Camera(), spec);
  const std::uint8_t* memory = image.rgba.data();
  spec.width = 640;
  renderer->RenderInto(image, state, Camera(), spec);
  EXPECT_EQ(image.rgba.data(), memory);
  EXPECT_EQ(image.rgba, expected.rgba);
  EXPECT_EQ(image.width, 640);
}

TEST(Renderer, ShowsStaleAndMissingDataClearly) {
  const auto renderer = MakeRenderer();
  const SceneState live = SceneWith(Posture::kStanding, LoadClass::kUnknown);
  SceneState stale = live;
  stale.liveness = Liveness::kStale;
  const Camera camera = NamedCamera("front", live);
  const Image live_picture = renderer->Render(live, camera, SmallView(true));
  const Image stale_picture = renderer->Render(stale, camera, SmallView(true));
  const Image none_picture = renderer->Render(SceneState(), camera, SmallView(true));
  EXPECT_GT(Compare(live_picture, stale_picture).pixels, 2000);
  EXPECT_GT(Compare(live_picture, none_picture).pixels, 2000);
  EXPECT_GT(Compare(stale_picture, none_picture).pixels, 2000);
  // The body itself is darker: it shows without any overlay.
  const Image bare_live = renderer->Render(live, camera, SmallView());
  const Image bare_stale = renderer->Render(stale, camera, SmallView());
  const Eigen::Vector3d head =
      live.people[0].links[urdf::kHead].position + Eigen::Vector3d(0, 0, 0.1);
  EXPECT_GT(DifferenceAt(bare_live, bare_stale, camera, head), 30);
}

TEST(Renderer, ShowsExactlyThePeopleOfTheScene) {
  const auto renderer = MakeRenderer();
  SceneState one = SceneWith(Posture::kStanding, LoadClass::kLow, 0, -0.8);
  SceneState two = one;
  two.people.push_back(SceneWith(Posture::kArmsForward, LoadClass::kHigh, 0, 0.8).people[0]);
  two.people[1].character = 1;
  const Camera camera = NamedCamera("front", two);
  const Image before = renderer->Render(one, camera, SmallView());
  const Image both = renderer->Render(two, camera, SmallView());
  EXPECT_GT(Compare(before, both).pixels, 3000);
  EXPECT_THAT(FindSphereMismatches(both, LocateSpheres(two, camera, 640, 360)),
              ::testing::IsEmpty());
  EXPECT_EQ(renderer->Render(one, camera, SmallView()).rgba, before.rgba) << "one has left";
}

TEST(Renderer, ShowsAChangedModelAtOnce) {
  const auto renderer = MakeRenderer();
  SceneState state = BareScene(Posture::kStanding);
  const Camera camera = NamedCamera("front", state);
  const Image before = renderer->Render(state, camera, SmallView());
  auto changed = std::make_shared<PersonModel>(*state.people[0].model);
  for (urdf::Link& link : changed->robot.links) {
    for (urdf::Visual& visual : link.visuals) visual.geometry.size *= 1.2;
  }
  changed->revision = 2;
  state.people[0].model = changed;
  EXPECT_GT(Compare(before, renderer->Render(state, camera, SmallView())).pixels, 500);
}

// Live pictures: with fewer triangles, discs for domes and another program for the floor.
TEST(Renderer, LooksTheSameWithDetailBySize) {
  const auto renderer = MakeRenderer();
  const SceneState state = SceneWithSmoothBody();
  for (const char* name : {"three_quarter", "front", "top"}) {
    const Camera camera = NamedCamera(name, state);
    PictureSpec view = SmallView();
    view.width = 640;
    view.height = 480;
    const Image full = renderer->Render(state, camera, view);
    view.look.detail = Detail::kBySize;
    const Image by_size = renderer->Render(state, camera, view);
    EXPECT_GT(Compare(full, by_size, 0).pixels, 100) << name << ": it is another picture";
    const Comparison seen = Compare(full, by_size, 48);
    EXPECT_LT(seen.pixels, 640 * 480 / 400) << name << ": " << Describe(seen, by_size);
    view.look.detail = Detail::kFull;
    EXPECT_EQ(renderer->Render(state, camera, view).rgba, full.rgba) << name;
  }
}

TEST(Renderer, SmoothsEdgesAndChangesNothingElseWhenSupersampling) {
  const auto renderer = MakeRenderer();
  const SceneState state = MixedScene(Posture::kStanding);
  const Camera camera = NamedCamera("three_quarter", state);
  PictureSpec spec = SmallView();
  const Image rough = renderer->Render(state, camera, spec);
  for (const int supersample : {2, 4}) {
    spec.supersample = supersample;
    const Image smooth = renderer->Render(state, camera, spec);
    double sum = 0;
    for (std::size_t i = 0; i < rough.rgba.size(); ++i)
      sum += std::abs(rough.rgba[i] - smooth.rgba[i]);
    EXPECT_LT(sum / static_cast<double>(rough.rgba.size()), 1.5) << "levels, on average";
    EXPECT_GT(Compare(rough, smooth).pixels, 1000) << "edges must have become softer";
  }
}

// 4200 px are drawn as two tiles; the person stands on the seam.
TEST(Renderer, RendersLargePicturesWithoutSeams) {
  const auto renderer = MakeRenderer();
  const SceneState state = MixedScene(Posture::kStanding);
  PictureSpec spec = SmallView();
  spec.width = 4200;
  spec.height = 300;
  Camera camera = NamedCamera("front", state);
  // From afar with a long lens, or spheres at the edge of so wide a picture would be ovals.
  camera.vertical_fov_rad = 0.05;
  camera.position.x() = 48;
  camera.far_m = 100;
  camera.target.y() -= (4096 - 2100) / Project(camera.target, camera, 4200, 300).px_per_m;
  camera.position.y() = camera.target.y();
  const Projected pelvis =
      Project(state.people[0].links[urdf::kPelvis].position, camera, 4200, 300);
  ASSERT_NEAR(pelvis.x_px, 4096, 30) << "the test must look at the seam";
  const Image image = renderer->Render(state, camera, spec);
  EXPECT_THAT(FindSphereMismatches(image, LocateSpheres(state, camera, 4200, 300)),
              ::testing::IsEmpty());
  double seam = 0, beside = 0;
  for (std::size_t y = 0; y < 300; ++y) {
    const std::uint8_t* row = &image.rgba[4 * 4200 * y];
    seam += std::abs(row[4 * 4095] - row[4 * 4096]);
    beside += std::abs(row[4 * 4094] - row[4 * 4095]) + std::abs(row[4 * 4096] - row[4 * 4097]);
  }
  EXPECT_LT(seam, beside + 300)
      << "neighbouring columns differ more across the seam than beside it";
}

TEST(Renderer, KeepsOverlaysAwayFromThePerson) {
  const auto renderer = MakeRenderer();
  const SceneState state = MixedScene(Posture::kStanding);
  const Camera camera = NamedCamera("front", state);
  for (const auto& [width, height] :
       {std::pair{1280, 720}, {1920, 1080}, {640, 480}, {720, 1280}, {320, 180}, {160, 90}}) {
    PictureSpec spec;
    spec.width = width;
    spec.height = height;
    spec.title = "A title of usual length";
    const Image with = renderer->Render(state, camera, spec);
    spec.overlays = false;
    const Image without = renderer->Render(state, camera, spec);
    EXPECT_GT(Compare(with, without).pixels, 20);
    double left = width, right = 0;
    for (const urdf::Pose& pose : state.people[0].links) {
      const double x = Project(pose.position, camera, width, height).x_px;
      left = std::min(left, x);
      right = std::max(right, x);
    }
    const double head = Project({0, 0, 1.8}, camera, width, height).y_px;
    for (int y = static_cast<int>(head); y < height; ++y) {
      for (int x = static_cast<int>(left); x <= static_cast<int>(right); ++x) {
        const auto at = static_cast<std::size_t>(4 * (y * width + x));
        ASSERT_EQ(with.rgba[at], without.rgba[at])
            << width << " x " << height << ": overlay at " << x << ", " << y;
      }
    }
  }
}

TEST(Renderer, AcceptsAnyText) {
  const auto renderer = MakeRenderer();
  SceneState state = MixedScene(Posture::kStanding);
  state.people.push_back(state.people[0]);
  state.people[1].character = 1;
  state.people[0].name = std::string(5000, 'W');
  state.people[1].name = "\xFF\xFE\xC0 \x01";
  state.source = std::string(3000, 'x');
  PictureSpec spec = SmallView(true);
  spec.title = std::string(20000, 'M') + "\xE2\x82";
  for (const Liveness liveness : {Liveness::kLive, Liveness::kStale, Liveness::kNoData}) {
    state.liveness = liveness;
    EXPECT_EQ(renderer->Render(state, NamedCamera("front", state), spec).width, 640);
  }
}

TEST(Renderer, RejectsInvalidSizesAndSupersampling) {
  const auto renderer = MakeRenderer();
  for (const auto& [width, height] :
       {std::pair{0, 720}, {-5, 720}, {15, 720}, {1280, 8193}, {1 << 30, 16}}) {
    PictureSpec spec;
    spec.width = width;
    spec.height = height;
    EXPECT_THROW(renderer->Render(SceneState(), Camera(), spec), UsageError)
        << width << " x " << height;
  }
  PictureSpec spec;
  spec.supersample = 3;
  EXPECT_THROW(renderer->Render(SceneState(), Camera(), spec), UsageError);
  spec.supersample = 1;
  spec.width = spec.height = 16;
  EXPECT_NO_THROW(renderer->Render(SceneState(), Camera(), spec));
  spec.width = 333;
  spec.height = 17;  // odd sizes are sizes
  EXPECT_EQ(renderer->Render(SceneState(), Camera(), spec).rgba.size(), 4u * 333 * 17);
}

TEST(Renderer, OmitsNonFiniteElementsAndNamesThem) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::string> log;
  const auto renderer =
      MakeRenderer("osmesa", [&](const std::string& line) { log.push_back(line); });
  SceneState two = SceneWith(Posture::kStanding, LoadClass::kLow, 0, -0.8);
  two.people.push_back(SceneWith(Posture::kArmsForward, LoadClass::kHigh, 0, 0.8).people[0]);
  two.people[1].character = 1;
  const Camera camera = NamedCamera("front", two);
  SceneState one = two;
  one.people.pop_back();
  const Image expected = renderer->Render(one, camera, SmallView());
  EXPECT_THAT(renderer->problems(), ::testing::IsEmpty());
  two.people[1].links[urdf::kHead].orientation.x() = kNan;
  EXPECT_EQ(renderer->Render(two, camera, SmallView()).rgba, expected.rgba);
  EXPECT_THAT(renderer->problems(), ::testing::ElementsAre(::testing::HasSubstr("person 1")));
  renderer->Render(two, camera, SmallView());
  EXPECT_EQ(log, renderer->problems()) << "said once";
  one.people[0].com->z() = kNan;
  one.people[0].loads[3].position.x() = std::numeric_limits<double>::infinity();
  renderer->Render(one, camera, SmallView(true));
  EXPECT_THAT(renderer->problems(), ::testing::ElementsAre(::testing::HasSubstr("1 load sphere"),
                                                           ::testing::HasSubstr("centre of mass")));
  Camera nowhere = camera;
  nowhere.target.y() = kNan;
  EXPECT_THROW(renderer->Render(one, nowhere, SmallView()), RenderError);
}

TEST(Renderer, RejectsASecondBackEndInTheSameProcess) {
  MakeRenderer();
  try {
    MakeRenderer("egl");
    FAIL() << "two kinds of GL in one process";
  } catch (const RenderError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("osmesa"));
  }
}

// What a driver says of itself through KHR_debug, here by its own means of saying anything.
TEST(Renderer, LogsWarningsOfOpenGlOnceAndInOneLine) {
  std::vector<std::string> log;
  const auto renderer =
      MakeRenderer("osmesa", [&](const std::string& line) { log.push_back(line); });
  renderer->Render(SceneState(), Camera(), SmallView());
  EXPECT_THAT(log, ::testing::IsEmpty());
  void* osmesa = ::dlopen("libOSMesa.so.8", RTLD_LAZY | RTLD_NOLOAD);
  ASSERT_NE(osmesa, nullptr);
  using Find = void* (*)(const char*);
  using Insert = void (*)(unsigned source, unsigned type, unsigned id, unsigned severity,
                          int length, const char* message);
  const auto insert = reinterpret_cast<Insert>(
      reinterpret_cast<Find>(::dlsym(osmesa, "OSMesaGetProcAddress"))("glDebugMessageInsert"));
  constexpr unsigned kByApplication = 0x824A, kError = 0x824C, kHigh = 0x9146, kNotice = 0x826B;
  for (int i = 0; i < 2; ++i) insert(kByApplication, kError, 7, kHigh, -1, "out of\n  memory");
  insert(kByApplication, kError, 8, kNotice, -1, "a shader was recompiled");
  EXPECT_THAT(log, ::testing::ElementsAre("gl: error: out of memory"));
}

// VTK notes every step of drawing in one list of the process, without a lock: two threads that draw
// lose its strings or write into freed ones.
TEST(Renderer, LeavesTheSharedEventListOfVtkEmpty) {
  const auto renderer = MakeRenderer();
  renderer->Render(EmptyScene(), Camera(), SmallView());
  std::string path;  // of the library, which the module alone is linked with
  const auto find = [](dl_phdr_info* library, std::size_t /*size*/, void* found) {
    if (std::strstr(library->dlpi_name, "libvtkCommonSystem") == nullptr) return 0;
    *static_cast<std::string*>(found) = library->dlpi_name;
    return 1;
  };
  ASSERT_EQ(::dl_iterate_phdr(find, &path), 1);
  void* vtk = ::dlopen(path.c_str(), RTLD_LAZY | RTLD_NOLOAD);
  ASSERT_NE(vtk, nullptr);
  const auto count =
      reinterpret_cast<int (*)()>(::dlsym(vtk, "_ZN11vtkTimerLog17GetNumberOfEventsEv"));
  ASSERT_NE(count, nullptr);
  EXPECT_EQ(count(), 0);
}

TEST(Watchdog, ReportsOnceEachWorkThatExceedsItsLimit) {
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::string> said;
  Watchdog dog([&](const std::string& what) {
    const std::lock_guard<std::mutex> lock(mutex);
    said.push_back(what);
    changed.notify_one();
  });
  for (int i = 0; i < 1000; ++i) {
    const Watchdog::Work work(dog, std::chrono::hours(1), [] { return "long limit"; });
  }
  {
    const Watchdog::Work work(dog, std::chrono::milliseconds(5), [] { return "short limit"; });
    std::unique_lock<std::mutex> lock(mutex);
    ASSERT_TRUE(changed.wait_for(lock, std::chrono::seconds(20), [&] { return !said.empty(); }));
  }
  {  // the next one is watched as the first was
    const Watchdog::Work work(dog, std::chrono::milliseconds(5), [] { return "again"; });
    std::unique_lock<std::mutex> lock(mutex);
    ASSERT_TRUE(changed.wait_for(lock, std::chrono::seconds(20), [&] { return said.size() == 2; }));
  }
  EXPECT_THAT(said, ::testing::ElementsAre("short limit", "again"));
}

// As at a low priority beside a build. Nine threads share one core.
TEST(Watchdog, GivesMoreTimeWhereThreadsWaitForACore) {
  cpu_set_t all, one;
  ASSERT_EQ(::sched_getaffinity(0, sizeof all, &all), 0);
  CPU_ZERO(&one);
  for (std::size_t core = 0; CPU_COUNT(&one) == 0; ++core) {
    if (CPU_ISSET(core, &all)) CPU_SET(core, &one);
  }
  ASSERT_EQ(::sched_setaffinity(0, sizeof one, &one), 0);
  std::atomic<bool> is_over = false;
  std::vector<std::thread> busy;
  for (int i = 0; i < 8; ++i) {
    busy.emplace_back([&] {
      while (!is_over) {
      }
    });
  }
  constexpr std::chrono::milliseconds kLimit(100);
  const auto begin = Watchdog::Clock::now();
  std::promise<Watchdog::Clock::time_point> said;
  {
    Watchdog dog([&](const std::string&) { said.set_value(Watchdog::Clock::now()); });
    const Watchdog::Work work(dog, kLimit, [] { return "busy"; });
    EXPECT_GT(said.get_future().get() - begin, 2 * kLimit) << "1.25 limits, where no thread waits";
  }
  is_over = true;
  for (std::thread& each : busy) each.join();
  EXPECT_EQ(::sched_setaffinity(0, sizeof all, &all), 0);
}

TEST(Renderer, RejectsAnUnknownBackEndAndListsTheKnownOnes) {
  try {
    MakeRenderer("vulkan");
    FAIL() << "made a back-end that does not exist";
  } catch (const RenderError& error) {
    EXPECT_THAT(error.what(),
                ::testing::AllOf(::testing::HasSubstr("vulkan"), ::testing::HasSubstr("osmesa")));
  }
}

TEST(Renderer, NamesTheRenderingSoftware) {
  EXPECT_THAT(MakeRenderer()->renderer_string(), ::testing::HasSubstr("llvmpipe"));
}

// Only so does a picture not depend on the machine's processor.
TEST(Renderer, SetsTheInstructionSetUnlessTheUserChoseOne) {
  ::unsetenv("GALLIUM_OVERRIDE_CPU_CAPS");
  MakeRenderer();
  ASSERT_NE(std::getenv("GALLIUM_OVERRIDE_CPU_CAPS"), nullptr);
  EXPECT_STREQ(std::getenv("GALLIUM_OVERRIDE_CPU_CAPS"), "sse4.1");
  ::unsetenv("GALLIUM_OVERRIDE_CPU_CAPS");
  PreferSpeed();
  MakeRenderer();
  EXPECT_STREQ(std::getenv("GALLIUM_OVERRIDE_CPU_CAPS"), "avx");
  EXPECT_STREQ(std::getenv("LP_NUM_THREADS"), "1");
  ::unsetenv("GALLIUM_OVERRIDE_CPU_CAPS");
  ::unsetenv("LP_NUM_THREADS");
}

TEST(RendererDeathTest, EndsTheProcessWhenUsedOnAnotherThread) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH(
      {
        const auto renderer = MakeRenderer();
        std::thread([&] { renderer->Render(SceneState(), Camera(), SmallView()); }).join();
      },
      "owner");
}

}  // namespace
}  // namespace kinescope::render
