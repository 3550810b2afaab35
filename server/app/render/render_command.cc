// `kinescope render`: pictures and clips of recordings and the built-in subject.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/json_text.h"
#include "server/app/commands.h"
#include "server/app/render/output_plan.h"
#include "server/app/render/render_job.h"
#include "server/app/render/render_options.h"
#include "server/app/render/render_verify.h"
#include "server/options/option_list.h"

namespace kinescope::app {
namespace {

constexpr int kMostJobs = 64;

void Tell(const OutputResult& result, bool as_json) {
  const bool is_still = result.kind == OutputKind::kStill;
  if (as_json) {
    nlohmann::json line = {
        {"out", result.out}, {"pictures", result.pictures}, {"drawn", result.drawn}};
    if (is_still) {
      line["counter"] = result.counter;
    } else {
      line["seconds"] = result.secs;
      if (result.drawn > 0) {
        line["pictures_per_second"] = static_cast<double>(result.drawn) / result.took_secs;
      }
    }
    fmt::print("{}\n", JsonText(line));
    return;
  }
  if (result.drawn == 0) {
    fmt::print("{}: is there already, of this source and these options (--force draws it again)\n",
               result.out);
    return;
  }
  const long kept = result.pictures - result.drawn;
  fmt::print("{}: {} picture{}{}\n", result.out, result.pictures, result.pictures == 1 ? "" : "s",
             kept > 0 ? fmt::format(", {} of them there already", kept) : "");
}

void Render(const RenderOptions& options) {
  if (options.sources.empty()) throw UsageError("what to render is missing; give a source");
  if (options.outs.empty()) throw UsageError("--out is missing; give the name of a file to write");
  if (options.jobs < 0 || options.jobs > kMostJobs) {
    throw UsageError(fmt::format("--jobs={}: expected 1 to {}, or 0 for as many as are fastest",
                                 options.jobs, kMostJobs));
  }
  const std::vector<SourcePlan> plans = PlanOutputs(options);
  const render::View view = ToView(options.view);
  ToTimeGrid(options.clip, false);  // refuses what makes no sense before a renderer is made
  JobSettings settings;
  settings.jobs = options.jobs > 0 ? options.jobs : DefaultJobs();
  settings.force = options.force;
  settings.sidecar = !options.no_sidecar;
  const auto pool = MakeDrawPool(settings.jobs, view, options.backend);
  for (const SourcePlan& plan : plans) {
    for (const OutputResult& result : RenderSource(options, plan, settings, *pool)) {
      Tell(result, options.json);
    }
  }
}

struct CommandOptions {
  RenderOptions render;
  std::string verify;
};

int Run(const CommandOptions& options) {
  if (options.verify.empty()) {
    Render(options.render);
    return 0;
  }
  return Verify(options.verify, options.render);
}

// The options that `add` adds to `command` go under a heading of their own in --help.
template <class Add>
void Group(CLI::App& command, const std::string& heading, Add&& add) {
  const std::size_t before = command.get_options().size();
  add();
  const std::vector<CLI::Option*> options = command.get_options();
  for (std::size_t i = before; i < options.size(); ++i) options[i]->group(heading);
}

}  // namespace

void AddRender(CommandLine line) {
  CLI::App* command = line.app.add_subcommand(
      "render",
      "Recordings to pictures and clips.\n"
      "  kinescope render take.mvnx --time 2.5 --out figure.png\n"
      "  kinescope render take.mvnx --out clip.mp4 --out clip.webm\n"
      "  kinescope render *.mvnx --camera front,top --out '{source}-{camera}.mp4'\n"
      "  kinescope render take.mvnx --start 2 --seconds 3 --out 'frames/%05d.png'\n"
      "What is there already, of the same source and options, is not drawn again.");
  const auto o = std::make_shared<CommandOptions>();
  RenderOptions& render = o->render;
  command->add_option("source", render.sources, kSourceKinds);
  Group(*command, "What to write", [&] {
    command
        ->add_option("--out", render.outs,
                     "file to write, once or several times: .png (a picture; with %05d or ##### in "
                     "its name, one for every moment), .mp4 (H.264), .webm (VP9), .webp, .gif. "
                     "{source} and {camera} in it are replaced")
        ->allow_extra_args(false);
    command->add_flag("--force", render.force, "draw again what is there already");
    command->add_flag("--no_sidecar", render.no_sidecar,
                      "no FILE.json beside each output (what is in it is in the file, too)");
    command->add_option("--jobs", render.jobs,
                        "threads that draw; the pictures do not depend on it. 0: as many as are "
                        "fastest here");
    command->add_flag("--json", render.json, "tell the result as JSON, a line for each output");
    command->add_option(
        "--verify", o->verify,
        "draw FILE again as it says it was drawn, and compare: exit code 0 when it is "
        "the same, 1 when not. The source is where it was, or give it");
  });
  Group(*command, "Which moments", [&] {
    render.moment.Visit(FlagAdder(*command));
    render.clip.Visit(FlagAdder(*command));
    render.pack.Visit(FlagAdder(*command));
  });
  Group(*command, "How it looks (several cameras: --camera front,top)", [&] {
    render.view.Visit(FlagAdder(*command));
    render.backend.Visit(FlagAdder(*command));
  });
  Group(*command, "The person", [&] { render.person.Visit(FlagAdder(*command)); });
  Group(*command, "Joint loads", [&] { render.loads.Visit(FlagAdder(*command)); });
  int& exit_code = line.exit_code;
  command->callback([o, &exit_code] { exit_code = Run(*o); });
}

}  // namespace kinescope::app
