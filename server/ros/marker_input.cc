#include "server/ros/marker_input.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "server/ros/point_colors.h"
#include "server/ros/raw_message.h"
#include "server/ros/shown_messages.h"
#include "server/ros/stamp.h"
#include "urdf/kinematics.h"

namespace kinescope::ros_bridge {
namespace {

using visualization_msgs::Marker;

bool SamePose(const urdf::Pose& a, const urdf::Pose& b) {
  return a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs();
}

bool SameMarker(const SceneMarker& a, const SceneMarker& b) {
  return a.type == b.type && SamePose(a.pose, b.pose) && a.scale == b.scale && a.color == b.color &&
         a.points == b.points && a.colors == b.colors && a.text == b.text &&
         a.mesh_uri == b.mesh_uri && a.mesh_has_own_colors == b.mesh_has_own_colors &&
         a.is_in_pixels == b.is_in_pixels && a.ground == b.ground;
}

void SizeInPixels(SceneMarker& marker, double size_px) {
  marker.scale.x() = marker.scale.y() = size_px;
  marker.is_in_pixels = true;
}

// @pre SceneAxisOf(style)
void ColourByPlace(SceneMarker& points, const ShownStyle& style) {
  const int axis = SceneAxisOf(style).value_or(0);
  std::vector<double> values;
  values.reserve(points.points.size());
  for (const Eigen::Vector3d& point : points.points) {
    values.push_back((points.pose.position + points.pose.orientation * point)[axis]);
  }
  points.colors.clear();
  for (const auto& color : ColorsOf(values, style)) points.colors.push_back(ColorOf(color));
}

bool AreLines(MarkerType type) {
  return type == MarkerType::kLineStrip || type == MarkerType::kLineList;
}

// As of RViz, where lines shine through only if the colour of all of them does.
void MakeOpaque(SceneMarker& lines) {
  constexpr double kOpaque = 0.9998;
  if (lines.color.w() < kOpaque) return;
  for (Eigen::Vector4d& color : lines.colors) color.w() = 1;
}

// As of RViz, which multiplies both; with none of the first nothing would be seen.
void FadeTriangles(SceneMarker& triangles) {
  const double alpha = triangles.color.w();
  if (!(alpha > 0 && alpha < 1)) return;
  for (Eigen::Vector4d& color : triangles.colors) color.w() *= alpha;
}

void Take(const MarkerLook& look, SceneMarker& marker) {
  if (marker.type == MarkerType::kTriangleList) {
    marker.ground = look.ground;
    if (!look.is_converted) FadeTriangles(marker);
  }
  if (!AreLines(marker.type)) return;
  if (look.has_thin_lines) SizeInPixels(marker, 1);
  if (!look.is_converted) MakeOpaque(marker);
}

// The sweep of those points of `message` that are drawn; null: of none, or not known.
std::shared_ptr<const Sweep> OfDrawn(std::shared_ptr<const Sweep> sweep, const Marker& message,
                                     std::size_t drawn) {
  if (!sweep || sweep->shares.size() != message.points.size()) return nullptr;
  if (drawn == message.points.size()) return sweep;
  Sweep rest{sweep->secs};
  for (std::size_t i = 0; i < message.points.size(); ++i) {
    const geometry_msgs::Point& at = message.points[i];
    if (IsWithinReach({at.x, at.y, at.z})) rest.shares.push_back(sweep->shares[i]);
  }
  return rest.shares.size() == drawn ? std::make_shared<const Sweep>(std::move(rest)) : nullptr;
}

// As laser_geometry has it, which RViz uses: the frame moves and turns evenly from `first` to
// `last`. @pre points.pose is that at the stamp
void Bend(SceneMarker& points, const urdf::Pose& local, const Sweep& sweep, const urdf::Pose& first,
          const urdf::Pose& last) {
  const Eigen::Quaterniond back = points.pose.orientation.conjugate();
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const auto share = static_cast<double>(sweep.shares[i]);
    const urdf::Pose frame = urdf::Interpolate(first, last, share);
    const Eigen::Vector3d in_frame = local.position + local.orientation * points.points[i];
    points.points[i] =
        back * (frame.position + frame.orientation * in_frame - points.pose.position);
  }
}

bool IsLeftOut(const Marker& message, const ShownStyle& style) {
  const std::vector<std::string>& hidden = style.frames.hidden;
  return std::find(hidden.begin(), hidden.end(), message.ns) != hidden.end();
}

}  // namespace

