#include "server/picture/camera_keys.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <filesystem>

#include "core/errors.h"
#include "server/options/option_list.h"

namespace kinescope::app {
namespace {

constexpr std::size_t kMostKeys = 1000;
constexpr std::uintmax_t kMostKeyBytes = 1 << 20;
constexpr double kFarthest = 1000;  // m; beyond, a depth buffer shows nothing

// One file being read: says where something is wrong.
class KeyFile {
 public:
  explicit KeyFile(const std::string& path) : path_(path) {}

  YAML::Node Load() const {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(path_, error);
    if (error) throw UsageError(fmt::format("--camera={}: {}", path_, error.message()));
    if (bytes > kMostKeyBytes) {
      throw UsageError(
          fmt::format("--camera={}: {} bytes, expected at most {}", path_, bytes, kMostKeyBytes));
    }
    try {
      return YAML::LoadFile(path_);
    } catch (const YAML::BadFile&) {
      throw UsageError(fmt::format("--camera={}: it may not be read", path_));
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

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

CameraKeySpec ReadKey(const KeyFile& file, const YAML::Node& node) {
  if (!node.IsMap()) file.Refuse(node, "expected a key, such as {time: 0, camera: front}");
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
      file.Refuse(entry.first, fmt::format("'{}' is not known; there are time, camera, position, "
                                           "target, fov and ease",
                                           name));
    }
  }
  if (!has_time) file.Refuse(node, "time: is missing");
  if (key.name.empty() != (position && target) || position.has_value() != target.has_value()) {
    file.Refuse(node, "expected either camera, or position and target");
  }
  if (position) {
    key.place = CameraFromTo(fmt::format("--camera={}: line {}", file.path(), node.Mark().line + 1),
                             *position, *target);
    if (key.fov_rad) key.place.vertical_fov_rad = *key.fov_rad;
  }
  return key;
}

}  // namespace

std::vector<CameraKeySpec> ReadCameraKeys(const std::string& path) {
  const KeyFile file(path);
  const YAML::Node root = file.Load();
  if (!root.IsMap() || root.size() != 1 || !root["keys"] || !root["keys"].IsSequence() ||
      root["keys"].size() == 0) {
    file.Refuse(root, "expected 'keys:' and a list of them");
  }
  const YAML::Node list = root["keys"];
  if (list.size() > kMostKeys) {
    file.Refuse(list, fmt::format("keys: {} of them, expected at most {}", list.size(), kMostKeys));
  }
  std::vector<CameraKeySpec> keys;
  for (const YAML::Node& node : list) {
    CameraKeySpec key = ReadKey(file, node);
    if (!keys.empty() && key.secs <= keys.back().secs) {
      file.Refuse(node, fmt::format("time: {}: expected more than {}, the time of the key before",
                                    key.secs, keys.back().secs));
    }
    keys.push_back(std::move(key));
  }
  return keys;
}

Eigen::Vector3d ParsePoint(const std::string& what, const std::string& text) {
  const auto refuse = [&] {
    throw UsageError(
        fmt::format("{}: '{}': expected X,Y,Z in m, each within +-{}", what, text, kFarthest));
  };
  Eigen::Vector3d point;
  std::size_t begin = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t end = axis < 2 ? text.find(',', begin) : text.size();
    if (end == std::string::npos) refuse();
    double value = 0;
    if (!CLI::detail::lexical_cast(text.substr(begin, end - begin), value) ||
        !(std::abs(value) <= kFarthest)) {
      refuse();
    }
    point[axis] = value;
    begin = end + 1;
  }
  return point;
}

render::Camera CameraFromTo(const std::string& what, const Eigen::Vector3d& position,
                            const Eigen::Vector3d& target) {
  const double distance = (position - target).norm();
  if (!(distance > 1e-3)) throw UsageError(what + ": the camera stands on what it looks at");
  render::Camera camera;
  camera.position = position;
  camera.target = target;
  camera.near_m = std::min(camera.near_m, 0.02 * distance);
  camera.far_m = std::max(camera.far_m, 4 * distance);
  return camera;
}

}  // namespace kinescope::app
