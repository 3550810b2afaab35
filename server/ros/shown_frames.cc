#include "server/ros/shown_frames.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/utf8.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

// RViz's, as shares of the length of an axis.
constexpr double kUsualLength = 0.2;  // m
constexpr double kAxisWidth = 0.1;
constexpr double kShaftWidth = 0.05, kHeadWidth = 0.2, kHeadLength = 0.5;
constexpr double kShortestArrow = 0.001;  // m
constexpr double kNameHeight = 0.32;  // ours, which is smaller, and can be read on light and dark
constexpr Rgb kNameColor = {0.38, 0.46, 0.62};
const Vector3d kShaftColor(0.8, 0.8, 0.3), kHeadColor(1, 0.1, 0.6), kGrey(0.7, 0.7, 0.7);
constexpr int kSidesOfHead = 8;
constexpr int kDeepest = 1000;  // parents of a frame: TF may have a loop
constexpr double kFarthest = kFarthestMarker / 2;
constexpr std::size_t kMostNamedFrames = 8, kLongestFrame = 100;  // bytes
constexpr int kIds = static_cast<int>(kMostShownFrames) + 3;      // of each way to show them
constexpr double kSilentSecs = 2;  // after that a frame is no longer heard of

std::shared_ptr<SceneMarker> EmptyMarker(int id, MarkerType type) {
  auto marker = std::make_shared<SceneMarker>();
  marker->ns = kNamespaceOfFrames;
  marker->id = id;
  marker->type = type;
  return marker;
}

Vector4d Faded(const Vector3d& color, double grey, double alpha) {
  Vector4d faded;
  faded << (1 - grey) * color + grey * kGrey, alpha;
  return faded;
}

void AddLine(SceneMarker& lines, const Vector3d& from, const Vector3d& to, const Vector4d& color) {
  lines.points.insert(lines.points.end(), {from, to});
  lines.colors.insert(lines.colors.end(), 2, color);
}

bool IsNear(const urdf::Pose& pose) {
  return pose.position.cwiseAbs().maxCoeff() < kFarthest;  // false of NaN, too
}

// "what: a, b and 3 more"; "" of no names.
std::string ListOf(const char* what, const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNamedFrames); ++i) {
    text += (text.empty() ? std::string(what) + ": " : ", ") +
            PrintableLine(names[i].substr(0, kLongestFrame));
  }
  if (names.size() > kMostNamedFrames) {
    text += " and " + std::to_string(names.size() - kMostNamedFrames) + " more";
  }
  return text;
}

// With its round base at `base`.
void AddHead(SceneMarker& heads, const Vector3d& base, const Vector3d& tip, double radius,
             const Vector4d& color) {
  const Vector3d ahead = (tip - base).normalized();
  const Vector3d side = ahead.unitOrthogonal(), other = ahead.cross(side);
  const auto corner = [&](int i) -> Vector3d {
    const double angle = 2 * M_PI * i / kSidesOfHead;
    return base + radius * (std::cos(angle) * side + std::sin(angle) * other);
  };
  for (int i = 0; i < kSidesOfHead; ++i) {
    heads.points.insert(heads.points.end(), {corner(i), corner(i + 1), tip});
    heads.points.insert(heads.points.end(), {corner(i + 1), corner(i), base});
    heads.colors.insert(heads.colors.end(), 6, color);
  }
}

}  // namespace

ShownFrames::ShownFrames(const ShownStyle& style, std::int64_t every_nanos, int number)
    : style_(style), every_nanos_(every_nanos), first_id_(number * kIds) {}

bool ShownFrames::Shown::operator==(const Shown& other) const {
  return name == other.name && pose.position == other.pose.position &&
         pose.orientation.coeffs() == other.pose.orientation.coeffs() && parent == other.parent &&
         grey == other.grey && alpha == other.alpha;
}

