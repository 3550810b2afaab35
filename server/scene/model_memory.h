/// Remembers the newest models of this process, so that two recordings of one person, rendered one
/// after the other, share a model, and with it all that renderers have made of it. Any thread.
#pragma once

#include <memory>

#include "core/scene_state.h"

namespace kinescope::app {

/// An earlier model that is equal to `model` in everything that sinks read; else `model`, which is
/// remembered. Models with gloves are not shared.
std::shared_ptr<const PersonModel> SharedModel(std::shared_ptr<const PersonModel> model);

}  // namespace kinescope::app
