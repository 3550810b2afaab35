#include "render/vtk/gl_drawing.h"

#include <GL/glew.h>
#include <vtkCamera.h>
#include <vtkCullerCollection.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLRenderer.h>
#include <vtkOpenGLState.h>
#include <vtkRendererCollection.h>

#include <algorithm>
#include <array>
#include <glm/mat4x4.hpp>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "render/camera/camera_matrices.h"
#include "render/image/resample.h"
#include "render/shape/floor_scale.h"
#include "render/vtk/floor_cache.h"
#include "render/vtk/ghost_actors.h"
#include "render/vtk/gl_context.h"
#include "render/vtk/ground.h"
#include "render/vtk/log_window.h"
#include "render/vtk/marker_actors.h"
#include "render/vtk/object_actors.h"
#include "render/vtk/person_actors.h"
#include "render/vtk/robot_actors.h"
#include "render/vtk/trail_actor.h"
#include "render/vtk/unshown_window.h"

namespace kinescope::render {
namespace {

// px, drawn at once; larger pictures are put together from tiles. Bounds the memory that VTK
// and Mesa need for a picture, and keeps clear of the largest texture.
constexpr int kLargestTile = 4096;

constexpr int kBandBytes = 1 << 18;

// At the nearest that any of the person can be; 0: so near that it does not matter.
double MetresPerPixel(const PersonState& person, const Camera& camera, int height) {
  constexpr double kReach = 1;  // m, of the limbs from the pelvis
  const Eigen::Vector3d to_camera = (camera.position - camera.target).normalized();
  const Eigen::Vector3d nearest = person.links[urdf::kPelvis].position + kReach * to_camera;
  const Projected place = Project(nearest, camera, height, height);
  return place.depth_m > 0 && place.px_per_m > 0 ? 1 / place.px_per_m : 0;
}

std::mutex creation;  // GLEW's table of functions and VTK's factories are the process'

void TurnUpsideDown(std::uint8_t* rgba, int width, int height) {
  const std::size_t row = 4 * static_cast<std::size_t>(width);
  std::uint8_t* top = rgba;
  std::uint8_t* bottom = rgba + row * static_cast<std::size_t>(height - 1);
  for (; top < bottom; top += row, bottom -= row) std::swap_ranges(top, top + row, bottom);
}

class GlDrawing : public Drawing {
 public:
  GlDrawing(const std::string& backend, LogLine log) : log_(std::move(log)), once_(log_) {
    const VtkLogScope scope(log_);
    const std::lock_guard<std::mutex> lock(creation);
    context_ = MakeGlContext(backend);
    window_->SetMultiSamples(0);
    window_->SetOwnContext(0);
    window_->SetIsCurrent(true);
    window_->SetMapped(true);
    window_->SetSupportsOpenGL(true);
    window_->SetReadyForRendering(true);
    window_->SetFrameBlitModeToNoBlit();
    window_->SetSize(16, 16);
    camera_->UseExplicitProjectionTransformMatrixOn();
    camera_->SetExplicitProjectionTransformMatrix(projection_);
    window_->SetNumberOfLayers(2);
    for (vtkRenderer* layer : {floor_layer_.Get(), people_layer_.Get()}) {
      layer->SetActiveCamera(camera_);
      layer->GetCullers()->RemoveAllItems();  // all is in view; sorting would undo our order
      window_->AddRenderer(layer);
    }
    floor_layer_->SetBackgroundAlpha(1);
    people_layer_->SetLayer(1);
    window_->Render();  // of nothing: initialises GLEW, under the lock
    LogGlMessages(once_);
    can_invert_ = GLEW_MESA_pack_invert != 0;
    ground_ = std::make_unique<Ground>();
    markers_ = std::make_unique<MarkerActors>();
    trails_ = std::make_unique<TrailActor>();
    for (vtkActor* floor : ground_->actors()) floor_layer_->AddActor(floor);
    floor_cache_ = std::make_unique<FloorCache>(window_, floor_layer_, people_layer_);
  }

