#include "server/app/golden/golden_compare.h"

#include <fmt/format.h>

#include "render/image/compare.h"
#include "render/image/png_file.h"

namespace kinescope::app {

PictureVerdict ComparePictures(const std::filesystem::path& one, const std::filesystem::path& other,
                               const std::filesystem::path& out) {
  const render::Image before = render::ReadPng(one), after = render::ReadPng(other);
  const render::Comparison comparison = render::Compare(before, after);
  PictureVerdict verdict;
  verdict.is_same = comparison.equal();
  verdict.is_byte_equal = comparison.same_size && comparison.largest_difference == 0;
  verdict.text = verdict.is_byte_equal  ? "the same pixels"
                 : comparison.same_size ? render::Describe(comparison, after)
                                        : fmt::format("sizes differ: {}x{} and {}x{}", before.width,
                                                      before.height, after.width, after.height);
  if (!verdict.is_same && !out.empty()) render::WritePng(out, render::DiffImage(before, after));
  return verdict;
}

}  // namespace kinescope::app