std::optional<Refusal> MarkerStore::Apply(std::size_t topic, const Marker& message, const Now& now,
                                          const ShownStyle& style, const MarkerLook& look,
                                          std::shared_ptr<const Sweep> sweep) {
  if (IsLeftOut(message, style)) return std::nullopt;
  const auto erase = [&](auto from, auto to) {
    for (auto entry = from; entry != to; ++entry) Release(entry->second);
    has_changed_ = has_changed_ || from != to;
    has_new_ = true;
    return entries_.erase(from, to);
  };
  if (message.action == Marker::DELETEALL) {
    const auto of_topic = [&](std::size_t number) {
      return entries_.lower_bound(Key{number, "", std::numeric_limits<int>::min()});
    };
    erase(of_topic(topic), of_topic(topic + 1));
    return std::nullopt;
  }
  const Key key{topic, message.ns, message.id};
  const auto old = entries_.find(key);
  if (message.action == Marker::DELETE) {
    if (old != entries_.end()) erase(old, std::next(old));
    return std::nullopt;
  }
  if (message.action != Marker::ADD) {
    return RefusalOf(
        "unknown action", message,
        fmt::format("action {}: expected 0 (add or modify), 2 (delete) or 3 (delete all)",
                    message.action));
  }
  auto shape = ToSceneMarker(message);
  if (!shape) return shape.error();
  if (style.size_px && shape->type == MarkerType::kPoints) SizeInPixels(*shape, *style.size_px);
  Take(look, *shape);
  const std::size_t freed = old == entries_.end() ? 0 : old->second.shape->points.size();
  if (old == entries_.end() && entries_.size() >= kMaxMarkers) {
    return RefusalOf("too many", message,
                     fmt::format("the limit of {} markers is reached", kMaxMarkers));
  }
  if (points_ - freed + shape->points.size() > kMaxPointsOfAll) {
    return RefusalOf(
        "too many", message,
        fmt::format("all markers together would have more than {} points", kMaxPointsOfAll));
  }
  points_ = points_ - freed + shape->points.size();
  Entry& entry = entries_[key];
  if (entry.is_new && entry.held_nanos) KeepWaiting(entry);
  // Many nodes publish the same marker again and again; its rendered form can be reused.
  if (!entry.shape || !SameMarker(*entry.shape, *shape)) {
    entry.shape = std::make_shared<const SceneMarker>(*std::move(shape));
  }
  entry.frame = WithoutSlash(message.header.frame_id);
  entry.axis_style.reset();
  const MarkerType type = entry.shape->type;
  const bool is_cloud = type == MarkerType::kPoints || type == MarkerType::kSphereList ||
                        type == MarkerType::kCubeList;
  if (is_cloud && SceneAxisOf(style)) entry.axis_style = style;
  entry.sweep = OfDrawn(std::move(sweep), message, entry.shape->points.size());
  entry.stamp_nanos = ToNanos(message.header.stamp);
  entry.is_locked = message.frame_locked != 0;
  entry.is_new = has_new_ = true;
  entry.lives_nanos = std::max<std::int64_t>(message.lifetime.toNSec(), 0);
  entry.dies_nanos = entry.lives_nanos > 0 ? now.graph_nanos + entry.lives_nanos : 0;
  entry.came_nanos = now.nanos;
  const std::size_t sent = HasPoints(type) ? message.points.size() : 0;
  const std::size_t left = entry.shape->points.size();
  if (left == sent) return std::nullopt;
  const std::string what =
      sent > kMaxMarkerPoints
          ? fmt::format("{} of {} points are drawn: no more than {} of one marker", left, sent,
                        kMaxMarkerPoints)
          : fmt::format("points that are not finite, or are beyond 100 km, are left out: {} of {}",
                        sent - left, sent);
  Refusal some = RefusalOf("some of its points", message, what);
  some.is_partial = true;
  return some;
}

