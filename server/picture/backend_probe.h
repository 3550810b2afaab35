/// Finding out which back-ends work without being taken along by one that does not: each is tried
/// in a child process with a time limit.
#pragma once

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace kinescope::app {

struct BackendReport {
  bool works = false;
  std::string reason;  // why not
  std::string renderer, gl_version;
  bool is_software = false;
  double first_picture_secs = 0;   // from nothing, the loading of its libraries included
  double pictures_per_second = 0;  // of a person in 1280 x 720 px, drawn and read back
  std::vector<std::string> log;    // what it warned of
};

nlohmann::json ToJson(const BackendReport& report);

/// Includes a cold shader cache and a busy machine.
constexpr std::chrono::milliseconds kProbeLimit(20'000);

/// Tries `backend` in a child process (`program`, a kinescope, with `probe --draw_with`), which is
/// killed after `limit`. Never throws: what goes wrong is the report.
BackendReport ProbeBackend(const std::filesystem::path& program, const std::string& backend,
                           std::chrono::milliseconds limit);

/// The same here and now: what the child does.
BackendReport MeasureBackend(const std::string& backend);

/// Devices of GPUs below `dev`: /dev/dri/renderD*, /dev/nvidia0 and so on. Whether a driver uses
/// them is another question.
std::vector<std::string> FindGpus(const std::filesystem::path& dev = "/dev");

}  // namespace kinescope::app
