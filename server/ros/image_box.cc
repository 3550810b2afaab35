#include "server/ros/image_box.h"

#include <spdlog/fmt/fmt.h>

#include <string_view>

#include "core/system/clocks.h"
#include "core/system/starts_with.h"
#include "core/system/utf8.h"
#include "server/ros/names.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::int64_t kPlaceCameraEveryNanos = 16'000'000;

bool AreSame(const ImageCamera& a, const ImageCamera& b) {
  return a.width == b.width && a.height == b.height && a.focal_px == b.focal_px &&
         a.center_px == b.center_px && a.scene_opacity == b.scene_opacity &&
         a.world_from_optical.position == b.world_from_optical.position &&
         a.world_from_optical.orientation.coeffs() == b.world_from_optical.orientation.coeffs();
}

}  // namespace

std::optional<Refusal> ImageBox::Put(std::size_t topic, CameraImage image,
                                     const CameraStyle& style) {
  if (shown_.count(topic) == 0 && shown_.size() >= kMostImages) {
    return Refusal{"too many cameras", fmt::format("more than {} topics of images", kMostImages)};
  }
  Shown& shown = shown_[topic];
  // Until its own place is known, which may come later than the image.
  if (shown.newest != nullptr) image.camera = shown.newest->camera;
  image.pane_width = style.pane_width;
  shown.newest = std::make_shared<const CameraImage>(std::move(image));
  shown.scene_opacity = style.scene_opacity;
  shown.is_placed_for_good = false;
  shown.looked_nanos = 0;
  has_changed_ = true;
  return std::nullopt;
}

void ImageBox::PutCalibration(std::size_t topic, const Calibration& calibration) {
  const auto [known, is_new] = calibrations_.try_emplace(topic, calibration);
  const bool is_same =
      known->second.frame == calibration.frame && AreSame(known->second.camera, calibration.camera);
  if (is_new || is_same) return;
  known->second = calibration;
  if (const auto shown = shown_.find(topic); shown != shown_.end()) {
    shown->second.is_placed_for_good = false;
  }
}

void ImageBox::Update(std::int64_t now_nanos, const FindFrame& find) {
  for (auto& [topic, shown] : shown_) {
    if (shown.scene_opacity <= 0 || shown.is_placed_for_good) continue;
    // A recording that is played again begins earlier.
    const bool is_soon =
        now_nanos >= shown.looked_nanos && now_nanos - shown.looked_nanos < kPlaceCameraEveryNanos;
    if (is_soon) continue;
    shown.looked_nanos = now_nanos;
    Place(topic, shown, find);
  }
}

void ImageBox::Place(std::size_t topic, Shown& shown, const FindFrame& find) {
  const CameraImage& image = *shown.newest;
  const auto calibration = calibrations_.find(topic);
  std::optional<FramePlace> place;
  if (calibration != calibrations_.end()) {
    const std::string& frame = calibration->second.frame;
    if (image.stamp_nanos != 0) place = find(frame, image.stamp_nanos);
    shown.is_placed_for_good = place && !place->is_early;
    if (!place) place = find(frame, 0);
  }
  if (!place) {
    if (!shown.lost_nanos) shown.lost_nanos = shown.looked_nanos;
    const bool is_for_long = shown.looked_nanos - *shown.lost_nanos >= kNanosPerSecond;
    if (!is_for_long || std::exchange(shown.is_told, true)) return;
    const std::string what = "the scene is not drawn over its pictures";
    if (calibration == calibrations_.end()) {
      lost_.push_back({topic, what + ": no calibration on camera_info beside it", "", ""});
    } else {
      lost_.push_back({topic, what, calibration->second.frame, ""});
    }
    return;
  }
  shown.lost_nanos.reset();
  ImageCamera camera = calibration->second.camera;
  const urdf::Pose in_frame = camera.world_from_optical;
  const urdf::Pose& frame = place->pose;
  camera.world_from_optical.position = frame.position + frame.orientation * in_frame.position;
  camera.world_from_optical.orientation = frame.orientation * in_frame.orientation;
  camera.scene_opacity = shown.scene_opacity;
  if (!FindDefect(camera).empty() || (image.camera && AreSame(*image.camera, camera))) return;
  auto placed = std::make_shared<CameraImage>(image);
  placed->camera = camera;
  shown.newest = std::move(placed);
  has_changed_ = true;
}

ImageList ImageBox::images() const {
  ImageList all;
  for (const auto& [topic, shown] : shown_) all.push_back(shown.newest);
  return all;
}

std::vector<WithoutPlace> ImageBox::TakeLost() { return std::exchange(lost_, {}); }

std::string WithoutTransport(const std::string& topic) {
  constexpr std::string_view kTransport = "/compressed";
  const bool has_transport = EndsWith(topic, kTransport) && topic.size() > kTransport.size();
  return has_transport ? topic.substr(0, topic.size() - kTransport.size()) : topic;
}

std::string NameOfCamera(const std::string& topic) {
  return WithoutSlashes(WithoutTransport(topic));
}

}  // namespace kinescope::ros_bridge
