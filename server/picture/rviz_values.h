/// Values of an RViz configuration as RViz 1.14 reads them: each is a text, which the property
/// that it meets converts; what cannot be converted is a default and no error. Pure functions.
#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <optional>
#include <string>

#include "core/suit_colors.h"

namespace kinescope::app::rviz {

/// Member `name` of a map. Not defined: `map` is no map, or has none of that name.
YAML::Node Member(const YAML::Node& map, const std::string& name);

std::string TextOf(const YAML::Node& map, const std::string& name, const std::string& otherwise);
/// As Qt has it: "", 0 and false are false, all other texts are true.
bool BoolOf(const YAML::Node& map, const std::string& name, bool otherwise);
/// 0 for what is no number, within `least` and `most`.
double NumberOf(const YAML::Node& map, const std::string& name, double otherwise, double least,
                double most);
/// The same. `remark`, unless a number is as the map has it: "Length 50 is taken as 10"; a number
/// below 0 is within no limits, and needs none.
struct Limit {
  double value = 0;
  std::string remark;
};
Limit LimitOf(const YAML::Node& map, const std::string& name, double otherwise, double least,
              double most);
/// 0 unless X, Y and Z are numbers.
Eigen::Vector3d VectorOf(const YAML::Node& map, const std::string& name);
/// Whether it is "r; g; b", each a whole number, or #rgb, #rrggbb or a name of SVG.
bool IsColor(const std::string& text);
/// nullopt: `map` has none of that name, or it is another text.
std::optional<Rgb> FindColor(const YAML::Node& map, const std::string& name);
/// `otherwise` also where there is another text. Numbers beyond 0 to 255 are the nearest of these.
Rgb ColorOf(const YAML::Node& map, const std::string& name, const Rgb& otherwise);

/// Adds a name to those of "(without=a|b)" of --marker_topics, "a|b"; false: it cannot stand there.
[[nodiscard]] bool AddHidden(const std::string& name, std::string& names);

/// Of the property of a frame, without a slash before it.
std::string FrameOf(const YAML::Node& map, const std::string& name, const std::string& otherwise);

/// In messages: a text of the file may be long, and must do nothing to a terminal.
std::string Shown(const std::string& text);
std::string Quoted(const std::string& text);
/// "Alpha 0.0 is 0: it is not seen"
std::string NotSeen(const YAML::Node& display);

/// From 1.
int LineOf(const YAML::Node& node);

}  // namespace kinescope::app::rviz
