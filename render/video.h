/// Clips: pictures of one size, one after the other, into a file and out of it again. H.264 in MP4,
/// VP9 in WebM, animated WebP and GIF, chosen by the file's name. The encoders are a module that is
/// loaded when the first clip is made or read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "render/image.h"

namespace kinescope::render {

/// Pictures a second, as a fraction, because 29.97 is none that a file can hold: 30000/1001 is.
struct FrameRate {
  int numerator = 30;
  int denominator = 1;
  double hz() const { return static_cast<double>(numerator) / denominator; }
  /// Of picture `k` after picture 0, rounded to the nearest.
  std::int64_t NanosOf(std::int64_t k) const;
};

enum class ClipFormat { kMp4, kWebm, kWebp, kGif };

/// By the extension; nullopt for any other. A .webp is always a clip here.
std::optional<ClipFormat> ClipFormatOf(const std::filesystem::path& path);

struct VideoOptions {
  FrameRate rate;  // .gif: at most 50 a second, which is what browsers show
  /// Constant quality of .mp4 (0, lossless, .. 51; default 18) and .webm (0 .. 63; default 24).
  std::optional<int> crf;
  /// Of .webp: 0 .. 99; 100 is lossless.
  int quality = 90;
  /// Whether the file keeps transparency, which .webm and .webp do, and .gif with edges that are
  /// there or not. Not given: as the first picture has any.
  std::optional<bool> alpha;
  /// "title", "comment"; every format keeps these, .gif only the comment.
  std::map<std::string, std::string> metadata;
};

/// Frame k is shown at time k / rate (.webm and .webp round to the millisecond, .gif to 10 ms).
/// Colour of .mp4 and .webm is tagged bt709, limited range. Alpha is straight, not premultiplied,
/// in what comes in and in every file. The same pictures give the same bytes with the same
/// libraries, whatever the machine. The file appears under its name only after Finish; without it
/// (an exception, Ctrl-C) nothing is left. One thread at a time.
class VideoWriter {
 public:
  virtual ~VideoWriter() = default;
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// @throws std::runtime_error: another size than the first, disk full, transparency that the
  /// format has not, ...
  virtual void Add(const Image& image) = 0;
  virtual void Finish() = 0;

 protected:
  VideoWriter() = default;
};

/// @throws std::runtime_error naming the path or the missing encoder and its package; UsageError
/// for a name, size or option that the format has not.
std::unique_ptr<VideoWriter> MakeVideoWriter(const std::filesystem::path& path, int width,
                                             int height, const VideoOptions& options);

/// Reads clips as players do: what MakeVideoWriter made, and anything libav can.
class VideoReader {
 public:
  virtual ~VideoReader() = default;
  VideoReader(const VideoReader&) = delete;
  VideoReader& operator=(const VideoReader&) = delete;

  /// The next picture; false at the end. @throws std::runtime_error for a damaged file.
  [[nodiscard]] virtual bool Next(Image& image) = 0;
  /// When the picture that came last is shown, s after the first.
  virtual double secs() const = 0;
  /// Keys in lower case: "comment", "title".
  virtual std::map<std::string, std::string> metadata() const = 0;

 protected:
  VideoReader() = default;
};

/// @throws std::runtime_error naming the path and the reason.
std::unique_ptr<VideoReader> OpenVideo(const std::filesystem::path& path);

}  // namespace kinescope::render
