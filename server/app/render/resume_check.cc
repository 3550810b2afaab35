#include "server/app/render/resume_check.h"

#include <stdexcept>

#include "core/system/sha256.h"
#include "server/app/render/provenance_comparison.h"
#include "server/app/render/provenance_files.h"

namespace kinescope::app {
namespace {

// A sidecar knows the file that it was written for; without one, the file speaks for itself.
bool IsWholeFile(const Output& output, const Json& provenance, bool has_sidecar) {
  if (!has_sidecar) {
    const auto embedded = ReadEmbedded(output.path);
    return embedded && DecideTheSame(*embedded, provenance);
  }
  const auto sidecar = ReadSidecar(output.path);
  if (!sidecar || !DecideTheSame(*sidecar, provenance)) return false;
  try {
    const Json file = sidecar->value("file", Json());
    return file.is_object() && file.value("sha256", Json()) == DigestOf(output.path).sha256;
  } catch (const std::runtime_error&) {
    return false;  // the file is gone
  }
}

}  // namespace

ResumeCheck::ResumeCheck(const Provenance& provenance, const RunSettings& settings)
    : provenance_(provenance),
      settings_(settings),
      may_skip_(!settings.force && provenance.is_repeatable()) {}

bool ResumeCheck::IsUpToDate(const Output& output) const {
  return may_skip_ && output.kind != OutputKind::kSequence &&
         IsWholeFile(output, provenance_.Of(output), settings_.sidecar);
}

bool ResumeCheck::Wants(const Output& output, long k) const {
  if (settings_.only_picture && *settings_.only_picture != k) return false;
  if (output.kind == OutputKind::kClip || !may_skip_) return true;
  const auto embedded = ReadEmbedded(PathOfPicture(output.path, k));
  return !embedded || !DecideTheSame(*embedded, provenance_.Of(output, k));
}

}  // namespace kinescope::app
