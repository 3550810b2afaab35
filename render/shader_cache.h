/// Keeps Mesa's cache of compiled shaders from ending the process. Mesa maps the index of the cache
/// into memory, as a file whose blocks are not allocated yet. When the disk is full, the first
/// write to such a block is answered with SIGBUS.
#pragma once

#include <filesystem>
#include <string>

namespace kinescope::render {

/// The folder where Mesa keeps its cache: $MESA_SHADER_CACHE_DIR, else $XDG_CACHE_HOME, else .cache
/// in the home folder of the account (not $HOME); in each, mesa_shader_cache. Empty without any.
std::filesystem::path ShaderCacheFolder();

/// Allocates all blocks of the index in `folder`, which is created if its parent's parent exists.
/// From then on, Mesa's writes cannot fail in memory, also if the disk becomes full later.
/// @return "", or why that is impossible, such as "No space left on device".
std::string ReserveShaderIndex(const std::filesystem::path& folder);

/// Reserves the index of Mesa's cache, or switches the cache off in the environment if that is
/// impossible; the first picture then takes about 0.5 s longer. In a service of systemd
/// that has a CACHE_DIRECTORY and no other folder, the cache is there. Call it before the first GL
/// context and before other threads call getenv(); only the first call has an effect.
/// @return a line for the log if the cache had to be switched off because the disk is full, else
/// "".
std::string PrepareShaderCache();

}  // namespace kinescope::render
