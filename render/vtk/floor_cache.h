/// Puts the floor under the people, in the same window. It is drawn at the size of the picture,
/// also where people are drawn larger and averaged: its shader averages itself. While the camera
/// stands still it is drawn once. Only parts of the window need it.
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
  using Key = std::array<double, 32>;

  /// `floor` is rendered first, `people` over it, in the same window. All are borrowed. GL objects
  /// are created and deleted while the context of the window is current.
  FloorCache(vtkOpenGLRenderWindow* window, vtkRenderer* floor, vtkRenderer* people);
  ~FloorCache();
  FloorCache(const FloorCache&) = delete;
  FloorCache& operator=(const FloorCache&) = delete;

  /// Call it before each Render of the window, whose size is `supersample` times the picture's.
  /// What Render leaves outside of `parts` (px of the window, from below) is not to be used.
  void Prepare(const Key& key, int supersample, const std::vector<Tile>& parts);
  /// GL's name of a framebuffer with the floor of the newest Render at the size of the picture; 0:
  /// it has been drawn in the window only.
  unsigned framebuffer() const;

 private:
  enum class Step { kDraw, kDrawAndKeep, kReuse };
  // Textures that can be drawn into.
  struct Target {
    unsigned framebuffer = 0, texture = 0, depth = 0;  // GL names, 0: none
    int width = 0, height = 0;                         // px
  };
  static void OnPeopleStart(vtkObject*, unsigned long, void* self, void*);
  void PutFloor();
  void Copy(unsigned from, int smaller, unsigned to, const Tile& part);
  void ClearDepth(unsigned of, const Tile& part);
  void Allocate(int width, int height, bool has_depth, Target& target);
  void AddDepth(int width, int height, Target& target);
  static void Release(Target& target);

  vtkOpenGLRenderWindow* const window_;
  vtkRenderer* const floor_;
  vtkRenderer* const people_;
  vtkNew<vtkCallbackCommand> on_start_;
  unsigned long observer_ = 0;
  Step step_ = Step::kDraw;
  Key key_{};
  int supersample_ = 1;
  std::vector<Tile> parts_;
  bool is_kept_ = false;  // `full_` has the floor of key_
  Target picture_;        // at the size of the picture, if people are drawn larger
  Target full_;           // at the size of the window
  Target far_;            // a strip with the greatest depth
};

}  // namespace kinescope::render
