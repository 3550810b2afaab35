/// Pictures that differ in one known way, to test and to measure what compares pictures.
#pragma once

#include <string>
#include <vector>

#include "render/image/image.h"

namespace kinescope::testing {

struct PictureMutation {
  std::string name;
  render::Image image;
  /// Of the difference that must fail: "pixels", "structure" or "light"; others may fail, too.
  /// Empty: none may.
  std::string layer;
};

/// `picture` with what the mutations change: a label with a number, two discs of one colour each, a
/// shaded sphere and a thin line.
/// @pre 320 x 180 px or more
render::Image Furnished(const render::Image& picture);

/// Of `Furnished(picture)`; deterministic.
std::vector<PictureMutation> MutationsOf(const render::Image& picture);

/// Channels times `factor`, rounded to nearest.
render::Image Scaled(const render::Image& picture, double factor);

}  // namespace kinescope::testing
