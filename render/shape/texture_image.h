/// Textures of mesh files: PNG and JPEG. Their bytes are untrusted. Pure functions, any thread.
#pragma once

#include <cstddef>
#include <cstdint>

#include "urdf/mesh/texture.h"

namespace kinescope::render {

/// A larger one than colours of vertices can show is read at a part of its size, if it is a JPEG.
/// @throws std::runtime_error with the reason
urdf::Texture DecodeTexture(const std::uint8_t* bytes, std::size_t size);

}  // namespace kinescope::render
