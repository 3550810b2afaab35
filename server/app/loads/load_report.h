/// Writes the report of a trial: one A4 page per person, as self-contained HTML (embedded pictures,
/// no scripts, no external files) or as PDF of the same page. Equal input gives equal bytes. One
/// thread.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "server/app/loads/load_summary.h"
#include "server/app/loads/load_trial.h"
#include "server/app/loads/report_page.h"
#include "server/app/loads/sensitivity.h"
#include "server/options/option_list.h"
#include "server/picture/backend.h"
#include "server/source/source_identity.h"

namespace kinescope::app {

/// To be called before the recording is read.
/// @throws UsageError for an ending that is neither .html, .htm nor .pdf, and for .pdf without the
/// program that makes it.
void CheckReportName(const std::string& path);

/// `options`: those of the command, with the ways in which they were set.
ReportOrigin OriginOf(const std::string& source, const SourceIdentity& identity,
                      const options::OptionList& options);

/// What the further runs say about a person, by character.
using SensitivityRows = std::function<std::vector<SensitivityRow>(int character)>;

/// @pre trials keep their curves; CheckReportName(path)
/// @throws std::runtime_error with the path and the reason; RenderError.
void WriteReport(const std::map<int, LoadTrial>& trials, const TrialContext& context,
                 const ReportOrigin& origin, const SensitivityRows& sensitivity,
                 const BackendOptions& backend, const std::filesystem::path& path);

}  // namespace kinescope::app