// Many markers share a frame and a stamp, so each is looked up once. Whether a frame exists does
// not depend on the stamp.
class MarkerStore::FrameCache {
 public:
  explicit FrameCache(const FindFrame& find) : find_(find) {}

  std::optional<Span> Find(const std::string& frame, std::int64_t stamp_nanos, const Sweep* sweep) {
    const auto first = Find(frame, stamp_nanos);
    if (!first) return std::nullopt;
    Span span{*first, std::nullopt};
    if (sweep == nullptr || stamp_nanos == 0) return span;
    const auto nanos = static_cast<std::int64_t>(sweep->secs * kNanosPerSecond);
    const auto last = Find(frame, stamp_nanos + nanos);
    if (!last) return span;
    span.first.is_early = first->is_early || last->is_early;
    if (!SamePose(first->pose, last->pose)) span.last = last->pose;
    return span;
  }

 private:
  std::optional<FramePlace> Find(const std::string& frame, std::int64_t stamp_nanos) {
    if (unknown_.count(frame) != 0) return std::nullopt;
    const std::pair<std::string, std::int64_t> key(frame, stamp_nanos);
    if (const auto known = known_.find(key); known != known_.end()) return known->second;
    auto found = find_(frame, stamp_nanos);
    if (found) {
      known_.emplace(key, *found);
    } else {
      unknown_.insert(frame);
    }
    return found;
  }

  const FindFrame& find_;
  std::map<std::pair<std::string, std::int64_t>, FramePlace> known_;
  std::set<std::string> unknown_;
};

// Until then what was before it stays, as in RViz. Of a sender that is always ahead, messages do
// not wait again and again.
bool MarkerStore::IsHeld(Entry& entry, const FramePlace& place, std::int64_t now_nanos) {
  constexpr std::int64_t kLongestHold = 500 * kNanosPerMilli, kDoesNotHold = 10 * kNanosPerSecond;
  const bool is_in_vain = entry.gave_up_nanos && now_nanos >= *entry.gave_up_nanos &&
                          now_nanos - *entry.gave_up_nanos < kDoesNotHold;
  if (!place.is_early || !entry.is_new || is_in_vain) {
    entry.held_nanos.reset();
    return false;
  }
  if (!entry.held_nanos || now_nanos < *entry.held_nanos) entry.held_nanos = now_nanos;
  if (now_nanos - *entry.held_nanos < kLongestHold) return true;
  entry.held_nanos.reset();
  entry.gave_up_nanos = now_nanos;
  return false;
}

// With the message before it, if that waits for transforms, too.
void MarkerStore::KeepWaiting(Entry& entry) {
  constexpr std::size_t kMost = 8, kMostPoints = kMaxPointsOfAll / 4;
  const std::size_t points = entry.shape->points.size();
  while (!entry.waiting.empty() &&
         (entry.waiting.size() >= kMost || waiting_points_ + points > kMostPoints)) {
    waiting_points_ -= entry.waiting.front().shape->points.size();
    entry.waiting.pop_front();
  }
  if (waiting_points_ + points > kMostPoints) return;
  waiting_points_ += points;
  entry.waiting.push_back(
      {entry.shape, entry.frame, entry.stamp_nanos, entry.axis_style, entry.sweep});
}

void MarkerStore::StopWaiting(Entry& entry, std::size_t count) {
  for (; count > 0; --count) {
    waiting_points_ -= entry.waiting.front().shape->points.size();
    entry.waiting.pop_front();
  }
}

void MarkerStore::Release(Entry& entry) {
  points_ -= entry.shape->points.size();
  StopWaiting(entry, entry.waiting.size());
}

