#include "server/picture/view_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "core/picture_limits.h"
#include "core/system/errors.h"
#include "core/system/starts_with.h"
#include "server/options/ros_names.h"
#include "server/options/text.h"
#include "server/scene/robot_source.h"
#include "server/scene/scene_reader.h"
#include "urdf/segments.h"

namespace kinescope::app {
namespace {

using options::BadValue;
using options::RefuseWord;

constexpr std::size_t kMaxViews = 16, kMaxPlots = 8, kMaxRobots = 64;
constexpr double kFarthestRobot = 1000;  // m

constexpr std::array<std::pair<const char*, const char*>, 4> kGrids = {{
    {"2x1", "front,right"},
    {"3x1", "front,right,top"},
    {"1x2", "front/right"},
    {"2x2", "front,right/top,three_quarter"},
}};

std::string DefaultOverlays() {
  std::string off;
  for (const render::OverlayInfo& overlay : render::kOverlays) {
    if (!(render::OverlayParts().*overlay.part))
      off += (off.empty() ? "" : ", ") + std::string(overlay.name);
  }
  return "all but " + off;
}

const std::vector<options::FormerWord> kFormerOverlays = {{"lamp", "status"},
                                                          {"strip", "frame_code"}};
const std::vector<options::FormerWord> kFormerParts = {
    {"held", "hand_loads"}, {"frames", "link_frames"}, {"axes", "joint_axes"}};

bool IsChange(const std::string& name) {
  return !name.empty() && (name[0] == '+' || name[0] == '-');
}

std::vector<std::string> ScoredJointNames() {
  std::vector<std::string> names;
  names.reserve(urdf::kScoredJoints.size());
  for (const int joint : urdf::kScoredJoints) {
    names.emplace_back(urdf::kJoints[urdf::At(joint)].ros_name);
  }
  return names;
}

int ScoredJointNamed(const std::string& name) {
  for (const int joint : urdf::kScoredJoints) {
    if (name == urdf::kJoints[urdf::At(joint)].ros_name) return joint;
  }
  RefuseWord(name, ScoredJointNames());
}

std::vector<std::string> PartNames(bool by_default) {
  std::vector<std::string> names;
  for (const render::ScenePartInfo& info : render::kSceneParts) {
    if (info.by_default == by_default) names.emplace_back(info.name);
  }
  return names;
}

render::ScenePart PartNamed(const std::string& name) {
  std::vector<std::string> known;
  for (const render::ScenePartInfo& info : render::kSceneParts) {
    if (name == info.name) return info.part;
    known.emplace_back(info.name);
  }
  RefuseWord(name, known);
}

std::string Joined(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ","));
}

constexpr std::string_view kTimes = "time:";

// One row of views: numbers with commas between.
void AppendTimes(const std::string& row, std::vector<double>& times) {
  for (std::size_t begin = 0; begin <= row.size();) {
    const std::size_t end = std::min(row.find(',', begin), row.size());
    const std::string text = row.substr(begin, end - begin);
    begin = end + 1;
    const std::optional<double> secs = options::ParseNumber(text);
    if (!secs || *secs < 0 || *secs > kLatestSecs) {
      throw BadValue(
          fmt::format("'{}' is not a time; expected 0 to {:.0f} s after the first sample, such as "
                      "time:0,0.5,1",
                      text, kLatestSecs),
          "");
    }
    times.push_back(*secs);
  }
}

// One row of views.
void AppendCameras(const std::string& row, std::vector<std::string>& cameras) {
  for (const std::string& camera : options::SplitItems(row)) {
    if (camera != "camera") ParseCamera(camera);
    cameras.push_back(camera);
  }
}

std::vector<std::string> GridNames() {
  std::vector<std::string> names;
  names.reserve(kGrids.size());
  for (const auto& [name, cameras] : kGrids) names.emplace_back(name);
  return names;
}

options::Choice<int>::Words SupersampleWords() {
  options::Choice<int>::Words words;
  for (const int factor : kSupersampleFactors) words.emplace_back(std::to_string(factor), factor);
  return words;
}

}  // namespace

