// `kinescope strip`: reads the frame code out of clips and pictures: which sample each frame shows.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/system/errors.h"
#include "core/system/json_text.h"
#include "core/system/stop_signal.h"
#include "render/frame_code.h"
#include "render/video.h"
#include "server/app/commands.h"
#include "server/app/progress.h"
#include "server/options/option_list.h"
#include "server/table/csv_row.h"
#include "server/table/output_file.h"

namespace kinescope::app {
namespace {

struct StripOptions {
  options::Texts files{"clips or pictures of Kinescope"};
  options::Text out{"-"};
  options::Flag json;

  void List(options::OptionList& option) {
    option("files", files, "clip (MP4, WebM, GIF, WebP, ...) or picture (PNG, JPEG) to read");
    option("out", out, "CSV file to write, one row per frame; -: standard output");
    option("json", json, "print one JSON object per frame instead of CSV");
    option.HasNoEffect("out", "with --json", [this] { return *json && *out != "-"; });
  }
};

/// Writes what is read, frame by frame.
class StripWriter {
 public:
  explicit StripWriter(const StripOptions& options) : is_json_(*options.json), out_(*options.out) {
    if (is_json_) return;
    CsvRow row(out_.buffer());
    for (const char* name : {"file", "frame", "display_time_s", "sample_counter", "time_code_s"}) {
      row.Text(name);
    }
    row.End();
  }

  void Add(const std::string& file, long frame, double secs,
           const std::optional<render::FrameCode>& code) {
    const double code_secs = code ? static_cast<double>(code->time_code_millis) / 1000 : 0;
    if (is_json_) {
      nlohmann::ordered_json object = {{"file", file}, {"frame", frame}, {"display_time_s", secs}};
      object["sample_counter"] = code ? nlohmann::ordered_json(code->counter) : nullptr;
      object["time_code_s"] = code ? nlohmann::ordered_json(code_secs) : nullptr;
      out_.buffer() += JsonText(object) + '\n';
    } else {
      CsvRow row(out_.buffer());
      row.Text(file);
      row.Whole(frame);
      row.Number(secs);
      if (code) {
        row.Whole(code->counter);
        row.Number(code_secs);
      } else {
        row.Empty();
        row.Empty();
      }
      row.End();
    }
    out_.FlushWhenLarge();
  }

  void Finish() { out_.Finish(); }

 private:
  const bool is_json_;
  OutputFile out_;
};

/// @return whether any frame has a frame code.
bool ReadStrips(const std::string& file, StripWriter& writer) {
  const auto video = render::OpenVideo(file);
  Progress progress(file + ": frames", 0);
  render::Image image;
  long frames = 0, found = 0;
  for (; video->Next(image); ++frames) {
    if (StopRequested()) throw std::runtime_error("interrupted; nothing was written");
    const auto code = render::ReadFrameCode(image);
    if (code) ++found;
    writer.Add(file, frames, video->secs(), code);
    progress.Step();
  }
  if (found < frames) {
    spdlog::warn(
        "{}: no readable frame code in {}{}", file,
        frames == 1 ? "the picture" : fmt::format("{} of {} frames", frames - found, frames),
        found == 0 ? "; draw it with --overlay frame_code at a size that is at most twice "
                     "that of this file"
                   : "");
  }
  return found > 0;
}

bool Strip(const StripOptions& options) {
  StripWriter writer(options);
  bool found = false;
  for (const std::string& file : *options.files) found |= ReadStrips(file, writer);
  writer.Finish();
  return found;
}

}  // namespace

Command StripCommand() {
  const auto values = std::make_shared<StripOptions>();
  Command command = CommandNamed("strip");
  command.shows_progress = true;
  command.about +=
      "\n  kinescope render walk.mvnx --overlay frame_code --out walk.mp4"
      "\n  kinescope strip walk.mp4 --out frames.csv";
  values->List(command.options);
  command.positionals = {"files"};
  command.required = {"files"};
  command.footer = "Exit code: 0 at least one frame has a frame code, 1 none has, 2 error.";
  command.run = [values](options::OptionList&) { return Strip(*values) ? 0 : 1; };
  return command;
}

}  // namespace kinescope::app
