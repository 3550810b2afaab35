#include "server/scene/model_memory.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <utility>

namespace kinescope::app {
namespace {

constexpr std::size_t kMost = 8;  // people of one recording, and some more

bool AreEqual(const urdf::AddedMass& a, const urdf::AddedMass& b) {
  return a.segment == b.segment && a.mass_kg == b.mass_kg &&
         a.position_in_link == b.position_in_link;
}

// Skeleton and description decide the inertias.
bool AreEqual(const urdf::BodyDescription& a, const urdf::BodyDescription& b) {
  return a.sex == b.sex && a.mass_kg == b.mass_kg && a.mass_is_assumed == b.mass_is_assumed &&
         a.table == b.table && a.sex_is_assumed == b.sex_is_assumed &&
         std::equal(a.added_masses.begin(), a.added_masses.end(), b.added_masses.begin(),
                    b.added_masses.end(),
                    [](const auto& of_a, const auto& of_b) { return AreEqual(of_a, of_b); });
}

bool AreEqual(const SuitColors& a, const SuitColors& b) {
  return a.top == b.top && a.trousers == b.trousers && a.shoes == b.shoes && a.bare == b.bare &&
         a.band == b.band;
}

// The URDF names the folder of the meshes, which has a hash of their content in its name.
bool AreEqual(const PersonModel& a, const PersonModel& b) {
  return a.urdf_xml == b.urdf_xml && a.human.skeleton == b.human.skeleton &&
         AreEqual(a.description, b.description) && AreEqual(a.suit, b.suit) &&
         a.lengths_are_measured == b.lengths_are_measured &&
         a.lengths_are_of_poses == b.lengths_are_of_poses && a.landmarks == b.landmarks &&
         a.color_rgb == b.color_rgb && a.revision == b.revision &&
         a.has_built_in_surface == b.has_built_in_surface &&
         (a.mesh_files == nullptr) == (b.mesh_files == nullptr);
}

bool HasGloves(const PersonModel& model) {
  return std::any_of(model.human.gloves.begin(), model.human.gloves.end(),
                     [](const auto& glove) { return glove.has_value(); });
}

}  // namespace

std::shared_ptr<const PersonModel> SharedModel(std::shared_ptr<const PersonModel> model) {
  static std::mutex mutex;
  static std::deque<std::weak_ptr<const PersonModel>> newest;  // guarded by mutex
  if (HasGloves(*model)) return model;
  const std::lock_guard lock(mutex);
  for (const auto& each : newest) {
    auto known = each.lock();
    if (known && AreEqual(*known, *model)) return known;
  }
  newest.push_back(model);
  if (newest.size() > kMost) newest.pop_front();
  return model;
}

}  // namespace kinescope::app
