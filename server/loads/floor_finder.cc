#include "server/loads/floor_finder.h"

#include <algorithm>
#include <cmath>

#include "core/system/clocks.h"

namespace kinescope::loads {
namespace {

constexpr double kBin = 0.001;                          // m
constexpr int kBinsOfLevel = 10;                        // a level is 1 cm thick
constexpr std::size_t kMostBins = 4096;                 // a sender cannot claim more memory
constexpr double kSlow = 0.1;                           // m/s
constexpr std::int64_t kRestNanos = 300'000'000;        // shorter ones are not counted
constexpr std::int64_t kLevelNanos = kNanosPerSecond;   // of rest, that make a level the floor
constexpr double kShareOfLevel = 0.05;                  // of all rest, that makes a level the floor
constexpr std::int64_t kJudgeEveryNanos = 250'000'000;  // of rest
constexpr double kCloseToZero = 0.005, kMoves = 0.003;  // m
constexpr double kFarthestFloor = 1e4;                  // m

using Heights = std::map<int, std::int64_t>;

void Put(double height, std::int64_t nanos, Heights& heights) {
  const auto bin = static_cast<int>(std::floor(height / kBin));
  if (heights.size() < kMostBins || heights.count(bin) > 0) heights[bin] += nanos;
}

// Where half of the time from bin `first` on, within a level, is below.
double MedianOf(const Heights& heights, int first, std::int64_t all) {
  std::int64_t below = 0;
  for (auto it = heights.lower_bound(first); it != heights.end(); ++it) {
    below += it->second;
    if (2 * below >= all) return (it->first + 0.5) * kBin;
  }
  return first * kBin;
}

}  // namespace

void FloorFinder::Find() {
  // At the beginning, a quarter of the rest so far has to do.
  const auto needed =
      std::max(std::min(kLevelNanos, rested_nanos_ / 4),
               static_cast<std::int64_t>(kShareOfLevel * static_cast<double>(rested_nanos_)));
  for (const auto& [bin, nanos] : rests_) {
    std::int64_t sum = 0;
    for (auto it = rests_.lower_bound(bin); it != rests_.end() && it->first < bin + kBinsOfLevel;
         ++it) {
      sum += it->second;
    }
    if (sum < needed) continue;
    is_found_ = true;
    double found = MedianOf(rests_, bin, sum);
    if (std::abs(found) < kCloseToZero) found = 0;  // MVN's own floor
    if (std::abs(found - height_) > kMoves || found == 0) height_ = found;
    return;
  }
}

void FloorFinder::Add(std::int64_t stamp_nanos, const std::array<double, 2>& lowest,
                      const std::array<double, 2>& speeds) {
  const std::int64_t nanos = times_.Add(stamp_nanos);
  if (!has_height_) {
    has_height_ = true;
    height_ = std::min(lowest[0], lowest[1]);
    if (std::abs(height_) < kCloseToZero) height_ = 0;
  }
  for (std::size_t i = 0; i < feet_.size(); ++i) {
    Foot& foot = feet_[i];
    const bool rests =
        last_speeds_[i] < kSlow && std::abs(last_lowest_[i]) < kFarthestFloor && times_.continues();
    if (!rests) {
      foot = Foot();
    } else if (nanos > 0) {
      foot.rest_nanos += nanos;
      Put(last_lowest_[i], nanos, foot.heights);
      if (foot.rest_nanos >= kRestNanos) {
        for (const auto& [bin, time] : foot.heights) {
          Put((bin + 0.5) * kBin, time, rests_);
          rested_nanos_ += time;
        }
        foot.heights.clear();
      }
    }
  }
  last_lowest_ = lowest;
  last_speeds_ = speeds;
  if (rested_nanos_ - judged_nanos_ < kJudgeEveryNanos) return;
  judged_nanos_ = rested_nanos_;
  Find();
}

}  // namespace kinescope::loads
