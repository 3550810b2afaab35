/// Where a camera stands and how it moves, as options describe it (docs/pictures.md).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/graph_view.h"
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

/// Whether none of them is given by coordinates, nor has keys that may be.
bool AreAllNamed(const std::vector<CameraChoice>& cameras);

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

/// A frame of TF that a placed camera goes with: its place is relative to that of the frame.
struct CameraBase {
  enum class Turn {
    kNone,     // with the axes of the scene
    kHeading,  // turned with the frame about the vertical
    kFull,     // as the frame, or as that of `axes`
  };
  std::string frame;  // "": the camera stands
  Turn turn = Turn::kNone;
  std::string axes = {};  // with kFull: of another frame, as RViz's Target and Fixed Frame

  CameraFrames frames() const { return {frame, axes}; }
};

/// FRAME, FRAME:heading, FRAME:pose or FRAME:axes=OTHER.
class CameraBaseValue : public options::ValueOf<CameraBase> {
 public:
  CameraBaseValue() : ValueOf({}) {}

  void Parse(const std::string& text) override;
  std::string ToText() const override;
  std::string Expected() const override;
  bool IsGiven() const override { return !value_.frame.empty(); }
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
  CameraBaseValue camera_tf;

  void List(options::OptionList& option);
};

}  // namespace kinescope::app
