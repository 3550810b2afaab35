#include "server/app/serve/missing_pose_warning.h"

#include <spdlog/spdlog.h>

#include "core/system/starts_with.h"

namespace kinescope::app {
namespace {

constexpr std::int64_t kPatienceNanos = 2'000'000'000;

std::string MostFrequentRejection(const SourceCounters& counters) {
  std::string reason = "pose messages are missing";
  std::uint64_t most = 0;
  for (const auto& [text, count] : counters.rejected) {
    if (count <= most) continue;
    most = count;
    reason = text;
  }
  return reason;
}

}  // namespace

void MissingPoseWarning::OnCounters(const SourceCounters& counters, const std::string& source,
                                    std::int64_t now_nanos) {
  if (is_done_ || counters.samples > 0 || counters.datagrams == 0) return;
  if (counters.passed_nanos > 0) return;
  if (!since_nanos_) since_nanos_ = now_nanos;
  if (now_nanos - *since_nanos_ < kPatienceNanos) return;
  is_done_ = true;
  if (StartsWith(source, "ros:")) {
    spdlog::warn(
        "{} messages from {}, but no person among their frames; expected 23 segments, such as "
        "skeleton_pelvis. For details run `kinescope inspect {}`",
        counters.datagrams, source, source);
    return;
  }
  spdlog::warn(
      "{} datagrams from {}, but no complete pose: {}. For details run `kinescope inspect {}`",
      counters.datagrams, source, MostFrequentRejection(counters), source);
}

}  // namespace kinescope::app
