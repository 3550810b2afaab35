/// Decides which outputs, and which pictures of a sequence, are up to date and need not be rendered
/// again. Reads files. One thread.
#pragma once

#include "server/app/render/output_plan.h"
#include "server/app/render/provenance.h"
#include "server/app/render/run_settings.h"

namespace kinescope::app {

class ResumeCheck {
 public:
  /// `provenance` is borrowed.
  ResumeCheck(const Provenance& provenance, const RunSettings& settings);

  /// Whether the file of `output` exists, is complete and shows what this run would render. Always
  /// false for a sequence, whose pictures are checked one by one.
  [[nodiscard]] bool IsUpToDate(const Output& output) const;

  /// Whether picture `k` of a clip or a sequence is to be rendered. @pre !IsUpToDate(output)
  [[nodiscard]] bool Wants(const Output& output, long k) const;

 private:
  const Provenance& provenance_;
  const RunSettings settings_;
  const bool may_skip_;
};

}  // namespace kinescope::app
