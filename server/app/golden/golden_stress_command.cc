// `kinescope golden stress`: are the pictures the same everywhere?
#include <memory>

#include "server/app/golden/golden_commands.h"
#include "server/app/golden/golden_stress.h"

namespace kinescope::app {
namespace {

struct StressOptions {
  GoldenCaseOptions cases;
  options::Whole rounds{1, {1, 1000, ""}};
  BackendOptions backend;
};

}  // namespace

Command GoldenStressCommand() {
  const auto values = std::make_shared<StressOptions>();
  Command stress;
  stress.name = "stress";
  stress.about =
      "Draws the cases under other circumstances, none of which may change a byte: numbers of "
      "threads, locale, time zone, working folder, read-only home, lowest priority";
  values->cases.List(stress.options);
  stress.options("rounds", values->rounds, "how often each circumstance is tried");
  stress.options("backend", values->backend.backend, "OpenGL back-end that draws");
  stress.positionals = {"folder", "case"};
  stress.footer = "Exit code: 0 the same bytes, 1 a picture differs, 2 a case could not be drawn.";
  stress.run = [values](options::OptionList&) {
    return StressSuite({*values->cases.folder, *values->cases.only, *values->backend.backend,
                        static_cast<int>(*values->rounds)});
  };
  return stress;
}

}  // namespace kinescope::app
