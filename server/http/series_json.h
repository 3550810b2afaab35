/// The query and the answer of /api/v1/series (docs/http.md). The query is untrusted: every count
/// is checked before anything is allocated. Pure functions, any thread.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tl/expected.hpp>

#include "server/history/series.h"

namespace kinescope::http {

inline constexpr std::size_t kMostSeriesKeys = 24;
inline constexpr std::size_t kMostSeriesColumns = 4096;
inline constexpr std::size_t kMostSeriesCells = 20'000;               // keys x columns
inline constexpr std::int64_t kLongestSeriesMicros = 86'400'000'000;  // a day

/// Of `query` as Target has it; "token" is left to others. The reason of an error is one line that
/// names the parameter and its value.
[[nodiscard]] tl::expected<history::SeriesQuestion, std::string> ParseSeriesQuestion(
    const std::map<std::string, std::string>& query);

/// @pre `answer` is that to `question`.
std::string SeriesJson(const history::SeriesQuestion& question,
                       const history::SeriesAnswer& answer);

}  // namespace kinescope::http
