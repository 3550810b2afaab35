/// The window in which the tiles of pictures are drawn: first the floor, at the size of the
/// picture, then the people over it, `supersample` times as large. The floor's shader averages
/// itself, so drawing it larger would gain nothing. Use it while the context of the window is
/// current. One thread.
#pragma once

#include <cstdint>
#include <vector>

#include "render/image/image.h"
#include "render/image/tile.h"
#include "render/vtk/held_size.h"

class vtkRenderer;

namespace kinescope::render {

class UnshownWindow;

class TileWindow {
 public:
  /// `floor` and `people` are the layers of `window`. All are borrowed.
  TileWindow(UnshownWindow* window, vtkRenderer* floor, vtkRenderer* people);
  ~TileWindow();
  TileWindow(const TileWindow&) = delete;
  TileWindow& operator=(const TileWindow&) = delete;

  /// What follows is of a tile of `width` x `height` px of a picture.
  void Begin(int width, int height, int supersample);

  /// Into floor_framebuffer(), at the size of the picture.
  void DrawFloor();
  /// Puts the floor of `tile`, which is in `image` already, under `parts` of it (px of the picture)
  /// and takes away what was there.
  void PutFloor(const Image& image, const Tile& tile, const std::vector<Tile>& parts);
  /// In place of PutFloor(), where GL is fast: replaces what DrawFloor() has drawn by the floor of
  /// `tile`, which is in `image`.
  void ReplaceFloor(const Image& image, const Tile& tile);
  /// And puts it under all.
  void EnlargeFloor();
  /// Over the floor, into framebuffer().
  void DrawPeople();

  /// GL's names.
  unsigned floor_framebuffer() const;
  unsigned framebuffer() const;

 private:
  // Textures that can be drawn into.
  struct Target {
    unsigned framebuffer = 0, color = 0, depth = 0;  // GL names, 0: none
    int width = 0, height = 0;                       // px
  };
  void Upload(const Image& image, const Tile& tile, const Tile& part, int scale);
  unsigned WindowTexture() const;
  void ClearDepth(const Tile& part);
  void Reserve(int width, int height, bool has_depth, Target& target);
  static void AddColor(Target& target);
  void AddDepth(Target& target);
  static void Release(Target& target);

  UnshownWindow* const window_;
  vtkRenderer* const floor_;
  vtkRenderer* const people_;
  HeldSize size_, small_size_;                    // of the window, of the floor
  int width_ = 0, height_ = 0, supersample_ = 1;  // of the tile
  bool is_depth_cleared_ = false;                 // in the window
  Target far_;                                    // a strip with the greatest depth
  Target small_;  // the floor where people are drawn larger; without depth
  std::vector<std::uint32_t> band_;
};

}  // namespace kinescope::render
