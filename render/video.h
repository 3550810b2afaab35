/// Clips: pictures of one size, one after the other, into an H.264 MP4 (libav).
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "render/image.h"

namespace kinescope::render {

struct VideoOptions {
  double frames_per_second = 30;
  int crf = 18;                                 // 0 (lossless) .. 51; x264's constant quality
  std::map<std::string, std::string> metadata;  // title, comment
};

/// Frame k is shown at time k / frames_per_second. Colour is tagged bt709, limited range. The file
/// appears under its name only after Finish; without it (an exception, Ctrl-C) nothing is left.
class VideoWriter {
 public:
  virtual ~VideoWriter() = default;
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// @throws std::runtime_error: another size than the first, disk full, ...
  virtual void Add(const Image& image) = 0;
  virtual void Finish() = 0;

 protected:
  VideoWriter() = default;
};

/// @throws std::runtime_error naming the path or the missing encoder; UsageError for an odd size.
std::unique_ptr<VideoWriter> MakeVideoWriter(const std::filesystem::path& path, int width,
                                             int height, const VideoOptions& options);

}  // namespace kinescope::render
