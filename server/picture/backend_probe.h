/// Tests which back-ends work. Each one runs in a child process with a time limit, so that a driver
/// that crashes or hangs does not affect the caller. Any thread.
#pragma once

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace kinescope::app {

struct BackendReport {
  bool works = false;
  std::string reason;  // why it does not work
  std::string renderer, gl_version;
  bool is_software = false;
  double first_picture_seconds = 0;  // from the start, including the loading of its libraries
  double pictures_per_second = 0;    // of a person at 1280 x 720 px, rendered and read back
  std::vector<std::string> log;      // warnings
};

nlohmann::json ToJson(const BackendReport& report);

/// Allows for a cold shader cache and a busy machine.
constexpr std::chrono::milliseconds kProbeLimit(20'000);

/// Tests `backend` in a child process (`program`, a kinescope, with `probe --draw_with`), which is
/// killed after `limit`. Never throws: failures are in the report.
BackendReport ProbeBackend(const std::filesystem::path& program, const std::string& backend,
                           std::chrono::milliseconds limit);

/// Performs the test in this process; called in the child.
BackendReport MeasureBackend(const std::string& backend);

/// GPU devices below `dev`: /dev/dri/renderD*, /dev/nvidia0 and so on. A driver may still not
/// support them.
std::vector<std::string> FindGpus(const std::filesystem::path& dev = "/dev");

}  // namespace kinescope::app
