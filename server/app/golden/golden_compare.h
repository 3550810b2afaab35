/// `golden compare`: two pictures of any origin. Pure but for files; one thread.
#pragma once

#include <filesystem>
#include <string>

namespace kinescope::app {

struct PictureVerdict {
  bool is_same = false;
  bool is_byte_equal = false;  // each pixel, also where it is invisible
  std::string text;            // one line
};

/// @param out  picture of the differences, written if there are any and it is not empty
/// @throws std::runtime_error with the file and the reason.
PictureVerdict ComparePictures(const std::filesystem::path& one, const std::filesystem::path& other,
                               const std::filesystem::path& out);

}  // namespace kinescope::app
