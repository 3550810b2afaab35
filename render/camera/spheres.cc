#include "render/camera/spheres.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/palette.h"

namespace kinescope::render {
namespace {

// Of the sphere's radius: inside the dark rim of the high class.
constexpr double kSampledShare = 0.65;

// Of the sampled pixels, that must be left when nearer spheres are taken away.
constexpr double kReadableShare = 0.3;

// Grey spheres and the body stay below this spread between largest and smallest channel (levels); a
// coloured sphere that shines through the body keeps twice as much.
constexpr int kGreySpread = 34;

// nullopt: no colour of a load (CoM, CoP).
std::optional<LoadClass> ClassOfColor(const std::uint8_t* rgb) {
  const int red = rgb[0], green = rgb[1], blue = rgb[2];
  const int high = std::max({red, green, blue});
  const int low = std::min({red, green, blue});
  if (high - low < kGreySpread) return LoadClass::kUnknown;
  if (high == green && green - red > (high - low) / 3) return LoadClass::kLow;
  if (high == blue || blue - green > (high - low) / 3) return std::nullopt;
  // Between red and yellow: share of the way that green has come from the lowest channel.
  const double toward_yellow = static_cast<double>(green - low) / (high - low);
  return toward_yellow < 0.27 ? LoadClass::kHigh : LoadClass::kMedium;
}

bool IsCovered(double x, double y, const SphereInPicture& sphere,
               const std::vector<SphereInPicture>& all) {
  return std::any_of(all.begin(), all.end(), [&](const SphereInPicture& other) {
    if (other.depth_m <= 0 || other.depth_m >= sphere.depth_m) return false;
    return std::hypot(x - other.x_px, y - other.y_px) < other.radius_px + 1;
  });
}

}  // namespace

std::vector<SphereInPicture> LocateSpheres(const SceneState& state, const Camera& camera,
                                           int width_px, int height_px) {
  std::vector<SphereInPicture> spheres;
  for (const PersonState& person : state.people) {
    for (const JointLoad& load : person.loads) {
      const Projected center = Project(load.position, camera, width_px, height_px);
      SphereInPicture sphere;
      sphere.character = person.character;
      sphere.joint = std::string(urdf::kJoints[static_cast<std::size_t>(load.joint)].ros_name);
      sphere.load_class = load.load_class;
      sphere.ratio = load.shown_ratio;
      sphere.x_px = center.x_px;
      sphere.y_px = center.y_px;
      sphere.depth_m = center.depth_m;
      sphere.radius_px = SphereRadius(load.joint, load.load_class, *person.model) * center.px_per_m;
      spheres.push_back(std::move(sphere));
    }
  }
  return spheres;
}

const char* ColorName(LoadClass load_class) {
  switch (load_class) {
    case LoadClass::kLow: return "green";
    case LoadClass::kMedium: return "orange";
    case LoadClass::kHigh: return "red";
    case LoadClass::kUnknown: break;
  }
  return "grey";
}

Reading ReadSphere(const Image& image, const std::vector<SphereInPicture>& spheres,
                   std::size_t index) {
  const SphereInPicture& sphere = spheres.at(index);
  const double radius = kSampledShare * sphere.radius_px;
  Reading reading;
  if (!(sphere.depth_m > 0 && radius >= 1)) return reading;
  // Far outside, coordinates outgrow what a pixel index can hold.
  if (!(std::abs(sphere.x_px) < 1e5 && std::abs(sphere.y_px) < 1e5)) return reading;
  const auto first = [](double edge) { return std::max(0, static_cast<int>(std::floor(edge))); };
  const auto last = [](double edge, int size) {
    return static_cast<int>(std::min(std::ceil(edge), static_cast<double>(size - 1)));
  };
  std::array<int, 4> votes{};
  int read = 0;
  for (int y = first(sphere.y_px - radius); y <= last(sphere.y_px + radius, image.height); ++y) {
    for (int x = first(sphere.x_px - radius); x <= last(sphere.x_px + radius, image.width); ++x) {
      const double center_x = x + 0.5, center_y = y + 0.5;
      if (std::hypot(center_x - sphere.x_px, center_y - sphere.y_px) > radius) continue;
      if (IsCovered(center_x, center_y, sphere, spheres)) continue;
      const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(x);
      const std::optional<LoadClass> seen = ClassOfColor(&image.rgba[4 * pixel]);
      if (!seen) continue;
      ++votes[static_cast<std::size_t>(*seen)];
      ++read;
    }
  }
  reading.is_readable = read >= 3 && read >= kReadableShare * M_PI * radius * radius;
  const auto most = std::max_element(votes.begin(), votes.end());
  if (reading.is_readable && *most * 2 > read) {
    reading.shown = static_cast<LoadClass>(most - votes.begin());
  }
  return reading;
}

std::vector<std::string> FindSphereMismatches(const Image& image,
                                              const std::vector<SphereInPicture>& spheres) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Reading reading = ReadSphere(image, spheres, i);
    if (!reading.is_readable || reading.shown == spheres[i].load_class) continue;
    lines.push_back(spheres[i].joint + " shows " +
                    (reading.shown ? ColorName(*reading.shown) : "no clear colour") +
                    ", expected " + ColorName(spheres[i].load_class));
  }
  return lines;
}

}  // namespace kinescope::render
