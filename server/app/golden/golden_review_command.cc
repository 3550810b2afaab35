// `kinescope golden review`: decides about the pictures of a run, on a page of this machine.
#include <cstddef>
#include <memory>
#include <string>

#include "core/system/standard_streams.h"
#include "core/system/stop_signal.h"
#include "core/system/words.h"
#include "server/app/golden/golden_commands.h"
#include "server/app/golden/golden_report_text.h"
#include "server/app/golden/golden_review.h"
#include "server/app/golden/golden_review_site.h"
#include "server/app/golden/golden_update.h"
#include "server/app/print.h"
#include "server/app/shell_word.h"
#include "server/http/local_server.h"

namespace kinescope::app {
namespace {

struct ReviewOptions {
  options::Text run{"out/golden"}, folder;
  options::Whole port{0, {0, 65535, "", false, "0: a free one"}};
  options::Flag takes_other_environment;
};

// `folder`: as it was given.
int PrintDecisions(const GoldenReview& review, const std::string& folder) {
  for (const CaseVerdict* each : review.cases()) {
    Print("{:<24} {}\n", each->name, Name(review.Of(*each)));
  }
  for (const CaseVerdict* each : review.others()) {
    Print("{:<24} has no picture to decide about\n  {}\n", each->name, FirstLine(*each));
  }
  const std::size_t accepted = review.Count(Decision::kAccepted),
                    rejected = review.Count(Decision::kRejected),
                    later = review.Count(Decision::kLater),
                    undecided = review.Count(Decision::kUndecided);
  Print("{} accepted, {} rejected, {} for later, {} undecided\n", accepted, rejected, later,
        undecided);
  if (later + undecided > 0) {
    Print("To continue: kinescope golden review {}{}\n", ShellWord(review.run_folder().string()),
          folder.empty() ? "" : " --folder " + ShellWord(folder));
  }
  return accepted == review.cases().size() && review.others().empty() ? 0 : 1;
}

void ServeReview(GoldenReview& review, int port) {
  http::LocalServer server(port, "--port");
  ReviewSite site(review, server.token());
  Print("{}\n", server.url());
  Print("{} to decide about for {}; end with Ctrl-C\n", Counted(review.cases().size(), "picture"),
        review.folder().string());
  FlushStandardOutput();
  server.Serve([&](const http::LocalRequest& request) { return site.Handle(request); },
               [&] { return site.has_ended() || StopRequested(); });
}

int ReviewRun(const ReviewOptions& options) {
  RefuseToAcceptInCi();
  GoldenReview review({*options.run, {}, *options.folder, *options.takes_other_environment});
  if (review.cases().empty()) {
    Print("The run has nothing to review: every case that was drawn is the same\n");
  } else {
    ServeReview(review, static_cast<int>(*options.port));
  }
  return PrintDecisions(review, *options.folder);
}

}  // namespace

Command GoldenReviewCommand() {
  const auto values = std::make_shared<ReviewOptions>();
  Command review;
  review.name = "review";
  review.about = "Shows the report of a run in a browser, where each picture is accepted by a key";
  review.options("run", values->run, "folder that golden check has left (its --out)");
  review.options("folder", values->folder, "folder of the cases; default: that of the run");
  review.options("port", values->port, "TCP port of the page on 127.0.0.1");
  review.options("other_environment", values->takes_other_environment,
                 "accept pictures that were drawn with another driver or font than the others");
  review.positionals = {"run"};
  review.footer =
      "Prints the address of the page, which only this machine can open. Keys of the page: A "
      "accept, R reject, L later, U undo, J and K next and previous, F finish.\n"
      "Accepting takes a picture at once, as golden accept does. What is rejected or left for "
      "later is kept in RUN/review.json.\n"
      "Ends with F if all is decided, or with Ctrl-C. Exit code: 0 all are accepted, 1 one is "
      "rejected, left or has no picture, 2 error. Refused where CI is set.";
  review.run = [values](options::OptionList&) { return ReviewRun(*values); };
  return review;
}

}  // namespace kinescope::app
