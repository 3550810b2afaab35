#include "render/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/hand_load_shape.h"
#include "core/palette.h"
#include "render/camera/camera.h"

namespace kinescope::render {
namespace {

constexpr std::size_t kMostNames = 4;  // of robots, and of markers; the others are counted
constexpr double kBoxRadius = 5, kLineRadius = 8;

// Whether the body mass of any person is assumed: the loads are only as good as that assumption.
const PersonState* WithAssumedMass(const SceneState& state) {
  for (const PersonState& person : state.people) {
    if (!person.loads.empty() && person.model->description.mass_is_assumed) return &person;
  }
  return nullptr;
}

// What the ratios are of, and from what: of the first person who has any.
std::string MetricOf(const SceneState& state) {
  for (const PersonState& person : state.people) {
    if (person.loads.empty()) continue;
    const BodyForces& forces = person.forces;
    std::string text = Name(forces.metric);
    if (forces.metric != LoadMetric::kExternal)
      text += forces.is_dynamic ? ", dynamic" : ", static";
    return text;
  }
  return "";
}

bool HasForceOnAFoot(const SceneState& state) {
  return std::any_of(state.people.begin(), state.people.end(), [](const PersonState& person) {
    return std::any_of(
        person.forces.feet.begin(), person.forces.feet.end(),
        [](const FootForce& foot) { return foot.touches_floor && foot.force.norm() > 0; });
  });
}

bool HasHandLoad(const SceneState& state) {
  return std::any_of(state.people.begin(), state.people.end(),
                     [](const PersonState& person) { return ShapeOfHandLoad(person).count > 0; });
}

bool HasRow(const std::vector<LegendRow>& rows, const LegendRow& row) {
  return std::find(rows.begin(), rows.end(), row) != rows.end();
}

// Rows of one kind, each once, the first ones by name.
class NamedRows {
 public:
  /// @param only_once  not even in another color
  void Add(LegendRow row, bool only_once = false) {
    const auto has_name = [&](const LegendRow& each) { return each.name == row.name; };
    if (HasRow(rows_, row)) return;
    if (only_once && std::any_of(rows_.begin(), rows_.end(), has_name)) return;
    if (rows_.size() < kMostNames) {
      rows_.push_back(std::move(row));
    } else {
      ++others_;
    }
  }
  void AppendTo(std::vector<LegendRow>& all, const char* others) {
    if (others_ > 0 && !rows_.empty()) {
      rows_.back().name = fmt::format("{} other {}", others_ + 1, others);
    }
    for (LegendRow& row : rows_) {
      if (!HasRow(all, row)) all.push_back(std::move(row));
    }
  }

