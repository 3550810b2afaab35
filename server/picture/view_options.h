/// The look of a picture, as every command that draws asks for it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "server/options/option_list.h"
#include "server/options/ros_names.h"
#include "server/picture/camera_options.h"
#include "server/picture/figure_value.h"
#include "server/picture/people_look.h"
#include "server/picture/trail_options.h"

namespace kinescope::app {

/// Which texts and plots are painted over a picture: names ("title,time": these) or changes of the
/// default ("+scale,-legend").
class OverlayValue : public options::ValueOf<render::OverlayParts> {
 public:
  OverlayValue() : ValueOf({}) {}

  void Parse(const std::string& text) override;
  std::string ToText() const override { return text_; }
  std::string Expected() const override;
  std::vector<std::string> Names() const override;
  /// Whether the plot was named, with or without a sign.
  bool names_plot() const;
  std::vector<options::FormerWord> former_words() const override { return former_words_; }

 private:
  std::string text_;
  std::vector<options::FormerWord> former_words_;
};

/// Several views in one picture, row by row: of several cameras, or of several moments; none: one
/// view.
struct ViewGrid {
  std::vector<std::string> cameras;  // names; "camera": the one of --camera
  std::vector<double> times;         // s after the first sample, of the camera of --camera
  int columns = 1;                   // of all rows but a shorter last one

  bool has_times() const { return !times.empty(); }
  /// Each once, in ascending order.
  std::vector<double> TimesInOrder() const;
};

class ViewsValue : public options::ValueOf<ViewGrid> {
 public:
  ViewsValue() : ValueOf({}) {}

  void Parse(const std::string& text) override;
  std::string ToText() const override { return text_; }
  std::string Expected() const override;
  std::vector<std::string> Names() const override;

 private:
  std::string text_;
};

struct Background {
  bool is_transparent = false;
  std::optional<Rgb> color;  // none: the theme's
};

/// theme, transparent, white, black or #RRGGBB.
class BackgroundValue : public options::ValueOf<Background> {
 public:
  BackgroundValue() : ValueOf({}) {}

  void Parse(const std::string& text) override;
  std::string ToText() const override { return text_; }
  std::string Expected() const override;
  std::vector<std::string> Names() const override;

 private:
  std::string text_ = "theme";
};

/// A body to compare with: an anatomical position, or a moment of a recording.
struct GhostSource {
  enum class Kind { kNone, kNPose, kTPose, kMoment };
  Kind kind = Kind::kNone;
  std::string source;  // kMoment
  double secs = 0;     // after the start of the source
};

/// n_pose, t_pose or SOURCE@SECS; "": none.
class GhostValue : public options::ValueOf<GhostSource> {
 public:
  GhostValue() : ValueOf({}) {}

  void Parse(const std::string& text) override;
  std::string ToText() const override { return text_; }
  std::string Expected() const override;
  std::vector<std::string> Names() const override { return {"n_pose", "t_pose"}; }
  std::vector<std::filesystem::path> Files() const override;
  void SetFolder(const std::filesystem::path& folder) override;

 private:
  std::string text_;
};

/// 0.35 unless told, from 0 to 1.
options::Number GhostOpacity();

/// Lists --ghost and --ghost_opacity. They are borrowed.
void ListGhost(options::OptionList& option, GhostValue& ghost, options::Number& opacity);

/// A robot's URDF, and where it is: it stands on the floor, or frames of TF have its links.
struct RobotPlace {
  std::string file;       // "": the URDF is in `parameter`
  std::string parameter;  // of the ROS graph; "" with a file
  struct Place {
    double x = 0, y = 0, yaw = 0;  // of the root, m, m, rad; world
  };
  std::optional<Place> place;            // none, and no prefix: beside the people
  std::optional<std::string> tf_prefix;  // of its frames in TF; none: it stands
  double opacity = 1;                    // 0..1
};

inline constexpr char kRobotHelp[] =
    "robot beside the people: on the floor, or moved by TF (of a bag, or of ROS in serve); may be "
    "repeated";

/// FILE.urdf, FILE.urdf@X,Y or FILE.urdf@X,Y,YAW (m, degrees): it stands. FILE.urdf@tf or
/// FILE.urdf@tf:PREFIX, ros:PARAMETER or ros:PARAMETER@tf:PREFIX: TF moves it. "(alpha=0.5)" after
/// any of these makes it translucent. Once per robot.
class RobotsValue : public options::ValueOf<std::vector<RobotPlace>> {
 public:
  RobotsValue() : ValueOf({}) {}

  void Parse(const std::string& text) override;
  void ParseAll(const std::vector<std::string>& texts) override;
  bool is_repeatable() const override { return true; }
  std::vector<std::string> ToTexts() const override { return texts_; }
  std::string ToText() const override;
  std::string Expected() const override;
  std::vector<std::filesystem::path> Files() const override;
  void SetFolder(const std::filesystem::path& folder) override;
  /// Those that stand.
  RobotsValue WithoutMoving() const;

 private:
  std::vector<std::string> texts_;
};

enum class LegendChoice { kInside, kOutside, kBelow, kOff };

struct ViewOptions {
  /// `most_cameras`: of the commands that draw one picture, 1.
  explicit ViewOptions(std::size_t most_cameras = 1);

  options::Size size;
  options::Optional<options::Number> width_mm, dpi;
  options::Number text_pt;
  CamerasValue camera;
  ViewsValue views;
  CameraOptions moves;
  options::Choice<int> supersample;  // times as many pixels each way
  options::Text title;
  OverlayValue overlay;
  options::Choice<LegendChoice> legend;
  options::List<int> plot;  // urdf::Joint
  options::Flag no_overlays;
  FigureValue figure;
  StyleValue style;
  LoadsShownValue loads;
  options::Number body_opacity;
  options::Choice<render::Theme> theme;
  BackgroundValue background;
  options::Switch floor;
  options::List<render::ScenePart> show, hide;
  TrailOptions trails;
  GhostValue ghost;
  options::Number ghost_opacity;
  RobotsValue robot;
  ShownTopicsValue marker_topics;

  void List(options::OptionList& option);
};

/// Without cameras. @throws UsageError if the picture would be too large or too small for its width
/// in print.
render::PictureSpec ToPictureSpec(const ViewOptions& options);

}  // namespace kinescope::app
