#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "urdf/skin/skin_template.h"

namespace kinescope::skin {
namespace {

constexpr char kMagic[4] = {'S', 'k', 'i', 'n'};

template <class T>
void Put(std::string& bytes, const T* values, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(values), sizeof(T) * count);
}

template <class T>
void Take(std::string_view& bytes, T* values, std::size_t count) {
  if (bytes.size() / sizeof(T) < count) throw std::runtime_error("the skin is truncated");
  std::memcpy(values, bytes.data(), sizeof(T) * count);
  bytes.remove_prefix(sizeof(T) * count);
}

}  // namespace

std::string ToBytes(const SkinTemplate& skin) {
  std::string bytes(kMagic, sizeof kMagic);
  const std::uint32_t counts[] = {static_cast<std::uint32_t>(skin.size()),
                                  static_cast<std::uint32_t>(skin.triangles.size())};
  Put(bytes, counts, 2);
  for (const auto& corner : skin.corners) {
    for (const Eigen::Vector3f& position : corner) {
      std::array<std::int16_t, 3> steps{};
      for (int axis = 0; axis < 3; ++axis) {
        steps[static_cast<std::size_t>(axis)] =
            static_cast<std::int16_t>(std::lround(position[axis] / kPositionStep));
      }
      Put(bytes, steps.data(), 3);
    }
  }
  Put(bytes, skin.weights.data(), skin.weights.size());
  Put(bytes, skin.triangles.data(), skin.triangles.size());
  return bytes;
}

SkinTemplate FromBytes(std::string_view bytes) {
  char magic[4];
  std::uint32_t counts[2];
  Take(bytes, magic, sizeof magic);
  if (!std::equal(magic, magic + sizeof magic, kMagic)) throw std::runtime_error("not a skin");
  Take(bytes, counts, 2);
  const std::size_t vertices = counts[0], triangles = counts[1];
  constexpr std::size_t kVertexBytes =
      SkinTemplate::kCorners * 3 * sizeof(std::int16_t) + sizeof(VertexWeights);
  if (bytes.size() != vertices * kVertexBytes + triangles * sizeof(Triangle)) {
    throw std::runtime_error("the skin has another size than it states");
  }
  SkinTemplate skin;
  std::vector<std::array<std::int16_t, 3>> steps(vertices);
  for (auto& corner : skin.corners) {
    Take(bytes, steps.data(), vertices);
    corner.reserve(vertices);
    for (const auto& step : steps) {
      corner.emplace_back(Eigen::Vector3f(step[0], step[1], step[2]) *
                          static_cast<float>(kPositionStep));
    }
  }
  skin.weights.resize(vertices);
  Take(bytes, skin.weights.data(), vertices);
  skin.triangles.resize(triangles);
  Take(bytes, skin.triangles.data(), triangles);
  return skin;
}

}  // namespace kinescope::skin
