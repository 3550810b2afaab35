#include "server/app/render/output_writer.h"

#include <spdlog/spdlog.h>

#include <optional>
#include <utility>

#include "server/app/render/provenance_files.h"
#include "server/picture/camera_json.h"

namespace kinescope::app {
namespace {

render::VideoOptions PackingOf(const RunContext& run, const Output& output) {
  render::VideoOptions options;
  options.rate = run.grid.rate;
  if (HasCrf(output.path) && run.options.pack.crf) {
    options.crf = static_cast<int>(*run.options.pack.crf);
  }
  options.encoding = run.options.pack.encoding;
  options.quality = static_cast<int>(*run.options.pack.quality);
  options.alpha = run.options.view.background->is_transparent;
  return options;
}

}  // namespace

OutputWriter::OutputWriter(const RunContext& run, Output output, bool is_up_to_date)
    : run_(run),
      output_(std::move(output)),
      is_up_to_date_(is_up_to_date),
      result_{output_.path, output_.kind} {
  if (is_up_to_date && run.settings.sidecar) {
    const Json pictures =
        ReadSidecar(output_.path).value_or(Json::object()).value("pictures", Json());
    if (pictures.is_number_integer()) result_.pictures = pictures.get<long>();
  }
  if (output_.kind == OutputKind::kClip && !is_up_to_date) {
    const render::PictureSpec spec = ToPictureSpec(run.options.view);
    render::MakeVideoWriter(output_.path, spec.width, spec.height, PackingOf(run, output_));
  }
}

void OutputWriter::Put(long k, const FuturePicture& picture, const render::Camera& camera,
                       const std::string& heading_note) {
  if (sink_ == nullptr) {
    first_camera_ = CameraJson(camera);
    heading_note_ = heading_note;
    if (!heading_note_.empty()) spdlog::warn("{}: {}", output_.path, heading_note_);
    sink_ = MakeSink();
  }
  sink_->Put(k, picture, camera);
  ++result_.drawn;
}

std::unique_ptr<OutputSink> OutputWriter::MakeSink() const {
  const MetadataOf metadata = [this](const render::Camera& camera, long k) {
    return MetadataFor(camera, k);
  };
  const render::PictureSpec spec = ToPictureSpec(run_.options.view);
  const double px_per_m = spec.print.PixelsPerMetre(spec.width);
  switch (output_.kind) {
    case OutputKind::kStill:
      return MakePngSink(output_.path, 1, metadata, LayerPathOf(run_.options, output_), px_per_m);
    case OutputKind::kSequence:
      // Compressing a picture may take longer than drawing it.
      return MakePngSink(output_.path, run_.settings.jobs + 1, metadata, "", px_per_m);
    case OutputKind::kClip: break;
  }
  return MakeClipSink(output_.path, spec, PackingOf(run_, output_), metadata);
}

void OutputWriter::AddCamera(Json camera, Json& provenance) const {
  provenance["camera"] = std::move(camera);
  if (!heading_note_.empty()) provenance["camera_note"] = heading_note_;
}

// On the threads of the sink.
std::map<std::string, std::string> OutputWriter::MetadataFor(const render::Camera& camera,
                                                             long k) const {
  const bool is_numbered = output_.kind == OutputKind::kSequence;
  Json provenance =
      run_.provenance.Of(output_, is_numbered ? std::optional<long>(k) : std::nullopt);
  AddCamera(CameraJson(camera), provenance);
  std::map<std::string, std::string> text;
  if (!run_.options.view.title->empty()) {
    text[output_.kind == OutputKind::kClip ? "title" : "Title"] = *run_.options.view.title;
  }
  if (output_.kind == OutputKind::kClip) {
    text["comment"] = ToText(provenance);
    return text;
  }
  text["Software"] = "Kinescope " KINESCOPE_VERSION;
  text["Source"] = provenance.at("source").at("name");
  text["Camera"] = output_.camera;
  text["Renderer"] = provenance.at("renderer");
  text[kProvenanceKey] = ToText(provenance);
  return text;
}

void OutputWriter::Finish(long clip_pictures) {
  if (is_up_to_date_) return;
  if (sink_ != nullptr) sink_->Finish();
  result_.pictures = is_still() ? 1 : clip_pictures;
  result_.secs = is_still() ? 0 : static_cast<double>(run_.grid.rate.NanosOf(clip_pictures)) * 1e-9;
  if (!run_.settings.sidecar || run_.settings.only_picture || result_.drawn == 0) return;
  Json provenance = run_.provenance.Of(output_);
  AddCamera(first_camera_, provenance);
  WriteSidecar(output_, std::move(provenance), run_.source, result_.pictures);
}

}  // namespace kinescope::app
