// `kinescope golden`: its commands.
#include "server/app/commands.h"
#include "server/app/golden/golden_commands.h"

namespace kinescope::app {

void GoldenCaseOptions::List(options::OptionList& option) {
  option("folder", folder, "folder with <case>.yaml, <case>.png and golden.lock");
  option("case", only, "cases to use; default: all");
}

GoldenSuite GoldenCaseOptions::Find() const { return FindGoldenSuite(*folder, *only); }

Command GoldenCommand() {
  Command command;
  command.name = "golden";
  command.about = "Compares pictures with the accepted ones";
  command.parts = {GoldenCheckCommand(),  GoldenReviewCommand(), GoldenAcceptCommand(),
                   GoldenUpdateCommand(), GoldenNewCommand(),    GoldenKeysCommand(),
                   GoldenListCommand(),   GoldenStressCommand(), GoldenCompareCommand()};
  return command;
}

}  // namespace kinescope::app
