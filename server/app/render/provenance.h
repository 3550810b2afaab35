/// Describes where a picture came from: everything that determines its pixels, as JSON. Two files
/// with equal provenance show the same. Files of provenance: provenance_files.h. An object belongs
/// to one thread at a time; the functions have no state.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "server/app/ordered_json.h"
#include "server/app/render/output_plan.h"
#include "server/app/render/render_options.h"

namespace kinescope::app {

/// 3: pictures of limbs and legends as they are now. 2: inputs are those that the options read. 1:
/// they were guessed from texts of options.
inline constexpr int kProvenanceSchema = 3;

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

/// The options that gave `provenance`, with one output named `path`. Former names of options are
/// read as their present ones; unknown ones are ignored.
/// @throws std::runtime_error for a provenance of another program or of a newer version.
RenderOptions OptionsOf(const Json& provenance, const std::string& path);

/// The options in `provenance` that this version does not know.
std::vector<std::string> UnknownOptionsOf(const Json& provenance);

/// The present name of an option of a provenance with this schema; `former_name` itself if there is
/// none.
std::string PresentNameOf(const std::string& former_name, int schema);

/// Whether each picture depends on the length of the clip or sequence: its plot shows all of it, or
/// its camera makes one turn or fits all of it.
bool DependsOnWholeClip(const ViewOptions& options);

/// As text for a file: ASCII, one line.
std::string ToText(const Json& provenance);
/// Parses such a text; nullopt if it is not a provenance.
std::optional<Json> FromText(const std::string& text);

}  // namespace kinescope::app
