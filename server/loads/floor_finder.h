/// Finds the height of the floor: the lowest level on which feet rest. MVN puts it at z = 0 in its
/// single-level scenario, and anywhere in the others. One level; of several (stairs, a platform) it
/// is the lowest. The result depends only on the samples in order. One thread.
///
/// Source: biomech-files.md B.8.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>

#include "server/loads/sample_times.h"

namespace kinescope::loads {

class FloorFinder {
 public:
  /// Forgets what was found: the soles of the model have moved.
  void Restart() { *this = FloorFinder(); }

  /// Adds the lowest sole point of each foot: world height, m, and its speed, m/s.
  void Add(std::int64_t stamp_nanos, const std::array<double, 2>& lowest,
           const std::array<double, 2>& speeds);

  /// World, m. Before a foot has rested for 0.3 s, the lowest point of the first sample.
  /// @pre Add was called
  double height() const { return height_; }
  /// Whether a foot has rested, so that height() is that of a level.
  bool is_found() const { return is_found_; }

 private:
  struct Foot {
    std::int64_t rest_nanos = 0;
    std::map<int, std::int64_t> heights;  // ns by bin, of the rest that goes on
  };
  void Find();

  SampleTimes times_;
  std::array<Foot, 2> feet_;
  std::array<double, 2> last_lowest_{}, last_speeds_{};
  std::map<int, std::int64_t> rests_;  // ns by bin of height
  std::int64_t rested_nanos_ = 0, judged_nanos_ = 0;
  bool has_height_ = false, is_found_ = false;
  double height_ = 0;
};

}  // namespace kinescope::loads