void OverlayValue::Parse(const std::string& text) {
  const std::vector<std::string> names = options::SplitItems(text);
  render::OverlayParts parts;
  std::vector<options::FormerWord> former_words;
  std::string text_now;
  const bool are_changes = !names.empty() && IsChange(names.front());
  if (!names.empty() && !are_changes) {
    for (const render::OverlayInfo& overlay : render::kOverlays) parts.*overlay.part = false;
  }
  for (const std::string& name : names) {
    if (IsChange(name) != are_changes) {
      throw BadValue("expected either names alone, or each name with + or - before it");
    }
    std::string word = are_changes ? name.substr(1) : name;
    const std::string sign = are_changes ? name.substr(0, 1) : "";
    if (const options::FormerWord* const former = options::FindFormer(kFormerOverlays, word)) {
      former_words.push_back(*former);
      word = former->current;
    }
    text_now += (text_now.empty() ? "" : ",") + sign + word;
    const auto* const found =
        std::find_if(render::kOverlays.begin(), render::kOverlays.end(),
                     [&](const render::OverlayInfo& overlay) { return overlay.name == word; });
    if (found == render::kOverlays.end()) RefuseWord(word, Names());
    parts.*found->part = !are_changes || name[0] == '+';
  }
  value_ = parts;
  text_ = former_words.empty() ? text : text_now;
  former_words_ = std::move(former_words);
}

std::string OverlayValue::Expected() const {
  return Joined(Names()) + " (these), or each with + or - (added to the default, or removed)";
}

std::vector<std::string> OverlayValue::Names() const {
  std::vector<std::string> names;
  names.reserve(render::kOverlays.size());
  for (const render::OverlayInfo& overlay : render::kOverlays) names.emplace_back(overlay.name);
  return names;
}

bool OverlayValue::names_plot() const { return text_.find("plot") != std::string::npos; }

std::vector<double> ViewGrid::TimesInOrder() const {
  std::vector<double> ordered = times;
  std::sort(ordered.begin(), ordered.end());
  ordered.erase(std::unique(ordered.begin(), ordered.end()), ordered.end());
  return ordered;
}

void ViewsValue::Parse(const std::string& text) {
  std::string rest = text;
  for (const auto& [name, cameras] : kGrids) {
    if (text == name) rest = cameras;
  }
  const bool has_times = rest.compare(0, kTimes.size(), kTimes) == 0;
  if (has_times) rest.erase(0, kTimes.size());
  const char* const what = has_times ? "times" : "cameras";
  ViewGrid grid;
  for (int row = 1; !rest.empty() || (has_times && row == 1); ++row) {
    const std::size_t slash = std::min(rest.find('/'), rest.size());
    const std::string items = rest.substr(0, slash);
    const bool is_last = slash == rest.size();
    rest.erase(0, slash + 1);
    const std::size_t before = grid.cameras.size() + grid.times.size();
    if (has_times) {
      AppendTimes(items, grid.times);
    } else {
      AppendCameras(items, grid.cameras);
    }
    const int count = static_cast<int>(grid.cameras.size() + grid.times.size() - before);
    if (row == 1) grid.columns = std::max(count, 1);
    if (count == 0 || count > grid.columns || (count < grid.columns && !is_last)) {
      throw BadValue(fmt::format("row {} has {} {}; expected {}, only the last row may have fewer",
                                 row, count, what, grid.columns));
    }
  }
  const std::size_t views = grid.cameras.size() + grid.times.size();
  if (views > kMaxViews) {
    throw BadValue(fmt::format("has {} views; expected at most {}", views, kMaxViews));
  }
  value_ = std::move(grid);
  text_ = text;
}

std::string ViewsValue::Expected() const {
  return fmt::format("{}", fmt::join(GridNames(), ", ")) +
         ", or cameras with , between and / between rows, such as "
         "front,right/top,camera (camera: the one of --camera), or moments of one camera, such as "
         "time:0,0.5/1,1.5 (s after the first sample)";
}

std::vector<std::string> ViewsValue::Names() const {
  std::vector<std::string> names = render::CameraNames();
  for (const std::string& grid : GridNames()) names.push_back(grid);
  return names;
}

void BackgroundValue::Parse(const std::string& text) {
  Background background;
  background.is_transparent = text == "transparent";
  if (text != "theme" && text != "transparent") {
    background.color = ColorFromHex(text == "white"   ? "#ffffff"
                                    : text == "black" ? "#000000"
                                                      : text);
    if (!background.color) RefuseText();
  }
  value_ = background;
  text_ = text;
}

std::string BackgroundValue::Expected() const {
  return "theme, transparent (PNG with alpha, soft edges too), white, black or #RRGGBB";
}

std::vector<std::string> BackgroundValue::Names() const {
  return {"theme", "transparent", "white", "black"};
}

