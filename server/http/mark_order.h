/// The body of POST /api/v1/mark (docs/http.md). Pure functions, any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace kinescope::http {

struct MarkOrder {
  std::optional<std::uint64_t> id;     // of the mark that is ended or removed; nullopt: a new one
  std::optional<std::uint64_t> state;  // SceneState::number on the author's screen; none: removed
  int button = 0;
  std::string text;  // one line, valid UTF-8
  bool is_span = false;
};

/// Of a mark's text, in characters.
inline constexpr std::size_t kLongestMark = 200;

/// The reason of an error is one line for the client.
[[nodiscard]] tl::expected<MarkOrder, std::string> ParseMarkOrder(std::string_view body);

}  // namespace kinescope::http
