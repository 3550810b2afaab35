/// Pictures of cameras (sensor_msgs/Image, and CompressedImage that is JPEG or PNG), without a copy
/// of their pixels. Pure functions, any thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/camera_image.h"
#include "server/ros/force_input.h"

namespace kinescope::ros_bridge {

/// A width or height of a message, which may be larger than an int.
[[nodiscard]] int Side(std::uint32_t px);

[[nodiscard]] bool IsImageType(const std::string& md5sum);

/// Of a serialised message of such a type; its name is left to the caller. @pre IsImageType(md5sum)
Taken<CameraImage> ReadImage(const std::string& md5sum,
                             std::shared_ptr<const std::vector<std::uint8_t>> bytes);

}  // namespace kinescope::ros_bridge
