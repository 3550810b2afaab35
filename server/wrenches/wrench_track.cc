#include "server/wrenches/wrench_track.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "core/system/errors.h"

namespace kinescope::wrenches {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 1e-6;           // s; times are printed with few digits
constexpr std::size_t kMostKnots = 100'000;  // of one body within a fraction of a second
constexpr double kNever = -std::numeric_limits<double>::infinity();

BodyWrench ToBodyWrench(const WrenchRow& row) {
  if (row.point) return {row.force, row.torque + row.point->cross(row.force), row.point};
  // Feet and ground have no point only without a force; that of a hand is about the grip.
  if (!IsHand(row.body)) return {};
  return {row.force, row.torque, std::nullopt};
}

// The value a fraction `t` of the way from `a` to `b`.
BodyWrench Between(const BodyWrench& a, const BodyWrench& b, double t) {
  const BodyWrench& nearest = t < 0.5 ? a : b;
  return {a.force + t * (b.force - a.force), a.moment + t * (b.moment - a.moment),
          nearest.point ? nearest.point : (t < 0.5 ? b : a).point};
}

}  // namespace

WrenchTrack::WrenchTrack(WrenchSettings settings)
    : settings_(std::move(settings)), format_(WrenchFormatOf(settings_.path)) {
  CheckFile();
  Rewind();
}

std::unique_ptr<WrenchReader> WrenchTrack::Open() const {
  std::error_code ignored;
  const auto kind = std::filesystem::status(settings_.path, ignored).type();
  // It is read twice, and opening a pipe could wait for ever.
  if (kind == std::filesystem::file_type::fifo || kind == std::filesystem::file_type::socket ||
      kind == std::filesystem::file_type::character) {
    throw SourceError(settings_.path + ": is a pipe or a device; expected a file on disk");
  }
  return ReadWrenches(OpenInputFile(settings_.path), settings_.path, format_, settings_);
}

void WrenchTrack::CheckFile() {
  struct Points {
    bool with = false, without = false;
  };
  std::array<Points, kWrenchBodyCount> points;
  const auto rows = Open();
  while (const auto row = rows->Next()) {
    has_[At(row->body)] = true;
    if (!IsHand(row->body) || (row->force.isZero(0) && row->torque.isZero(0))) continue;
    Points& seen = points[At(row->body)];
    (row->point ? seen.with : seen.without) = true;
    if (seen.with && seen.without) {
      throw SourceError(
          fmt::format("{}: rows of {} have a point only in part, such as the one at "
                      "{} s; expected a point in all of them or in none",
                      settings_.path, Name(row->body), row->secs));
    }
  }
  if (std::none_of(has_.begin(), has_.end(), [](bool has) { return has; })) {
    throw SourceError(settings_.path + ": contains no row of forces");
  }
  if (Has(WrenchBody::kRightFoot) != Has(WrenchBody::kLeftFoot)) {
    const WrenchBody only =
        Has(WrenchBody::kRightFoot) ? WrenchBody::kRightFoot : WrenchBody::kLeftFoot;
    throw SourceError(fmt::format(
        "{}: has forces on {} only; expected those on both feet, or Ground for both together. For "
        "a foot that never touches anything, add rows of zeros",
        settings_.path, Name(only)));
  }
}

void WrenchTrack::Rewind() {
  rows_ = Open();
  for (Knots& knots : knots_) knots.clear();
  newest_secs_ = asked_secs_ = kNever;
}

// Keeps what MeanOf() may need: the rows around `secs` and one row beyond.
void WrenchTrack::Seek(double secs, double period) {
  if (secs < asked_secs_) Rewind();
  asked_secs_ = secs;
  while (rows_ != nullptr && newest_secs_ <= secs + period + kLongestGap) {
    const auto row = rows_->Next();
    if (!row) {
      rows_.reset();
      break;
    }
    newest_secs_ = row->secs;
    Knots& knots = knots_[At(row->body)];
    while (knots.size() > 2 && knots[2].secs < secs - period - kLongestGap) knots.pop_front();
    if (knots.size() == kMostKnots) {
      throw SourceError(
          fmt::format("{}: more than {} rows of {} from {} to {} s; expected the "
                      "time in seconds",
                      settings_.path, kMostKnots, Name(row->body), knots.front().secs, row->secs));
    }
    knots.push_back({row->secs, ToBodyWrench(*row)});
  }
}

