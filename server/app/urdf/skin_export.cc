#include "server/app/urdf/skin_export.h"

#include <cmath>
#include <optional>
#include <vector>

#include "core/skin_inputs.h"
#include "urdf/rig/skin_glb.h"
#include "urdf/skin/outfit.h"
#include "urdf/skin/person_skin.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::app {
namespace {

using Color = skin::SkinTemplate::Color;

Color ToBytes(const Rgb& color) {
  Color bytes = {0, 0, 0, 255};
  for (std::size_t i = 0; i < color.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(std::lround(255 * color[i]));
  }
  return bytes;
}

// As in pictures (render/vtk/skin_actor.cc): what lies on top comes first.
const Rgb& ColorAt(const skin::Borders& inside, const SuitColors& suit) {
  if (inside.bare > 0) return suit.bare;
  if (inside.shoes > 0) return suit.shoes;
  if (inside.trousers > 0) return suit.trousers;
  return inside.bands > 0 ? suit.band : suit.top;
}

std::string WriteGlb(const PersonModel& model, const rig::SkinGlbOptions& options) {
  const urdf::HumanModel& human = model.human;
  const skin::Build build = BuildOf(model);
  const skin::SkinTemplate& built_in = skin::BuiltInSkin();
  const std::vector<skin::Borders> borders = skin::OutfitOf(built_in, build);
  std::vector<Color> colors;
  colors.reserve(built_in.triangles.size());
  for (const skin::Triangle& triangle : built_in.triangles) {
    skin::Borders sum;
    for (const std::uint16_t corner : triangle) {
      const skin::Borders& at = borders[corner];
      sum.trousers += at.trousers;
      sum.bare += at.bare;
      sum.shoes += at.shoes;
      sum.bands += at.bands;
    }
    colors.push_back(ToBytes(ColorAt(sum, model.suit)));
  }
  return rig::WriteSkinGlb(skin::PersonSkin(built_in, build, human.skeleton, GlovesOf(human)),
                           built_in, colors, options);
}

}  // namespace

std::string SkinGlbOf(const PersonModel& model, bool has_skeleton) {
  return WriteGlb(model, {std::nullopt, has_skeleton});
}

std::string PosedSkinGlbOf(const PersonState& person, bool has_skeleton) {
  const rig::SkinPosture posture{person.links, FingersOf(person)};
  return WriteGlb(*person.model, {posture, has_skeleton});
}

}  // namespace kinescope::app
