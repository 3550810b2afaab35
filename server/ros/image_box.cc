#include "server/ros/image_box.h"

#include <spdlog/fmt/fmt.h>

#include <string_view>

#include "core/system/starts_with.h"
#include "server/ros/names.h"

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
  constexpr std::string_view kTransport = "/compressed";
  std::string name = WithoutSlashes(topic);
  if (EndsWith(name, kTransport)) name.resize(name.size() - kTransport.size());
  return name;
}

}  // namespace kinescope::ros_bridge
