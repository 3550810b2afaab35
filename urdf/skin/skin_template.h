/// The skin of all people: a surface in the bind pose of a person of kReferenceHeight, and the
/// frames that carry each vertex. The built-in one is made when the program is built
/// (urdf/skin/make): closed, and for four builds. One of the user's own (urdf/rig) has colours.
/// Plain data and pure functions, any thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinescope::skin {

/// A kind of person. 0, 0: a man of 75 kg with a stature of 1.75 m; 1, 0: a woman of that stature
/// and 72.4 kg (62 kg at 1.62 m).
struct Build {
  double woman = 0;  // 0..1
  double heavy = 0;  // 1: with kHeavyKilograms more; negative: lighter
};
inline constexpr double kHeavyKilograms = 30;
inline constexpr double kHeaviest = 1.6;

/// Of a person of this stature, m, and mass, kg. Equal body mass indices give equal builds; within
/// what still looks like a person, -0.45 to kHeaviest. An unknown stature (0) gives the average
/// build.
Build BuildOf(bool is_woman, double height, double mass);

inline constexpr std::size_t kInfluences = 4;

struct VertexWeights {
  std::array<std::uint8_t, kInfluences> frames{};   // of Frames()
  std::array<std::uint8_t, kInfluences> weights{};  // descending; their sum is 255
};

using Triangle = std::array<std::uint16_t, 3>;  // counter-clockwise from outside

struct SkinTemplate {
  static constexpr std::size_t kCorners = 4;  // man, woman, heaviest man, heaviest woman
  /// Positions, m. Of a skin that is the same for all builds, only the first.
  std::array<std::vector<Eigen::Vector3f>, kCorners> corners;
  std::vector<VertexWeights> weights;
  std::vector<Triangle> triangles;
  using Color = std::array<std::uint8_t, 4>;  // sRGB and 255
  std::vector<Color> colors;                  // of each vertex; empty: it wears a suit (outfit.h)
  bool is_two_sided = false;                  // triangles are also seen from behind

  std::size_t size() const { return weights.size(); }
  /// Positions of a person of `build`, m.
  std::vector<Eigen::Vector3f> Blend(const Build& build) const;
};

/// The one that is part of the program.
const SkinTemplate& BuiltInSkin();

/// Little-endian: magic, counts, positions in steps of kPositionStep, weights, triangles.
std::string ToBytes(const SkinTemplate& skin);
SkinTemplate FromBytes(std::string_view bytes);
inline constexpr double kPositionStep = 1.0 / 16384;  // m

}  // namespace kinescope::skin
