/// The report of one person as HTML: one A4 page, laid out with tables and blocks that browsers and
/// PDF converters render alike. Pure functions; any thread.
#pragma once

#include <string>
#include <vector>

#include "server/app/loads/load_summary.h"
#include "server/app/loads/load_trial.h"
#include "server/app/loads/sensitivity.h"

namespace kinescope::app {

struct ReportPicture {
  std::string url;           // data: with the picture
  std::string title, lines;  // plain text below it: bold, and the rest
};

/// How to make the report again, without paths and times of this run.
struct ReportOrigin {
  std::string digest;   // "sha256 ..., 123 bytes", or why there is none
  std::string command;  // with all options that were given
};

struct ReportPage {
  const LoadTrial& trial;  // keeps its curves
  const TrialContext& context;
  const ReportOrigin& origin;
  std::vector<ReportPicture> pictures;
  std::vector<SensitivityRow> sensitivity;
  std::size_t number = 1, count = 1;  // of this page
};

/// The whole document. `pages`: what PageHtml returns, one after the other.
std::string ReportDocument(const TrialContext& context, const std::string& pages);

std::string PageHtml(const ReportPage& page);

}  // namespace kinescope::app