void GhostValue::Parse(const std::string& text) {
  GhostSource ghost;
  if (text == "n_pose" || text == "t_pose") {
    ghost.kind = text == "n_pose" ? GhostSource::Kind::kNPose : GhostSource::Kind::kTPose;
  } else if (!text.empty()) {
    const auto parts = options::SplitAtLast(text, '@');
    const auto secs = parts ? options::ParseNumber(parts->second) : std::nullopt;
    if (!secs || parts->first.empty() || *secs < 0 || *secs > kLatestSecs) RefuseText();
    ghost = {GhostSource::Kind::kMoment, parts->first, *secs};
  }
  value_ = std::move(ghost);
  text_ = text;
}

std::string GhostValue::Expected() const {
  return fmt::format("n_pose, t_pose or SOURCE@SECS (0 to {:.0f} s after its start)", kLatestSecs);
}

std::vector<std::filesystem::path> GhostValue::Files() const {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(value_.source, ignored)) return {};
  return {value_.source};
}

void GhostValue::SetFolder(const std::filesystem::path& folder) {
  const bool is_generated =
      StartsWith(value_.source, "demo:") || StartsWith(value_.source, "pose:");
  if (value_.kind != GhostSource::Kind::kMoment || is_generated) return;
  value_.source = (folder / value_.source).string();
  text_ = (folder / text_).string();  // it begins with the source
}

void RobotsValue::Parse(const std::string& text) {
  std::vector<std::string> texts;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    texts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  ParseAll(texts);
}

namespace {

// A name may hold an @ of its own: what follows the last one is a place when it looks like one.
std::optional<RobotPlace> ParseRobot(const std::string& whole) {
  constexpr std::string_view kRos = "ros:", kTf = "tf", kAlpha = "(alpha=";
  RobotPlace robot;
  std::string text = whole;
  const std::size_t style = text.rfind(kAlpha);
  if (style != std::string::npos && text.back() == ')') {
    const std::size_t begin = style + kAlpha.size();
    const auto opacity = options::ParseNumber(text.substr(begin, text.size() - 1 - begin));
    if (!opacity || *opacity < 0 || *opacity > 1) return std::nullopt;
    robot.opacity = *opacity;
    text.erase(style);
  }
  robot.file = text;
  const auto parts = options::SplitAtLast(text, '@');
  const std::string place = parts ? parts->second : "";
  if (place == kTf || StartsWith(place, "tf:")) {
    robot.file = parts->first;
    robot.tf_prefix = place == kTf ? "" : place.substr(kTf.size() + 1);
    if (place != kTf && !IsFrameName(*robot.tf_prefix)) return std::nullopt;
  } else if (place.find_first_of("0123456789+-.") == 0) {
    const auto numbers = options::ParseNumbers(place);
    const bool is_good = numbers && (numbers->size() == 2 || numbers->size() == 3) &&
                         std::all_of(numbers->begin(), numbers->end(),
                                     [](double n) { return std::abs(n) <= kFarthestRobot; });
    if (!is_good) return std::nullopt;
    robot.file = parts->first;
    const double yaw = numbers->size() == 3 ? (*numbers)[2] : 0;
    robot.place = {(*numbers)[0], (*numbers)[1], yaw * M_PI / 180};
  }
  if (robot.file.empty()) return std::nullopt;
  if (!StartsWith(robot.file, kRos)) return robot;
  robot.parameter = robot.file.substr(kRos.size());
  robot.file.clear();
  if (robot.place || !IsTopicName(robot.parameter)) return std::nullopt;
  if (!robot.tf_prefix) robot.tf_prefix = "";
  return robot;
}

}  // namespace

void RobotsValue::ParseAll(const std::vector<std::string>& texts) {
  if (texts.size() > kMaxRobots) {
    throw BadValue(fmt::format("expected at most {} robots", kMaxRobots));
  }
  std::vector<RobotPlace> robots;
  for (const std::string& text : texts) {
    const std::optional<RobotPlace> robot = ParseRobot(text);
    if (!robot) RefuseText();
    robots.push_back(*robot);
  }
  value_ = std::move(robots);
  texts_ = texts;
}

std::string RobotsValue::ToText() const { return fmt::format("{}", fmt::join(texts_, ";")); }