  ~GlDrawing() override {
    const VtkLogScope scope(log_);
    context_->MakeCurrent();
    floor_cache_.reset();
    floor_layer_->RemoveAllViewProps();
    people_layer_->RemoveAllViewProps();
    window_->Finalize();
  }

  Driver driver() const override {
    context_->MakeCurrent();
    const auto text = [](GLenum name) {
      const auto* found = reinterpret_cast<const char*>(glGetString(name));
      return std::string(found != nullptr ? found : "unknown");
    };
    return {text(GL_RENDERER), text(GL_VERSION)};
  }

  Eigen::AlignedBox3d Bounds(const RobotState& robot) override {
    const VtkLogScope scope(log_);
    context_->MakeCurrent();
    if (spare_ == nullptr) spare_ = std::make_unique<RobotActors>();
    std::vector<Label> ignored;
    spare_->Update(robot, SceneLook(), once_, ignored);
    return spare_->Measure(robot);
  }

  std::vector<std::string> problems() const override {
    std::vector<std::string> all;
    const auto add = [&](const std::vector<std::string>& some) {
      all.insert(all.end(), some.begin(), some.end());
    };
    for (const auto& [character, person] : people_) add(person->problems());
    for (const auto& robot : robots_) add(robot->problems());
    add(markers_->problems());
    return all;
  }

  void Draw(const SceneState& state, const Camera& camera, const SceneLook& look, int supersample,
            Image& image, DrawnScene& drawn) override {
    const VtkLogScope scope(log_);
    context_->MakeCurrent();
    UpdateLook(look, camera, drawn.labels);
    UpdateActors(state, camera, look, image.height * supersample, drawn.labels);
    AimCamera(camera);
    VisibleLines lines(look.style == Style::kLine ? Lines(camera) : std::vector<SpaceLine>(),
                       camera, image.width, image.height);
    const int step = kLargestTile / supersample;
    for (int y = 0; y < image.height; y += step) {
      for (int x = 0; x < image.width; x += step) {
        const Tile tile{x, y, std::min(step, image.width - x), std::min(step, image.height - y)};
        DrawTile(tile, camera, supersample, image);
        if (!lines.is_empty()) lines.Judge(tile, supersample, ReadDepth());
      }
    }
    drawn.lines = lines.Take();
  }

 private:
  void UpdateLook(const SceneLook& look, const Camera& camera, std::vector<Label>& labels) {
    const Rgb& background = BackgroundOf(look);
    floor_layer_->SetBackground(background[0], background[1], background[2]);
    ground_->SetFocus(camera.target);
    ground_->SetLook(look);
    floor_look_ = {background[0],
                   background[1],
                   background[2],
                   static_cast<double>(look.theme == Theme::kDark),
                   static_cast<double>(look.floor),
                   static_cast<double>(look.detail)};
    if (look.Shows(ScenePart::kScale) && look.floor) AddFloorScale(camera, labels);
  }

  // `height`: px, drawn.
  void UpdateActors(const SceneState& state, const Camera& camera, const SceneLook& look,
                    int height, std::vector<Label>& labels) {
    // By character: people who stay keep their meshes.
    bool is_changed = people_.size() != state.people.size();
    for (const PersonState& person : state.people) {
      auto& actors = people_[person.character];
      if (actors != nullptr) continue;
      actors = std::make_unique<PersonActors>();
      is_changed = true;
    }
    for (auto each = people_.begin(); each != people_.end();) {
      const bool is_here =
          std::any_of(state.people.begin(), state.people.end(),
                      [&](const auto& person) { return person.character == each->first; });
      is_changed = is_changed || !is_here;
      each = is_here ? std::next(each) : people_.erase(each);
    }
    is_changed = UpdateRobots(state, look, labels) || is_changed;
    is_changed = objects_.Update(state.objects, state.liveness, labels) || is_changed;
    markers_->Update(state.markers, once_, labels);
    trails_->Show(look.trails);
    is_changed = ghosts_.Update(look, once_, labels) || is_changed;
    for (const PersonState& person : state.people) {
      PersonActors& actors = *people_.at(person.character);
      is_changed = actors.Update(person, state.liveness, camera, look,
                                 MetresPerPixel(person, camera, height), once_, labels) ||
                   is_changed;
    }
    if (is_changed || !is_listed_) ListActors();
    is_listed_ = true;
  }

