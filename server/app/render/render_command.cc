// `kinescope render`: pictures and clips of recordings and the built-in subject.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/system/errors.h"
#include "core/system/json_text.h"
#include "server/app/commands.h"
#include "server/app/print.h"
#include "server/app/render/draw_pools.h"
#include "server/app/render/output_plan.h"
#include "server/app/render/provenance_files.h"
#include "server/app/render/render_options.h"
#include "server/app/render/render_run.h"
#include "server/app/render/render_verify.h"

namespace kinescope::app {
namespace {

void PrintResult(const OutputResult& result, bool as_json) {
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
    Print("{}\n", JsonText(line));
    return;
  }
  if (result.drawn == 0) {
    Print("{}: up to date, skipped (--force renders it again)\n", result.out);
    return;
  }
  const long kept = result.pictures - result.drawn;
  Print("{}: {} picture{}{}\n", result.out, result.pictures, result.pictures == 1 ? "" : "s",
        kept > 0 ? fmt::format(", {} of them skipped (up to date)", kept) : "");
}

// As Render() checks them before it makes a renderer.
std::vector<SourcePlan> Plan(const RenderOptions& options) {
  if (options.sources->empty()) throw UsageError("source is missing: name what to render");
  if (options.sources->size() > 1 && options.loads.measured.wrenches.IsGiven()) {
    throw UsageError("--wrenches=" + *options.loads.measured.wrenches +
                     ": was measured during one recording; render its source alone");
  }
  if (options.outs->empty()) throw UsageError("--out is missing: name the file to write");
  std::vector<SourcePlan> plans = PlanOutputs(options);
  ToTimeGrid(options.clip, false);  // refuses contradictions
  return plans;
}

std::vector<DeclaredOutput> OutputsOf(const RenderOptions& options) {
  using Kind = DeclaredOutput::Kind;
  std::vector<DeclaredOutput> outputs;
  if (!options.verify->empty()) return outputs;
  for (const SourcePlan& plan : Plan(options)) {
    for (const Output& output : plan.outputs) {
      const bool is_numbered = output.kind == OutputKind::kSequence;
      outputs.push_back({"out", output.path, is_numbered ? Kind::kNumbered : Kind::kFile});
      const std::string layer = LayerPathOf(options, output);
      if (!layer.empty()) outputs.push_back({"overlay_layer", layer});
      if (!*options.no_sidecar) outputs.push_back({"out", SidecarOf(output.path)});
    }
  }
  return outputs;
}

void Render(const RenderOptions& options, DrawPools& pools) {
  const std::vector<SourcePlan> plans = Plan(options);
  const render::PictureSpec spec = ToPictureSpec(options.view);
  RunSettings settings;
  settings.jobs = JobsFor(*options.jobs, spec);
  settings.force = *options.force;
  settings.sidecar = !*options.no_sidecar;
  DrawPool& pool = pools.PoolFor(settings.jobs, spec, options.backend);
  for (const SourcePlan& plan : plans) {
    for (const OutputResult& result : RenderSource(options, plan, settings, pool)) {
      PrintResult(result, *options.json);
    }
  }
}

}  // namespace

Command RenderCommand() { return RenderCommand(std::make_shared<DrawPools>()); }

Command RenderCommand(const std::shared_ptr<DrawPools>& pools) {
  const auto values = std::make_shared<RenderOptions>();
  Command command = CommandNamed("render");
  command.shows_progress = true;
  command.about +=
      "\n  kinescope render take.mvnx --time 2.5 --out figure.png"
      "\n  kinescope render take.mvnx --out clip.mp4 --out clip.webm"
      "\n  kinescope render *.mvnx --camera front,top --out '{source}-{camera}.mp4'"
      "\n  kinescope render take.mvnx --start 2 --seconds 3 --out 'frames/%05d.png'"
      "\nOutputs that are up to date are skipped.";
  values->List(command.options);
  command.options.HasNoEffect(
      "fps", "on a single picture; name a clip or a sequence in --out",
      [values = values.get()] { return !values->outs->empty() && AreStills(*values->outs); });
  command.positionals = {"source"};
  command.reads = {"source", "verify"};
  command.run = [values, pools](options::OptionList& list) {
    if (!values->verify->empty()) return Verify(*values->verify, *values);
    ApplyRviz(values->rviz, ToPictureSpec(values->view).height, list);
    Render(*values, *pools);
    return 0;
  };
  command.outputs = [values] { return OutputsOf(*values); };
  command.failure = "the file does not show what it says";
  return command;
}

}  // namespace kinescope::app