 private:
  std::vector<LegendRow> rows_;
  std::size_t others_ = 0;
};

// Of its first coloured part.
Rgb ColorOfRobot(const RobotState& robot) {
  for (const urdf::Link& link : robot.model->links) {
    for (const urdf::Visual& visual : link.visuals) {
      if (visual.rgba) return {(*visual.rgba)[0], (*visual.rgba)[1], (*visual.rgba)[2]};
    }
  }
  return kBodyColor;
}

// What the style makes of a colour of the body and what it holds.
Rgb Drawn(const Rgb& color, const SceneLook& look) {
  switch (look.style) {
    case Style::kClay: return kClayColor;
    case Style::kLine: return PaperOf(look.theme);
    case Style::kMatte: break;
  }
  return color;
}

// Of the first one; nullopt if no person holds any.
std::optional<Rgb> ColorOfTool(const SceneState& state) {
  for (const PersonState& person : state.people) {
    if (!person.model->human.tools.any()) continue;
    for (const urdf::Link& link : person.model->robot.links) {
      for (const urdf::Visual& visual : link.visuals) {
        if (visual.material != urdf::kToolMaterial) continue;
        return visual.rgba ? Rgb{(*visual.rgba)[0], (*visual.rgba)[1], (*visual.rgba)[2]}
                           : kBodyColor;
      }
    }
  }
  return std::nullopt;
}

void AddTrailsAndGhosts(const SceneLook& look, std::vector<LegendRow>& rows) {
  NamedRows trails, ghosts;
  for (const Trail& trail : look.trails) {
    if (trail.name.empty()) continue;
    trails.Add(
        {{trail.color, 1}, kLineRadius, "path: " + trail.name, "", LegendRow::Symbol::kLine});
  }
  trails.AppendTo(rows, "paths");
  for (const Ghost& ghost : look.ghosts) {
    if (ghost.name.empty()) continue;
    ghosts.Add({{kBodyColor, ghost.opacity}, 7, ghost.name, "", LegendRow::Symbol::kGhost});
  }
  ghosts.AppendTo(rows, "reference poses");
}

void AddThings(const SceneState& state, const SceneLook& look, std::vector<LegendRow>& rows) {
  const auto add_box = [&](const Rgb& color, const char* name) {
    rows.push_back({{color, 1}, kBoxRadius, name, "", LegendRow::Symbol::kBox});
  };
  if (look.Shows(ScenePart::kHeld) && HasHandLoad(state)) add_box(kHandLoadColor, "hand load");
  if (const auto color = ColorOfTool(state); color && look.Shows(ScenePart::kBody)) {
    add_box(Drawn(*color, look), "tool in the hand");
  }
  if (look.Shows(ScenePart::kObjects) && !state.objects.empty()) {
    add_box(kObjectColor, "tracked object");
  }
  NamedRows robots, markers;
  for (const RobotState& robot : state.robots) {
    if (!look.Shows(ScenePart::kRobots)) break;
    const std::string name = robot.name.empty() ? robot.model->name : robot.name;
    robots.Add(
        {{ColorOfRobot(robot), 1}, kBoxRadius, "robot " + name, "", LegendRow::Symbol::kBox});
  }
  robots.AppendTo(rows, "robots");
  for (const auto& marker : state.markers) {
    if (!look.Shows(ScenePart::kMarkers)) break;
    // They say themselves what they are.
    const bool is_known = marker->ns == kNamespaceOfFrames || marker->ns == kNamespaceOfGrids ||
                          marker->ns == kNamespaceOfAxes;
    const Eigen::Vector4d& color = marker->colors.empty() ? marker->color : marker->colors.front();
    if (marker->type == MarkerType::kText || is_known || color.w() == 0) continue;
    markers.Add({{{color[0], color[1], color[2]}, 1},
                 kBoxRadius,
                 marker->ns.empty() ? "marker" : "marker " + marker->ns,
                 "",
                 LegendRow::Symbol::kBox},
                true);
  }
  markers.AppendTo(rows, "markers");
}

}  // namespace

bool HasOnlyRobots(const SceneState& state) {
  return state.people.empty() && !state.robots.empty() && state.stamp_nanos == 0;
}

SphereRim SphereRimOf(LoadClass load_class) {
  const double rim = RimOf(load_class);
  return rim > 0 ? SphereRim::kDark : rim < 0 ? SphereRim::kWhite : SphereRim::kNone;
}

bool LegendRow::operator==(const LegendRow& other) const {
  return name == other.name && range == other.range && ink.color == other.ink.color;
}

void LegendContent::Add(const LegendContent& other) {
  if (title.empty() || other.has_classes()) title = other.title;
  for (const LegendRow& row : other.rows) {
    if (!HasRow(rows, row)) rows.push_back(row);
  }
  if (images.size() < other.images.size()) images = other.images;
  for (const std::string& note : other.notes) {
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
  }
}

LegendRow GroundReactionRow() {
  LegendRow row{{kCopColor, 1}, 0, "ground reaction force", "1 m/kN", LegendRow::Symbol::kArrow};
  row.short_name = "GRF";
  return row;
}

std::vector<ImageSize> ImageSizesOf(const SceneState& state) {
  std::vector<ImageSize> sizes;
  for (const auto& image : state.images) {
    sizes.push_back({ProportionsOf(*image), image->pane_width});
  }
  return sizes;
}

namespace {

// What a person may show, whether or not there is one yet.
void AddPeople(const SceneState& state, const SceneLook& look, LegendContent& content) {
  const std::string medium = fmt::format("{:.3g} %", 100 * state.class_limits[0]);
  const std::string high = fmt::format("{:.3g} %", 100 * state.class_limits[1]);
  const auto add_class = [&](LoadClass load_class, double radius, const char* name,
                             const std::string& range) {
    content.rows.push_back({{ColorOf(load_class), 1},
                            radius,
                            name,
                            range,
                            LegendRow::Symbol::kDisc,
                            SphereRimOf(load_class)});
  };
  if (look.Shows(ScenePart::kLoads)) {
    content.title = kLegendTitle;
    add_class(LoadClass::kLow, 6.0, "low", "≤ " + medium);
    add_class(LoadClass::kMedium, 7.2, "medium", "≤ " + high);
    add_class(LoadClass::kHigh, 8.4, "high", "> " + high);
    add_class(LoadClass::kUnknown, 4.8, "unknown", "–");
  }
  if (look.Shows(ScenePart::kCom)) content.rows.push_back({{kComColor, 1}, 5, "centre of mass"});
  if (look.Shows(ScenePart::kCop)) {
    content.rows.push_back({{kCopColor, 1}, 5, "centre of pressure"});
  }
  if (look.Shows(ScenePart::kForces) && HasForceOnAFoot(state)) {
    content.rows.push_back(GroundReactionRow());
  }
  AddTrailsAndGhosts(look, content.rows);
}

}  // namespace

LegendContent LegendOf(const SceneState& state, const SceneLook& look) {
  LegendContent content;
  content.images = ImageSizesOf(state);
  if (HasOnlyRobots(state)) return content;
  const bool is_of_people = state.liveness != Liveness::kNoPerson && !ShowsExtent(state);
  if (is_of_people) AddPeople(state, look, content);
  AddThings(state, look, content.rows);
  if (content.title.empty() && !content.rows.empty()) content.title = kSymbolsTitle;
  if (std::string metric = MetricOf(state); !metric.empty()) {
    content.notes.push_back(std::move(metric));
  }
  if (const PersonState* assumed = WithAssumedMass(state)) {
    content.notes.push_back(
        fmt::format("body mass assumed: {:.0f} kg", assumed->model->description.mass_kg));
  }
  return content;
}

}  // namespace kinescope::render
