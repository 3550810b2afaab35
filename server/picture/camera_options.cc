#include "server/picture/camera_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/system/starts_with.h"
#include "server/options/ros_names.h"
#include "server/options/text.h"
#include "server/picture/camera_keys.h"

namespace kinescope::app {
namespace {

using options::BadValue;
using options::Number;

constexpr char kAxes[] = "axes=";   // of a base of a camera
constexpr double kMaxOrbit = 3600;  // degrees per second; more shows no motion any more

bool IsKeyFile(const std::string& camera) {
  const std::string extension = std::filesystem::path(camera).extension();
  return extension == ".yaml" || extension == ".yml";
}

// "X,Y,Z:X,Y,Z": position and target; with a third one, what is up in the picture.
render::Camera ParsePlace(const std::string& text) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(':', at), text.size());
    const auto point = ParsePoint(text.substr(at, end - at));
    if (!point || points.size() == 3) throw BadValue("expected X,Y,Z:X,Y,Z, in m");
    points.push_back(*point);
    at = end + 1;
  }
  if (points.size() < 2) throw BadValue("expected X,Y,Z:X,Y,Z, in m");
  auto camera = CameraFromTo(points[0], points[1]);
  if (!camera) throw BadValue("expected a position that differs from the target");
  if (points.size() < 3) return *camera;
  const Eigen::Vector3d ahead = points[1] - points[0];
  if (points[2].cross(ahead).norm() < 1e-6 * ahead.norm()) {
    throw BadValue(
        "expected as third point a direction that is up in the picture, across the view");
  }
  camera->up = points[2];
  return *camera;
}

std::string WithoutLeadingSlash(const std::string& name) {
  return name.size() > 1 && name.front() == '/' ? name.substr(1) : name;
}

}  // namespace

CameraChoice ParseCamera(const std::string& text) {
  CameraChoice choice{text, std::nullopt, IsKeyFile(text)};
  if (choice.is_key_file) return choice;
  if (text.find(':') != std::string::npos) {
    choice.place = ParsePlace(text);
    return choice;
  }
  for (const std::string& name : render::CameraNames()) {
    if (name == render::CameraMeantBy(text)) return choice;
  }
  throw BadValue(fmt::format(
      "unknown camera '{}'; expected {}, X,Y,Z:X,Y,Z (position: target, m) or FILE.yaml with keys",
      text, fmt::join(render::CameraNames(), ", ")));
}

bool AreAllNamed(const std::vector<CameraChoice>& cameras) {
  return std::none_of(cameras.begin(), cameras.end(), [](const CameraChoice& camera) {
    return camera.place || camera.is_key_file;
  });
}

CamerasValue::CamerasValue(std::size_t most)
    : ValueOf({{"three_quarter", std::nullopt, false}}), most_(most) {}

void CamerasValue::Parse(const std::string& text) {
  std::vector<CameraChoice> cameras;
  for (const std::string& item : options::SplitItems(text)) cameras.push_back(ParseCamera(item));
  if (cameras.empty()) RefuseText();
  if (cameras.size() > most_) {
    throw BadValue(fmt::format("expected at most {} camera{}", most_, most_ == 1 ? "" : "s"));
  }
  value_ = std::move(cameras);
}

std::string CamerasValue::ToText() const {
  std::string text;
  for (const CameraChoice& camera : value_) text += (text.empty() ? "" : ";") + camera.text;
  return text;
}

std::string CamerasValue::Expected() const {
  return fmt::format("{}, X,Y,Z:X,Y,Z (position: target, m) or FILE.yaml with keys{}",
                     fmt::join(render::CameraNames(), ", "),
                     most_ > 1 ? "; several with , or ; between" : "");
}

std::vector<std::filesystem::path> CamerasValue::Files() const {
  std::vector<std::filesystem::path> files;
  for (const CameraChoice& camera : value_) {
    if (camera.is_key_file) files.emplace_back(camera.text);
  }
  return files;
}

