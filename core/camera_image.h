/// A picture that a camera of other nodes has taken (sensor_msgs/Image and CompressedImage), as it
/// came: its pixels are decoded where they are shown (render/image/camera_picture.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "urdf/kinematics.h"

namespace kinescope {

/// The camera that took an image: a pinhole camera without distortion, as calibrations describe it
/// (sensor_msgs/CameraInfo). Its axes follow REP 103: z forward, x to the right, y down.
struct ImageCamera {
  urdf::Pose world_from_optical;
  int width = 0, height = 0;  // px, of the image that was calibrated
  // px, in x and y; pixels have their centres at whole numbers.
  std::array<double, 2> focal_px = {}, center_px = {};
  double scene_opacity = 1;  // 0..1, of the scene that is drawn over the image
};

/// Why no scene can be drawn as it sees it, such as "its focal lengths are not positive"; "": it
/// can.
[[nodiscard]] std::string FindDefect(const ImageCamera& camera);

struct CameraImage {
  std::string name;                 // of its topic
  int width = 0, height = 0;        // px; 0: those of the file
  std::string encoding;             // as in sensor_msgs/image_encodings.h; "jpeg", "png": a file
  std::size_t row_bytes = 0;        // from one row to the next
  std::size_t begin = 0, size = 0;  // of the pixels, or of the file, in `bytes`
  bool is_bigendian = false;        // numbers of two and four bytes
  std::int64_t stamp_nanos = 0;     // of the node that took it
  std::int64_t received_nanos = 0;  // monotonic clock; 0: of a recording
  std::optional<ImageCamera> camera = std::nullopt;  // if the scene is drawn over it
  double pane_width = 0;  // of a picture that shows it, as a share of its width; 0: as usual
  /// Null: none. Shared, because they are large.
  std::shared_ptr<const std::vector<std::uint8_t>> bytes;
};

/// How the pixels of an encoding are stored.
struct PixelFormat {
  enum class Kind { kRgb, kGrey8, kUyvy, kYuyv, kNumber };
  Kind kind;
  std::size_t bytes;                         // of a pixel
  std::array<std::size_t, 3> rgb = {};       // kRgb: the bytes of its colours
  bool is_float = false, is_signed = false;  // kNumber
};
/// nullopt: the encoding is not known, or a file.
std::optional<PixelFormat> FormatOf(const std::string& encoding);

/// Whether it is a file, which has its width and height within it.
[[nodiscard]] bool IsFile(const CameraImage& image);

/// Why its pixels cannot be read, such as "encoding 'xyz': ..."; "": they can, or it is a file,
/// which is not looked at.
[[nodiscard]] std::string FindDefect(const CameraImage& image);

/// Width by height, within limits that a layout can bear; 4 : 3 of a file, which is not looked at.
[[nodiscard]] double ProportionsOf(const CameraImage& image);

/// Whether it is the newest although others should have come since. `now_nanos`: monotonic clock,
/// as SceneState::made_nanos. Not known of a recording.
[[nodiscard]] bool IsOld(const CameraImage& image, std::int64_t now_nanos);

/// The newest of each topic. Their order does not change.
using ImageList = std::vector<std::shared_ptr<const CameraImage>>;

inline constexpr std::size_t kMostImages = 4;

}  // namespace kinescope
