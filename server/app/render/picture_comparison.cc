#include "server/app/render/picture_comparison.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <utility>

#include "render/image/compare.h"
#include "render/image/png_file.h"
#include "server/app/render/output_plan.h"

namespace kinescope::app {

PictureReader::PictureReader(std::string path) : path_(std::move(path)) {
  if (render::ClipFormatOf(path_)) video_ = render::OpenVideo(path_);
}

bool PictureReader::Next(render::Image& image) {
  if (video_ != nullptr) return video_->Next(image);
  const std::string path = PathOfPicture(path_, next_);
  const bool is_single = path == path_;
  if ((is_single && next_ > 0) || !std::filesystem::exists(path)) return false;
  image = render::ReadPng(path);
  ++next_;
  return true;
}

Verdict ComparePictures(const std::string& then, const std::string& now, const Tolerance& tolerance,
                        std::optional<long> count) {
  Verdict verdict;
  PictureReader expected(then), actual(now);
  render::Image a, b;
  for (long k = 0; !count || k < *count; ++k) {
    const bool has_a = expected.Next(a), has_b = actual.Next(b);
    if (!has_a && !has_b) break;
    verdict.picture = k;
    if (has_a != has_b) {
      verdict.same = false;
      verdict.how = has_a ? fmt::format("it has more than {} pictures", k)
                          : fmt::format("it has only {} pictures", k);
      return verdict;
    }
    const render::Comparison comparison = render::Compare(a, b, tolerance.levels);
    const auto most = static_cast<std::int64_t>(tolerance.pixels_share * b.width * b.height);
    if (comparison.same_size && comparison.pixels <= most) continue;
    verdict.same = false;
    verdict.how = render::Describe(comparison, b);
    verdict.diff = render::DiffImage(a, b, tolerance.levels);
    return verdict;
  }
  return verdict;
}

}  // namespace kinescope::app
