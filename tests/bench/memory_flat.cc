// Does drawing leak? Pictures of a moving person by one renderer; the process' memory after 1, 10
// and 100 thousand of them. Usage: memory_flat [PICTURES [back-end]].
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "render/camera/camera.h"
#include "render/renderer.h"
#include "server/scene/scene_reader.h"

namespace {

using namespace kinescope;

double RssMb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kib = 0;
    if (word == "VmRSS:" && status >> kib) return kib / 1024;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const long pictures = argc > 1 ? std::atol(argv[1]) : 100'000;
  const auto renderer = render::MakeRenderer(argc > 2 ? argv[2] : "osmesa");
  std::printf("%s\n", renderer->renderer_string().c_str());
  app::SceneReader reader("demo:lift", app::SceneOptions());
  render::Image image;
  long next_report = 1000;
  for (long i = 1; i <= pictures; ++i) {
    const auto scene = reader.Next();
    render::PictureSpec spec;
    spec.width = spec.height = 64;
    // What is kept from picture to picture is given back and made anew: another view of the floor,
    // another size.
    if (i % 10 == 0) spec.width = 80;
    if (i % 50 == 0) spec.supersample = 2;
    const auto& cameras = render::CameraNames();
    const std::string& name = cameras[static_cast<std::size_t>(i / 25) % cameras.size()];
    renderer->RenderInto(image, *scene, render::NamedCamera(name, *scene), spec);
    if (i != next_report) continue;
    std::printf("%7ld pictures: RSS %.1f MB\n", i, RssMb());
    std::fflush(stdout);
    next_report *= 10;
  }
}
