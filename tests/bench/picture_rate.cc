// What a moving person costs Kinescope, for comparison with RViz by rviz_peer.sh, from the same
// camera. Usage: picture_rate SECONDS [skin|urdf [back-end]]. CPU time is of all threads, memory
// that of this process, which draws only.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "render/camera/camera.h"
#include "render/renderer.h"
#include "server/scene/scene_options.h"
#include "server/scene/scene_reader.h"
#include "tests/bench/cpu_time.h"

namespace {

using namespace kinescope;

double ResidentMegabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmRSS:", 0) == 0) return std::atof(line.c_str() + 6) / 1024;
  }
  return 0;
}

// RViz's Orbit view in rviz_peer.sh, whose field of view is fixed.
render::Camera PeerCamera() {
  constexpr double kDistance = 3, kYaw = 0.6, kPitch = 0.25;
  render::Camera camera;
  camera.target = {0, 0, 0.9};
  camera.position = camera.target + kDistance * Eigen::Vector3d(std::cos(kYaw) * std::cos(kPitch),
                                                                std::sin(kYaw) * std::cos(kPitch),
                                                                std::sin(kPitch));
  camera.vertical_fov_rad = M_PI / 4;
  return camera;
}

void Measure(render::Renderer& renderer, render::Figure::Kind figure, int supersample,
             bool overlays, double secs) {
  using Clock = std::chrono::steady_clock;
  app::SceneReader reader("demo:lift", app::ToShownSceneOptions(app::PersonOptions()));
  auto scene = reader.Next();
  const render::Camera camera = PeerCamera();
  render::PictureSpec spec;
  spec.supersample = supersample;
  spec.overlays = overlays;
  spec.look.figure = figure;
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
  std::printf(
      "kinescope %s %dx%d, %dx, overlays %s: %.1f pictures/s, CPU %.2f ms a picture, %.0f MB\n",
      figure == render::Figure::kUrdf ? "urdf" : "skin", spec.width, spec.height, supersample,
      overlays ? "on" : "off", pictures / elapsed(), 1000 * (CpuSecs() - cpu) / pictures,
      ResidentMegabytes());
}

}  // namespace

int main(int argc, char** argv) {
  const double secs = argc > 1 ? std::atof(argv[1]) : 10;
  const auto figure =
      argc > 2 && std::string(argv[2]) == "urdf" ? render::Figure::kUrdf : render::Figure::kSkin;
  const auto renderer = render::MakeRenderer(argc > 3 ? argv[3] : "osmesa");
  Measure(*renderer, figure, 1, false, secs);
  Measure(*renderer, figure, 1, true, secs);
  Measure(*renderer, figure, 2, true, secs);
}
