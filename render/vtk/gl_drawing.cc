#include "render/vtk/gl_drawing.h"

#include <GL/glew.h>
#include <vtkCamera.h>
#include <vtkCullerCollection.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkOpenGLRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkVersion.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/mat4x4.hpp>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "core/system/check.h"
#include "render/camera/camera_matrices.h"
#include "render/camera/picture_region.h"
#include "render/shape/floor_scale.h"
#include "render/vtk/floor_cache.h"
#include "render/vtk/ghost_actors.h"
#include "render/vtk/gl_context.h"
#include "render/vtk/ground.h"
#include "render/vtk/log_window.h"
#include "render/vtk/marker_actors.h"
#include "render/vtk/number_shader.h"
#include "render/vtk/object_actors.h"
#include "render/vtk/person_actors.h"
#include "render/vtk/pixel_reader.h"
#include "render/vtk/robot_actors.h"
#include "render/vtk/tile_window.h"
#include "render/vtk/trail_actor.h"
#include "render/vtk/unshown_window.h"

namespace kinescope::render {
namespace {

// px, drawn at once; larger pictures are put together from tiles. Bounds the memory that VTK
// and Mesa need for a picture, and keeps clear of the largest texture.
constexpr int kLargestTile = 4096;

// At the nearest that any of the person can be; 0: so near that it does not matter.
double MetresPerPixel(const PersonState& person, const Camera& camera, int height) {
  constexpr double kReach = 1;  // m, of the limbs from the pelvis
  const Eigen::Vector3d to_camera = (camera.position - camera.target).normalized();
  const Eigen::Vector3d nearest = person.links[urdf::kPelvis].position + kReach * to_camera;
  const Projected place = Project(nearest, camera, height, height);
  return place.depth_m > 0 && place.px_per_m > 0 ? 1 / place.px_per_m : 0;
}

std::mutex creation;  // GLEW's table of functions and VTK's factories are the process'

std::string GlText(GLenum name) {
  const auto* found = reinterpret_cast<const char*>(glGetString(name));
  return found != nullptr ? found : "unknown";
}

struct ListedActor {
  vtkActor* actor;
  int character;  // of the person; -1: it belongs to none
};

// A thing of the picture.
struct Named {
  std::string name;
  int character;
};

// Sums up the places; Seen() divides them.
void AddPixel(int x, int y, bool is_through, SeenObject& object) {
  ++(is_through ? object.through : object.pixels);
  object.x_px += x + 0.5;
  object.y_px += y + 0.5;
  Tile& box = object.box;
  if (IsEmpty(box)) {
    box = {x, y, 1, 1};
    return;
  }
  const int right = std::max(box.x + box.width, x + 1), left = std::min(box.x, x);
  box = {left, box.y, right - left, y + 1 - box.y};
}

class GlDrawing : public Drawing {
 public:
  GlDrawing(const std::string& backend, LogLine log, const RegionSettings& regions)
      : regions_(regions), log_(std::move(log)), once_(log_) {
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
    is_software_ = IsSoftware(GlText(GL_RENDERER));
    pixels_ = std::make_unique<PixelReader>(window_);
    ground_ = std::make_unique<Ground>();
    markers_ = std::make_unique<MarkerActors>();
    trails_ = std::make_unique<TrailActor>();
    for (vtkActor* floor : ground_->actors()) floor_layer_->AddActor(floor);
    tiles_ = std::make_unique<TileWindow>(window_, floor_layer_, people_layer_);
  }

  ~GlDrawing() override {
    const VtkLogScope scope(log_);
    context_->MakeCurrent();
    tiles_.reset();
    floor_layer_->RemoveAllViewProps();
    people_layer_->RemoveAllViewProps();
    window_->Finalize();
  }

