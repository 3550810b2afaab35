/// Describes where a picture came from: everything that determines its pixels, as JSON, in the file
/// and beside it. Two files with equal provenance show the same. An object belongs to one thread at
/// a time; the functions have no state.
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

/// 2: inputs are those that the options read. 1: they were guessed from texts of options.
inline constexpr int kProvenanceSchema = 2;

/// The keyword of a PNG's text chunk. Clips have it as their comment.
inline constexpr const char* kProvenanceKey = "Kinescope";

/// The part that all outputs of one source share. Computes the SHA-256 of the source and of every
/// file in the options. @throws SourceError.
class Provenance {
 public:
  Provenance(const RenderOptions& options, const std::string& source,
             const render::RendererInfo& renderer);

  /// Everything that determines the pixels of `output`. `number`: one picture of a sequence.
  Json Of(const Output& output, std::optional<long> number = {}) const;

  /// Whether the source can be read again and is identified by its content: false for a pipe and
  /// for standard input.
  bool is_repeatable() const { return is_repeatable_; }

 private:
  const RenderOptions& options_;
  Json shared_;
  bool is_repeatable_ = true;
};

Json Describe(const render::Camera& camera);

/// The options that gave `provenance`, with one output named `path`.
/// @throws std::runtime_error for a provenance of another program or of a newer version.
RenderOptions OptionsOf(const Json& provenance, const std::string& path);

/// As text for a file: ASCII, one line.
std::string ToText(const Json& provenance);
/// Parses such a text; nullopt if it is not a provenance.
std::optional<Json> FromText(const std::string& text);

/// Whether two provenances describe the same pixels; ignores values that follow from others
/// (camera, size of the file, ...).
[[nodiscard]] bool DecideTheSame(const Json& a, const Json& b);

/// The provenance in the file `path`; nullopt if it has none, is missing or is not a picture.
std::optional<Json> ReadEmbedded(const std::string& path);

/// The path of the sidecar file of an output: FILE.json.
std::string SidecarOf(const std::string& path);
std::optional<Json> ReadSidecar(const std::string& path);
/// Writes FILE.json: `provenance`, the path of the source, the number of pictures and, except for a
/// sequence, size and SHA-256 of the finished file. @throws std::runtime_error.
void WriteSidecar(const Output& output, Json provenance, const std::string& source, long pictures);

/// Whether the file of `output` exists, is complete and was rendered with `provenance`.
[[nodiscard]] bool IsFinished(const Output& output, const Json& provenance, bool has_sidecar);

}  // namespace kinescope::app
