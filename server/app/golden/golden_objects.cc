#include "server/app/golden/golden_objects.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace kinescope::app {
namespace {

using nlohmann::json;
using render::SphereInPicture;

using Key = std::pair<int, std::string>;  // character, joint

std::map<Key, const SphereInPicture*> ByKey(const std::vector<SphereInPicture>& spheres) {
  std::map<Key, const SphereInPicture*> by_key;
  for (const SphereInPicture& sphere : spheres) by_key[{sphere.character, sphere.joint}] = &sphere;
  return by_key;
}

LoadClass ToClass(const std::string& name) {
  for (const LoadClass load_class : kLoadClasses) {
    if (name == Name(load_class)) return load_class;
  }
  return LoadClass::kUnknown;
}

// "right_elbow", and whose where it is not the first person's.
std::string Who(const Key& key) {
  return key.first == 0 ? key.second : fmt::format("{} of person {}", key.second, key.first);
}

std::string ClassText(const SphereInPicture& sphere) {
  return fmt::format("{} ({})", Name(sphere.load_class), render::ColorName(sphere.load_class));
}

void Compare(const Key& key, const SphereInPicture& expected, const SphereInPicture& actual,
             std::vector<std::string>& changes) {
  if (expected.load_class != actual.load_class) {
    changes.push_back(
        fmt::format("{}: expected {}, found {}", Who(key), ClassText(expected), ClassText(actual)));
  }
  const bool both_known = std::isfinite(expected.ratio) && std::isfinite(actual.ratio);
  if (both_known && std::abs(expected.ratio - actual.ratio) > 0.005) {
    changes.push_back(fmt::format("{}: expected a load ratio of {:.3f}, found {:.3f}", Who(key),
                                  expected.ratio, actual.ratio));
  } else if (!both_known && std::isfinite(expected.ratio) != std::isfinite(actual.ratio)) {
    changes.push_back(fmt::format("{}: its load is now {}", Who(key),
                                  std::isfinite(actual.ratio) ? "known" : "unknown"));
  }
  const double moved = std::hypot(expected.x_px - actual.x_px, expected.y_px - actual.y_px);
  if (moved > 1) changes.push_back(fmt::format("{}: moved by {:.1f} px", Who(key), moved));
  if (std::abs(expected.radius_px - actual.radius_px) > 1) {
    changes.push_back(fmt::format("{}: expected a radius of {:.1f} px, found {:.1f} px", Who(key),
                                  expected.radius_px, actual.radius_px));
  }
}

double Rounded(double value, double step) { return std::round(value / step) * step; }

}  // namespace

std::string ToJson(const std::vector<SphereInPicture>& spheres) {
  std::string text = "{\"spheres\": [";
  const char* separator = "\n  ";
  for (const SphereInPicture& sphere : spheres) {
    const std::string ratio =
        std::isfinite(sphere.ratio) ? fmt::format("{:.3f}", Rounded(sphere.ratio, 0.001)) : "null";
    text += separator;
    text += fmt::format(
        R"({{"person": {}, "joint": "{}", "class": "{}", "ratio": {}, "x": {:.1f}, "y": {:.1f}, "radius": {:.1f}}})",
        sphere.character, sphere.joint, Name(sphere.load_class), ratio, sphere.x_px, sphere.y_px,
        sphere.radius_px);
    separator = ",\n  ";
  }
  return text + "\n]}\n";
}

std::vector<SphereInPicture> ReadObjects(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file)
    throw std::runtime_error(path.string() +
                             ": cannot open the file (missing, or no read permission)");
  std::vector<SphereInPicture> spheres;
  try {
    const json document = json::parse(file);
    for (const json& object : document.at("spheres")) {
      SphereInPicture sphere;
      sphere.character = object.at("person");
      sphere.joint = object.at("joint");
      sphere.load_class = ToClass(object.at("class"));
      const json& ratio = object.at("ratio");
      sphere.ratio =
          ratio.is_null() ? std::numeric_limits<double>::quiet_NaN() : ratio.get<double>();
      sphere.x_px = object.at("x");
      sphere.y_px = object.at("y");
      sphere.radius_px = object.at("radius");
      spheres.push_back(std::move(sphere));
    }
  } catch (const json::exception& error) {
    throw std::runtime_error(path.string() + ": " + error.what());
  }
  return spheres;
}

std::vector<std::string> FindObjectChanges(const std::vector<SphereInPicture>& expected,
                                           const std::vector<SphereInPicture>& actual) {
  std::vector<std::string> changes;
  const auto before = ByKey(expected);
  const auto now = ByKey(actual);
  for (const auto& [key, sphere] : before) {
    const auto match = now.find(key);
    if (match == now.end()) {
      changes.push_back(Who(key) + ": load sphere is missing");
    } else {
      Compare(key, *sphere, *match->second, changes);
    }
  }
  for (const auto& [key, sphere] : now) {
    if (before.count(key) == 0) {
      changes.push_back(fmt::format("{}: new load sphere, {}", Who(key), ClassText(*sphere)));
    }
  }
  return changes;
}

}  // namespace kinescope::app
