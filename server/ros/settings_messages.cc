#include "server/ros/settings_messages.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace kinescope::ros_bridge {
namespace {

using dynamic_reconfigure::Config;
using dynamic_reconfigure::ConfigDescription;
using dynamic_reconfigure::ParamDescription;

constexpr char kSex[] = "sex", kCamera[] = "camera";
constexpr char kGroup[] = "Default";  // as its generator calls it
constexpr std::size_t kMostRefused = 20, kLongestName = 60;

struct NumberParameter {
  const char* name;
  double least, most;  // the options of these names have the same range
  const char* description;
  double& (*of)(LiveSettings&);
};
constexpr NumberParameter kNumbers[] = {
    {"class_medium", 0.01, 5, "share of the capacity above which a rising load is medium (orange)",
     [](LiveSettings& all) -> double& { return all.class_limits[0]; }},
    {"class_high", 0.01, 5, "share of the capacity above which a rising load is high (red)",
     [](LiveSettings& all) -> double& { return all.class_limits[1]; }},
    {"mass", 20, 300, "body mass of the first person, kg",
     [](LiveSettings& all) -> double& { return all.mass_kg; }},
    {"height", 0.5, 2.5, "stature of the first person while the stream has no segment lengths, m",
     [](LiveSettings& all) -> double& { return all.height_m; }},
};

// As the generator of dynamic_reconfigure writes it, a dictionary of Python.
std::string Choices(const char* description, const std::vector<std::string>& values) {
  std::string items;
  for (const std::string& value : values) {
    items += fmt::format(
        "{}{{'name': '{}', 'type': 'str', 'value': '{}', 'srcline': 0, 'srcfile': '', "
        "'description': '{}', 'ctype': 'std::string', 'cconsttype': 'const char * const'}}",
        items.empty() ? "" : ", ", value, value, value);
  }
  return fmt::format("{{'enum': [{}], 'enum_description': '{}'}}", items, description);
}

ParamDescription Describe(const char* name, const char* type, const char* description,
                          const std::string& edit_method = "") {
  ParamDescription out;
  out.name = name;
  out.type = type;
  out.description = description;
  out.edit_method = edit_method;
  return out;
}

const std::vector<std::string>& Sexes() {
  static const std::vector<std::string> names = {Name(urdf::Sex::kMale), Name(urdf::Sex::kFemale)};
  return names;
}

bool Has(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

class Reader {
 public:
  Reader(const LiveSettings& now, const std::vector<std::string>& cameras)
      : now_(now), cameras_(cameras) {
    wanted_.all = now;
  }

  WantedSettings Read(const Config& config) {
    for (const auto& given : config.doubles) TakeNumber(given.name, given.value);
    for (const auto& given : config.ints) TakeNumber(given.name, given.value);
    for (const auto& given : config.strs) TakeText(given.name, given.value);
    for (const auto& given : config.bools) Refuse(given.name, "is no parameter that is on or off");
    AddChanges();
    return std::move(wanted_);
  }

 private:
  void Refuse(const std::string& name, const std::string& why) {
    if (wanted_.refused.size() == kMostRefused) return;
    wanted_.refused.push_back(name.substr(0, kLongestName) + ": " + why);
  }

  void TakeNumber(const std::string& name, double value) {
    const auto* const known =
        std::find_if(std::begin(kNumbers), std::end(kNumbers),
                     [&](const NumberParameter& each) { return name == each.name; });
    if (known == std::end(kNumbers)) return Refuse(name, "no parameter that is a number");
    if (std::isnan(value)) return Refuse(name, "not a number");
    known->of(wanted_.all) = std::clamp(value, known->least, known->most);
  }

  void TakeText(const std::string& name, const std::string& value) {
    if (name == kSex && Has(Sexes(), value)) {
      wanted_.all.sex = value == Name(urdf::Sex::kFemale) ? urdf::Sex::kFemale : urdf::Sex::kMale;
    } else if (name == kCamera && Has(cameras_, value)) {
      wanted_.all.camera = value;
    } else if (name == kSex || (name == kCamera && !cameras_.empty())) {
      Refuse(name, fmt::format("'{}' is none of {}", value.substr(0, kLongestName),
                               fmt::join(name == kSex ? Sexes() : cameras_, ", ")));
    } else {
      Refuse(name, "no parameter that is a text");
    }
  }

  void AddChanges() {
    LiveSettings& all = wanted_.all;
    if (!(all.class_limits[0] < all.class_limits[1])) {
      Refuse("class_medium, class_high",
             fmt::format("{} is not below {}", all.class_limits[0], all.class_limits[1]));
      all.class_limits = now_.class_limits;
    }
    SettingsChange& change = wanted_.change;
    if (all.class_limits != now_.class_limits) change.class_limits = all.class_limits;
    if (all.mass_kg != now_.mass_kg) change.person.mass_kg = all.mass_kg;
    if (all.height_m != now_.height_m) change.person.height_m = all.height_m;
    if (all.sex != now_.sex) change.person.sex = all.sex;
    if (all.camera != now_.camera) change.camera = all.camera;
  }

  const LiveSettings& now_;
  const std::vector<std::string>& cameras_;
  WantedSettings wanted_;
};

}  // namespace

ConfigDescription DescribeSettings(const LiveSettings& start,
                                   const std::vector<std::string>& cameras) {
  ConfigDescription out;
  out.groups.resize(1);
  out.groups[0].name = kGroup;
  LiveSettings least = start, most = start;
  for (const NumberParameter& number : kNumbers) {
    out.groups[0].parameters.push_back(Describe(number.name, "double", number.description));
    number.of(least) = number.least;
    number.of(most) = number.most;
  }
  out.groups[0].parameters.push_back(Describe(
      kSex, "str", "selects body table and strength of the first person", Choices(kSex, Sexes())));
  if (!cameras.empty()) {
    out.groups[0].parameters.push_back(
        Describe(kCamera, "str", "camera of the live picture", Choices(kCamera, cameras)));
  }
  out.min = ToConfig(least);
  out.max = ToConfig(most);
  out.dflt = ToConfig(start);
  return out;
}

Config ToConfig(const LiveSettings& settings) {
  Config config;
  LiveSettings all = settings;
  for (const NumberParameter& number : kNumbers) {
    config.doubles.emplace_back();
    config.doubles.back().name = number.name;
    config.doubles.back().value = number.of(all);
  }
  const auto add_text = [&](const char* name, const std::string& value) {
    config.strs.emplace_back();
    config.strs.back().name = name;
    config.strs.back().value = value;
  };
  add_text(kSex, Name(settings.sex));
  if (!settings.camera.empty()) add_text(kCamera, settings.camera);
  config.groups.resize(1);
  config.groups[0].name = kGroup;
  config.groups[0].state = 1;
  return config;
}

WantedSettings ReadConfig(const Config& wanted, const LiveSettings& now,
                          const std::vector<std::string>& cameras) {
  return Reader(now, cameras).Read(wanted);
}

}  // namespace kinescope::ros_bridge