  Driver driver() const override {
    context_->MakeCurrent();
    return {GlText(GL_RENDERER), GlText(GL_VERSION),
            std::string("VTK ") + vtkVersion::GetVTKVersion()};
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
    const std::vector<Tile> parts =
        lines.is_empty() ? Parts(camera, image) : std::vector<Tile>{WholeOf(image)};
    DrawTiles(parts, camera, supersample, image, [&](const Tile& tile) {
      if (lines.is_empty()) return;
      lines.Judge(tile, supersample,
                  pixels_->ReadDepth(tile.width * supersample, tile.height * supersample));
    });
    CheckParts(parts, camera, supersample, image);
    drawn.lines = lines.Take();
  }

  std::vector<SeenObject> See(const SceneState& state, const Camera& camera, const SceneLook& look,
                              int supersample, int width, int height) override {
    const VtkLogScope scope(log_);
    context_->MakeCurrent();
    std::vector<Label> ignored;
    UpdateActors(state, camera, look, height * supersample, ignored);
    AimCamera(camera);
    Image numbers;
    SetSize(numbers, width, height);
    const std::vector<Named> named = DrawNumbers(camera, numbers);
    return Seen(numbers, named);
  }

 private:
  void UpdateLook(const SceneLook& look, const Camera& camera, std::vector<Label>& labels) {
    const Rgb& background = BackgroundOf(look);
    floor_layer_->SetBackground(background[0], background[1], background[2]);
    ground_->SetFocus(camera.target);
    ground_->SetLook(look);
    shadow_color_ = ColorsOf(look.theme).shadow;
    floor_look_ = {background[0], background[1], background[2],
                   static_cast<double>(look.theme == Theme::kDark),
                   static_cast<double>(look.floor)};
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

  // In the order of rendering.
  std::vector<ListedActor> Actors() {
    std::vector<ListedActor> all;
    const auto add = [&](vtkActor* actor, int character = -1) {
      all.push_back({actor, character});
    };
    for (const auto& [id, person] : people_) add(person->shadow(), id);
    for (const auto& robot : robots_) add(robot->shadow());
    const auto add_bodies = [&](bool are_veils) {
      for (const auto& [id, person] : people_) {
        if (person->has_veil() != are_veils) continue;
        for (vtkActor* body : person->bodies()) add(body, id);
      }
    };
    add_bodies(false);
    for (const auto& [id, person] : people_) add(person->held(), id);
    for (vtkActor* object : objects_.actors()) add(object);
    const auto add_robots = [&](bool are_translucent) {
      for (const auto& robot : robots_) {
        for (vtkActor* body : robot->bodies(are_translucent)) add(body);
      }
    };
    add_robots(false);
    for (vtkActor* marker : markers_->solid()) add(marker);
    add(trails_->actor());
    for (const auto& [id, person] : people_) {
      for (vtkActor* ghost : person->ghosts()) add(ghost, id);
    }
    for (const auto& [id, person] : people_) {
      for (vtkActor* mark : person->marks()) add(mark, id);
    }
    // What shines through covers nothing: all that does not comes before it. Maps, which lie on the
    // floor, come before robots.
    for (vtkActor* marker : markers_->blended()) add(marker);
    add_robots(true);
    add_bodies(true);
    for (vtkActor* ghost : ghosts_.actors()) add(ghost);
    return all;
  }

  void ListActors() {
    people_layer_->RemoveAllViewProps();
    listed_ = Actors();
    for (const ListedActor& each : listed_) people_layer_->AddActor(each.actor);
  }

  // By part; one name: the actor is one thing; none: it is no thing of its own, such as a shadow.
  std::vector<std::string> NamesOf(const ListedActor& listed) {
    if (const auto person = people_.find(listed.character); person != people_.end()) {
      return person->second->NamesOf(listed.actor);
    }
    if (listed.actor == trails_->actor()) return trails_->names();
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      for (const bool are_translucent : {false, true}) {
        const auto bodies = robots_[i]->bodies(are_translucent);
        const bool is_of = std::find(bodies.begin(), bodies.end(), listed.actor) != bodies.end();
        if (is_of) return {"robot " + std::to_string(i + 1)};
      }
    }
    if (const int ghost = ghosts_.IndexOf(listed.actor); ghost >= 0) {
      return {"reference pose " + std::to_string(ghost + 1)};
    }
    std::vector<std::string> names = objects_.NamesOf(listed.actor);
    return names.empty() ? markers_->NamesOf(listed.actor) : names;
  }

