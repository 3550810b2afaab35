#include "server/scene/model_factory.h"

#include <fmt/format.h>

#include <utility>

#include "server/body/body_color.h"
#include "server/body/model_name.h"
#include "server/scene/model_memory.h"

namespace kinescope::app {

ModelFactory::ModelFactory(ModelSettings settings)
    : settings_(std::move(settings)),
      appearance_hash_(settings_.mesh_cache ? HashOf(settings_.appearance) : 0) {}

void ModelFactory::NameMeshes(PersonModel& model) const {
  const BodyAppearance& appearance = settings_.appearance;
  const std::string name = MeshSetName(appearance_hash_, model.human);
  model.mesh_files = settings_.mesh_cache->Files(
      name, [appearance, human = model.human] { return AllMeshFiles(appearance, human); });
  const std::string folder = settings_.mesh_cache->FolderOf(name).string();
  if (appearance.is_smooth) model.human.mesh_folder = folder;
  if (!appearance.tools) return;
  model.human.tool_folder = folder;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    model.human.tools.set(side, (*appearance.tools)[side].has_value());
  }
}

std::string FindDefect(const PersonChange& change) {
  constexpr double kLeastHeight = 0.5, kMostHeight = 2.5;  // m, as --height
  if (change.height_m && !(*change.height_m >= kLeastHeight && *change.height_m <= kMostHeight)) {
    return fmt::format("stature of {} m; expected {} to {} m", *change.height_m, kLeastHeight,
                       kMostHeight);
  }
  if (!change.mass_kg) return "";
  urdf::BodyDescription body;
  body.mass_kg = *change.mass_kg;
  return urdf::FindDefect(body);
}

urdf::BodyDescription ModelFactory::BodyOf(const PersonChange& stated) const {
  urdf::BodyDescription body = settings_.body;
  if (stated.sex) {
    body.sex = *stated.sex;
    body.sex_is_assumed = false;
    if (body.mass_is_assumed) body.mass_kg = urdf::DefaultMass(body.sex);
  }
  if (stated.mass_kg) {
    body.mass_kg = *stated.mass_kg;
    body.mass_is_assumed = false;
  }
  return body;
}

std::string ModelFactory::NameOf(const PersonDescription& person) const {
  if (settings_.takes_names && IsModelName(person.character.name)) return person.character.name;
  const std::string& name = settings_.model_name;
  return person.index > 0 ? name + "_" + std::to_string(person.index) : name;
}

std::shared_ptr<const PersonModel> ModelFactory::Make(const PersonDescription& person,
                                                      std::uint64_t revision) const {
  auto model = std::make_shared<PersonModel>();
  model->index = person.index;
  model->revision = revision;
  model->description = BodyOf(person.stated);
  model->lengths_are_measured = person.character.skeleton.has_value();
  model->lengths_are_of_poses = person.lengths_are_of_poses;
  model->landmarks = person.character.landmarks;
  model->color_rgb = person.character.color_rgb;
  urdf::HumanModel& human = model->human;
  human.model_name = NameOf(person);
  human.skeleton = person.character.skeleton.value_or(
      urdf::DefaultSkeleton(person.stated.height_m.value_or(settings_.height_m)));
  if (person.l5_in_pelvis) human.skeleton.origin_in_parent[urdf::kL5] = *person.l5_in_pelvis;
  human.body = urdf::MakeBodyParameters(model->description, human.skeleton);
  const Rgb own = BodyColor(person.character.color_rgb, person.index);
  human.body_rgb = settings_.body_color.value_or(own);
  model->suit = SuitOf(own, settings_.body_color);
  person.worn.AddTo(person.character, human);
  model->has_built_in_surface = settings_.appearance.is_smooth && !settings_.appearance.custom;
  if (settings_.mesh_cache && settings_.appearance.has_meshes()) NameMeshes(*model);
  model->urdf_xml = urdf::WriteUrdf(human);
  model->robot = urdf::ParseUrdf(model->urdf_xml);
  return SharedModel(std::move(model));
}

}  // namespace kinescope::app
