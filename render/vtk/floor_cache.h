/// Caches the rendered floor while the camera stands still, as in most streams: the floor covers
/// half of every picture and costs as much as the rest. The picture is the same, byte for byte.
#pragma once

#include <vtkNew.h>

#include <array>

class vtkCallbackCommand;
class vtkObject;
class vtkOpenGLRenderWindow;
class vtkRenderer;

namespace kinescope::render {

class FloorCache {
 public:
  /// All values that the floor's pixels depend on.
  using Key = std::array<double, 33>;

  /// `floor` is rendered first, `people` over it, in the same window. All are borrowed. GL objects
  /// are created and deleted while the context of the window is current.
  FloorCache(vtkOpenGLRenderWindow* window, vtkRenderer* floor, vtkRenderer* people);
  ~FloorCache();
  FloorCache(const FloorCache&) = delete;
  FloorCache& operator=(const FloorCache&) = delete;

  /// Call it before each Render of the window, after its size is set.
  void Prepare(const Key& key);

 private:
  enum class Step { kDraw, kDrawAndKeep, kReuse };
  static void OnPeopleStart(vtkObject*, unsigned long, void* self, void*);
  void Copy();
  void Allocate(int width, int height);
  void Release();

  vtkOpenGLRenderWindow* const window_;
  vtkRenderer* const floor_;
  vtkRenderer* const people_;
  vtkNew<vtkCallbackCommand> on_start_;
  unsigned long observer_ = 0;
  Step step_ = Step::kDraw;
  Key key_{};
  bool is_kept_ = false;                    // the texture contains the floor of key_
  unsigned framebuffer_ = 0, texture_ = 0;  // GL names, 0: none
  int width_ = 0, height_ = 0;              // px, of the texture
};

}  // namespace kinescope::render