  // For a message.
  std::string TextOf(const ListedActor& listed) {
    const std::vector<std::string> names = NamesOf(listed);
    const std::string name = names.empty()      ? "shadow"
                             : names.size() > 1 ? names.front() + " and its like"
                                                : names.front();
    return listed.character < 0 ? name : name + " of person " + std::to_string(listed.character);
  }

  // The number of each pixel as its colour, 0: nothing. @return what the numbers from 1 on are.
  std::vector<Named> DrawNumbers(const Camera& camera, Image& image) {
    std::vector<Named> all;
    std::vector<std::unique_ptr<NumberShader>> shaders;
    std::vector<vtkActor*> hidden;
    for (const ListedActor& listed : listed_) {
      if (!listed.actor->GetVisibility()) continue;
      const std::vector<std::string> names = NamesOf(listed);
      if (names.empty()) {
        listed.actor->VisibilityOff();
        hidden.push_back(listed.actor);
        continue;
      }
      const int first = 1 + static_cast<int>(all.size());
      shaders.push_back(std::make_unique<NumberShader>(listed.actor, first, names.size() > 1));
      for (const std::string& name : names) all.push_back({name, listed.character});
    }
    std::fill(image.rgba.begin(), image.rgba.end(), std::uint8_t{0});
    image.floor = nullptr;
    for (int y = 0; y < image.height; y += kLargestTile) {
      for (int x = 0; x < image.width; x += kLargestTile) {
        const Tile tile{x, y, std::min(kLargestTile, image.width - x),
                        std::min(kLargestTile, image.height - y)};
        AimAt(tile, camera, image);
        tiles_->Begin(tile.width, tile.height, 1);
        tiles_->PutFloor(image, tile, {tile});
        tiles_->DrawPeople();
        pixels_->Read(tiles_->framebuffer(), tile, tile, 1, image);
      }
    }
    for (vtkActor* actor : hidden) actor->VisibilityOn();
    return all;
  }

  static std::vector<SeenObject> Seen(const Image& numbers, const std::vector<Named>& named) {
    std::map<std::pair<int, std::string>, SeenObject> seen;  // by person and name
    std::vector<SeenObject*> by_number(named.size(), nullptr);
    std::size_t at = 0;
    for (int y = 0; y < numbers.height; ++y) {
      for (int x = 0; x < numbers.width; ++x, at += 4) {
        const PixelNumber pixel = NumberOf(&numbers.rgba[at]);
        if (pixel.number == 0) continue;
        const auto index = static_cast<std::size_t>(pixel.number - 1);
        SeenObject*& object = by_number.at(index);
        if (object == nullptr) {
          const auto& [name, character] = named[index];
          object = &seen[{character, name}];
          object->name = name;
          object->character = character;
        }
        AddPixel(x, y, pixel.is_through, *object);
      }
    }
    std::vector<SeenObject> all;
    for (auto& [key, object] : seen) {
      const double count = static_cast<double>(object.pixels + object.through);
      object.x_px /= count;
      object.y_px /= count;
      all.push_back(std::move(object));
    }
    return all;
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

  void AimAt(const Tile& tile, const Camera& camera, const Image& image) {
    const double aspect = static_cast<double>(image.width) / image.height;
    const glm::dmat4 clip =
        TileFromClip(tile, image.width, image.height) * ClipFromView(camera, aspect);
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column)
        projection_->SetElement(row, column, clip[column][row]);
    }
    camera_->Modified();
    markers_->SetViewSize(tile.width, tile.height);
  }

  static Tile WholeOf(const Image& image) { return {0, 0, image.width, image.height}; }

