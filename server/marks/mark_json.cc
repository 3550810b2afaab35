#include "server/marks/mark_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "core/system/json_parse.h"

namespace kinescope::marks {
namespace {

using nlohmann::json;

constexpr std::array<std::pair<Kind, const char*>, 3> kKinds = {
    {{Kind::kMark, "mark"}, {Kind::kChange, "change"}, {Kind::kTrial, "trial"}}};

const char* NameOf(Kind kind) {
  return std::find_if(kKinds.begin(), kKinds.end(),
                      [&](const auto& each) { return kind == each.first; })
      ->second;
}

json ToJson(const Moment& moment) {
  return {{"state", moment.state},
          {"micros", moment.made_nanos / 1000},
          {"stamp_micros", moment.stamp_nanos / 1000},
          {"time_code_millis", moment.time_code_millis},
          {"counter", moment.counter}};
}

// Reads members; `is_right` is false from the first one that is missing or of another kind.
class Reader {
 public:
  explicit Reader(const json& object) : object_(object), is_right_(object.is_object()) {}

  bool is_right() const { return is_right_; }

  template <class Integer>
  void Read(const char* name, Integer& value) {
    const json* const found = Find(name);
    if (found == nullptr || !found->is_number_integer()) return Fail();
    if (found->is_number_unsigned() &&
        found->get<std::uint64_t>() >
            static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
      return Fail();
    }
    const auto number = found->get<std::int64_t>();
    if (std::is_unsigned_v<Integer> && number < 0) return Fail();
    value = static_cast<Integer>(number);
    if (static_cast<std::int64_t>(value) != number) Fail();
  }
  void ReadMicros(const char* name, std::int64_t& nanos) {
    std::int64_t micros = 0;
    Read(name, micros);
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max() / 1000;
    if (micros > kMost || micros < -kMost) return Fail();
    nanos = 1000 * micros;
  }
  void Read(const char* name, bool& value) {
    const json* const found = Find(name);
    if (found == nullptr || !found->is_boolean()) return Fail();
    value = found->get<bool>();
  }
  void Read(const char* name, std::string& value) {
    const json* const found = Find(name);
    if (found == nullptr || !found->is_string()) return Fail();
    value = found->get<std::string>();
  }
  void Read(const char* name, double& value) {
    const json* const found = Find(name);
    if (found == nullptr || !found->is_number()) return Fail();
    value = found->get<double>();
    if (!std::isfinite(value)) Fail();
  }
  void Read(const char* name, Kind& kind) {  // absent in the files of earlier versions
    if (!is_right_ || object_.find(name) == object_.end()) return;
    std::string text;
    Read(name, text);
    const auto* const known = std::find_if(kKinds.begin(), kKinds.end(),
                                           [&](const auto& each) { return text == each.second; });
    if (known == kKinds.end()) return Fail();
    kind = known->first;
  }
  void Read(const char* name, Moment& moment) {
    const json* const found = Find(name);
    if (found == nullptr) return Fail();
    Reader in(*found);
    in.Read("state", moment.state);
    in.ReadMicros("micros", moment.made_nanos);
    in.ReadMicros("stamp_micros", moment.stamp_nanos);
    in.Read("time_code_millis", moment.time_code_millis);
    in.Read("counter", moment.counter);
    if (!in.is_right()) Fail();
  }
  void Read(const char* name, std::optional<Moment>& moment) {
    const json* const found = Find(name);
    if (found != nullptr && found->is_null()) return;
    Read(name, moment.emplace());
  }

 private:
  const json* Find(const char* name) const {
    if (!is_right_) return nullptr;
    const auto found = object_.find(name);
    return found == object_.end() ? nullptr : &*found;
  }
  void Fail() { is_right_ = false; }

  const json& object_;
  bool is_right_;
};

}  // namespace

json ToJson(const Mark& mark) {
  const std::int64_t before = mark.end ? 0 : kWindowNanos;
  const Moment& last = mark.end ? *mark.end : mark.at;
  return {{"id", mark.id},
          {"revision", mark.revision},
          {"run_micros", mark.run_micros},
          {"kind", NameOf(mark.kind)},
          {"button", mark.button},
          {"text", mark.text},
          {"role", mark.role},
          {"at", ToJson(mark.at)},
          {"end", mark.end ? ToJson(*mark.end) : json()},
          {"is_open", mark.is_open},
          {"is_removed", mark.is_removed},
          {"behind_secs", mark.behind_secs},
          {"pressed_micros", mark.pressed_nanos / 1000},
          {"window_stamp_micros",
           {(mark.at.stamp_nanos - before) / 1000, (last.stamp_nanos + before) / 1000}}};
}

std::optional<Mark> ReadMark(std::string_view line) {
  const json object = ParseJson(line);
  Reader in(object);
  Mark mark;
  in.Read("id", mark.id);
  in.Read("revision", mark.revision);
  in.Read("run_micros", mark.run_micros);
  in.Read("kind", mark.kind);
  in.Read("button", mark.button);
  in.Read("text", mark.text);
  in.Read("role", mark.role);
  in.Read("at", mark.at);
  in.Read("end", mark.end);
  in.Read("is_open", mark.is_open);
  in.Read("is_removed", mark.is_removed);
  in.Read("behind_secs", mark.behind_secs);
  in.ReadMicros("pressed_micros", mark.pressed_nanos);
  if (!in.is_right()) return std::nullopt;
  return mark;
}

}  // namespace kinescope::marks
