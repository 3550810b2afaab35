#include "render/vtk/ghost_actors.h"

#include <algorithm>

#include "core/palette.h"

namespace kinescope::render {
namespace {

Eigen::Vector4f TintOf(Theme theme) {
  const Rgb& color = theme == Theme::kDark ? kGhostOnDark : kGhostOnLight;
  return Eigen::Vector4d(color[0], color[1], color[2], kGhostShare).cast<float>();
}

}  // namespace

bool GhostActors::Update(const SceneLook& look, OnceLog& log, std::vector<Label>& labels) {
  const std::vector<Ghost>& ghosts = look.ghosts;
  const Eigen::Vector4f tint = TintOf(look.theme);
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

int GhostActors::IndexOf(const vtkActor* actor) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const auto actors = bodies_[i]->actors();
    const bool is_of = std::find(actors.begin(), actors.end(), actor) != actors.end();
    if (is_of) return static_cast<int>(i);
  }
  return -1;
}

void GhostActors::AddTo(PictureRegion& region) const {
  for (const auto& body : bodies_) body->AddTo(region);
}

}  // namespace kinescope::render