  // Those that may differ from the floor.
  std::vector<Tile> Parts(const Camera& camera, const Image& image) const {
    if (regions_.is_off || !is_software_) return {WholeOf(image)};
    PictureRegion region(camera, image.width, image.height, regions_.margin_px);
    AddTo(region);
    return region.Rectangles();
  }

  void AddTo(PictureRegion& region) const {
    for (const auto& [character, person] : people_) person->AddTo(region);
    for (const auto& robot : robots_) robot->AddTo(region);
    objects_.AddTo(region);
    markers_->AddTo(region);
    trails_->AddTo(region);
    ghosts_.AddTo(region);
  }

  // @throws RenderError if `image`, of which `parts` were drawn, differs from the same drawn whole.
  void CheckParts(const std::vector<Tile>& parts, const Camera& camera, int supersample,
                  const Image& image) {
    if (regions_.check_every == 0 || ++checkable_ % regions_.check_every != 0) return;
    const auto draw = [&](Image& into) {
      SetSize(into, image.width, image.height);
      DrawTiles({WholeOf(image)}, camera, supersample, into, [](const Tile&) {});
    };
    Image whole, without;
    draw(whole);
    const auto differs = std::mismatch(whole.rgba.begin(), whole.rgba.end(), image.rgba.begin());
    if (differs.first == whole.rgba.end()) return;
    const std::ptrdiff_t pixel = (differs.first - whole.rgba.begin()) / 4;
    std::string said;
    for (const ListedActor& listed : listed_) {
      if (!listed.actor->GetVisibility()) continue;
      const std::string name = TextOf(listed);
      listed.actor->VisibilityOff();
      draw(without);
      listed.actor->VisibilityOn();
      const auto at = whole.rgba.begin() + 4 * pixel;
      const bool is_there = !std::equal(at, at + 4, without.rgba.begin() + 4 * pixel);
      if (is_there && said.find(name) == std::string::npos) {
        said += (said.empty() ? "" : ", ") + name;
      }
    }
    throw RenderError("the part of the picture that was drawn is too small (" +
                      std::to_string(parts.size()) + " rectangles): at column " +
                      std::to_string(pixel % image.width) + ", row " +
                      std::to_string(pixel / image.width) + " there is also: " + said);
  }

  // The `parts` of a picture; around them it gets the floor. `on_drawn`: called after each tile.
  template <class OnDrawn>
  void DrawTiles(const std::vector<Tile>& parts, const Camera& camera, int supersample,
                 Image& image, const OnDrawn& on_drawn) {
    const int step = kLargestTile / supersample;
    for (int y = 0; y < image.height; y += step) {
      for (int x = 0; x < image.width; x += step) {
        const Tile tile{x, y, std::min(step, image.width - x), std::min(step, image.height - y)};
        AimAt(tile, camera, image);
        tiles_->Begin(tile.width, tile.height, supersample);
        if (regions_.is_off || !is_software_) {
          DrawWhole(tile, camera, supersample, image);
        } else {
          DrawParts(tile, parts, camera, supersample, image);
        }
        on_drawn(tile);
      }
    }
  }

  void DrawWhole(const Tile& tile, const Camera& camera, int supersample, Image& image) {
    image.floor = nullptr;
    tiles_->DrawFloor();
    if (HasFloorShadows()) {
      pixels_->Read(tiles_->floor_framebuffer(), tile, tile, 1, image);
      BlendShadows(tile, camera, image);
      tiles_->ReplaceFloor(image, tile);
    }
    tiles_->EnlargeFloor();
    tiles_->DrawPeople();
    pixels_->Read(tiles_->framebuffer(), tile, tile, supersample, image);
  }

  void DrawParts(const Tile& tile, const std::vector<Tile>& parts, const Camera& camera,
                 int supersample, Image& image) {
    std::vector<Tile> here;
    for (const Tile& part : parts) {
      const Tile shared = Intersection(part, tile);
      if (!IsEmpty(shared)) here.push_back(shared);
    }
    GetFloor(tile, camera, image);
    BlendShadows(tile, camera, image);
    if (here.empty()) return;
    tiles_->PutFloor(image, tile, here);
    tiles_->DrawPeople();
    for (const Tile& part : here) {
      pixels_->Read(tiles_->framebuffer(), tile, part, supersample, image);
      MarkChanged(image, part);
    }
  }