bool ShownFrames::Update(const Now& now, const ListFrames& list, const FindFrame& find) {
  // A recording that is played again begins earlier.
  const bool is_again = looked_ && now.graph_nanos < looked_->graph_nanos;
  if (looked_ && !is_again && now.nanos - looked_->nanos < every_nanos_) return false;
  looked_ = now;
  if (is_again) {
    seen_.clear();
    lost_.clear();
  }
  list([&](const TreeFrame& frame) {
    const auto [place, is_new] = seen_.try_emplace(frame.name);
    Seen& seen = place->second;
    if (is_new || seen.newest_nanos != frame.newest_nanos) seen.since_nanos = now.graph_nanos;
    if (seen.parent != frame.parent) seen.parent = frame.parent;
    seen.newest_nanos = frame.newest_nanos;
    seen.listed_nanos = now.nanos;
  });
  std::vector<const Frame*> frames;
  for (const Frame& frame : seen_) {
    const Seen& seen = frame.second;
    if (seen.listed_nanos == now.nanos && OwnAgeOf(seen, now) < style_.frames.timeout_secs) {
      frames.push_back(&frame);
    }
  }
  std::sort(frames.begin(), frames.end(), [](auto* a, auto* b) { return a->first < b->first; });
  std::vector<Shown> shown = Place(frames, find, now);
  if (shown == shown_) return false;
  shown_ = std::move(shown);
  Draw();
  return true;
}

double ShownFrames::OwnAgeOf(const Seen& frame, const Now& now) {
  return frame.newest_nanos == 0 ? 0 : Secs(now.graph_nanos - frame.since_nanos);
}

double ShownFrames::AgeOf(const Seen& frame, const Now& now) const {
  double age = OwnAgeOf(frame, now);
  auto parent = seen_.find(frame.parent);
  for (int i = 0; i < kDeepest && parent != seen_.end(); ++i) {
    if (parent->second.listed_nanos != now.nanos) break;
    age = std::max(age, OwnAgeOf(parent->second, now));
    parent = seen_.find(parent->second.parent);
  }
  return age;
}

bool ShownFrames::HasLoop(const Seen& frame) const {
  auto parent = seen_.find(frame.parent);
  int depth = 0;
  for (; depth < kDeepest && parent != seen_.end(); ++depth) {
    parent = seen_.find(parent->second.parent);
  }
  return depth == kDeepest;
}

std::vector<ShownFrames::Shown> ShownFrames::Place(const std::vector<const Frame*>& frames,
                                                   const FindFrame& find, const Now& now) {
  const FramesStyle& style = style_.frames;
  std::map<std::string, std::optional<urdf::Pose>> places;  // most frames are parents, too
  const auto find_near = [&](const std::string& name) {
    const auto [place, is_new] = places.try_emplace(name);
    if (is_new) place->second = find(name);
    return place->second && IsNear(*place->second) ? place->second : std::nullopt;
  };
  std::vector<Shown> all;
  std::map<std::string, Lost> lost;
  for (const Frame* const each : frames) {
    const auto& [name, frame] = *each;
    if (all.size() == kMostShownFrames) break;
    if (std::find(style.hidden.begin(), style.hidden.end(), name) != style.hidden.end()) continue;
    const double age_secs = AgeOf(frame, now), age = age_secs / style.timeout_secs;
    if (age >= 1) continue;
    const std::optional<urdf::Pose> pose = find_near(name);
    if (!pose) {
      const auto before = lost_.find(name);
      const bool is_heard_of = age_secs < kSilentSecs && lost.size() < kMostShownFrames;
      const std::int64_t since = before == lost_.end() ? now.nanos : before->second.since_nanos;
      const Why why = places[name] ? Why::kFar : HasLoop(frame) ? Why::kLoop : Why::kNoWay;
      if (is_heard_of) lost[name] = {since, why};
      continue;
    }
    Shown shown{
        name, *pose, {}, std::clamp(3 * age - 1, 0.0, 1.0), std::clamp(3 - 3 * age, 0.0, 1.0)};
    const auto parent =
        style.has_arrows && !frame.parent.empty() ? find_near(frame.parent) : std::nullopt;
    if (parent) shown.parent = parent->position;
    all.push_back(std::move(shown));
  }
  lost_ = std::move(lost);
  return all;
}

