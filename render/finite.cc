#include "render/finite.h"

#include <algorithm>

namespace kinescope::render {
namespace {

constexpr double kFurthest = 1e6;  // m; beyond, single precision has no millimetres for long

bool IsFinite(const Eigen::Vector3d& point) {
  return point.allFinite() && point.cwiseAbs().maxCoeff() < kFurthest;
}

bool IsFinite(const urdf::Pose& pose) {
  return IsFinite(pose.position) && pose.orientation.coeffs().allFinite();
}

template <class Poses>
bool AreFinite(const Poses& poses) {
  return std::all_of(poses.begin(), poses.end(), [](const auto& pose) { return IsFinite(pose); });
}

bool IsFinite(const PersonState& person) {
  if (!AreFinite(person.links)) return false;
  for (const auto& glove : person.gloves) {
    if (glove && !AreFinite(glove->links)) return false;
  }
  for (const auto& prop : person.props) {
    if (prop && !IsFinite(prop->pose)) return false;
  }
  return true;
}

bool HasFiniteMarks(const PersonState& person) {
  return (!person.com || IsFinite(*person.com)) && (!person.cop || IsFinite(*person.cop)) &&
         std::all_of(person.loads.begin(), person.loads.end(),
                     [](const JointLoad& load) { return IsFinite(load.position); });
}

std::string NameOf(const PersonState& person) {
  return "person " + std::to_string(person.character) +
         (person.name.empty() ? "" : " ('" + person.name + "')");
}

void DropMarks(PersonState& person, std::vector<std::string>& problems) {
  const std::size_t before = person.loads.size();
  person.loads.erase(std::remove_if(person.loads.begin(), person.loads.end(),
                                    [](const auto& load) { return !IsFinite(load.position); }),
                     person.loads.end());
  if (person.loads.size() < before) {
    problems.push_back(NameOf(person) + ": " + std::to_string(before - person.loads.size()) +
                       " load spheres are not drawn: their position is not finite");
  }
  const auto drop = [&](auto& mark, const char* name) {
    if (!mark || IsFinite(*mark)) return;
    mark.reset();
    problems.push_back(NameOf(person) + ": the " + name +
                       " is not drawn: its position is not finite");
  };
  drop(person.com, "centre of mass");
  drop(person.cop, "centre of pressure");
}

}  // namespace

std::optional<SceneState> WithoutNonFinite(const SceneState& state,
                                           std::vector<std::string>& problems) {
  const bool is_fine =
      std::all_of(state.people.begin(), state.people.end(),
                  [](const auto& person) { return IsFinite(person) && HasFiniteMarks(person); }) &&
      std::all_of(state.objects.begin(), state.objects.end(),
                  [](const auto& object) { return IsFinite(object.pose); });
  if (is_fine) return std::nullopt;
  SceneState drawable = state;
  drawable.people.clear();
  for (const PersonState& person : state.people) {
    if (!IsFinite(person)) {
      problems.push_back(NameOf(person) + " is not drawn: a pose is not finite");
      continue;
    }
    drawable.people.push_back(person);
    DropMarks(drawable.people.back(), problems);
  }
  drawable.objects.clear();
  for (const TrackedObject& object : state.objects) {
    if (IsFinite(object.pose)) {
      drawable.objects.push_back(object);
    } else {
      problems.push_back("object '" + object.name + "' is not drawn: its pose is not finite");
    }
  }
  return drawable;
}

}  // namespace kinescope::render