BodyWrenches WrenchTrack::MeanAt(double secs, double period) {
  Seek(secs, period);
  BodyWrenches wrenches;
  for (std::size_t i = 0; i < wrenches.size(); ++i) {
    wrenches[i] = MeanOf(knots_[i], secs, period);
  }
  return wrenches;
}

std::optional<BodyWrench> WrenchTrack::MeanOf(const Knots& knots, double secs, double period) {
  const auto continues = [&](std::size_t i) {  // from knot i to the next one
    return i + 1 < knots.size() && knots[i + 1].secs - knots[i].secs <= kLongestGap + kRounding;
  };
  const auto after =
      std::upper_bound(knots.begin(), knots.end(), secs + kRounding,
                       [](double time, const Knot& knot) { return time < knot.secs; });
  if (after == knots.begin()) return std::nullopt;
  const auto at = static_cast<std::size_t>(after - knots.begin()) - 1;
  const bool is_on_knot = secs <= knots[at].secs + kRounding;
  if (!is_on_knot && !continues(at)) return std::nullopt;
  const double step = continues(at)                 ? knots[at + 1].secs - knots[at].secs
                      : at > 0 && continues(at - 1) ? knots[at].secs - knots[at - 1].secs
                                                    : period;
  const double width = period - step;
  if (width <= kRounding) {
    if (is_on_knot) return knots[at].wrench;
    return Between(knots[at].wrench, knots[at + 1].wrench, (secs - knots[at].secs) / step);
  }
  // The integral over the part of the time that has values.
  std::size_t first = at;
  while (first > 0 && continues(first - 1) && knots[first].secs > secs - width / 2) --first;
  BodyWrench sum;
  double covered = 0;
  for (std::size_t i = first; continues(i) && knots[i].secs < secs + width / 2; ++i) {
    const double length = knots[i + 1].secs - knots[i].secs;
    const double from = std::max(knots[i].secs, secs - width / 2);
    const double to = std::min(knots[i + 1].secs, secs + width / 2);
    if (to <= from) continue;
    const double middle = (0.5 * (from + to) - knots[i].secs) / length;
    const BodyWrench mean = Between(knots[i].wrench, knots[i + 1].wrench, middle);
    sum.force += (to - from) * mean.force;
    sum.moment += (to - from) * mean.moment;
    covered += to - from;
  }
  if (covered <= 0) return knots[at].wrench;
  sum.force /= covered;
  sum.moment /= covered;
  sum.point = knots[at].wrench.point;
  for (std::size_t i = first; !sum.point && i < knots.size(); ++i)
    sum.point = knots[i].wrench.point;
  return sum;
}

MeasuredGroundForce GroundForceOf(const BodyWrench& wrench, double floor_z,
                                  const Vector3d& last_point) {
  MeasuredGroundForce ground;
  const Vector3d& force = wrench.force;
  const Vector3d& moment = wrench.moment;
  if (force.z() < kMinGroundForce) {
    ground.point = last_point;
    return ground;
  }
  ground.only_vertical = force.x() == 0 && force.y() == 0;
  ground.force = force;
  ground.point = {(floor_z * force.x() - moment.y()) / force.z(),
                  (moment.x() + floor_z * force.y()) / force.z(), floor_z};
  ground.free_moment = moment.z() - (ground.point.x() * force.y() - ground.point.y() * force.x());
  return ground;
}

MeasuredHandForce HandForceOf(const BodyWrench& wrench) {
  MeasuredHandForce hand;
  hand.force = wrench.force;
  hand.moment = wrench.moment;
  hand.point = wrench.point;
  if (hand.point) hand.moment -= hand.point->cross(hand.force);
  return hand;
}

}  // namespace kinescope::wrenches
