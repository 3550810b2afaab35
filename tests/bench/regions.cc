// Draws random scenes whole and by regions, and compares the bytes: regions STATES [LARGEST_PX
// [SEED]]. Ends with 1 at the first difference, and says which seed and view it has.
#include <cstdio>
#include <cstdlib>

#include "render/image/compare.h"
#include "tests/render/random_scenes.h"

int main(int argc, char** argv) {
  using namespace kinescope;
  const int states = argc > 1 ? std::atoi(argv[1]) : 2000;
  const int largest = argc > 2 ? std::atoi(argv[2]) : 4096;
  const int seed = argc > 3 ? std::atoi(argv[3]) : 1;
  constexpr int kPictures = 10;  // of a view
  const auto make = [](bool is_off) {
    render::RendererSettings settings;
    settings.regions.is_off = is_off;
    settings.regions.check_every = is_off ? 0 : 1;
    return render::MakeRenderer(std::move(settings));
  };
  const auto whole = make(true), parts = make(false);
  testing::RandomScenes scenes(static_cast<unsigned>(seed));
  render::Image expected, drawn;
  for (int done = 0; done < states;) {
    testing::RandomScenes::View view = scenes.NextView(largest);
    for (int i = 0; i < kPictures && done < states; ++i, ++done) {
      const SceneState state = scenes.NextState(view.spec.look);
      whole->RenderInto(expected, state, view.camera, view.spec);
      parts->RenderInto(drawn, state, view.camera, view.spec);
      if (expected.rgba == drawn.rgba) continue;
      std::printf("state %d of seed %d (%d x %d px) differs\n", done, seed, view.spec.width,
                  view.spec.height);
      return 1;
    }
  }
  std::printf("%d states: the same bytes\n", states);
  return 0;
}
