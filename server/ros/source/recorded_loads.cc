#include "server/ros/source/recorded_loads.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "server/ros/raw_message.h"
#include "urdf/segments.h"

namespace kinescope::ros_bridge {
namespace {

constexpr double kLeastKg = 0.05;
constexpr std::size_t kMostTopics = 16;

std::string MassText(double from, double to) {
  return to - from < kLeastKg ? fmt::format("{:.3g} kg", to)
                              : fmt::format("{:.3g} to {:.3g} kg", from, to);
}

}  // namespace

bool RecordedLoads::IsOne(const BagConnection& connection) {
  return Is<kinescope_ros::JointLoadArray>(connection.md5sum);
}

void RecordedLoads::Take(const BagMessage& message) {
  if (message.bytes.size() != message.size) return;
  if (!ReadBounded(message.bytes.data(), message.bytes.size(), message_)) return;
  const std::string& topic = message.connection->topic;
  if (by_topic_.size() >= kMostTopics && by_topic_.count(topic) == 0) return;
  Seen& seen = by_topic_[topic];
  const double mass = message_.body_mass;
  if (message_.body_mass_assumed == 0 && std::isfinite(mass)) {
    if (!seen.mass_kg) seen.mass_kg.emplace(mass, mass);
    seen.mass_kg = {std::min(seen.mass_kg->first, mass), std::max(seen.mass_kg->second, mass)};
  }
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const double held = message_.held_mass[side];
    if (std::isfinite(held)) seen.held_kg[side] = std::max(seen.held_kg[side], held);
  }
}

std::vector<std::string> RecordedLoads::Texts() const {
  std::vector<std::string> texts;
  for (const auto& [topic, seen] : by_topic_) {
    std::vector<std::string> parts;
    if (seen.mass_kg) {
      parts.push_back("a body mass of " + MassText(seen.mass_kg->first, seen.mass_kg->second));
    }
    for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
      if (seen.held_kg[side] < kLeastKg) continue;
      parts.push_back(fmt::format("up to {:.3g} kg in the {} hand", seen.held_kg[side],
                                  side == urdf::kRight ? "right" : "left"));
    }
    if (parts.empty()) continue;
    texts.push_back(fmt::format("the joint loads of {} were computed with {}", topic,
                                fmt::join(parts, " and ")));
  }
  return texts;
}

}  // namespace kinescope::ros_bridge
