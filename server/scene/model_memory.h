/// Knows the newest models of this process, as long as somebody has them, a renderer for example:
/// two recordings of one person, rendered one after the other, then share a model, and with it all
/// that the renderer has made of it. Any thread.
#pragma once

#include <memory>

#include "core/scene_state.h"

namespace kinescope::app {

/// An earlier model that is equal to `model` in everything that sinks read; else `model`, which is
/// remembered. Models with gloves are not shared.
std::shared_ptr<const PersonModel> SharedModel(std::shared_ptr<const PersonModel> model);

}  // namespace kinescope::app