void ShownFrames::Draw() {
  const double length = style_.size_m.value_or(kUsualLength);
  const auto axes = EmptyMarker(first_id_, MarkerType::kLineList),
             shafts = EmptyMarker(first_id_ + 1, MarkerType::kLineList),
             heads = EmptyMarker(first_id_ + 2, MarkerType::kTriangleList);
  axes->scale.x() = kAxisWidth * length;
  shafts->scale.x() = kShaftWidth * length;
  markers_.clear();
  for (const Shown& frame : shown_) {
    const Vector3d& at = frame.pose.position;
    const Eigen::Matrix3d turn = frame.pose.orientation.toRotationMatrix();
    for (int i = 0; style_.frames.has_axes && i < 3; ++i) {
      AddLine(*axes, at, at + length * turn.col(i),
              Faded(Vector3d::Unit(i), frame.grey, frame.alpha * style_.alpha.value_or(1)));
    }
    const double distance = frame.parent ? (*frame.parent - at).norm() : 0;
    if (distance >= kShortestArrow) {
      const double usual = kHeadLength * length;  // RViz's of a short arrow is shorter
      const double head = distance < usual ? usual * distance : usual;
      const Vector3d base = *frame.parent + head / distance * (at - *frame.parent);
      AddLine(*shafts, at, base, Faded(kShaftColor, frame.grey, frame.alpha));
      AddHead(*heads, base, *frame.parent, kHeadWidth * length / 2,
              Faded(kHeadColor, frame.grey, frame.alpha));
    }
  }
  for (const auto& marker : {axes, shafts, heads}) {
    if (!marker->points.empty()) markers_.push_back(marker);
  }
  const Rgb rgb = style_.color.value_or(kNameColor);
  const Vector3d color(rgb[0], rgb[1], rgb[2]);
  for (std::size_t i = 0; style_.frames.has_names && i < shown_.size(); ++i) {
    const Shown& frame = shown_[i];
    const auto name = EmptyMarker(first_id_ + 3 + static_cast<int>(i), MarkerType::kText);
    name->text = PrintableLine(frame.name.substr(0, kLongestFrame));
    name->scale.z() = style_.frames.name_m.value_or(kNameHeight * length);
    name->pose.position = frame.pose.position - Vector3d(0, 0, name->scale.z() / 2);
    name->color = Faded(color, frame.grey, frame.alpha);
    markers_.push_back(name);
  }
}

std::string ShownFrames::TakeLost() {
  std::map<Why, std::vector<std::string>> names;
  for (const auto& [name, lost] : lost_) {
    const bool is_for_long = looked_ && looked_->nanos - lost.since_nanos >= kNanosPerSecond;
    if (is_for_long && told_.size() < kMostShownFrames && told_.insert(name).second) {
      names[lost.why].push_back(name);
    }
  }
  std::string text;
  for (const auto& [why, title] :
       {std::pair(Why::kNoWay, "frames without a way to that of the scene"),
        std::pair(Why::kLoop, "frames in a loop or below it"),
        std::pair(Why::kFar, "frames beyond 50 km")}) {
    const std::string list = ListOf(title, names[why]);
    text += (text.empty() || list.empty() ? "" : "; ") + list;
  }
  return text;
}

MarkerList Together(MarkerList markers, const std::vector<ShownFrames>& frames) {
  for (const ShownFrames& each : frames) {
    markers.insert(markers.end(), each.markers().begin(), each.markers().end());
  }
  return markers;
}

}  // namespace kinescope::ros_bridge