// The newest of them that has its transforms.
bool MarkerStore::PlaceWaiting(Entry& entry, FrameCache& frames, std::int64_t now_nanos) {
  for (std::size_t count = entry.waiting.size(); count > 0; --count) {
    const Waiting& each = entry.waiting[count - 1];
    const auto place = frames.Find(each.frame, each.stamp_nanos, each.sweep.get());
    if (!place || place->first.is_early) continue;
    entry.held_nanos = now_nanos;  // transforms do come
    const bool is_changed = PutAt(entry, each, *place);
    StopWaiting(entry, count);
    return is_changed;
  }
  return false;
}

bool MarkerStore::PutAt(Entry& entry, const Waiting& message, const Span& place) {
  const urdf::Pose &local = message.shape->pose, &frame = place.first.pose;
  const urdf::Pose pose{frame.position + frame.orientation * local.position,
                        (frame.orientation * local.orientation).normalized()};
  const bool is_bent = message.sweep && place.last;
  if (entry.placed && entry.placed_shape == message.shape && !is_bent && !entry.is_placed_bent &&
      SamePose(entry.placed->pose, pose)) {
    return false;
  }
  SceneMarker placed = *message.shape;
  placed.pose = pose;
  if (is_bent) Bend(placed, local, *message.sweep, frame, *place.last);
  if (message.axis_style) ColourByPlace(placed, *message.axis_style);
  entry.placed = std::make_shared<const SceneMarker>(std::move(placed));
  entry.placed_shape = message.shape;
  entry.is_placed_bent = is_bent;
  return true;
}

bool MarkerStore::Place(const Key& key, Entry& entry, FrameCache& frames, const Now& now) {
  auto place = frames.Find(entry.frame, entry.is_locked ? 0 : entry.stamp_nanos, entry.sweep.get());
  const bool is_told = !place && (!entry.stands_in_scene || entry.is_told_missing);
  if (is_told && !entry.is_lost) lost_.push_back(LostOf(key, entry));
  entry.is_lost = is_told;
  if (!place && !entry.stands_in_scene) {
    return false;  // it stays where it was, or has no place yet
  }
  if (!place) place.emplace();
  const bool has_waited = entry.is_new && entry.held_nanos;
  if (IsHeld(entry, place->first, now.nanos)) return PlaceWaiting(entry, frames, now.nanos);
  if (has_waited && entry.lives_nanos > 0) {  // it lives from now on, as in RViz
    entry.dies_nanos = now.graph_nanos + entry.lives_nanos;
  }
  StopWaiting(entry, entry.waiting.size());
  entry.is_new = false;
  entry.is_early = place->first.is_early;
  return PutAt(entry, {entry.shape, entry.frame, entry.stamp_nanos, entry.axis_style, entry.sweep},
               *place);
}

void MarkerStore::StartAgain(const Now& now) {
  constexpr std::int64_t kJustNanos = 100 * kNanosPerMilli;
  for (auto it = entries_.begin(); it != entries_.end();) {
    Entry& entry = it->second;
    const bool is_of_beginning = now.nanos - entry.came_nanos < kJustNanos &&
                                 entry.stamp_nanos <= now.graph_nanos + kJustNanos;
    if (entry.is_of_frame || is_of_beginning) {
      if (entry.lives_nanos > 0) entry.dies_nanos = now.graph_nanos + entry.lives_nanos;
      ++it;
      continue;
    }
    Release(entry);
    has_changed_ = true;
    it = entries_.erase(it);
  }
}

