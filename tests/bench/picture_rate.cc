// What a moving person costs us, for comparison with RViz by rviz_peer.sh.
// Usage: picture_rate SECONDS [back-end]. CPU time is of all threads.
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "render/camera/camera.h"
#include "render/renderer.h"
#include "server/scene/scene_reader.h"

namespace {

using namespace kinescope;

double CpuSecs() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto secs = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return secs(usage.ru_utime) + secs(usage.ru_stime);
}

void Measure(render::Renderer& renderer, int supersample, bool overlays, double secs) {
  using Clock = std::chrono::steady_clock;
  app::SceneReader reader("demo:lift", app::SceneOptions());
  auto scene = reader.Next();
  const render::Camera camera = render::NamedCamera("three_quarter", *scene);
  render::PictureSpec spec;
  spec.supersample = supersample;
  spec.overlays = overlays;
  render::Image image;
  for (int i = 0; i < 10; ++i) renderer.RenderInto(image, *(scene = reader.Next()), camera, spec);
  const double cpu = CpuSecs();
  const auto start = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  int pictures = 0;
  for (; elapsed() < secs; ++pictures) {
    scene = reader.Next();  // reading and loads of a sample are in the figure
    renderer.RenderInto(image, *scene, camera, spec);
  }
  std::printf("kinescope %dx%d, %dx, overlays %s: %.1f pictures/s, CPU %.2f ms a picture\n",
              spec.width, spec.height, supersample, overlays ? "on" : "off", pictures / elapsed(),
              1000 * (CpuSecs() - cpu) / pictures);
}

}  // namespace

int main(int argc, char** argv) {
  const double secs = argc > 1 ? std::atof(argv[1]) : 10;
  const auto renderer = render::MakeRenderer(argc > 2 ? argv[2] : "osmesa");
  std::printf("%s\n", renderer->renderer_string().c_str());
  Measure(*renderer, 1, false, secs);
  Measure(*renderer, 1, true, secs);
  Measure(*renderer, 2, true, secs);
}