  // What `image` has of the same floor is not copied again.
  void GetFloor(const Tile& tile, const Camera& camera, Image& image) {
    const FloorCache::Key key = FloorKey(camera, tile);
    SharedPixels floor = floors_.Find(key);
    if (floor != nullptr && floor == image.floor) {
      for (const Tile& part : image.changed.Rectangles()) CopyFloor(*floor, tile, part, image);
    } else if (floor != nullptr) {
      CopyFloor(*floor, tile, tile, image);
    } else {
      tiles_->DrawFloor();
      pixels_->Read(tiles_->floor_framebuffer(), tile, tile, 1, image);
      floor = floors_.Keep(key, tile, image);
    }
    const bool is_whole = tile.width == image.width && tile.height == image.height;
    image.floor = is_whole ? std::move(floor) : nullptr;
    image.changed = CellSet(image.width, image.height);
  }

  bool HasFloorShadows() const {
    return std::any_of(people_.begin(), people_.end(),
                       [](const auto& each) { return each.second->floor_shadow() != nullptr; });
  }

  void BlendShadows(const Tile& tile, const Camera& camera, Image& image) const {
    for (const auto& [character, person] : people_) {
      const FloorShadow* const shadow = person->floor_shadow();
      if (shadow != nullptr) shadow->BlendInto(image, tile, camera, shadow_color_);
    }
  }

  // The floor of a picture is the same however much larger people are drawn.
  FloorCache::Key FloorKey(const Camera& camera, const Tile& tile) const {
    FloorCache::Key key{};
    auto end = std::copy_n(projection_->GetData(), 16, key.begin());
    const auto add = [&](const Eigen::Vector3d& of) { end = std::copy_n(of.data(), 3, end); };
    add(camera.position);
    add(camera.target);
    add(Eigen::Vector3d::Map(camera_->GetViewUp()));
    *end++ = tile.width;
    *end++ = tile.height;
    end = std::copy(floor_look_.begin(), floor_look_.end(), end);
    KINESCOPE_CHECK(end == key.end());
    return key;
  }

  const RegionSettings regions_;
  LogLine log_;
  OnceLog once_;
  std::unique_ptr<GlContext> context_;  // outlives everything that follows
  vtkNew<UnshownWindow> window_;
  vtkNew<vtkOpenGLRenderer> floor_layer_;   // drawn first, without depth
  vtkNew<vtkOpenGLRenderer> people_layer_;  // over it
  vtkNew<vtkCamera> camera_;
  vtkNew<vtkMatrix4x4> projection_;
  std::unique_ptr<Ground> ground_;
  std::unique_ptr<TileWindow> tiles_;
  FloorCache floors_;
  std::unique_ptr<PixelReader> pixels_;
  std::map<int, std::unique_ptr<PersonActors>> people_;
  ObjectActors objects_;
  std::unique_ptr<MarkerActors> markers_;
  std::unique_ptr<TrailActor> trails_;
  GhostActors ghosts_;
  Rgb shadow_color_ = {};
  std::array<double, 5> floor_look_{};  // what of it the floor's pixels depend on
  bool is_listed_ = false;
  std::vector<std::unique_ptr<RobotActors>> robots_;  // in the order of the state
  std::unique_ptr<RobotActors> spare_;                // measured, not drawn yet
  std::vector<ListedActor> listed_;
  int checkable_ = 0;  // pictures
  bool is_software_ = false;
};

}  // namespace

std::unique_ptr<Drawing> MakeGlDrawing(const std::string& backend, const LogLine& log,
                                       const RegionSettings& regions) {
  return std::make_unique<GlDrawing>(backend, log, regions);
}

}  // namespace kinescope::render
