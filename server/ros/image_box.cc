#include "server/ros/image_box.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace kinescope::ros_bridge {

std::optional<Refusal> ImageBox::Put(std::size_t topic, CameraImage image) {
  if (newest_.count(topic) == 0 && newest_.size() >= kMostImages) {
    return Refusal{"too many cameras", fmt::format("more than {} topics of images", kMostImages)};
  }
  newest_[topic] = std::make_shared<const CameraImage>(std::move(image));
  has_changed_ = true;
  return std::nullopt;
}

ImageList ImageBox::images() const {
  ImageList all;
  for (const auto& [topic, image] : newest_) all.push_back(image);
  return all;
}

std::string NameOfCamera(const std::string& topic) {
  const std::string transport = "/compressed";
  std::string name = topic.substr(std::min(topic.find_first_not_of('/'), topic.size()));
  const bool has_transport =
      name.size() > transport.size() &&
      name.compare(name.size() - transport.size(), transport.size(), transport) == 0;
  if (has_transport) name.resize(name.size() - transport.size());
  return name;
}

}  // namespace kinescope::ros_bridge
