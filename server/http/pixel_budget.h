/// Limits the pixels that snapshots cost per second, for each address and in all, so that the live
/// picture keeps its frame rate. A part is reserved for snapshots of up to kSmallPixels, such as
/// those of the page: large ones cannot use it up. A part of the common budget is reserved for
/// addresses that drew little lately: the others cannot use it up, however fast they request.
/// Time is an argument. Server's thread only.
#pragma once

#include <optional>
#include <string>

#include "server/http/answer.h"
#include "server/http/bucket.h"

namespace kinescope::http {

class PixelBudget {
 public:
  static constexpr double kSmallPixels = 1920.0 * 1080.0;
  static constexpr double kLargestPixels = 4096.0 * 4096.0;
  /// What the smallest snapshot costs: setting up, encoding and sending it takes time, too.
  static constexpr double kLeastPixels = 250'000;
  /// Refill per second. A megapixel takes about 0.06 s of one core without a GPU.
  static constexpr double kPixelsPerSecond = kSmallPixels;  // of one address
  static constexpr double kPixelsPerSecondInAll = 1.5 * kSmallPixels;
  /// Of one address from the reserve; so many addresses are needed to use it up.
  static constexpr double kModestPixelsPerSecond = kPixelsPerSecondInAll / 16;

  explicit PixelBudget(Clock::time_point now);

  /// Whether `snapshot` exceeds a budget: nullopt, or the answer that rejects it and says when to
  /// try again.
  [[nodiscard]] std::optional<Answer> Refuse(const std::string& address,
                                             const SnapshotRequest& snapshot,
                                             Clock::time_point now);
  /// Pays for a snapshot that will be rendered. @pre Refuse() has just returned nullopt
  void Pay(const std::string& address, const SnapshotRequest& snapshot, Clock::time_point now);

 private:
  struct Share {
    Bucket left;
    Bucket modest;  // what it may take from the reserve
  };
  Share& Of(const std::string& address, Clock::time_point now);

  Bucket all_;
  PerAddress<Share> addresses_;
};

}  // namespace kinescope::http
