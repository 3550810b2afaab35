/// Decides which people are where people can be. Cameras frame all people, so one wrong position (a
/// damaged stream, a suit without a reference, a hostile sender) would empty the picture for all.
/// Depends only on the samples in order. One thread.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "core/body_sample.h"

namespace kinescope::app {

class PlausiblePlaces {
 public:
  static constexpr double kFarthest = 1000;  // m, from the others, and in one step

  struct Doubt {
    std::string text;
    bool is_of_person = false;  // far from the others; else only this sample is: the last plausible
                                // one may be shown
  };

  /// Nullopt if the sample is plausible; otherwise why not: "900 km from the others".
  /// - Farther than kFarthest from where the person was: not for 3 s, then it is there. A
  ///   place of fewer than three samples, or of more than a second ago, does not count.
  /// - Farther than kFarthest from the person who is nearest to the origin of the world: suits are
  ///   calibrated near it. The larger group would not do: false senders can be many.
  /// @param position of the pelvis, world, m  @param stamp_nanos when it was
  /// measured or came, on one clock for all people
  std::optional<Doubt> WhyNot(int character, const Eigen::Vector3d& position,
                              std::int64_t stamp_nanos);

  void Forget(int character) { places_.erase(character); }

 private:
  struct Place {
    Eigen::Vector3d position;                // of the newest sample
    std::int64_t stamp_nanos = 0;            // of the newest sample
    Eigen::Vector3d plausible;               // where the person last was
    int seen = 0;                            // samples there, in a row; limited
    std::optional<std::int64_t> away_since;  // stamp of the first sample away from there
  };

  std::optional<std::string> WhyFarFromItself(const Eigen::Vector3d& position,
                                              std::int64_t stamp_nanos, Place& place);
  std::optional<std::string> WhyFarFromOthers(const Place& own) const;

  std::map<int, Place> places_;  // by character
};

}  // namespace kinescope::app
