/// `golden compare`: two pictures of any origin. Pure but for files; any thread.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "render/image/picture_difference.h"

namespace kinescope::app {

struct PictureVerdict {
  render::PictureDifference difference;
  bool is_same = false;  // each layer keeps its limit
  std::string headline;  // "the same pixels", "the same to the eye: ..." or "DIFFERS: ..."
};

/// @param heat_map  file of the heat map, written if the pictures are not the same and it is not
///                  empty
/// @throws std::runtime_error with the file and the reason.
PictureVerdict ComparePictures(const std::filesystem::path& one, const std::filesystem::path& other,
                               const std::filesystem::path& heat_map);

/// The headline and, unless the pixels are the same, a line for each layer with what it found and
/// its limit.
std::vector<std::string> LinesOf(const PictureVerdict& verdict);

/// What a layer of render::JudgeLayers() found, as numbers. @pre both pictures have one size
nlohmann::json NumbersOf(const std::string& layer, const render::PictureDifference& difference);

/// As docs/json.md describes it.
nlohmann::json ToJson(const PictureVerdict& verdict);

}  // namespace kinescope::app
