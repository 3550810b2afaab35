/// The entries of a legend: what a picture shows, with the names and colours as drawn. Pure
/// functions and values, any thread.
#pragma once

#include <string>
#include <vector>

#include "core/load_class.h"
#include "core/scene_state.h"
#include "render/painter.h"
#include "render/scene_look.h"

namespace kinescope::render {

/// Then there is no stream to tell of, and no load.
bool HasOnlyRobots(const SceneState& state);

/// Of a load sphere: its outer quarter. A second code beside the colour, for grey print.
enum class SphereRim { kNone, kDark, kWhite };
SphereRim SphereRimOf(LoadClass load_class);

struct LegendRow {
  enum class Symbol { kDisc, kArrow, kLine, kBox, kGhost };
  Ink ink;
  double radius = 0;  // px in a picture 720 px high
  std::string name;
  std::string range = {};
  Symbol symbol = Symbol::kDisc;
  SphereRim rim = SphereRim::kNone;
  std::string short_name = {};  // in place of the name where both name and range have no room

  /// Of an element that only some pictures have: a path, a reference pose, an object, a robot, a
  /// marker, a hand load.
  bool is_addition() const { return symbol != Symbol::kDisc && symbol != Symbol::kArrow; }
  bool operator==(const LegendRow& other) const;
};

inline constexpr const char* kLegendTitle = "Joint load, % of capacity";
inline constexpr const char* kSymbolsTitle = "Symbols";  // without load classes

/// Of the picture of a camera, as it is shown.
struct ImageSize {
  double proportion = 1;  // width by height
  double share = 0;       // of the width of the picture; 0: as usual

  bool operator==(const ImageSize& other) const {
    return proportion == other.proportion && share == other.share;
  }
};
std::vector<ImageSize> ImageSizesOf(const SceneState& state);

struct LegendContent {
  std::string title;                   // kLegendTitle or kSymbolsTitle; "" without rows
  std::vector<LegendRow> rows;         // from top to bottom
  std::vector<std::string> notes;      // below them, fainter: load metric, assumed body mass
  std::vector<ImageSize> images = {};  // not listed, but beside the scene as it is

  bool is_empty() const { return rows.empty(); }
  bool has_classes() const { return title == kLegendTitle; }
  /// Adds what `other` has and this content has not: of several moments.
  void Add(const LegendContent& other);
};

/// Of the arrows on the feet.
LegendRow GroundReactionRow();

/// Of the elements that `look` shows and `state` contains. Empty if there are only robots, whose
/// pictures have no legend.
LegendContent LegendOf(const SceneState& state, const SceneLook& look);

}  // namespace kinescope::render
