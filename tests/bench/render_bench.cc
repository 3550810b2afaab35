// What a picture costs at 1280 x 720: drawing and reading back, with and without anti-aliasing,
// with a standing and with a moving camera, and what it costs to encode it. CPU time counts all
// threads. And what the skin of one body costs before it is drawn, on one thread.

#include <benchmark/benchmark.h>
#include <dlfcn.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <vector>

#include "render/image/png_file.h"
#include "render/renderer.h"
#include "render/video.h"
#include "tests/render/test_scene.h"
#include "urdf/kinematics.h"
#include "urdf/skeleton.h"
#include "urdf/skin/occlusion.h"
#include "urdf/skin/person_skin.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::render {
namespace {

using kinescope::testing::MixedScene;
using kinescope::testing::Posture;

// A person who sways, so that no two pictures are the same.
class Sway {
 public:
  explicit Sway(int people = 1, bool is_skin = false) {
    if (is_skin) {
      const auto model = std::make_shared<PersonModel>(*state_.people[0].model);
      model->has_built_in_surface = true;
      state_.people[0].model = model;
    }
    for (int i = 1; i < people; ++i) {
      state_.people.push_back(state_.people[0]);
      state_.people.back().character = i;
      Shift(state_.people.back(), {0, 0.9 * i, 0});
    }
  }
  const SceneState& Next() {
    ++step_;
    for (PersonState& person : state_.people) Shift(person, {0, 0.002 * std::sin(0.1 * step_), 0});
    state_.counter += 1;
    state_.time_code_millis += 16;
    return state_;
  }
  const SceneState& state() const { return state_; }

 private:
  static void Shift(PersonState& person, const Eigen::Vector3d& by) {
    for (urdf::Pose& pose : person.links) pose.position += by;
    for (JointLoad& load : person.loads) load.position += by;
  }

  SceneState state_ = MixedScene(Posture::kStanding);
  int step_ = 0;
};

void SetRate(benchmark::State& run) {
  run.counters["pictures/s"] =
      benchmark::Counter(static_cast<double>(run.iterations()), benchmark::Counter::kIsRate);
}

void Draw(benchmark::State& run, bool moves) {
  const auto renderer = MakeRenderer();
  run.SetLabel(renderer->renderer_string());
  Sway sway(static_cast<int>(run.range(2)), run.range(4) != 0);
  PictureSpec view;
  view.supersample = static_cast<int>(run.range(0));
  view.overlays = run.range(1) != 0;
  if (run.range(3) != 0) view.look.detail = Detail::kBySize;
  Camera camera = NamedCamera("three_quarter", sway.state());
  Image image;
  for (int i = 0; i < 3; ++i) renderer->RenderInto(image, sway.Next(), camera, view);
  for (auto _ : run) {
    if (moves) camera.position.y() += 1e-4;
    renderer->RenderInto(image, sway.Next(), camera, view);
    benchmark::DoNotOptimize(image.rgba.data());
  }
  SetRate(run);
}

void DrawStandingCamera(benchmark::State& run) { Draw(run, false); }
void DrawMovingCamera(benchmark::State& run) { Draw(run, true); }

// The floor: what no drawing can be cheaper than, in the renderer's own context. A framebuffer is
// cleared and read into memory, as a picture is that has been drawn, and nothing else.
class BareGl {
 public:
  BareGl(unsigned width, unsigned height) : width_(width), height_(height) {
    // Loaded by the renderer already, for itself alone.
    void* library = ::dlopen("libOSMesa.so.8", RTLD_LAZY | RTLD_NOLOAD);
    using Find = void* (*)(const char*);
    const auto find = library != nullptr
                          ? reinterpret_cast<Find>(::dlsym(library, "OSMesaGetProcAddress"))
                          : nullptr;
    if (find == nullptr) {
      std::fprintf(stderr, "no OSMesa here\n");
      std::abort();
    }
    clear_color_ = reinterpret_cast<ClearColor>(find("glClearColor"));
    clear_ = reinterpret_cast<Clear>(find("glClear"));
    read_ = reinterpret_cast<ReadPixels>(find("glReadPixels"));
    const auto generate_textures = reinterpret_cast<Generate>(find("glGenTextures"));
    const auto generate_framebuffers = reinterpret_cast<Generate>(find("glGenFramebuffers"));
    unsigned texture = 0, framebuffer = 0;
    generate_textures(1, &texture);
    reinterpret_cast<Bind>(find("glBindTexture"))(kTexture2d, texture);
    reinterpret_cast<TexImage>(find("glTexImage2D"))(kTexture2d, 0, kRgba8, static_cast<int>(width),
                                                     static_cast<int>(height), 0, kRgba,
                                                     kUnsignedByte, nullptr);
    generate_framebuffers(1, &framebuffer);
    reinterpret_cast<Bind>(find("glBindFramebuffer"))(kFramebuffer, framebuffer);
    reinterpret_cast<Attach>(find("glFramebufferTexture2D"))(kFramebuffer, kColorAttachment,
                                                             kTexture2d, texture, 0);
  }

  void ClearAndRead(float level, Image& image) {
    clear_color_(level, level, level, 1);
    clear_(kColorBuffer);
    read_(0, 0, static_cast<int>(width_), static_cast<int>(height_), kRgba, kUnsignedByte,
          image.rgba.data());
  }

