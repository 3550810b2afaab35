/// Where a camera stands and how it moves, as options describe it (docs/pictures.md).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "render/camera/camera.h"
#include "server/options/option_list.h"
#include "server/scene/held_heading.h"

namespace kinescope::app {

/// A named camera, a fixed one, or a file of keys.
struct CameraChoice {
  std::string text;                     // as it was given: "front", "0,-4,1:0,0,1", "keys.yaml"
  std::optional<render::Camera> place;  // fixed
  bool is_key_file = false;
};

/// @throws options::BadValue.
CameraChoice ParseCamera(const std::string& text);

/// One or several cameras.
class CamerasValue : public options::ValueOf<std::vector<CameraChoice>> {
 public:
  /// `most`: how many may be given.
  explicit CamerasValue(std::size_t most);

  void Parse(const std::string& text) override;
  std::string ToText() const override;
  std::string Expected() const override;
  std::vector<std::string> Names() const override { return render::CameraNames(); }
  std::vector<std::filesystem::path> Files() const override;
  void SetFolder(const std::filesystem::path& folder) override;

 private:
  std::size_t most_;
};

/// Degrees per second, or one turn over the clip.
struct Orbit {
  bool is_one_turn = false;
  double degrees_per_sec = 0;
};

class OrbitValue : public options::ValueOf<Orbit> {
 public:
  OrbitValue() : ValueOf({}) {}

  void Parse(const std::string& text) override;
  std::string ToText() const override;
  std::string Expected() const override;
  std::vector<std::string> Names() const override { return {"turn"}; }
};

enum class Fit { kAuto, kOff, kNow, kClip };

struct CameraOptions {
  CameraOptions();

  options::Choice<bool> projection;        // true: orthographic
  options::Optional<options::Number> fov;  // degrees, vertical
  OrbitValue orbit;
  options::Optional<options::Number> follow;  // s of lag
  options::Choice<Fit> fit;
  options::Choice<CameraFrame> camera_frame;

  void List(options::OptionList& option);
};

}  // namespace kinescope::app