  // @return whether there are other actors than before.
  bool UpdateRobots(const SceneState& state, const SceneLook& look, std::vector<Label>& labels) {
    bool is_changed = robots_.size() != state.robots.size();
    if (robots_.size() > state.robots.size()) robots_.resize(state.robots.size());
    for (std::size_t i = 0; i < state.robots.size(); ++i) {
      const RobotState& robot = state.robots[i];
      if (i == robots_.size()) robots_.emplace_back();
      const bool is_measured = spare_ != nullptr && spare_->IsOf(robot);
      if (is_measured && (robots_[i] == nullptr || !robots_[i]->IsOf(robot))) {
        robots_[i] = std::move(spare_);
        is_changed = true;
      }
      if (robots_[i] == nullptr) robots_[i] = std::make_unique<RobotActors>();
      is_changed = robots_[i]->Update(robot, look, once_, labels) || is_changed;
    }
    return is_changed;
  }

  void ListActors() {
    people_layer_->RemoveAllViewProps();
    const auto add = [&](vtkActor* actor) { people_layer_->AddActor(actor); };
    for (const auto& [id, person] : people_) add(person->shadow());
    for (const auto& robot : robots_) add(robot->shadow());
    for (const auto& [id, person] : people_) {
      for (vtkActor* body : person->bodies()) add(body);
      add(person->held());
    }
    for (vtkActor* object : objects_.actors()) add(object);
    for (const auto& robot : robots_) {
      for (vtkActor* body : robot->bodies()) add(body);
    }
    add(markers_->solid());
    add(trails_->actor());
    for (const auto& [id, person] : people_) {
      for (vtkActor* ghost : person->ghosts()) add(ghost);
    }
    for (const auto& [id, person] : people_) {
      for (vtkActor* mark : person->marks()) add(mark);
    }
    add(markers_->blended());
    for (vtkActor* ghost : ghosts_.actors()) add(ghost);
  }

  std::vector<SpaceLine> Lines(const Camera& camera) const {
    std::vector<SpaceLine> lines;
    for (const auto& [character, person] : people_) person->AddLines(camera, lines);
    return lines;
  }

  void AimCamera(const Camera& camera) {
    // Rows of the view matrix are the camera's axes; ours never lacks an upward one.
    const glm::dmat4 view = ViewFromWorld(camera);
    camera_->SetPosition(camera.position.x(), camera.position.y(), camera.position.z());
    camera_->SetFocalPoint(camera.target.x(), camera.target.y(), camera.target.z());
    camera_->SetViewUp(view[0][1], view[1][1], view[2][1]);
    camera_->SetParallelProjection(camera.is_orthographic() ? 1 : 0);  // shaders of VTK ask
  }

  void DrawTile(const Tile& tile, const Camera& camera, int supersample, Image& image) {
    const double aspect = static_cast<double>(image.width) / image.height;
    const glm::dmat4 clip =
        TileFromClip(tile, image.width, image.height) * ClipFromView(camera, aspect);
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column)
        projection_->SetElement(row, column, clip[column][row]);
    }
    camera_->Modified();
    const int width = tile.width * supersample, height = tile.height * supersample;
    window_->SetSize(width, height);
    floor_cache_->Prepare(FloorKey(camera, width, height));
    window_->Render();
    const bool is_whole =
        supersample == 1 && tile.width == image.width && tile.height == image.height;
    if (is_whole) {
      ReadPixels(0, width, height, image.rgba.data());
      return;
    }
    // In bands that stay in the second-level cache until they are averaged, instead of 15 MB at
    // once (tests/bench/README.md).
    const int band = std::max(1, kBandBytes / (4 * width * supersample));  // rows of the picture
    large_.resize(4 * static_cast<std::size_t>(width) *
                  static_cast<std::size_t>(std::min(band, tile.height) * supersample));
    for (int y = 0; y < tile.height; y += band) {
      const int rows = std::min(band, tile.height - y);
      ReadPixels(height - (y + rows) * supersample, width, rows * supersample, large_.data());
      AverageInto(large_.data(), tile.width, rows, supersample, image, tile.x, tile.y + y);
    }
  }

