/// The commands of `kinescope golden`, and what they have in common.
#pragma once

#include "server/app/command.h"
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
