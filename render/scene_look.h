/// Appearance of a scene: theme, background, visible elements, and elements beside the scene itself
/// (trails, reference poses). Plain data, part of PictureSpec. World, metres.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/palette.h"
#include "core/scene_state.h"

namespace kinescope::render {

enum class Theme { kLight, kDark };

/// The scene elements that can be shown and hidden by name.
enum class ScenePart : std::uint32_t {
  kBody,
  kLoads,
  kCom,
  kCop,
  kSupport,
  kForces,
  kHeld,
  kShadows,
  kObjects,
  kRobots,
  kMarkers,
  kFrames,
  kAxes,
  kScale,
};

struct ScenePartInfo {
  ScenePart part;
  const char* name;  // as in the options --show and --hide
  bool by_default;
  const char* what;  // description for help texts
};

extern const std::array<ScenePartInfo, 14> kSceneParts;

/// The set of visible elements; initially the default ones.
class ScenePartSet {
 public:
  ScenePartSet();
  bool Has(ScenePart part) const { return (bits_ & Bit(part)) != 0; }
  void Set(ScenePart part, bool shown) { bits_ = shown ? bits_ | Bit(part) : bits_ & ~Bit(part); }
  bool operator==(const ScenePartSet& other) const { return bits_ == other.bits_; }

 private:
  static std::uint32_t Bit(ScenePart part) { return 1u << static_cast<std::uint32_t>(part); }
  std::uint32_t bits_ = 0;
};

/// Past positions of a point, oldest first; world, m. Rendered as a line that becomes thicker
/// towards its end.
struct Trail {
  std::vector<Eigen::Vector3d> points;
  Rgb color = {0, 0, 0};
  std::string name = {};  // of the point, for the legend; "": no entry
};

/// A reference pose: a second, translucent body.
struct Ghost {
  PersonState person;
  double opacity = 0.35;  // 0..1
  std::string name = {};  // for the legend; "": no entry
};

/// How finely bodies are rendered.
enum class Detail {
  kFull,
  kBySize,  // with fewer triangles where the difference is below a pixel: for live pictures
};

/// What people are rendered as. A body of the user's own (custom meshes, primitives) is always that
/// of its URDF.
enum class Figure {
  kSkin,  // one continuous surface in a suit
  kUrdf,  // the rigid parts of the URDF, as RViz shows them
};

struct SceneLook {
  Theme theme = Theme::kLight;
  std::optional<Rgb> background;  // replaces that of the theme
  /// The alpha of the picture is the share of each pixel that the scene covers, soft edges and
  /// shadows included; alpha is straight (colours are not multiplied by alpha), as in PNG. Over
  /// white, the picture equals the one with a white background, up to one level per channel.
  bool is_transparent = false;
  bool floor = true;
  Detail detail = Detail::kFull;
  Figure figure = Figure::kSkin;
  ScenePartSet shown;
  std::vector<Trail> trails;
  std::vector<Ghost> ghosts;

  bool Shows(ScenePart part) const { return shown.Has(part); }
};

/// Colours of a theme that carry no meaning.
struct ThemeColors {
  Rgb background, floor, fine_line, line;  // of the grid: 0.25 m, 1 m
  Rgb shadow;
};

const ThemeColors& ColorsOf(Theme theme);
inline const Rgb& BackgroundOf(const SceneLook& look) {
  return look.background ? *look.background : ColorsOf(look.theme).background;
}

/// Whether `look` hides anything that `Without` would remove.
bool HidesAnything(const SceneLook& look);
/// `state` without the elements that `look` hides, as far as they are data of the state.
[[nodiscard]] SceneState Without(SceneState state, const SceneLook& look);

}  // namespace kinescope::render
