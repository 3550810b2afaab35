#include "render/renderer.h"

#include <cstdio>
#include <cstdlib>
#include <thread>
#include <utility>
#include <vector>

#include "render/module.h"
#include "render/overlay.h"
#include "server/core/check.h"
#include "server/core/errors.h"

namespace kinescope::render {

struct Renderer::Owner {
  const std::thread::id thread = std::this_thread::get_id();
};

namespace {

constexpr int kSmallestSide = 16;
constexpr int kLargestSide = 8192;

void CheckView(const View& view) {
  const auto check_side = [](const char* name, int value) {
    if (value >= kSmallestSide && value <= kLargestSide) return;
    throw UsageError(std::string("a picture's ") + name + " is " + std::to_string(kSmallestSide) +
                     " to " + std::to_string(kLargestSide) + " px, not " + std::to_string(value));
  };
  check_side("width", view.width);
  check_side("height", view.height);
  if (view.supersample != 1 && view.supersample != 2 && view.supersample != 4) {
    throw UsageError("supersample is 1, 2 or 4, not " + std::to_string(view.supersample));
  }
}

// The scene and its camera raised so that the floor is at z = 0, where the drawing has it.
void LiftToFloor(SceneState& state, Camera& camera) {
  const Eigen::Vector3d lift(0, 0, -state.floor_z);
  camera.position += lift;
  camera.target += lift;
  for (PersonState& person : state.people) {
    for (urdf::Pose& link : person.links) link.position += lift;
    for (auto& glove : person.gloves) {
      if (!glove) continue;
      for (urdf::Pose& link : glove->links) link.position += lift;
    }
    for (auto& prop : person.props) {
      if (prop) prop->pose.position += lift;
    }
    for (JointLoad& load : person.loads) load.position += lift;
    if (person.com) *person.com += lift;
    if (person.cop) *person.cop += lift;
  }
  for (TrackedObject& object : state.objects) object.pose.position += lift;
  for (RobotState& robot : state.robots) {
    for (Eigen::Isometry3d& link : robot.world_from_link) link.pretranslate(lift);
  }
  state.floor_z = 0;
}

// Drawing by a module, overlays by us.
class ModuleRenderer : public Renderer {
 public:
  explicit ModuleRenderer(std::unique_ptr<Drawing> drawing) : drawing_(std::move(drawing)) {}

  std::string renderer_string() const override { return drawing_->renderer_string(); }
  Eigen::AlignedBox3d Bounds(const RobotState& robot) override { return drawing_->Bounds(robot); }
  std::vector<std::string> problems() const override { return drawing_->problems(); }

 private:
  void DoRender(Image& image, const SceneState& state, const Camera& camera,
                const View& view) override {
    if (state.floor_z != 0) {
      SceneState lifted = state;
      Camera lifted_camera = camera;
      LiftToFloor(lifted, lifted_camera);
      return DoRender(image, lifted, lifted_camera, view);
    }
    labels_.clear();
    drawing_->Draw(state, camera, view.supersample, image, labels_);
    if (view.overlays) overlay_.Paint(image, state, camera, view, labels_);
  }

  std::unique_ptr<Drawing> drawing_;
  Overlay overlay_;
  std::vector<Label> labels_;
};

void ToStderr(const std::string& line) { std::fprintf(stderr, "render: %s\n", line.c_str()); }

}  // namespace

Renderer::Renderer() : owner_(std::make_unique<const Owner>()) {}

Renderer::~Renderer() { KINESCOPE_CHECK(std::this_thread::get_id() == owner_->thread); }

Image Renderer::Render(const SceneState& state, const Camera& camera, const View& view) {
  Image image;
  RenderInto(image, state, camera, view);
  return image;
}

void Renderer::RenderInto(Image& image, const SceneState& state, const Camera& camera,
                          const View& view) {
  KINESCOPE_CHECK(std::this_thread::get_id() == owner_->thread);
  CheckView(view);
  image.width = view.width;
  image.height = view.height;
  image.rgba.resize(4 * static_cast<std::size_t>(view.width) *
                    static_cast<std::size_t>(view.height));
  DoRender(image, state, camera, view);
}

std::unique_ptr<Renderer> MakeRenderer(const std::string& backend, LogLine log) {
  if (backend != "osmesa") {
    throw RenderError("back-end '" + backend + "' is not known; there is: osmesa");
  }
  ::setenv("GALLIUM_OVERRIDE_CPU_CAPS", "sse4.1", 0);
  const auto* module =
      static_cast<const DrawingModule*>(LoadModule("libkinescope_render_osmesa.so", kDrawingEntry));
  return std::make_unique<ModuleRenderer>(module->make(log ? std::move(log) : LogLine(ToStderr)));
}

}  // namespace kinescope::render
