#include "urdf/skin/skin_template.h"

#include <algorithm>

#include "urdf/skeleton.h"

// The file that urdf/skin/make writes.
// NOLINTNEXTLINE(hicpp-no-assembler): the data are read where the linker put them
asm(R"(
  .section .rodata
  .balign 16
  kinescope_skin_begin: .incbin ")" KINESCOPE_SKIN_FILE R"("
  kinescope_skin_end:
  .previous
)");
extern "C" {
extern const char kinescope_skin_begin[];
extern const char kinescope_skin_end[];
}

namespace kinescope::skin {

Build BuildOf(bool is_woman, double height, double mass) {
  if (!(height > 0)) return {is_woman ? 1.0 : 0.0, 0};
  const double reference = is_woman ? 62 / (1.62 * 1.62) : 75 / (1.75 * 1.75);  // kg/m^2
  const double index = mass / (height * height);
  const double more = (index - reference) * urdf::kReferenceHeight * urdf::kReferenceHeight;
  return {is_woman ? 1.0 : 0.0, std::clamp(more / kHeavyKilograms, -0.45, kHeaviest)};
}

std::vector<Eigen::Vector3f> SkinTemplate::Blend(const Build& build) const {
  if (corners[1].empty()) return corners[0];
  const auto woman = static_cast<float>(build.woman),
             heavy = static_cast<float>(build.heavy / kHeaviest);
  const std::array<float, kCorners> share = {(1 - woman) * (1 - heavy), woman * (1 - heavy),
                                             (1 - woman) * heavy, woman * heavy};
  std::vector<Eigen::Vector3f> positions(size(), Eigen::Vector3f::Zero());
  for (std::size_t corner = 0; corner < kCorners; ++corner) {
    for (std::size_t i = 0; i < size(); ++i) positions[i] += share[corner] * corners[corner][i];
  }
  return positions;
}

const SkinTemplate& BuiltInSkin() {
  static const SkinTemplate kSkin = FromBytes(std::string_view(
      kinescope_skin_begin, static_cast<std::size_t>(kinescope_skin_end - kinescope_skin_begin)));
  return kSkin;
}

}  // namespace kinescope::skin