void CamerasValue::SetFolder(const std::filesystem::path& folder) {
  for (CameraChoice& camera : value_) {
    if (camera.is_key_file) camera.text = (folder / camera.text).string();
  }
}

void OrbitValue::Parse(const std::string& text) {
  if (text == "turn") {
    value_ = {true, 0};
    return;
  }
  const auto degrees = options::ParseNumber(text);
  if (!degrees || std::abs(*degrees) > kMaxOrbit) RefuseText();
  value_ = {false, *degrees};
}

std::string OrbitValue::ToText() const {
  return value_.is_one_turn ? "turn" : options::NumberText(value_.degrees_per_sec);
}

std::string OrbitValue::Expected() const {
  return fmt::format("degrees per second from -{} to {}, or turn (once over the clip)", kMaxOrbit,
                     kMaxOrbit);
}

void CameraBaseValue::Parse(const std::string& text) {
  using Turn = CameraBase::Turn;
  const std::size_t colon = text.find(':');
  const std::string turn = colon == std::string::npos ? "position" : text.substr(colon + 1);
  CameraBase base;
  base.frame = WithoutLeadingSlash(text.substr(0, colon));
  if (StartsWith(turn, kAxes)) base.axes = WithoutLeadingSlash(turn.substr(sizeof kAxes - 1));
  const bool is_turn =
      turn == "position" || turn == "heading" || turn == "pose" || IsFrameName(base.axes);
  if (!is_turn || !IsFrameName(base.frame)) RefuseText();
  base.turn = turn == "heading"                      ? Turn::kHeading
              : turn == "pose" || !base.axes.empty() ? Turn::kFull
                                                     : Turn::kNone;
  value_ = std::move(base);
}

std::string CameraBaseValue::ToText() const {
  constexpr const char* kTurns[] = {"", ":heading", ":pose"};
  if (!value_.axes.empty()) return value_.frame + ":" + kAxes + value_.axes;
  return value_.frame + kTurns[static_cast<int>(value_.turn)];
}

std::string CameraBaseValue::Expected() const {
  return "a frame of TF, as FRAME (its position), FRAME:heading, FRAME:pose or FRAME:axes=OTHER";
}

CameraOptions::CameraOptions()
    : projection({{"perspective", false}, {"orthographic", true}}, false),
      fov(Number(30, {1, 150, "degrees"})),
      follow(Number(0, {0, 60, "s"})),
      fit({{"auto", Fit::kAuto}, {"off", Fit::kOff}, {"now", Fit::kNow}, {"clip", Fit::kClip}},
          Fit::kAuto),
      camera_frame({{"start", CameraFrame::kStart},
                    {"person", CameraFrame::kPerson},
                    {"world", CameraFrame::kWorld}},
                   CameraFrame::kStart) {}

void CameraOptions::List(options::OptionList& option) {
  option("projection", projection, "how depth is shown");
  option("fov", fov, "vertical field of view; not given: that of the named camera");
  option("orbit", orbit, "rotation of the camera around its target");
  option(
      "follow", follow,
      "time constant with which the camera follows the people; not given: only when they leave the "
      "middle");
  option("camera_frame", camera_frame,
         "what named cameras are turned with, so that front sees the face: start (the first "
         "person's heading at the first picture; live: when they first stood), person (their "
         "heading now) or world");
  option("camera_tf", camera_tf,
         "frame of TF (of a bag, or of ROS in serve) that a camera given by X,Y,Z:X,Y,Z goes with, "
         "which is then relative to it: to its position, with its heading, or as it is turned");
  option("fit", fit,
         "how close a named camera comes, so that everything shown fills the free part of the "
         "picture: "
         "now (chosen anew for each picture), clip (one for the whole clip; it stands still unless "
         "the "
         "people go far), off, or auto: now for stills, clip for clips of recordings, else off");
}

}  // namespace kinescope::app
