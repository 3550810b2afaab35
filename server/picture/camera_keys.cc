#include "server/picture/camera_keys.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <filesystem>

#include "core/system/errors.h"
#include "server/options/text.h"
#include "server/options/yaml_file.h"

namespace kinescope::app {
namespace {

constexpr std::size_t kMaxKeys = 1000;
constexpr double kFarthest = 1000;  // m; beyond, a depth buffer shows nothing

// One file being read: says where something is wrong.
class KeyFile {
 public:
  explicit KeyFile(const std::string& path) : path_(path) {}

  YAML::Node Load() const {
    std::error_code error;
    const bool is_folder = std::filesystem::is_directory(path_, error);
    if (error) throw UsageError(fmt::format("--camera={}: {}", path_, error.message()));
    if (is_folder) throw UsageError(fmt::format("--camera={}: a folder; expected a file", path_));
    return Parsed([this] { return options::LoadYaml(path_); });
  }

  template <class Read>
  YAML::Node Parsed(const Read& read) const {
    try {
      return read();
    } catch (const YAML::BadFile&) {
      throw UsageError(
          fmt::format("--camera={}: cannot open the file (no read permission)", path_));
    } catch (const YAML::Exception& problem) {
      throw UsageError(
          fmt::format("--camera={}: line {}: {}", path_, problem.mark.line + 1, problem.msg));
    }
  }

  [[noreturn]] void Refuse(const YAML::Node& node, const std::string& reason) const {
    throw UsageError(fmt::format("--camera={}: line {}: {}", path_,
                                 node.IsDefined() ? node.Mark().line + 1 : 1, reason));
  }

  double Number(const YAML::Node& node, const std::string& key, double least, double most) const {
    double value = 0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) ||
        !(value >= least && value <= most)) {
      Refuse(node, fmt::format("{}: {}: expected a number from {} to {}", key,
                               node.IsScalar() ? node.Scalar() : "a list", least, most));
    }
    return value;
  }

  Eigen::Vector3d Point(const YAML::Node& node, const std::string& key) const {
    if (!node.IsSequence() || node.size() != 3) {
      Refuse(node, key + ": expected [x, y, z], m");
    }
    Eigen::Vector3d point;
    for (int axis = 0; axis < 3; ++axis) {
      point[axis] = Number(node[axis], key, -kFarthest, kFarthest);
    }
    return point;
  }

  render::Ease EaseOf(const YAML::Node& node) const {
    const std::string text = node.IsScalar() ? node.Scalar() : "";
    if (text == "smooth") return render::Ease::kSmooth;
    if (text == "linear") return render::Ease::kLinear;
    if (text == "hold") return render::Ease::kHold;
    Refuse(node, fmt::format("ease: {}: expected smooth, linear or hold", text));
  }

 private:
  std::string path_;
};

CameraKeySpec ReadKey(const KeyFile& file, const YAML::Node& node) {
  if (!node.IsMap()) file.Refuse(node, "expected a keyframe, such as {time: 0, camera: front}");
  CameraKeySpec key;
  std::optional<Eigen::Vector3d> position, target;
  bool has_time = false;
  for (const auto& entry : node) {
    const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "?";
    const YAML::Node value = entry.second;
    if (name == "time") {
      key.secs = file.Number(value, name, 0, 1e6);
      has_time = true;
    } else if (name == "camera") {
      key.name = value.IsScalar() ? value.Scalar() : "?";
      try {
        render::NamedCameraAt(key.name, {});
      } catch (const UsageError& unknown) {
        file.Refuse(value, unknown.what());
      }
    } else if (name == "position") {
      position = file.Point(value, name);
    } else if (name == "target") {
      target = file.Point(value, name);
    } else if (name == "fov") {
      key.fov_rad = file.Number(value, name, 1, 150) * M_PI / 180;
    } else if (name == "ease") {
      key.ease = file.EaseOf(value);
    } else {
      file.Refuse(
          entry.first,
          fmt::format("unknown key '{}'; expected time, camera, position, target, fov or ease",
                      name));
    }
  }
  if (!has_time) file.Refuse(node, "time is missing");
  if (key.name.empty() != (position && target) || position.has_value() != target.has_value()) {
    file.Refuse(node, "expected either camera, or position and target");
  }
  if (position) {
    const auto place = CameraFromTo(*position, *target);
    if (!place) file.Refuse(node, "expected a position that differs from the target");
    key.place = *place;
    if (key.fov_rad) key.place.vertical_fov_rad = *key.fov_rad;
  }
  return key;
}

std::vector<CameraKeySpec> ReadKeys(const KeyFile& file, const YAML::Node& root) {
  if (!root.IsMap() || root.size() != 1 || !root["keys"] || !root["keys"].IsSequence() ||
      root["keys"].size() == 0) {
    file.Refuse(root, "expected 'keys:' and a list of keyframes");
  }
  const YAML::Node list = root["keys"];
  if (list.size() > kMaxKeys) {
    file.Refuse(list,
                fmt::format("keys: {} keyframes; expected at most {}", list.size(), kMaxKeys));
  }
  std::vector<CameraKeySpec> keys;
  for (const YAML::Node& node : list) {
    CameraKeySpec key = ReadKey(file, node);
    if (!keys.empty() && key.secs <= keys.back().secs) {
      file.Refuse(node,
                  fmt::format("time: {}: expected more than {}, the time of the previous keyframe",
                              key.secs, keys.back().secs));
    }
    keys.push_back(std::move(key));
  }
  return keys;
}

}  // namespace

std::vector<CameraKeySpec> ReadCameraKeys(const std::string& path) {
  const KeyFile file(path);
  return ReadKeys(file, file.Load());
}

std::vector<CameraKeySpec> ParseCameraKeys(const std::string& path, const std::string& text) {
  const KeyFile file(path);
  return ReadKeys(file, file.Parsed([&] { return options::ParseYaml(text); }));
}

std::optional<Eigen::Vector3d> ParsePoint(const std::string& text) {
  const auto numbers = options::ParseNumbers(text);
  if (!numbers || numbers->size() != 3) return std::nullopt;
  const Eigen::Vector3d point((*numbers)[0], (*numbers)[1], (*numbers)[2]);
  if (point.cwiseAbs().maxCoeff() > kFarthest) return std::nullopt;
  return point;
}

std::optional<render::Camera> CameraFromTo(const Eigen::Vector3d& position,
                                           const Eigen::Vector3d& target) {
  const double distance = (position - target).norm();
  if (!(distance > 1e-3)) return std::nullopt;
  render::Camera camera;
  camera.position = position;
  camera.target = target;
  camera.near_m = std::min(camera.near_m, 0.02 * distance);
  camera.far_m = std::max(camera.far_m, 4 * distance);
  return camera;
}

}  // namespace kinescope::app
