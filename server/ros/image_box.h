/// The newest picture of each topic. One thread.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/camera_image.h"
#include "server/ros/force_input.h"

namespace kinescope::ros_bridge {

class ImageBox {
 public:
  /// @param topic  numbers of topics give the order
  /// Why it is not taken: there are kMostImages of other topics.
  std::optional<Refusal> Put(std::size_t topic, CameraImage image);

  /// Whether something was put since the last call.
  bool TakeChanged() { return std::exchange(has_changed_, false); }
  ImageList images() const;

 private:
  std::map<std::size_t, std::shared_ptr<const CameraImage>> newest_;
  bool has_changed_ = false;
};

/// "camera/image_raw" for "/camera/image_raw", and for its transport
/// "/camera/image_raw/compressed".
std::string NameOfCamera(const std::string& topic);

}  // namespace kinescope::ros_bridge
