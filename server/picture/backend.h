/// Which way to a GL context draws the pictures of a command, and what is said about the choice.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "render/renderer.h"

namespace kinescope::app {

struct BackendOptions {
  std::string backend = "osmesa";
  double draw_limit_secs = 0;

  template <class Option>
  void Visit(Option&& option) {
    option(
        "backend", backend,
        "what draws: osmesa or egl (software), egl_device (a GPU) or auto (a GPU where one works, "
        "else software)");
    option(
        "draw_limit_secs", draw_limit_secs,
        "so long may the driver take for a picture until it is said to hang; 0: 30 and 1 more for "
        "each million pixels drawn");
  }
};

/// What is to be known before the first renderer is made.
struct BackendChoice {
  std::string name;  // one of render::BackendNames()
  std::string note;  // a GPU that is not used, a back-end that was fallen back from; "" none
};

/// Where to look for GPUs, and the program that tries them out.
struct Machine {
  std::filesystem::path dev = "/dev";
  std::filesystem::path program = "/proc/self/exe";
};

/// `auto` looks for a GPU, and draws with it in a child process first: a broken driver may hang or
/// crash. The choice costs some seconds where there is a GPU, and nothing elsewhere.
/// @throws UsageError naming the value.
BackendChoice ChooseBackend(const BackendOptions& options, const Machine& machine = {});

/// A renderer of that back-end, whose warnings go to the log. Any thread; the renderer then belongs
/// to it. @throws render::RenderError, UsageError.
std::unique_ptr<render::Renderer> StartRenderer(
    const BackendOptions& options, const BackendChoice& choice,
    std::function<void(const std::string&)> on_hang = {}, render::LogLine log = {});

/// Chosen and started; the note is said once on the log.
std::unique_ptr<render::Renderer> StartRenderer(const BackendOptions& options);

/// For the metadata of a picture: "Renderer", "Backend" and, where there is one, "Backend note".
std::map<std::string, std::string> DrawnBy(const render::Renderer& renderer);

}  // namespace kinescope::app
