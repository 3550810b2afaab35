#include "server/app/golden/golden_compare.h"

#include <fmt/format.h>

#include <future>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "render/image/heat_map.h"
#include "render/image/png_file.h"

namespace kinescope::app {
namespace {

using nlohmann::json;
using render::PictureDifference;

constexpr std::size_t kClustersTold = 16;

std::string HeadlineOf(const PictureDifference& difference) {
  if (difference.is_byte_equal) return "the same pixels";
  std::string failed;
  for (const render::LayerVerdict& layer : render::JudgeLayers(difference)) {
    if (!layer.passes) failed += (failed.empty() ? "" : ", ") + layer.layer;
  }
  if (!failed.empty()) return "DIFFERS: " + failed;
  if (difference.pixels.largest_distance == 0) {
    return "the same to the eye: differs only where it is transparent";
  }
  const int levels = difference.levels.largest_difference;
  return fmt::format("the same to the eye: largest difference {} level{}", levels,
                     levels == 1 ? "" : "s");
}

json BoxOf(const render::Tile& box) {
  return {{"x", box.x}, {"y", box.y}, {"width", box.width}, {"height", box.height}};
}

json SizeOf(int width, int height) { return {{"width", width}, {"height", height}}; }

json PixelsOf(const PictureDifference& difference) {
  json clusters = json::array();
  for (const render::Cluster& cluster : difference.pixels.clusters) {
    if (clusters.size() == kClustersTold) break;
    json entry = BoxOf(cluster.box);
    entry["pixels"] = cluster.pixels;
    clusters.push_back(std::move(entry));
  }
  return {{"changed", difference.pixels.changed},
          {"on_edges", difference.pixels.on_edges},
          {"limit", difference.limits.changed_pixels},
          {"largest_distance", difference.pixels.largest_distance},
          {"distance_limit", difference.limits.color_distance},
          {"clusters", std::move(clusters)}};
}

json StructureOf(const PictureDifference& difference) {
  const render::Structure& structure = difference.structure;
  return {{"mean", structure.mean},
          {"worst", structure.worst},
          {"limit", difference.limits.structure},
          {"worst_block",
           render::IsEmpty(structure.worst_block) ? json(nullptr) : BoxOf(structure.worst_block)}};
}

json LightOf(const PictureDifference& difference) {
  json light = {{"limit", difference.limits.light}, {"worst", nullptr}};
  if (!difference.light.is_known) return light;
  const render::ToneLight& worst = difference.light.worst;
  light["worst"] = {{"least_luma", worst.least_luma},
                    {"most_luma", worst.most_luma},
                    {"red", worst.difference[0]},
                    {"green", worst.difference[1]},
                    {"blue", worst.difference[2]}};
  return light;
}

bool IsInvisible(const render::Image& image) {
  for (std::size_t alpha = 3; alpha < image.rgba.size(); alpha += 4) {
    if (image.rgba[alpha] != 0) return false;
  }
  return true;
}

}  // namespace

PictureVerdict ComparePictures(const std::filesystem::path& one, const std::filesystem::path& other,
                               const std::filesystem::path& heat_map) {
  // Reading takes most of the time, so each picture has a thread.
  std::future<render::Image> read = std::async(std::launch::async, render::ReadPng, other);
  const render::Image before = render::ReadPng(one), after = read.get();
  PictureVerdict verdict;
  verdict.difference = render::FindDifference(before, after);
  if (!verdict.difference.is_byte_equal && IsInvisible(before) && IsInvisible(after)) {
    throw std::runtime_error(
        fmt::format("'{}' and '{}' are wholly transparent, so there is nothing to compare",
                    one.string(), other.string()));
  }
  verdict.is_same = render::IsSameToTheEye(verdict.difference);
  verdict.headline = HeadlineOf(verdict.difference);
  if (!verdict.is_same && !heat_map.empty()) {
    render::WritePng(heat_map, render::HeatMap(before, verdict.difference));
  }
  return verdict;
}

std::vector<std::string> LinesOf(const PictureVerdict& verdict) {
  std::vector<std::string> lines = {verdict.headline};
  if (verdict.difference.is_byte_equal) return lines;
  for (const render::LayerVerdict& layer : render::JudgeLayers(verdict.difference)) {
    lines.push_back(fmt::format("  {:<10} {:<7}  {}", layer.layer,
                                layer.passes ? "same" : "DIFFERS", layer.text));
  }
  return lines;
}

json NumbersOf(const std::string& layer, const PictureDifference& difference) {
  if (layer == "structure") return StructureOf(difference);
  return layer == "light" ? LightOf(difference) : PixelsOf(difference);
}

json ToJson(const PictureVerdict& verdict) {
  const PictureDifference& difference = verdict.difference;
  json result = {{"same", verdict.is_same},
                 {"byte_equal", difference.is_byte_equal},
                 {"text", verdict.headline},
                 {"expected_size", SizeOf(difference.expected_width, difference.expected_height)},
                 {"actual_size", SizeOf(difference.actual_width, difference.actual_height)}};
  if (!difference.is_same_size) return result;
  result["largest_difference_levels"] = difference.levels.largest_difference;
  result["pixels"] = PixelsOf(difference);
  result["structure"] = StructureOf(difference);
  result["light"] = LightOf(difference);
  return result;
}

}  // namespace kinescope::app
