/// Appearance of a scene: theme, background, visible elements, and elements beside the scene itself
/// (trails, reference poses). Plain data, part of PictureSpec. World, metres.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/palette.h"
#include "core/scene_state.h"

namespace kinescope::skin {
struct SkinTemplate;  // urdf/skin/skin_template.h
}

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

/// How finely bodies are rendered.
enum class Detail {
  kFull,
  kBySize,  // with fewer triangles where the difference is below a pixel: for live pictures
};

/// What people are rendered as. A body of the user's own (custom meshes, primitives) is always that
/// of its URDF.
struct Figure {
  enum Kind {
    kSkin,  // one continuous surface
    kUrdf,  // the rigid parts of the URDF, as RViz shows them
  };
  Kind kind = kSkin;
  std::shared_ptr<const skin::SkinTemplate> own_skin;  // null: the built-in one, in a suit

  Figure(Kind of_kind = kSkin) : kind(of_kind) {}  // NOLINT(google-explicit-constructor)
  bool operator==(const Figure& other) const {
    return kind == other.kind && own_skin == other.own_skin;
  }
};

/// Where the classes of joint loads are shown. On people without a skin: as spheres.
enum class LoadsShown {
  kSpheres,
  kSkin,  // as regions of the skin around the joints, hatched where the class is unknown
  kBoth,
};

/// How bodies are drawn.
enum class Style {
  kMatte,  // a suit in soft light
  kClay,   // one colour, in soft light
  kLine,   // outlines, folds and the borders of the suit as lines
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
  LoadsShown loads = LoadsShown::kSpheres;
  Style style = Style::kMatte;
  double body_opacity = 1;  // 0..1, of people
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
/// The one whose floor and texts go with that background.
Theme ThemeOn(const Rgb& background);
/// m, from the camera's target; the floor has faded into the background there.
inline constexpr double kFloorReach = 9;
/// m; a disc with corners comes a little closer than its radius.
inline constexpr double kFloorEnd = 0.98 * kFloorReach;
/// The share of the floor's colour at a distance from the camera's target, m; the rest is that of
/// the background.
inline double FloorShare(double distance_m) {
  const double share = distance_m / kFloorEnd;
  const double fade = share < 1 ? 1 - share * share : 0;
  return fade * fade;
}
/// What bodies are filled with in Style::kLine. Not the background, which may be transparent.
inline Rgb PaperOf(Theme theme) {
  return theme == Theme::kDark ? ColorsOf(theme).background : Rgb{1, 1, 1};
}
inline const Rgb& BackgroundOf(const SceneLook& look) {
  return look.background ? *look.background : ColorsOf(look.theme).background;
}

/// Whether `look` hides anything that `Without` would remove.
bool HidesAnything(const SceneLook& look);
/// `state` without the elements that `look` hides, as far as they are data of the state.
[[nodiscard]] SceneState Without(SceneState state, const SceneLook& look);

}  // namespace kinescope::render
