#include "server/scene/wrench_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace kinescope::app {
namespace {

using options::BadValue;
using wrenches::GroupBody;

constexpr double kMostOffset = 864'000;  // s, ten days
constexpr double kFarthestPlace = 1000;  // m
constexpr double kMostYaw = 360;         // degrees
constexpr std::size_t kMostWrenchGroups = 16;
constexpr char kNoBody[] = "none";
constexpr char kGroupForm[] =
    "GROUP=BODY, with commas between several, such as ground_force_1=RightFoot; bodies: RightFoot, "
    "LeftFoot, RightHand, LeftHand, Ground or none";

GroupBody ToGroupBody(std::string_view item) {
  const std::size_t first = std::min(item.find_first_not_of(' '), item.size());
  item = item.substr(first, item.find_last_not_of(' ') + 1 - first);
  const auto parts = options::SplitAtLast(item, '=');
  if (!parts || parts->first.empty()) throw BadValue(std::string("expected ") + kGroupForm);
  GroupBody group = {parts->first, wrenches::FindWrenchBody(parts->second)};
  if (!group.body && parts->second != kNoBody) {
    throw BadValue("unknown body '" + parts->second + "'; expected " + kGroupForm);
  }
  return group;
}

}  // namespace

void WrenchFileValue::Parse(const std::string& text) {
  if (!text.empty() && !wrenches::FindWrenchFormat(text)) RefuseText();
  value_ = text;
}

void WrenchBodiesValue::Parse(const std::string& text) {
  std::vector<GroupBody> groups;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find_first_of(",;", begin), text.size());
    if (groups.size() == kMostWrenchGroups) {
      throw BadValue(fmt::format("expected at most {} of {}", kMostWrenchGroups, kGroupForm));
    }
    groups.push_back(ToGroupBody(std::string_view(text).substr(begin, end - begin)));
    begin = end + 1;
  }
  value_ = std::move(groups);
  text_ = text;
}

std::string WrenchBodiesValue::Expected() const { return kGroupForm; }

void WrenchPlaceValue::Parse(const std::string& text) {
  const auto numbers = options::ParseNumbers(text);
  const bool is_good =
      numbers && numbers->size() == 3 &&
      std::max(std::abs((*numbers)[0]), std::abs((*numbers)[1])) <= kFarthestPlace &&
      std::abs((*numbers)[2]) <= kMostYaw;
  if (!is_good) RefuseText();
  std::copy(numbers->begin(), numbers->end(), value_.begin());
}

std::string WrenchPlaceValue::ToText() const {
  return options::NumberText(value_[0]) + "," + options::NumberText(value_[1]) + "," +
         options::NumberText(value_[2]);
}

std::string WrenchPlaceValue::Expected() const {
  return fmt::format("X,Y,YAW (m within {}, degrees within {})", kFarthestPlace, kMostYaw);
}

WrenchOptions::WrenchOptions()
    : wrench_bodies(WrenchBodiesValue()),
      wrench_offset(options::Number(0, {-kMostOffset, kMostOffset, "s"})),
      wrench_place(WrenchPlaceValue()),
      wrench_sign(options::Choice<bool>({{"on_person", false}, {"on_plate", true}}, false)) {}

void WrenchOptions::List(options::OptionList& option) {
  option.Group("Measured forces");
  option("wrenches", wrenches,
         "file of forces that plates and hand sensors measured during the recording "
         "(docs/loads.md); they replace the computed ones");
  option("wrench_bodies", wrench_bodies,
         "body on which each group of columns of a MOT or STO file acts, where its name does not "
         "tell; none: left out");
  option("wrench_offset", wrench_offset,
         "time to add to the times of the file, which count from the first sample; not given: 0");
  option("wrench_place", wrench_place,
         "where the origin of the file's frame is in the source's world, and its turn about the "
         "vertical; not given: 0,0,0");
  option("wrench_sign", wrench_sign,
         "whether the forces of feet are those on the person or those on the plate; not given: "
         "on_person");
  for (const std::string& name : WrenchOptionNames()) {
    if (name == "wrenches") continue;
    option.HasNoEffect(name, "without --wrenches", [this] { return wrenches->empty(); });
  }
}

std::vector<std::string> WrenchOptionNames() {
  return {"wrenches", "wrench_bodies", "wrench_offset", "wrench_place", "wrench_sign"};
}

std::optional<wrenches::WrenchSettings> ToWrenchSettings(const WrenchOptions& options) {
  if (options.wrenches->empty()) return std::nullopt;
  wrenches::WrenchSettings settings;
  settings.path = *options.wrenches;
  if (options.wrench_bodies) settings.groups = *options.wrench_bodies;
  if (options.wrench_place) {
    const auto& [x, y, yaw_degrees] = *options.wrench_place;
    settings.place = {x, y, yaw_degrees * M_PI / 180};
  }
  settings.offset_secs = options.wrench_offset.value_or(0.0);
  settings.is_on_plate = options.wrench_sign.value_or(false);
  return settings;
}

}  // namespace kinescope::app
