/// A renderer without OpenGL, for tests of what happens around the drawing.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "render/renderer.h"

namespace kinescope::testing {

class FakeRenderer : public render::Renderer {
 public:
  /// Called for every picture, which it may change, on the renderer's thread; may wait or throw.
  using OnDraw = std::function<void(render::Image& image, const SceneState& state,
                                    const render::Camera& camera, const render::PictureSpec& spec)>;

  explicit FakeRenderer(OnDraw on_draw = nullptr) : on_draw_(std::move(on_draw)) {}

  Eigen::AlignedBox3d Bounds(const RobotState&) override { return {}; }
  std::vector<std::string> problems() const override { return {}; }
  render::RendererInfo info() const override { return {"fake", "a fake", "0.0", true, "", "none"}; }

 private:
  // Every level is the number of the picture, from 1; what is written over it names that.
  void DoRender(render::Image& image, const SceneState& state, const render::Camera& camera,
                const render::PictureSpec& spec) override {
    ++drawn_;
    std::fill(image.rgba.begin(), image.rgba.end(), drawn_);
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
    if (on_draw_) on_draw_(image, state, camera, spec);
  }
  std::string DoOverlayLayer(const SceneState&, const render::Camera&, const render::PictureSpec&,
                             render::LayerFormat) override {
    return "over picture " + std::to_string(drawn_);
  }
  render::PictureContents DoContents(const SceneState&, const render::Camera&,
                                     const render::PictureSpec&) override {
    return {};
  }

  const OnDraw on_draw_;
  std::uint8_t drawn_ = 0;
};

}  // namespace kinescope::testing
