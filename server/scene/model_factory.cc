#include "server/scene/model_factory.h"

#include "server/body/body_color.h"
#include "server/body/body_meshes.h"

namespace kinescope::app {

std::shared_ptr<const PersonModel> ModelFactory::Make(const PersonDescription& person,
                                                      std::uint64_t revision) const {
  auto model = std::make_shared<PersonModel>();
  model->revision = revision;
  model->description = settings_.body;
  model->lengths_are_measured = person.character.skeleton.has_value();
  urdf::HumanModel& human = model->human;
  human.model_name = settings_.model_name;
  if (person.index > 0) human.model_name += "_" + std::to_string(person.index);
  human.skeleton = person.character.skeleton.value_or(urdf::DefaultSkeleton(settings_.height_m));
  if (person.l5_in_pelvis) human.skeleton.origin_in_parent[urdf::kL5] = *person.l5_in_pelvis;
  human.body = urdf::MakeBodyParameters(settings_.body, human.skeleton);
  human.body_rgb = BodyColor(person.character.color_rgb, person.index);
  person.worn.AddTo(person.character, human);
  if (settings_.smooth_figure) {
    human.mesh_folder = WriteToCache(BodyMeshFiles(human, settings_.figure_meshes.get()));
  }
  if (settings_.tools) {
    human.tool_folder = WriteToCache(ToolMeshFiles(*settings_.tools, human.skeleton));
    for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
      human.tools.set(side, (*settings_.tools)[side] && !human.tool_folder.empty());
    }
  }
  model->urdf_xml = urdf::WriteUrdf(human);
  model->robot = urdf::ParseUrdf(model->urdf_xml);
  return model;
}

}  // namespace kinescope::app