 private:
  // GL's headers are the drawing module's; these are OpenGL 3.2's numbers.
  static constexpr unsigned kTexture2d = 0x0DE1, kRgba = 0x1908, kRgba8 = 0x8058;
  static constexpr unsigned kUnsignedByte = 0x1401, kFramebuffer = 0x8D40;
  static constexpr unsigned kColorAttachment = 0x8CE0, kColorBuffer = 0x4000;
  using ClearColor = void (*)(float, float, float, float);
  using Clear = void (*)(unsigned);
  using ReadPixels = void (*)(int, int, int, int, unsigned, unsigned, void*);
  using Generate = void (*)(int, unsigned*);
  using Bind = void (*)(unsigned, unsigned);
  using TexImage = void (*)(unsigned, int, int, int, int, int, unsigned, unsigned, const void*);
  using Attach = void (*)(unsigned, unsigned, unsigned, unsigned, int);

  unsigned width_, height_;
  ClearColor clear_color_;
  Clear clear_;
  ReadPixels read_;
};

void ClearAndReadBack(benchmark::State& run) {
  const auto renderer = MakeRenderer();
  PictureSpec view;
  view.width = 1280 * static_cast<int>(run.range(0));
  view.height = 720 * static_cast<int>(run.range(0));
  Sway sway;
  Image image = renderer->Render(sway.state(), NamedCamera("front", sway.state()), view);
  BareGl gl(static_cast<unsigned>(view.width), static_cast<unsigned>(view.height));
  int step = 0;
  for (auto _ : run) {
    gl.ClearAndRead(static_cast<float>(++step % 100) / 100, image);
    benchmark::DoNotOptimize(image.rgba.data());
  }
  SetRate(run);
}

// From nothing to the first picture, in a process that has loaded the module already (see the test
// programs for a cold start: it adds the loading of VTK, Mesa and LLVM).
void FirstPicture(benchmark::State& run) {
  const SceneState state = MixedScene(Posture::kStanding);
  const Camera camera = NamedCamera("front", state);
  for (auto _ : run)
    benchmark::DoNotOptimize(MakeRenderer()->Render(state, camera, PictureSpec()).rgba.data());
}

Image Sample() {
  const SceneState state = MixedScene(Posture::kStanding);
  return MakeRenderer()->Render(state, NamedCamera("three_quarter", state), PictureSpec());
}

void Jpeg(benchmark::State& run) {
  const Image image = Sample();
  std::size_t size = 0;
  for (auto _ : run) size = EncodeJpeg(image, 80).size();
  run.counters["bytes"] = static_cast<double>(size);
  SetRate(run);
}

void Png(benchmark::State& run) {
  const Image image = Sample();
  std::size_t size = 0;
  for (auto _ : run) size = EncodePng(image).size();
  run.counters["bytes"] = static_cast<double>(size);
  SetRate(run);
}

void H264(benchmark::State& run) {
  const auto renderer = MakeRenderer();
  Sway sway;
  std::vector<Image> pictures;
  const Camera camera = NamedCamera("three_quarter", sway.state());
  for (int i = 0; i < 30; ++i)
    pictures.push_back(renderer->Render(sway.Next(), camera, PictureSpec()));
  const auto path = std::filesystem::temp_directory_path() / "kinescope_render_bench.mp4";
  const auto video = MakeVideoWriter(path, 1280, 720, {});
  std::size_t next = 0;
  for (auto _ : run) video->Add(pictures[next++ % pictures.size()]);
  SetRate(run);
}

// All vertices of the whole skin: their places by the frames, the folds at elbows, hips and knees
// (all bent, so that flesh meets), normals, and how much of the sky limbs cover.
void PoseSkin(benchmark::State& run) {
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  const skin::Build build;
  const skin::PersonSkin person(skin::BuiltInSkin(), build, skeleton);
  const std::vector<skin::LimbRun> limbs = skin::LimbRunsOf(skin::BuiltInSkin().weights);
  urdf::JointAngles angles{};
  for (const int joint : {urdf::jRightElbow, urdf::jLeftElbow, urdf::jRightHip, urdf::jLeftHip}) {
    angles[urdf::At(joint)].y() = -2;
  }
  for (const int joint : {urdf::jRightKnee, urdf::jLeftKnee}) angles[urdf::At(joint)].y() = 2;
  skin::PersonSkin::Surface surface;
  std::vector<float> open_sky;
  for (auto _ : run) {
    angles[urdf::jT9T8].z() += 1e-4;
    const urdf::LinkPoses links = urdf::ForwardKinematics(skeleton, {}, angles);
    person.Pose(links, {}, surface);
    skin::SetOpenSky(surface.positions, surface.normals, limbs,
                     skin::CapsulesOf(skeleton, build, links), open_sky);
    benchmark::DoNotOptimize(open_sky.data());
  }
  run.counters["vertices"] = static_cast<double>(open_sky.size());
}

BENCHMARK(PoseSkin)->Unit(benchmark::kMillisecond);
BENCHMARK(DrawStandingCamera)
    ->ArgNames({"supersample", "overlays", "people", "by_size", "skin"})
    ->Args({1, 0, 1, 0, 0})
    ->Args({1, 0, 1, 0, 1})
    ->Args({1, 0, 1, 1, 1})
    ->Args({1, 1, 1, 0, 0})
    ->Args({1, 1, 1, 1, 1})
    ->Args({1, 1, 4, 0, 0})
    ->Args({1, 1, 4, 1, 0})
    ->Args({1, 1, 4, 1, 1})
    ->Args({2, 1, 1, 0, 0})
    ->Args({2, 1, 1, 0, 1})
    ->Args({2, 1, 1, 1, 1})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(DrawMovingCamera)
    ->ArgNames({"supersample", "overlays", "people", "by_size", "skin"})
    ->Args({1, 0, 1, 0, 0})
    ->Args({1, 1, 4, 0, 0})
    ->Args({1, 1, 4, 1, 0})
    ->Args({2, 0, 1, 0, 0})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(ClearAndReadBack)
    ->ArgName("supersample")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(FirstPicture)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(Jpeg)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(Png)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(H264)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace kinescope::render
