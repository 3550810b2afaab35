/// Where a picture came from: everything that decides its pixels, as JSON, in the file and beside
/// it. Two files whose provenance is equal show the same. One thread at a time per object; the
/// functions have no state.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "render/camera.h"
#include "render/renderer.h"
#include "server/app/render/output_plan.h"
#include "server/app/render/render_options.h"

namespace kinescope::app {

using Json = nlohmann::ordered_json;

/// The keyword of a PNG's text chunk. Clips have it as their comment.
inline constexpr const char* kProvenanceKey = "Kinescope";

/// What all outputs of one source share: reads the source and every file that an option names, for
/// their SHA-256. @throws SourceError.
class Provenance {
 public:
  Provenance(const RenderOptions& options, const std::string& source,
             const render::RendererInfo& renderer);

  /// What decides the pixels of `output`. `number`: of one picture of a sequence.
  Json Of(const Output& output, std::optional<long> number = {}) const;

  /// Whether the source can be read again and is known by its content: neither a pipe nor
  /// standard input.
  bool is_repeatable() const { return is_repeatable_; }

 private:
  const RenderOptions& options_;
  Json shared_;
  bool is_repeatable_ = true;
};

Json Describe(const render::Camera& camera);

/// Options back from what Of() gave, and one output that is called `path`.
/// @throws std::runtime_error for a provenance of another program or a newer one.
RenderOptions OptionsOf(const Json& provenance, const std::string& path);

/// As text for a file: ASCII, one line.
std::string ToText(const Json& provenance);
/// The other way; nullopt for what is none.
std::optional<Json> FromText(const std::string& text);

/// Whether two tell of the same pixels: without what follows from the rest (camera, size of the
/// file, ...).
[[nodiscard]] bool DecideTheSame(const Json& a, const Json& b);

/// What the file `path` says of itself: nullopt where it says nothing, is missing or no picture.
std::optional<Json> ReadEmbedded(const std::string& path);

/// FILE.json, beside every output.
std::string SidecarOf(const std::string& path);
std::optional<Json> ReadSidecar(const std::string& path);
/// Writes FILE.json: `provenance`, the path of the source, the number of pictures and, unless the
/// output is a sequence, the finished file's size and SHA-256. @throws std::runtime_error.
void WriteSidecar(const Output& output, Json provenance, const std::string& source, long pictures);

/// Whether `output` lies there finished, whole and drawn from `provenance`.
[[nodiscard]] bool IsFinished(const Output& output, const Json& provenance, bool has_sidecar);

}  // namespace kinescope::app
