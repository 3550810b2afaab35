/// The commands of `kinescope golden`, and what they have in common.
#pragma once

#include <cstddef>
#include <string>

#include "server/app/command.h"
#include "server/app/golden/golden_check.h"
#include "server/app/golden/golden_jobs.h"
#include "server/app/golden/golden_suite.h"
#include "server/options/option_list.h"
#include "server/picture/backend.h"

namespace kinescope::app {

/// Which cases are meant.
struct GoldenCaseOptions {
  options::Text folder{"golden_images"};
  options::Texts only;

  void List(options::OptionList& option);
  /// @throws as FindGoldenSuite().
  GoldenSuite Find() const;
};

/// How cases are drawn: several at a time, each in a process of its own.
struct GoldenJobOptions {
  options::Whole jobs{0, {0, 64, ""}};
  options::Number case_limit_secs{120, {0.1, 86'400, "s"}};
  BackendOptions backend;

  void List(options::OptionList& option);
  /// For so many cases of `folder`. Tells the processes how many threads each may fill pixels with.
  JobSettings Start(const std::string& folder, std::size_t cases, const CheckSettings& check) const;
};

Command GoldenCheckCommand();
Command GoldenAcceptCommand();
Command GoldenReviewCommand();
Command GoldenUpdateCommand();
Command GoldenNewCommand();
Command GoldenKeysCommand();
Command GoldenListCommand();
Command GoldenStressCommand();
Command GoldenCompareCommand();

}  // namespace kinescope::app
