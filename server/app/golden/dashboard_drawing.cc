#include "server/app/golden/dashboard_drawing.h"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/system/scratch_folder.h"
#include "core/system/starts_with.h"
#include "core/system/utf8.h"
#include "server/app/command_table.h"
#include "server/app/golden/page_browser.h"
#include "server/app/process_group.h"
#include "server/source/scheme.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

// 2020-01-01 12:00 UTC: the newest sample of each recording came then.
constexpr std::int64_t kDateMillis = 1'577'880'000'000;

// The rest of a line that has `text`, as the server writes it when it has reached that state.
std::optional<std::string> RestAfter(const std::string& line, const std::string& text) {
  const std::size_t at = line.find(text);
  if (at == std::string::npos) return std::nullopt;
  return line.substr(at + text.size());
}

class DashboardServer {
 public:
  explicit DashboardServer(const DashboardSpec& spec)
      : process_({CommandOf(spec), {"KINESCOPE_TOKEN", "KINESCOPE_VIEWER_TOKEN"}, FolderOf(spec)}) {
    const auto deadline = ProcessGroup::Clock::now() + spec.limit;
    while (!has_stopped_) {
      if (process_.has_ended()) throw std::runtime_error("the server " + HowItEnded());
      if (!process_.Read(deadline)) {
        throw std::runtime_error(
            fmt::format("the server has not read {:.3f} s of the recording in {} s", spec.time,
                        spec.limit.count() / 1000));
      }
      TakeLines();
    }
  }

  const std::string& url() const { return url_; }

 private:
  static bool IsFile(const DashboardSpec& spec) {
    return KindOfSource(spec.source) == SourceKind::kFile;
  }
  // A recording is named without its folder, because the page shows its name.
  static std::string FolderOf(const DashboardSpec& spec) {
    return IsFile(spec) ? fs::absolute(spec.source).parent_path().string() : "";
  }
  static std::string NameOf(const DashboardSpec& spec) {
    return IsFile(spec) ? fs::path(spec.source).filename().string() : spec.source;
  }

  std::vector<std::string> CommandOf(const DashboardSpec& spec) const {
    const fs::path program = spec.program.empty() ? ProgramOf("serve") : spec.program;
    std::vector<std::string> command = {program.string(),
                                        "serve",
                                        "--source=" + NameOf(spec),
                                        fmt::format("--stop_at={}", spec.time),
                                        "--ros=off",
                                        "--http_port=0",
                                        "--bind_ip=127.0.0.1",
                                        "--marks_file=" + (scratch_ / "marks.jsonl").string(),
                                        "--recordings_folder=" + scratch_.path().string()};
    bool has_pictures = false;
    for (const std::string& option : spec.options) {
      command.push_back(option);
      has_pictures = has_pictures || StartsWith(option, "--pictures");
    }
    // They take long to begin, and the page shows none of the past.
    if (!has_pictures) command.emplace_back("--pictures=off");
    return command;
  }

  void TakeLines() {
    while (auto line = process_.TakeLine()) {
      if (const auto url = RestAfter(*line, "page at ")) url_ = *url;
      if (RestAfter(*line, "stopped at ")) has_stopped_ = true;
      last_line_ = PrintableLine(*line);
    }
  }

  std::string HowItEnded() {
    const std::string ending = process_.End();
    TakeLines();
    return fmt::format("has ended with {}: {}", ending, last_line_);
  }

  ScratchFolder scratch_;  // before the process that uses it
  ProcessGroup process_;
  std::string url_, last_line_;
  bool has_stopped_ = false;
};

std::string AddressOf(const DashboardServer& server, const DashboardSpec& spec) {
  return fmt::format("{}?{}{}at={}", server.url(), spec.query, spec.query.empty() ? "" : "&",
                     spec.time);
}

}  // namespace

PageDrawing DrawDashboard(const DashboardSpec& spec) {
  PageSpec page;
  std::optional<DashboardServer> server;
  try {
    // Before the recording is read.
    page.chromium = spec.chromium.empty() ? FindChromium() : spec.chromium;
    server.emplace(spec);
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("page: dashboard: {}", error.what()));
  }
  page.name = "dashboard";
  page.url = AddressOf(*server, spec);
  page.width_px = spec.width_px;
  page.height_px = spec.height_px;
  page.is_dark = spec.is_dark;
  page.ready_when = "body[data-settled]";
  page.date_millis = kDateMillis;
  page.limit = spec.limit;
  return DrawPage(page);
}

}  // namespace kinescope::app
