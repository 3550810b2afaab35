#include "server/wrenches/wrench_row.h"

namespace kinescope::wrenches {
namespace {

struct BodyNames {
  const char* name;
  const char* link;
};
constexpr std::array<BodyNames, kWrenchBodyCount> kBodyNames = {{{"RightFoot", "right_foot"},
                                                                 {"LeftFoot", "left_foot"},
                                                                 {"RightHand", "right_hand"},
                                                                 {"LeftHand", "left_hand"},
                                                                 {"Ground", "ground"}}};

}  // namespace

const char* Name(WrenchBody body) { return kBodyNames[At(body)].name; }

std::vector<std::string> WrenchBodyNames() {
  std::vector<std::string> names;
  names.reserve(kBodyNames.size());
  for (const BodyNames& body : kBodyNames) names.emplace_back(body.name);
  return names;
}

std::optional<WrenchBody> FindWrenchBody(std::string_view name) {
  for (std::size_t i = 0; i < kBodyNames.size(); ++i) {
    if (name == kBodyNames[i].name || name == kBodyNames[i].link) return static_cast<WrenchBody>(i);
  }
  return std::nullopt;
}

}  // namespace kinescope::wrenches
