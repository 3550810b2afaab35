/// Compares two outputs picture by picture: PNGs, numbered sequences, clips. One thread.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "render/image/image.h"
#include "render/video.h"

namespace kinescope::app {

/// Reads the pictures of a file or of a numbered sequence, one after the other.
class PictureReader {
 public:
  /// @throws std::runtime_error if a clip cannot be read.
  explicit PictureReader(std::string path);

  /// False after the last picture. @throws std::runtime_error for a damaged file.
  [[nodiscard]] bool Next(render::Image& image);

 private:
  const std::string path_;
  std::unique_ptr<render::VideoReader> video_;  // of a clip
  long next_ = 0;
};

struct Verdict {
  bool same = true;
  bool same_bytes = false;
  long picture = 0;  // the first that differs
  std::string how;   // "123 pixels differ ..."
  render::Image diff;
};

/// How far two pictures may differ and still be the same.
struct Tolerance {
  int levels = 0;           // per channel, of a pixel that counts as equal
  double pixels_share = 0;  // of the pixels of a picture, which may differ by more
};

/// The first difference of the outputs `then` and `now`. `count`: only so many pictures, because
/// the folder of a sequence may contain more of an older one; nullopt: all.
Verdict ComparePictures(const std::string& then, const std::string& now, const Tolerance& tolerance,
                        std::optional<long> count);

}  // namespace kinescope::app
