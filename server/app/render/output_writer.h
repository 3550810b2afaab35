/// Writes one output of a run: its pictures, their metadata, and the sidecar. One thread calls it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "render/camera/camera.h"
#include "render/video.h"
#include "server/app/render/draw_pool.h"
#include "server/app/render/output_plan.h"
#include "server/app/render/output_sink.h"
#include "server/app/render/provenance.h"
#include "server/app/render/render_options.h"
#include "server/app/render/run_settings.h"

namespace kinescope::app {

struct OutputResult {
  std::string out;
  OutputKind kind = OutputKind::kStill;
  long pictures = 0;          // of the output
  long drawn = 0;             // of these, rendered in this run; the others were up to date
  double secs = 0;            // duration of the clip or sequence, s
  double took_secs = 0;       // time to render and write them, s
  std::uint32_t counter = 0;  // sample counter of a still
};

/// What the outputs of a run have in common. All of it is borrowed.
struct RunContext {
  const RenderOptions& options;
  const std::string& source;
  const RunSettings& settings;
  const Provenance& provenance;
  const TimeGrid& grid;
};

class OutputWriter {
 public:
  /// `is_up_to_date`: nothing is written. @throws UsageError, std::runtime_error for a clip that
  /// cannot be written or encoded, before its first picture is rendered.
  OutputWriter(const RunContext& run, Output output, bool is_up_to_date);
  OutputWriter(const OutputWriter&) = delete;
  OutputWriter& operator=(const OutputWriter&) = delete;

  const Output& output() const { return output_; }
  bool is_still() const { return output_.kind == OutputKind::kStill; }
  bool is_up_to_date() const { return is_up_to_date_; }

  /// Pictures of a clip must be added in order. `heading_note`: how its cameras are turned; that of
  /// the first picture is logged and recorded. @throws the error of an earlier picture.
  void Put(long k, const FuturePicture& picture, const render::Camera& camera,
           const std::string& heading_note);
  /// The sample counter of a still.
  void SetCounter(std::uint32_t counter) { result_.counter = counter; }

  /// Waits until the output is complete, then writes its sidecar. `clip_pictures`: the number of
  /// pictures of a clip or sequence. @throws std::runtime_error with the file and the reason.
  void Finish(long clip_pictures);

  const OutputResult& result() const { return result_; }

 private:
  std::unique_ptr<OutputSink> MakeSink() const;
  void AddCamera(Json camera, Json& provenance) const;
  std::map<std::string, std::string> MetadataFor(const render::Camera& camera, long k) const;

  const RunContext run_;
  const Output output_;
  const bool is_up_to_date_;
  OutputResult result_;
  Json first_camera_;
  std::string heading_note_;
  std::unique_ptr<OutputSink> sink_;  // from the first picture on; last: its threads use the others
};

}  // namespace kinescope::app
