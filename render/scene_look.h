/// How the scene of a picture is to look: theme, background, what of it is shown, and what is drawn
/// beside the scene itself (trails, ghosts). Plain data, part of View.
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

/// What can be switched on and off by name.
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
  const char* name;  // as in --show and --hide
  bool by_default;
  const char* what;  // for people
};

extern const std::array<ScenePartInfo, 14> kSceneParts;

/// Those that are shown; at first the default ones.
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

/// Where a point has been, oldest first; world, m. Drawn as a line that grows towards its end.
struct Trail {
  std::vector<Eigen::Vector3d> points;
  Rgb color = {0, 0, 0};
};

/// A second body, through which the scene is seen.
struct Ghost {
  PersonState person;
  double opacity = 0.35;  // 0..1
};

struct SceneLook {
  Theme theme = Theme::kLight;
  std::optional<Rgb> background;  // instead of the theme's
  /// The picture's alpha says how much of each pixel the scene covers, soft edges and shadows too;
  /// colours are straight (not multiplied by alpha), as PNG wants them. Over white it is the
  /// picture with a white background, to a level per channel.
  bool is_transparent = false;
  bool floor = true;
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

/// Whether `look` hides anything that `Without` would take away.
bool HidesAnything(const SceneLook& look);
/// `state` without what `look` hides, as far as that is data of the state.
[[nodiscard]] SceneState Without(SceneState state, const SceneLook& look);

}  // namespace kinescope::render
