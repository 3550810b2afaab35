// Writes pictures that differ from one in known ways, for compare_peers.py.
// Usage: picture_pairs PICTURE.png FOLDER: writes FOLDER/expected.png and, for each mutation, a PNG
// file; prints file, tab, whether it must be told apart (1 or 0), tab, name.
#include <cstdio>
#include <exception>
#include <string>

#include "render/image/png_file.h"
#include "tests/render/image/picture_mutations.h"

int main(int argc, char** argv) try {
  using namespace kinescope;
  if (argc != 3) {
    std::fprintf(stderr, "usage: picture_pairs PICTURE.png FOLDER\n");
    return 2;
  }
  const render::Image picture = render::ReadPng(argv[1]);
  const std::string folder = argv[2];
  render::WritePng(folder + "/expected.png", testing::Furnished(picture));
  int count = 0;
  for (const testing::PictureMutation& mutation : testing::MutationsOf(picture)) {
    const std::string file = folder + "/mutation_" + std::to_string(count++) + ".png";
    render::WritePng(file, mutation.image);
    std::printf("%s\t%d\t%s\n", file.c_str(), mutation.layer.empty() ? 0 : 1,
                mutation.name.c_str());
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "picture_pairs: %s\n", error.what());
  return 2;
}