std::string RobotsValue::Expected() const {
  return fmt::format(
      "FILE.urdf, FILE.urdf@X,Y or FILE.urdf@X,Y,YAW (m and degrees, within {}); moved by TF: "
      "FILE.urdf@tf, ros:PARAMETER, with a prefix of its frames FILE.urdf@tf:PREFIX, "
      "ros:PARAMETER@tf:PREFIX; any of these translucent: FILE.urdf@tf(alpha=0.5)",
      kFarthestRobot);
}

RobotsValue RobotsValue::WithoutMoving() const {
  RobotsValue standing;
  for (std::size_t i = 0; i < value_.size(); ++i) {
    if (value_[i].tf_prefix) continue;
    standing.value_.push_back(value_[i]);
    standing.texts_.push_back(texts_[i]);
  }
  return standing;
}

std::vector<std::filesystem::path> RobotsValue::Files() const {
  std::vector<std::filesystem::path> files;
  for (const RobotPlace& robot : value_) {
    if (robot.file.empty()) continue;
    for (auto& file : FilesOfRobot(robot.file)) files.push_back(std::move(file));
  }
  return files;
}

void RobotsValue::SetFolder(const std::filesystem::path& folder) {
  for (std::size_t i = 0; i < value_.size(); ++i) {
    if (value_[i].file.empty()) continue;
    value_[i].file = (folder / value_[i].file).string();
    texts_[i] = (folder / texts_[i]).string();  // it begins with the file
  }
}

ViewOptions::ViewOptions(std::size_t most_cameras)
    : size({kDefaultPictureWidth, kDefaultPictureHeight}),
      width_mm(options::Number(80, {5, 5000, "mm"})),
      dpi(options::Number(300, {10, 4800, "pixels per inch"})),
      text_pt(render::PrintSize().text_pt, {1, 200, "pt"}),
      camera(most_cameras),
      supersample(SupersampleWords(), 2),
      legend({{"inside", LegendChoice::kInside},
              {"outside", LegendChoice::kOutside},
              {"below", LegendChoice::kBelow},
              {"off", LegendChoice::kOff}},
             LegendChoice::kInside),
      plot(Joined(ScoredJointNames()), kMaxPlots, ScoredJointNamed),
      body_opacity(BodyOpacity()),
      theme({{"light", render::Theme::kLight}, {"dark", render::Theme::kDark}},
            render::Theme::kLight),
      floor(true),
      show(Joined(PartNames(false)), render::kSceneParts.size(), PartNamed, kFormerParts),
      hide(Joined(PartNames(true)), render::kSceneParts.size(), PartNamed, kFormerParts),
      ghost_opacity(GhostOpacity()) {}

options::Number GhostOpacity() { return {0.35, {0, 1}}; }

void ListGhost(options::OptionList& option, GhostValue& ghost, options::Number& opacity) {
  option("ghost", ghost, "a translucent second body to compare with");
  option("ghost_opacity", opacity, "opacity of the ghost");
  option.HasNoEffect("ghost_opacity", "without --ghost",
                     [&ghost] { return ghost->kind == GhostSource::Kind::kNone; });
}

void ViewOptions::List(options::OptionList& option) {
  option.Group("The picture");
  option("size", size, "size of the picture");
  option("width_mm", width_mm, "width of the picture as it is printed");
  option("dpi", dpi, "pixels per inch in print: sets the size, with the aspect ratio of --size");
  option("text_pt", text_pt, "smallest text in print");
  option("camera", camera, "where the camera stands");
  option("views", views, "several views in one picture");
  moves.List(option);
  option("supersample", supersample, "pixels drawn per pixel of the picture, each way");
  option("title", title, "text in the upper left corner");
  option("overlay", overlay, "texts and plots over the picture; default: " + DefaultOverlays());
  option("legend", legend,
         "place of the legend: over the scene, in a column to its right, in a strip under it, or "
         "none");
  option("plot", plot, "joints whose loads are plotted over time");
  option("no_overlays", no_overlays, "no text or plot over the picture; texts of markers stay");
  ListPeopleLook(option, figure, style, loads, body_opacity);
  option("theme", theme, "colours of floor and background");
  option("background", background, "colour of the background");
  option("floor", floor, "whether the floor is drawn");
  option("show", show, "parts to show beside the default ones");
  option("hide", hide, "parts to hide");
  trails.List(option);
  ListGhost(option, ghost, ghost_opacity);
  option("robot", robot, kRobotHelp);
  option("marker_topics", marker_topics,
         "topics of a bag to show beside its markers: points, poses, paths, wrenches, laser scans, "
         "point clouds, maps, pictures of cameras and frames of TF (docs/ros.md)");
  for (const char* name : {"dpi", "text_pt"}) {
    option.HasNoEffect(name, "without --width_mm", [this] { return !width_mm; });
  }
  option.HasNoEffect("camera_tf", "with a named camera", [this] { return AreAllNamed(*camera); });
  const auto no_overlays_at_all = [this] { return *no_overlays; };
  for (const char* name : {"title", "overlay", "legend", "plot", "text_pt"}) {
    option.HasNoEffect(name, "with --no_overlays", no_overlays_at_all);
  }
  option.HasNoEffect("title", "unless --overlay includes title",
                     [this] { return !overlay->title; });
  option.HasNoEffect("legend", "unless --overlay includes legend",
                     [this] { return !overlay->legend; });
}

