#include "server/app/serve/ros_camera_loop.h"

#include <utility>

#include "server/picture/pinhole.h"

namespace kinescope::app {

RosCameraLoop::RosCameraLoop(const RosCameraSettings& settings, RendererFactory make_renderer,
                             std::shared_ptr<const SceneState> first, Send send)
    : loop_({"view", settings.width, settings.height, settings.rate_hz, settings.people,
             settings.background, settings.trails},
            settings.camera, std::move(make_renderer), std::move(first),
            [send = std::move(send)](const render::Image& image, const SceneState& state,
                                     const render::Camera& camera) {
              const Pinhole pinhole = PinholeOf(camera, image.height);
              send({image.width, image.height, image.rgba, state.stamp_nanos,
                    pinhole.world_from_optical, pinhole.focal_px});
            }) {}

}  // namespace kinescope::app
