/// Makes the model of a person (segment lengths, masses, URDF) from the options of the command and
/// from what the stream says about the person. Writes no files: a model names its mesh files, and
/// sinks whose readers are other programs have them written (core/mesh_files.h). Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/person_change.h"
#include "core/scene_state.h"
#include "server/body/body_meshes.h"
#include "server/body/gloves_and_props.h"
#include "server/body/mesh_cache.h"

namespace kinescope::app {

struct ModelSettings {
  std::string model_name = "skeleton";  // prefix of links and joints; further people get _1, _2 ...
  /// The name of a person that can be one is the prefix, in place of `model_name`: that of the TF
  /// frames which another node publishes.
  bool takes_names = false;
  urdf::BodyDescription body;
  double height_m = urdf::kDefaultHeight;  // of the default body, until the source sends segment
                                           // lengths, m
  bool height_is_assumed = true;           // the default value
  BodyAppearance appearance;
  std::optional<Rgb> body_color;  // of --body_color; none: BodyColor(), and a quiet suit
  /// Where the URDF says that meshes are. Null: the body consists of primitives, without tools, for
  /// commands that draw no person.
  std::shared_ptr<const MeshCache> mesh_cache;
};

/// What is known about one person.
struct PersonDescription {
  std::size_t index = 0;  // in the order of appearance
  Character character;
  bool lengths_are_of_poses = false;            // character.skeleton is measured, not sent
  std::optional<Eigen::Vector3d> l5_in_pelvis;  // m, link frame; overrides the scale data
  GlovesAndProps worn;
  PersonChange stated;  // by an operator; overrides the options
};

/// Why `change` is invalid, with the value and the expected range; "" if it is valid.
[[nodiscard]] std::string FindDefect(const PersonChange& change);

class ModelFactory {
 public:
  explicit ModelFactory(ModelSettings settings);

  /// The body of ModelSettings, as changed by `stated`. @post FindDefect() of it is "" if
  /// FindDefect(stated) is
  urdf::BodyDescription BodyOf(const PersonChange& stated) const;

  /// `revision`: one more than that of the person's model before, 1 for the first.
  std::shared_ptr<const PersonModel> Make(const PersonDescription& person,
                                          std::uint64_t revision) const;

 private:
  std::string NameOf(const PersonDescription& person) const;
  void NameMeshes(PersonModel& model) const;

  const ModelSettings settings_;
  const std::uint64_t appearance_hash_;
};

}  // namespace kinescope::app
