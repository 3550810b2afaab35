/// What a golden picture shows, in names, words and numbers: the part of `golden.lock` that is
/// compared before any pixel. Pure functions; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "render/camera/camera.h"
#include "render/camera/spheres.h"
#include "render/contents.h"
#include "render/image/tile.h"
#include "server/picture/joint_turns.h"

namespace kinescope::app {

/// A thing that is seen: a body, a joint's load, the centre of pressure, a robot. px of the
/// picture.
struct ObjectFact {
  std::string name;  // unique: "left_knee", "left_knee of person 2", "front/body"
  std::optional<LoadClass> load_class;   // of a load
  std::optional<double> ratio;           // of the capacity; nullopt where it is unknown, or no load
  std::int64_t pixels = 0, through = 0;  // see render::SeenObject
  double x_px = 0, y_px = 0;             // its middle
};

struct TextFact {
  std::string part, text;  // see render::PaintedText
  double x_px = 0, y_px = 0;
};

struct CameraFact {
  std::string view;  // "": there is one
  render::Camera camera;
};

/// How far a joint of a person is bent, whatever of it is seen.
struct JointFact {
  std::string name;  // "right_elbow", "right_elbow of person 2"
  std::array<double, 4> parent_from_child = {1, 0, 0, 0};  // see JointTurn
};

struct PictureFacts {
  std::vector<ObjectFact> objects;
  std::vector<JointFact> joints;  // none: of a page, or not recorded yet
  std::vector<TextFact> texts;
  std::vector<CameraFact> cameras;
  bool has_floor = true;
  std::optional<double> floor_z_m;  // its level; nullopt: it was not recorded yet
};

/// `loads`: of the scene, where they would be; their names are those of `contents`.
std::vector<ObjectFact> ObjectFactsOf(const render::PictureContents& contents,
                                      const std::vector<render::SphereInPicture>& loads);
std::vector<TextFact> TextFactsOf(const render::PictureContents& contents);
std::vector<JointFact> JointFactsOf(const std::vector<JointTurn>& turns);

/// Around which pixels an object of the picture is seen, px.
struct ObjectPlace {
  std::string name;  // as in ObjectFact
  render::Tile box;
};

std::vector<ObjectPlace> ObjectPlacesOf(const render::PictureContents& contents);

/// The names of those that lie in `box`, the smallest first, as what is large is behind everything;
/// three at most.
std::vector<std::string> ObjectsIn(const render::Tile& box, std::vector<ObjectPlace> places);

/// One line per object, text and camera, and one for all joints, so that a change is readable
/// beside the change of a program. Rounded to 0.1 px, 0.001 of a ratio, 0.1 mm, 0.02°.
std::string ToJson(const PictureFacts& facts);

/// A whole number from 0 to `most`. @throws nlohmann::json::exception if it is none.
std::int64_t CountFrom(const nlohmann::json& json, std::int64_t most);

/// @throws nlohmann::json::exception if a member is missing or of another type.
PictureFacts FactsFrom(const nlohmann::json& json);

}  // namespace kinescope::app
