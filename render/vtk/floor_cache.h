/// Caches the rendered floor while the camera stands still, as in most streams: the floor covers
/// half of every picture and costs as much as the rest. The picture is the same, byte for byte.
/// With the floor at hand, only parts of a picture need to be drawn.
#pragma once

#include <vtkNew.h>

#include <array>
#include <vector>

#include "render/camera/tile.h"

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

  /// Whether the floor of `key` is in the cache.
  bool Has(const Key& key) const { return is_kept_ && key == key_; }
  /// Call it before each Render of the window, after its size is set.
  void Prepare(const Key& key);
  /// In place of Prepare(): the window keeps what it has, except in `parts` (px of the window, from
  /// below), which get the floor. What Render draws elsewhere is not to be used. @pre Has(key)
  void PrepareParts(const std::vector<Tile>& parts);
  /// GL's name of the framebuffer with the floor. @pre Has() its key
  unsigned framebuffer() const { return framebuffer_; }

 private:
  enum class Step { kDraw, kDrawAndKeep, kReuse, kReuseParts };
  static void OnPeopleStart(vtkObject*, unsigned long, void* self, void*);
  void Copy();
  void CopyParts();
  void Allocate(int width, int height);
  void Release();

  vtkOpenGLRenderWindow* const window_;
  vtkRenderer* const floor_;
  vtkRenderer* const people_;
  vtkNew<vtkCallbackCommand> on_start_;
  unsigned long observer_ = 0;
  Step step_ = Step::kDraw;
  Key key_{};
  std::vector<Tile> parts_;
  bool is_kept_ = false;                    // the texture contains the floor of key_
  unsigned framebuffer_ = 0, texture_ = 0;  // GL names, 0: none
  int width_ = 0, height_ = 0;              // px, of the texture
};

}  // namespace kinescope::render
