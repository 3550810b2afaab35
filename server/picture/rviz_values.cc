#include "server/picture/rviz_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>

#include "core/system/utf8.h"
#include "server/options/text.h"
#include "server/picture/color_names.h"

namespace kinescope::app::rviz {
namespace {

constexpr double kMostLevel = 255;  // of a colour

Rgb ToRgb(const std::array<double, 3>& levels) {
  const auto share = [](double level) { return std::clamp(level, 0.0, kMostLevel) / kMostLevel; };
  return {share(levels[0]), share(levels[1]), share(levels[2])};
}

// "#ff8000", or "#f80".
std::optional<Rgb> ParseHex(const std::string& text) {
  if (text.size() != 4 && text.size() != 7) return std::nullopt;
  const char* const format = text.size() == 7 ? "#%2x%2x%2x%n" : "#%1x%1x%1x%n";
  const double step = text.size() == 7 ? 1 : 17;
  unsigned r = 0, g = 0, b = 0;
  int end = 0;
  if (std::sscanf(text.c_str(), format, &r, &g, &b, &end) != 3) return std::nullopt;
  if (end != static_cast<int>(text.size())) return std::nullopt;
  return ToRgb({step * r, step * g, step * b});
}

// "177; 255; 255"; what follows has no effect.
std::optional<Rgb> ParseLevels(const std::string& text) {
  int r = 0, g = 0, b = 0, end = 0;
  const int read = std::sscanf(text.c_str(), "%5d ; %5d ; %5d %n", &r, &g, &b, &end);
  const char next = text.c_str()[end];
  if (read != 3 || (next != '\0' && next != ';')) return std::nullopt;
  return ToRgb({1.0 * r, 1.0 * g, 1.0 * b});
}

std::optional<Rgb> ParseColor(const std::string& text) {
  if (const auto levels = ParseLevels(text)) return levels;
  const auto hex = ParseHex(text);
  return hex ? hex : FindColorByName(text);
}

// The text of a property; one that has children has its own beside them. A property that may have
// children and has none is its own value.
std::optional<std::string> ScalarOf(const YAML::Node& map, const std::string& name) {
  if (name == "Value" && map.IsDefined() && map.IsScalar()) return map.Scalar();
  YAML::Node value = Member(map, name);
  // yaml-cpp: an assignment would change the tree, not this handle.
  if (value.IsDefined() && value.IsMap()) value.reset(Member(value, "Value"));
  if (!value.IsDefined() || !value.IsScalar()) return std::nullopt;
  return value.Scalar();
}

}  // namespace

YAML::Node Member(const YAML::Node& map, const std::string& name) {
  const YAML::Node none(YAML::NodeType::Undefined);
  if (!map.IsDefined() || !map.IsMap()) return none;
  YAML::Node value = none;
  for (const auto& each : map) {  // the last of equal names counts
    if (each.first.IsScalar() && each.first.Scalar() == name) value.reset(each.second);
  }
  return value;
}

std::string TextOf(const YAML::Node& map, const std::string& name, const std::string& otherwise) {
  return ScalarOf(map, name).value_or(otherwise);
}

bool BoolOf(const YAML::Node& map, const std::string& name, bool otherwise) {
  std::string text = TextOf(map, name, otherwise ? "true" : "false");
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return !text.empty() && text != "0" && text != "false";
}

double NumberOf(const YAML::Node& map, const std::string& name, double otherwise, double least,
                double most) {
  const auto text = ScalarOf(map, name);
  if (!text) return otherwise;
  return std::clamp(options::ParseNumber(*text).value_or(0), least, most);
}

Limit LimitOf(const YAML::Node& map, const std::string& name, double otherwise, double least,
              double most) {
  constexpr double kEnd = std::numeric_limits<double>::max();
  const double saved = NumberOf(map, name, otherwise, -kEnd, kEnd);
  Limit limit = {std::clamp(saved, least, most), ""};
  if (saved > 0 && saved != limit.value) {
    limit.remark = name + " " + options::NumberText(saved) + " is taken as " +
                   options::NumberText(limit.value);
  }
  return limit;
}

Eigen::Vector3d VectorOf(const YAML::Node& map, const std::string& name) {
  const YAML::Node value = Member(map, name);
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const std::string text = TextOf(value, std::string(1, "XYZ"[axis]), "");
    const auto number = options::ParseNumber(text);
    if (!number) return Eigen::Vector3d::Zero();
    vector[axis] = *number;
  }
  return vector;
}

bool IsColor(const std::string& text) { return ParseColor(text).has_value(); }

std::optional<Rgb> FindColor(const YAML::Node& map, const std::string& name) {
  const auto text = ScalarOf(map, name);
  return text ? ParseColor(*text) : std::nullopt;
}

Rgb ColorOf(const YAML::Node& map, const std::string& name, const Rgb& otherwise) {
  return FindColor(map, name).value_or(otherwise);
}

bool AddHidden(const std::string& name, std::string& names) {
  if (name.empty() || name.find_first_of("|,;()=") != std::string::npos) return false;
  names += (names.empty() ? "" : "|") + name;
  return true;
}

std::string FrameOf(const YAML::Node& map, const std::string& name, const std::string& otherwise) {
  std::string frame = TextOf(map, name, otherwise);
  if (!frame.empty() && frame.front() == '/') frame.erase(0, 1);
  return frame;
}

std::string Shown(const std::string& text) {
  constexpr std::size_t kLongest = 300;  // bytes
  return PrintableLine(text.size() > kLongest ? text.substr(0, kLongest) + "…" : text);
}

std::string Quoted(const std::string& text) { return "'" + Shown(text) + "'"; }

std::string NotSeen(const YAML::Node& display) {
  return "Alpha " + Shown(TextOf(display, "Alpha", "")) + " is 0: it is not seen";
}

int LineOf(const YAML::Node& node) { return node.Mark().line + 1; }

}  // namespace kinescope::app::rviz
