// `kinescope golden`: its commands.
#include <algorithm>
#include <cstdint>

#include "render/renderer.h"
#include "server/app/commands.h"
#include "server/app/golden/golden_commands.h"
#include "server/picture/cores.h"

namespace kinescope::app {

void GoldenCaseOptions::List(options::OptionList& option) {
  option("folder", folder, "folder with <case>.yaml, <case>.png and golden.lock");
  option("case", only, "cases to use; default: all");
}

void GoldenJobOptions::List(options::OptionList& option) {
  backend.List(option);
  option("jobs", jobs,
         "cases that are drawn at a time; each in a process of its own; 0: one per core");
  option("case_limit_secs", case_limit_secs,
         "time after which a case is given up as one that hangs");
}

JobSettings GoldenJobOptions::Start(const std::string& folder, std::size_t cases,
                                    const CheckSettings& check) const {
  JobSettings settings;
  const std::int64_t asked = *jobs > 0 ? *jobs : CoresHere();
  settings.jobs = static_cast<int>(
      std::max<std::int64_t>(1, std::min(asked, static_cast<std::int64_t>(cases))));
  settings.limit_secs = *case_limit_secs;
  settings.command = CommandOfJobs(folder, check, backend);
  render::UseFillingThreads(FillingThreads(CoresHere(), settings.jobs));
  return settings;
}

GoldenSuite GoldenCaseOptions::Find() const { return FindGoldenSuite(*folder, *only); }

Command GoldenCommand() {
  Command command = CommandNamed("golden");
  command.parts = {GoldenCheckCommand(),  GoldenReviewCommand(), GoldenAcceptCommand(),
                   GoldenUpdateCommand(), GoldenNewCommand(),    GoldenKeysCommand(),
                   GoldenListCommand(),   GoldenStressCommand(), GoldenCompareCommand()};
  return command;
}

}  // namespace kinescope::app
