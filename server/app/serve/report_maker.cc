#include "server/app/serve/report_maker.h"

#include <fmt/format.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

#include "server/app/command_table.h"
#include "server/picture/child_process.h"

namespace kinescope::app {
namespace {

constexpr std::chrono::minutes kReportTimeout(10), kClipTimeout(60);

// `what`: that it makes. `arguments`: the command first.
void RunCommand(const char* what, std::vector<std::string> arguments, const OptionTexts& options,
                std::chrono::minutes longest, const Workshop::Progress& progress) {
  arguments.insert(arguments.begin(), ProgramOf(arguments.front()).string());
  for (const auto& [name, value] : options) arguments.push_back("--" + name + "=" + value);
  const ChildResult result =
      RunChild(arguments, longest, [&progress] { return progress.is_wanted(); });
  if (!progress.is_wanted()) return;
  if (result.was_too_slow) {
    throw std::runtime_error(
        fmt::format("the {} took more than {} minutes", what, longest.count()));
  }
  if (result.exit_code == 0 && result.signal == 0) return;
  const std::string why = LastLineOf(result.err);
  throw std::runtime_error(
      fmt::format("no {}: {}", what, why.empty() ? "the program ended by itself" : why));
}

}  // namespace

void MakeReport(const std::filesystem::path& recording, const std::filesystem::path& report,
                const OptionTexts& options, const Workshop::Progress& progress) {
  RunCommand("report", {"loads", recording.string(), "--report", report.string()}, options,
             kReportTimeout, progress);
}

void MakeRecordedClip(const std::filesystem::path& recording, const std::filesystem::path& clip,
                      const OptionTexts& options, const Workshop::Progress& progress) {
  RunCommand("clip",
             {"render", recording.string(), "--out", clip.string(), "--force", "--no_sidecar"},
             options, kClipTimeout, progress);
}

}  // namespace kinescope::app
