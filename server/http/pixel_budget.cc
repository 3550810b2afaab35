#include "server/http/pixel_budget.h"

#include <algorithm>
#include <cmath>

namespace kinescope::http {
namespace {

// Smaller snapshots that one address, and all, can take at once beside a largest one.
constexpr double kReserve = 4 * PixelBudget::kSmallPixels;
constexpr double kReserveInAll = 8 * PixelBudget::kSmallPixels;
// Of the common budget, for addresses that drew little lately; of one such address, at once.
constexpr double kReserveForModest = kReserveInAll / 2;
constexpr double kModest = 4 * PixelBudget::kSmallPixels;

double PriceOf(const SnapshotRequest& snapshot) {
  return std::max(PixelBudget::kLeastPixels, static_cast<double>(snapshot.width) * snapshot.height);
}

std::string SizeText(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

Answer TooManyPixels(int status, const char* whose, const SnapshotRequest& snapshot,
                     std::chrono::duration<double> wait) {
  const std::string secs = std::to_string(std::max(1, static_cast<int>(std::ceil(wait.count()))));
  const std::string smaller =
      PriceOf(snapshot) > PixelBudget::kSmallPixels ? ", or request at most 1920x1080" : "";
  Answer answer =
      ErrorAnswer(status, "snapshot of " + SizeText(snapshot.width, snapshot.height) +
                              ": the snapshots of " + whose + " have used up their budget of " +
                              "pixels per second; try again in " + secs + " s" + smaller);
  answer.headers.emplace_back("Retry-After", secs);
  return answer;
}

}  // namespace

PixelBudget::PixelBudget(Clock::time_point now)
    : all_(2 * kLargestPixels + kReserveInAll, kPixelsPerSecondInAll, now) {}

PixelBudget::Share& PixelBudget::Of(const std::string& address, Clock::time_point now) {
  return addresses_.At(
      address,
      [&] {
        return Share{Bucket(kLargestPixels + kReserve, kPixelsPerSecond, now),
                     Bucket(kModest, kModestPixelsPerSecond, now)};
      },
      [&](Share& share) { return share.left.IsFull(now) && share.modest.IsFull(now); });
}

std::optional<Answer> PixelBudget::Refuse(const std::string& address,
                                          const SnapshotRequest& snapshot, Clock::time_point now) {
  const double pixels = PriceOf(snapshot);
  const bool is_small = pixels <= kSmallPixels;
  Share& share = Of(address, now);
  const auto own_wait = share.left.WaitFor(pixels + (is_small ? 0 : kReserve), now);
  if (own_wait.count() > 0) return TooManyPixels(429, "your address", snapshot, own_wait);
  const bool is_modest = is_small && share.modest.WaitFor(pixels, now).count() <= 0;
  const double others = is_modest ? 0 : is_small ? kReserveForModest : kReserveInAll;
  const auto all_wait = all_.WaitFor(pixels + others, now);
  if (all_wait.count() > 0) return TooManyPixels(503, "all clients", snapshot, all_wait);
  return std::nullopt;
}

void PixelBudget::Pay(const std::string& address, const SnapshotRequest& snapshot,
                      Clock::time_point now) {
  Share& share = Of(address, now);
  share.left.Take(PriceOf(snapshot), now);
  share.modest.Take(PriceOf(snapshot), now);
  all_.Take(PriceOf(snapshot), now);
}

}  // namespace kinescope::http
