// What a picture costs at 1280 x 720: drawing and reading back, with and without anti-aliasing,
// with a standing and with a moving camera, and what it costs to encode it. CPU time counts all
// threads.

#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>

#include "render/png_file.h"
#include "render/renderer.h"
#include "render/video.h"
#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using kinescope::testing::MixedScene;
using kinescope::testing::Posture;

// A person who sways, so that no two pictures are the same.
class Sway {
 public:
  const SceneState& Next() {
    ++step_;
    const Eigen::Vector3d shift(0, 0.002 * std::sin(0.1 * step_), 0);
    PersonState& person = state_.people[0];
    for (urdf::Pose& pose : person.links) pose.position += shift;
    for (JointLoad& load : person.loads) load.position += shift;
    state_.counter += 1;
    state_.time_code_millis += 16;
    return state_;
  }
  const SceneState& state() const { return state_; }

 private:
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
  Sway sway;
  View view;
  view.supersample = static_cast<int>(run.range(0));
  view.overlays = run.range(1) != 0;
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

// From nothing to the first picture, in a process that has loaded the module already (see the test
// programs for a cold start: it adds the loading of VTK, Mesa and LLVM).
void FirstPicture(benchmark::State& run) {
  const SceneState state = MixedScene(Posture::kStanding);
  const Camera camera = NamedCamera("front", state);
  for (auto _ : run)
    benchmark::DoNotOptimize(MakeRenderer()->Render(state, camera, View()).rgba.data());
}

Image Sample() {
  const SceneState state = MixedScene(Posture::kStanding);
  return MakeRenderer()->Render(state, NamedCamera("three_quarter", state), View());
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
  for (int i = 0; i < 30; ++i) pictures.push_back(renderer->Render(sway.Next(), camera, View()));
  const auto path = std::filesystem::temp_directory_path() / "kinescope_render_bench.mp4";
  const auto video = MakeVideoWriter(path, 1280, 720, {});
  std::size_t next = 0;
  for (auto _ : run) video->Add(pictures[next++ % pictures.size()]);
  SetRate(run);
}

BENCHMARK(DrawStandingCamera)
    ->ArgNames({"supersample", "overlays"})
    ->Args({1, 0})
    ->Args({1, 1})
    ->Args({2, 1})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(DrawMovingCamera)
    ->ArgNames({"supersample", "overlays"})
    ->Args({1, 0})
    ->Args({2, 0})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(FirstPicture)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(Jpeg)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(Png)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(H264)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace kinescope::render