namespace {

// px
options::PixelSize SizeOf(const ViewOptions& options) {
  if (!options.width_mm || !options.dpi) return *options.size;
  const double scale = *options.width_mm / render::kMmPerInch * *options.dpi / options.size->width;
  const options::PixelSize size{static_cast<int>(std::lround(scale * options.size->width)),
                                static_cast<int>(std::lround(scale * options.size->height))};
  const auto is_possible = [](int side) {
    return side >= options::Size::kMin && side <= options::Size::kMax;
  };
  if (is_possible(size.width) && is_possible(size.height)) return size;
  throw UsageError(
      fmt::format("--width_mm={} at --dpi={} is a picture of {} x {} px; expected {} to {} px each "
                  "way: change one of them",
                  options.width_mm.ToText(), options.dpi.ToText(), size.width, size.height,
                  options::Size::kMin, options::Size::kMax));
}

// Each view names its own time; what is over all of them cannot have one.
void CheckMomentViews(const ViewOptions& options) {
  if (!options.views->has_times()) return;
  const auto refuse = [&](const std::string& what) {
    throw UsageError(
        fmt::format("--views={}: several moments have no common {}; leave one of them out",
                    options.views.ToText(), what));
  };
  if (!options.plot->empty()) refuse("cursor for --plot=" + options.plot.ToText());
  if (!*options.no_overlays && options.overlay->frame_code) refuse("frame code (--overlay)");
}

void CheckPrintedTexts(const render::PictureSpec& spec) {
  const render::OverlayParts& parts = spec.parts;
  const bool has_texts = spec.overlays && (parts.legend || parts.time || parts.scale ||
                                           parts.plot || (parts.title && !spec.title.empty()));
  if (!spec.print.is_known() || !has_texts || render::HasRoomForTexts(spec)) return;
  throw UsageError(fmt::format(
      "--width_mm={}: the picture is too narrow or too low for texts of --text_pt={}; use a larger "
      "width, a smaller --text_pt, or --no_overlays",
      spec.print.width_mm, spec.print.text_pt));
}

}  // namespace

render::PictureSpec ToPictureSpec(const ViewOptions& options) {
  CheckMomentViews(options);
  render::PictureSpec spec;
  const options::PixelSize size = SizeOf(options);
  spec.width = size.width;
  spec.height = size.height;
  if (options.width_mm) spec.print = {*options.width_mm, *options.text_pt};
  spec.supersample = *options.supersample;
  spec.title = *options.title;
  spec.overlays = !*options.no_overlays;
  spec.marker_texts = true;  // they are part of the scene
  spec.parts = *options.overlay;
  if (options.views->has_times()) spec.parts.time = false;  // each view has its own
  // Naming joints shows the plot, unless --overlay decides.
  if (!options.plot->empty() && !options.overlay.names_plot()) spec.parts.plot = true;
  switch (*options.legend) {
    case LegendChoice::kOff: spec.parts.legend = false; break;
    case LegendChoice::kOutside: spec.legend = render::LegendPlace::kOutside; break;
    case LegendChoice::kBelow: spec.legend = render::LegendPlace::kBelow; break;
    case LegendChoice::kInside: break;
  }
  render::SceneLook& look = spec.look;
  LoadPeopleLook(options.figure, options.style, options.loads, options.body_opacity).ApplyTo(look);
  look.theme = *options.theme;
  look.is_transparent = options.background->is_transparent;
  look.background = options.background->color;
  look.floor = *options.floor;
  for (const render::ScenePart part : *options.show) look.shown.Set(part, true);
  for (const render::ScenePart part : *options.hide) look.shown.Set(part, false);
  CheckPrintedTexts(spec);
  return spec;
}

}  // namespace kinescope::app
