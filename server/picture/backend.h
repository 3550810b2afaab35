/// Selects the OpenGL back-end of a command and describes the choice.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "core/system/install_paths.h"
#include "render/renderer.h"
#include "server/options/option_list.h"

namespace kinescope::app {

struct BackendOptions {
  BackendOptions();

  options::Choice<std::string> backend;
  options::Number draw_limit_secs;  // 0: by the size of the picture

  void List(options::OptionList& option);
};

/// The choice, made before the first renderer exists.
struct BackendChoice {
  std::string name;  // one of render::BackendNames()
  std::string note;  // a GPU that is not used, or a back-end that failed before; "": nothing to
                     // report
};

/// Where to look for GPUs, and the program that tests them.
struct Machine {
  std::filesystem::path dev = "/dev";
  std::filesystem::path program = FindProgram(kMainProgram);  // has `probe`
};

/// `auto` looks for a GPU and renders with it in a child process first, because a broken driver may
/// crash or not respond. This takes some seconds on a machine with a GPU, and no time on others.
/// @throws UsageError with the value.
BackendChoice ChooseBackend(const BackendOptions& options, const Machine& machine = {});

/// A renderer of that back-end, whose warnings are logged, each once in this process. Any thread;
/// the renderer belongs to the calling thread. @throws render::RenderError, UsageError.
std::unique_ptr<render::Renderer> StartRenderer(
    const BackendOptions& options, const BackendChoice& choice,
    std::function<void(const std::string&)> on_hang = {});

/// Chooses and starts a back-end; the note is logged once.
std::unique_ptr<render::Renderer> StartRenderer(const BackendOptions& options);

/// Makes a renderer that belongs to the calling thread and reports a driver that does not respond
/// to `on_hang`, on another thread. @throws render::RenderError, UsageError.
using RendererFactory = std::function<std::unique_ptr<render::Renderer>(
    std::function<void(const std::string&)> on_hang)>;

/// Chooses a back-end now, for all renderers of the process; the note is logged once.
/// @throws as ChooseBackend.
RendererFactory RenderersOf(const BackendOptions& options);

/// For the metadata of a picture: "Renderer", "Backend" and, if there is one, "Backend note".
std::map<std::string, std::string> DrawnBy(const render::Renderer& renderer);

}  // namespace kinescope::app
