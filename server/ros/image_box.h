/// The newest picture of each topic, with the place of the camera that took it where the scene is
/// drawn over the picture. One thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/camera_image.h"
#include "core/graph_view.h"
#include "server/ros/calibration.h"
#include "server/ros/force_input.h"
#include "server/ros/frame_ways.h"

namespace kinescope::ros_bridge {

class ImageBox {
 public:
  /// Where a frame is at a time, in the frame of the scene; stamp 0: the newest place.
  using FindFrame =
      std::function<std::optional<FramePlace>(const std::string& frame, std::int64_t stamp_nanos)>;

  /// @param topic  numbers of topics give the order
  /// Why it is not taken: there are kMostImages of other topics.
  std::optional<Refusal> Put(std::size_t topic, CameraImage image, const CameraStyle& style = {});

  /// Of the camera of a topic, whether or not an image has come.
  void PutCalibration(std::size_t topic, const Calibration& calibration);

  /// Places the cameras: at the time of their images where that is known, else where they are now.
  void Update(std::int64_t now_nanos, const FindFrame& find);

  /// Whether something has changed since the last call.
  bool TakeChanged() { return std::exchange(has_changed_, false); }
  ImageList images() const;

  /// Scenes that are not drawn over the images of a topic, because its camera has had no
  /// calibration or no place for a second. Once for each topic.
  std::vector<WithoutPlace> TakeLost();

 private:
  struct Shown {
    std::shared_ptr<const CameraImage> newest;
    double scene_opacity = 0;         // 0: the scene is not drawn over it
    bool is_placed_for_good = false;  // at its own time
    std::int64_t looked_nanos = 0;
    std::optional<std::int64_t> lost_nanos;  // since then its camera has no place
    bool is_told = false;
  };
  void Place(std::size_t topic, Shown& shown, const FindFrame& find);

  std::map<std::size_t, Shown> shown_;
  std::map<std::size_t, Calibration> calibrations_;
  std::vector<WithoutPlace> lost_;
  bool has_changed_ = false;
};

/// "/camera/image_raw" for its transport "/camera/image_raw/compressed"; others are their own.
std::string WithoutTransport(const std::string& topic);

/// "camera/image_raw" for "/camera/image_raw", and for its transport.
std::string NameOfCamera(const std::string& topic);

}  // namespace kinescope::ros_bridge
