#include "server/app/shard.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/system/sha256.h"

namespace kinescope::app {
namespace {

std::optional<int> WholeNumber(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

bool Shard::Has(const std::string& id) const {
  Sha256 hash;
  hash.Add(id);
  const std::uint64_t first = std::stoull(hash.Finish().substr(0, 16), nullptr, 16);
  return first % static_cast<std::uint64_t>(count) == static_cast<std::uint64_t>(number - 1);
}

void ShardValue::Parse(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) RefuseText();
  const auto number = WholeNumber(std::string_view(text).substr(0, slash));
  const auto count = WholeNumber(std::string_view(text).substr(slash + 1));
  if (!number || !count || *count < 1 || *count > kMost || *number < 1 || *number > *count) {
    RefuseText();
  }
  value_ = {*number, *count};
}

std::string ShardValue::ToText() const { return fmt::format("{}/{}", value_.number, value_.count); }

std::string ShardValue::Expected() const {
  return fmt::format("K/N, K from 1 to N, N at most {}", kMost);
}

}  // namespace kinescope::app
