/// Images of depths as clouds of points: RViz's DepthCloud. One thread.
#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/camera_image.h"
#include "core/graph_view.h"
#include "server/ros/calibration.h"
#include "server/ros/force_input.h"
#include "server/ros/shown_messages.h"

namespace kinescope::ros_bridge {

class DepthClouds {
 public:
  void PutCalibration(std::size_t topic, const Calibration& calibration);
  /// The colours of the next cloud. Or why they cannot be used.
  std::optional<Refusal> PutColors(std::size_t topic, CameraImage image);

  /// The points of depths, which are in mm (16UC1) or in m (32FC1), in the frame of the image: of
  /// an image with more than `style` shows, those of every n-th row and column. None before the
  /// first calibration. A point without a size is as large as its pixel at the median of the
  /// depths, so that surfaces are closed there.
  Taken<ShownMarkers> ToMarkers(std::size_t topic, const CameraImage& depths,
                                const std_msgs::Header& header, const ShownStyle& style) const;

 private:
  struct Topic {
    std::optional<Calibration> calibration;
    std::optional<CameraImage> colors;
  };
  std::map<std::size_t, Topic> topics_;
};

}  // namespace kinescope::ros_bridge
