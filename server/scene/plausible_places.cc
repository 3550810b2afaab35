#include "server/scene/plausible_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "core/system/clocks.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kPresent = kNanosPerSecond;  // after its newest sample
constexpr std::int64_t kStays = 3 * kNanosPerSecond;

constexpr int kSamplesToBelieve = 3;

bool AreNear(const Vector3d& a, const Vector3d& b) {
  return (a - b).norm() <= PlausiblePlaces::kFarthest;
}

std::string Kilometres(double metres) {
  return metres < 1e4 ? fmt::format("{:.1f} km", metres / 1000)
                      : fmt::format("{:.0f} km", metres / 1000);
}

}  // namespace

std::optional<std::string> PlausiblePlaces::WhyFarFromItself(const Vector3d& position,
                                                             std::int64_t stamp_nanos,
                                                             Place& place) {
  if (AreNear(position, place.plausible) || place.seen < kSamplesToBelieve) return std::nullopt;
  // Somewhere else again: a position that is noise never becomes plausible.
  if (!place.away_since || !AreNear(position, place.position) || stamp_nanos < *place.away_since) {
    place.away_since = stamp_nanos;
  }
  if (stamp_nanos - *place.away_since >= kStays) return std::nullopt;
  return fmt::format("{} from where it was", Kilometres((position - place.plausible).norm()));
}

std::optional<std::string> PlausiblePlaces::WhyFarFromOthers(const Place& own) const {
  const Place* nearest = &own;
  for (const auto& [id, other] : places_) {
    const bool is_present = std::abs(own.stamp_nanos - other.stamp_nanos) <= kPresent;
    if (is_present && other.position.norm() < nearest->position.norm()) nearest = &other;
  }
  if (AreNear(own.position, nearest->position)) return std::nullopt;
  return fmt::format("{} from the others", Kilometres((own.position - nearest->position).norm()));
}

std::optional<PlausiblePlaces::Doubt> PlausiblePlaces::WhyNot(int character,
                                                              const Vector3d& position,
                                                              std::int64_t stamp_nanos) {
  const Place newcomer{position, stamp_nanos, position, 0, std::nullopt};
  Place& place = places_.try_emplace(character, newcomer).first->second;
  if (std::abs(stamp_nanos - place.stamp_nanos) > kPresent) place = newcomer;  // comes back
  const auto far_from_itself = WhyFarFromItself(position, stamp_nanos, place);
  place.position = position;
  place.stamp_nanos = stamp_nanos;
  if (far_from_itself) return Doubt{*far_from_itself, false};
  if (const auto far_from_others = WhyFarFromOthers(place)) return Doubt{*far_from_others, true};
  place.seen = AreNear(position, place.plausible) ? std::min(place.seen + 1, kSamplesToBelieve) : 1;
  place.plausible = position;
  place.away_since.reset();
  return std::nullopt;
}

}  // namespace kinescope::app
