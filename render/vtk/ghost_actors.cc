#include "render/vtk/ghost_actors.h"

namespace kinescope::render {
namespace {

// Cool, apart from the floor, and no colour of a person or a class.
const Eigen::Vector4f kTintOnLight = {0.35f, 0.45f, 0.62f, 0.75f};
const Eigen::Vector4f kTintOnDark = {0.60f, 0.72f, 0.92f, 0.75f};

}  // namespace

bool GhostActors::Update(const SceneLook& look, OnceLog& log, std::vector<Label>& labels) {
  const std::vector<Ghost>& ghosts = look.ghosts;
  const Eigen::Vector4f& tint = look.theme == Theme::kDark ? kTintOnDark : kTintOnLight;
  bool is_changed = bodies_.size() != ghosts.size();
  bodies_.resize(ghosts.size());
  for (std::size_t i = 0; i < ghosts.size(); ++i) {
    if (bodies_[i] == nullptr) bodies_[i] = std::make_unique<BodyActor>(Pass::kVeil);
    bodies_[i]->SetOpacity(ghosts[i].opacity);
    is_changed =
        bodies_[i]->Update(ghosts[i].person, {look.figure}, tint, {}, log, labels) || is_changed;
  }
  return is_changed;
}

std::vector<vtkActor*> GhostActors::actors() {
  std::vector<vtkActor*> actors;
  for (const auto& body : bodies_) {
    for (vtkActor* actor : body->actors()) actors.push_back(actor);
  }
  return actors;
}

void GhostActors::AddTo(PictureRegion& region) const {
  for (const auto& body : bodies_) body->AddTo(region);
}

}  // namespace kinescope::render
