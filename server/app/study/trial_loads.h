/// What a JSON file of `kinescope loads` says of a trial, without its samples. Reads files; any
/// thread.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/load_class.h"

namespace kinescope::app {

/// Exposure of a joint. Numbers that are unknown are NaN.
struct JointLoads {
  std::array<std::uint64_t, kLoadClassCount> samples{};                         // by band
  double p10 = std::numeric_limits<double>::quiet_NaN(), p50 = p10, p90 = p10;  // of the ratio
  double peak = p10;                                                            // ratio
  double peak_secs = p10;  // since the beginning of the recording
  double peak_moment_Nm = p10;
  std::string peak_channel;
  double longest_high_secs = p10;  // longest time above the upper class limit
  std::uint64_t rises = 0;         // above it
  double rises_per_min = p10;

  bool is_known() const { return std::isfinite(p50); }  // in some sample
  std::uint64_t all_samples() const;
  /// Of all samples, %; NaN without samples.
  double Percent(LoadClass band) const;
};

struct PersonLoads {
  int number = 0;    // MVN character id
  std::string name;  // "": unknown
  std::uint64_t samples = 0;
  double secs = 0, mass_kg = 0, height_m = 0;
  /// As the option was given, or as the recording says ("1 kg right"); "": assumed.
  std::string sex, hand_load;
  std::vector<JointLoads> joints;  // in the order of ScoredName()
  double compression_most_N = std::numeric_limits<double>::quiet_NaN();  // at L5/S1
  double compression_mean_N = compression_most_N;
  double compression_above_secs = compression_most_N;  // above the lower limit, 3400 N
};

struct TrialLoads {
  std::string source, program;
  std::map<std::string, std::string> options;  // values used, as text; those not given are missing
  std::vector<PersonLoads> people;
};

/// Of a JSON file that is compressed or written anew by another program, this much is read.
inline constexpr std::size_t kMostLoadsBytes = 256 << 20;

/// Whether a text begins as a JSON file of loads.
bool LooksLikeLoads(std::string_view head);

/// From a file as `kinescope loads` writes it, only the end is read, however many samples stand
/// before it. @throws SourceError with the path and what is wrong.
TrialLoads ReadTrialLoads(const std::string& path);

/// Of a text. @throws std::exception.
TrialLoads ParseTrialLoads(std::string_view text);

}  // namespace kinescope::app