bool MarkerStore::Update(const Now& now, const FindFrame& find_frame) {
  // Thousands of markers are looked at less often than there are samples.
  constexpr std::size_t kFew = 256;
  constexpr std::int64_t kNanosPerMarker = 1000;
  const bool is_new = std::exchange(has_new_, false);
  if (entries_.size() > kFew && !is_new && now.nanos < next_look_nanos_) return false;
  next_look_nanos_ = now.nanos + static_cast<std::int64_t>(entries_.size()) * kNanosPerMarker;
  bool changed = std::exchange(has_changed_, false);
  // A marker that moves is copied with its points, at about 10 ns each.
  constexpr std::int64_t kNanosPerPoint = 100;
  constexpr std::int64_t kRetryNanos = 100'000'000;
  // For transforms of the time of a message. TF keeps its own as long.
  constexpr std::int64_t kLongestWait = 10 * kNanosPerSecond;
  const bool move = now.nanos >= next_move_nanos_;
  if (move) next_move_nanos_ = now.nanos + static_cast<std::int64_t>(points_) * kNanosPerPoint;
  const bool retry = now.nanos >= next_retry_nanos_;
  if (retry) next_retry_nanos_ = now.nanos + kRetryNanos;
  FrameCache frames(find_frame);
  for (auto it = entries_.begin(); it != entries_.end();) {
    Entry& entry = it->second;
    const bool waits = entry.is_new && entry.held_nanos;
    if (!waits && entry.dies_nanos != 0 && now.graph_nanos >= entry.dies_nanos) {
      Release(entry);
      changed = changed || entry.placed;
      it = entries_.erase(it);
      continue;
    }
    if (entry.is_early && now.nanos - entry.came_nanos > kLongestWait) entry.is_early = false;
    const bool is_due =
        entry.is_lost ? retry : entry.is_new || ((entry.is_locked || entry.is_early) && move);
    if (is_due && Place(it->first, entry, frames, now)) changed = true;
    ++it;
  }
  if (!changed) return false;
  placed_.clear();
  for (const auto& [key, entry] : entries_) {
    if (entry.placed) placed_.push_back(entry.placed);
  }
  return true;
}

void MarkerStore::AddOfFrame(std::size_t topic, const ShownTopic& frame) {
  const Marker lines =
      frame.is_grid ? GridMarker(frame.name, frame.style) : AxesMarker(frame.name, frame.style);
  MarkerLook ours;
  ours.is_converted = true;
  if (const auto refusal = Apply(topic, lines, 0, {}, ours)) {
    throw UsageError("--marker_topics: " + refusal->text);
  }
  Entry& entry = entries_.at(Key{topic, lines.ns, lines.id});
  if (frame.is_grid && !frame.style.width_m) {  // as RViz's style Lines
    auto thin = std::make_shared<SceneMarker>(*entry.shape);
    SizeInPixels(*thin, 1);
    entry.shape = std::move(thin);
  }
  entry.is_of_frame = true;
  entry.stands_in_scene = frame.style.stands_in_scene;
  entry.is_told_missing = frame.style.is_told_missing;
}

void MarkerStore::PlaceAgain() {
  for (auto& [key, entry] : entries_) entry.is_new = true;
  has_new_ = true;
  next_retry_nanos_ = 0;
}

std::string MarkerStore::FirstFrame() const {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [](const auto& entry) {
    return !entry.second.is_of_frame && !entry.second.frame.empty();
  });
  return found == entries_.end() ? "" : found->second.frame;
}

WithoutPlace MarkerStore::LostOf(const Key& key, const Entry& entry) {
  const std::size_t topic = std::get<0>(key);
  if (!entry.is_of_frame) return {topic, "marker " + IdentityOf(*entry.shape), entry.frame, ""};
  return {topic, entry.shape->ns == kNamespaceOfGrids ? "a grid" : "axes", entry.frame,
          entry.stands_in_scene ? "; it stands at the origin of the scene" : ""};
}

std::vector<WithoutPlace> MarkerStore::TakeLost() { return std::exchange(lost_, {}); }

std::vector<WithoutPlace> MarkerStore::Unplaced() const {
  std::vector<WithoutPlace> all;
  std::set<std::pair<std::size_t, std::string>> known;
  for (const auto& [key, entry] : entries_) {
    if (!entry.is_lost || !known.emplace(std::get<0>(key), entry.frame).second) continue;
    all.push_back(LostOf(key, entry));
  }
  return all;
}

}  // namespace kinescope::ros_bridge