  FloorCache::Key FloorKey(const Camera& camera, int width, int height) const {
    FloorCache::Key key{};
    const double* matrix = projection_->GetData();
    std::copy(matrix, matrix + 16, key.begin());
    const Eigen::Vector3d up = Eigen::Vector3d::Map(camera_->GetViewUp());
    const double rest[] = {camera.position.x(),
                           camera.position.y(),
                           camera.position.z(),
                           camera.target.x(),
                           camera.target.y(),
                           camera.target.z(),
                           up.x(),
                           up.y(),
                           up.z(),
                           static_cast<double>(width),
                           static_cast<double>(height)};
    static_assert(16 + std::size(rest) + std::tuple_size_v<decltype(floor_look_)> ==
                  std::tuple_size_v<FloorCache::Key>);
    const auto end = std::copy(std::begin(rest), std::end(rest), key.begin() + 16);
    std::copy(floor_look_.begin(), floor_look_.end(), end);
    return key;
  }

  // Straight from VTK's framebuffer into the picture: its own way copies twice, and GL's rows start
  // at the bottom, which Mesa turns round while it copies; with other drivers we do.
  // `bottom`: the first row, in GL's count.
  void ReadPixels(int bottom, int width, int height, std::uint8_t* rgba) {
    vtkOpenGLState* gl = window_->GetState();
    gl->PushReadFramebufferBinding();
    window_->GetRenderFramebuffer()->Bind(GL_READ_FRAMEBUFFER);
    window_->GetRenderFramebuffer()->ActivateReadBuffer(0);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    if (can_invert_) glPixelStorei(GL_PACK_INVERT_MESA, 1);
    glReadPixels(0, bottom, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    if (can_invert_) glPixelStorei(GL_PACK_INVERT_MESA, 0);
    gl->PopReadFramebufferBinding();
    const GLenum error = glGetError();
    if (error != GL_NO_ERROR) {
      throw RenderError("OpenGL error " + std::to_string(error) + " while drawing " +
                        std::to_string(width) + " x " + std::to_string(height) +
                        " px; try a smaller picture");
    }
    if (!can_invert_) TurnUpsideDown(rgba, width, height);
  }

  // Of the tile drawn last, from below.
  std::vector<float> ReadDepth() {
    const int* const size = window_->GetSize();
    std::vector<float> depth(static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]));
    vtkOpenGLState* gl = window_->GetState();
    gl->PushReadFramebufferBinding();
    window_->GetRenderFramebuffer()->Bind(GL_READ_FRAMEBUFFER);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, size[0], size[1], GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
    gl->PopReadFramebufferBinding();
    return depth;
  }

  LogLine log_;
  OnceLog once_;
  std::unique_ptr<GlContext> context_;  // outlives everything that follows
  vtkNew<UnshownWindow> window_;
  vtkNew<vtkOpenGLRenderer> floor_layer_;   // drawn first, without depth
  vtkNew<vtkOpenGLRenderer> people_layer_;  // over it
  vtkNew<vtkCamera> camera_;
  vtkNew<vtkMatrix4x4> projection_;
  std::unique_ptr<Ground> ground_;
  std::unique_ptr<FloorCache> floor_cache_;
  std::map<int, std::unique_ptr<PersonActors>> people_;
  ObjectActors objects_;
  std::unique_ptr<MarkerActors> markers_;
  std::unique_ptr<TrailActor> trails_;
  GhostActors ghosts_;
  std::array<double, 6> floor_look_{};  // what of it the floor's pixels depend on
  bool is_listed_ = false;
  std::vector<std::unique_ptr<RobotActors>> robots_;  // in the order of the state
  std::unique_ptr<RobotActors> spare_;                // measured, not drawn yet
  std::vector<std::uint8_t> large_;
  bool can_invert_ = false;  // MESA_pack_invert
};

}  // namespace

std::unique_ptr<Drawing> MakeGlDrawing(const std::string& backend, const LogLine& log) {
  return std::make_unique<GlDrawing>(backend, log);
}

}  // namespace kinescope::render
