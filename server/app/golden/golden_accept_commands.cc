// `kinescope golden accept | update`: from now on, this is the picture.
#include <memory>

#include "core/system/scratch_folder.h"
#include "server/app/golden/accept_lock.h"
#include "server/app/golden/golden_accept.h"
#include "server/app/golden/golden_commands.h"
#include "server/app/golden/golden_update.h"

namespace kinescope::app {
namespace {

struct AcceptOptions {
  options::Text run{"out/golden"}, folder;
  options::Texts only;
  options::Flag takes_other_environment;
};

int AcceptAll(const AcceptOptions& options) {
  RefuseToAcceptInCi();
  return AcceptRun(
      {*options.run, *options.only, *options.folder, *options.takes_other_environment});
}

struct UpdateOptions {
  GoldenCaseOptions cases;
  options::Text pictures;
  GoldenJobOptions jobs;
};

int UpdateAll(const UpdateOptions& options) {
  RefuseToAcceptInCi();
  const AcceptLock lock(*options.cases.folder);
  if (!options.pictures->empty()) {
    GoldenSuite all = FindGoldenSuite(*options.cases.folder, {});
    MovePictures(all, *options.pictures);
  }
  const GoldenSuite suite = options.cases.Find();
  const ScratchFolder drawn;
  CheckSettings settings;
  settings.out = drawn.path();
  settings.keeps_all = true;
  return UpdateSuite(suite, options.jobs.Start(*options.cases.folder, suite.cases.size(), settings),
                     drawn.path());
}

}  // namespace

Command GoldenAcceptCommand() {
  const auto values = std::make_shared<AcceptOptions>();
  Command accept;
  accept.name = "accept";
  accept.about = "Takes the new pictures of a run of golden check, without drawing them again";
  accept.options("run", values->run, "folder that golden check has left (its --out)");
  accept.options("case", values->only, "cases to take; default: all that are not the same");
  accept.options("folder", values->folder, "folder of the cases; default: that of the run");
  accept.options("other_environment", values->takes_other_environment,
                 "take pictures that were drawn with another driver or font than the others");
  accept.positionals = {"run", "case"};
  accept.footer =
      "Works on another machine than the run, too: it takes a picture only if the case, its inputs "
      "and the picture accepted before are those of the run.\n"
      "Exit code: 0 all are taken, 2 one is not. Refused where CI is set.";
  accept.run = [values](options::OptionList&) { return AcceptAll(*values); };
  return accept;
}

Command GoldenUpdateCommand() {
  const auto values = std::make_shared<UpdateOptions>();
  Command update;
  update.name = "update";
  update.about = "Draws every case and accepts it as it is; writes only what has changed";
  values->cases.List(update.options);
  values->jobs.List(update.options);
  update.options("pictures", values->pictures,
                 "folder in which the accepted pictures lie from now on, such as one in Git LFS; "
                 "golden.lock names it to the other commands. Default: beside the cases");
  update.positionals = {"folder", "case"};
  update.footer = "Exit code: 0 all are accepted, 2 a case is not. Refused where CI is set.";
  update.run = [values](options::OptionList&) { return UpdateAll(*values); };
  return update;
}

}  // namespace kinescope::app
