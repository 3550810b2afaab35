/// Writes and reads clips: frames of one size, one after the other. H.264 in MP4, VP9 in WebM,
/// animated WebP and GIF, selected by the file name. The encoders are a module that is loaded when
/// the first clip is written or read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "render/image/image.h"

namespace kinescope::render {

/// Frames per second as a fraction, because files cannot store 29.97 but 30000/1001.
struct FrameRate {
  int numerator = 30;
  int denominator = 1;
  double hz() const { return static_cast<double>(numerator) / denominator; }
  /// Time of frame `k` after frame 0, ns, rounded to nearest.
  std::int64_t NanosOf(std::int64_t k) const;
};

enum class ClipFormat { kMp4, kWebm, kWebp, kGif };

/// By the extension; nullopt for any other. A .webp is always a clip here.
std::optional<ClipFormat> ClipFormatOf(const std::filesystem::path& path);

/// Generation of the settings of the encoders of .mp4 and .webm. 1: of files whose provenance names
/// none, with a key picture every 2 s.
inline constexpr int kClipEncoding = 2;

struct VideoOptions {
  FrameRate rate;  // .gif: at most 50 per second, the limit of browsers
  /// Constant quality of .mp4 (0, lossless, to 51; default 18) and .webm (0 to 63; default 24).
  std::optional<int> crf;
  /// Of .webp: 0 to 99; 100 is lossless.
  int quality = 90;
  /// Whether the file keeps transparency. .webm and .webp support it; .gif only fully transparent
  /// or opaque pixels. Absent: if the first frame has any.
  std::optional<bool> alpha;
  /// 1 to kClipEncoding; earlier ones make the clips of earlier versions again.
  int encoding = kClipEncoding;
  /// "title", "comment"; every format stores both, .gif only the comment.
  std::map<std::string, std::string> metadata;
};

/// Frame k is shown at time k / rate (.webm and .webp round to the millisecond, .gif to 10 ms). The
/// colours of .mp4 and .webm are tagged bt709, limited range. Alpha is straight, not premultiplied,
/// in the input and in every file. Equal frames give equal bytes with the same libraries on every
/// machine. The file gets its name only in Finish; without it (an exception, Ctrl-C) nothing
/// remains. One thread at a time.
class VideoWriter {
 public:
  virtual ~VideoWriter() = default;
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// @throws std::runtime_error: another size than the first frame, disk full, transparency in a
  /// format without it, ...
  virtual void Add(const Image& image) = 0;
  virtual void Finish() = 0;

 protected:
  VideoWriter() = default;
};

/// @throws std::runtime_error with the path, or the missing encoder and its package; UsageError for
/// a name, size or option that the format does not support.
std::unique_ptr<VideoWriter> MakeVideoWriter(const std::filesystem::path& path, int width,
                                             int height, const VideoOptions& options);

/// Reads clips as players do: those of MakeVideoWriter, and all that libav supports. One thread at
/// a time.
class VideoReader {
 public:
  virtual ~VideoReader() = default;
  VideoReader(const VideoReader&) = delete;
  VideoReader& operator=(const VideoReader&) = delete;

  /// The next frame; false at the end. @throws std::runtime_error for a damaged file.
  [[nodiscard]] virtual bool Next(Image& image) = 0;
  /// Display time of the newest frame, s after the first.
  virtual double secs() const = 0;
  /// Keys in lower case: "comment", "title".
  virtual std::map<std::string, std::string> metadata() const = 0;

 protected:
  VideoReader() = default;
};

/// @throws std::runtime_error with the path and the reason.
std::unique_ptr<VideoReader> OpenVideo(const std::filesystem::path& path);

}  // namespace kinescope::render
