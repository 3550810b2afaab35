// `kinescope golden compare`: two pictures of any origin.
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "core/system/json_text.h"
#include "server/app/golden/golden_commands.h"
#include "server/app/golden/golden_compare.h"
#include "server/app/print.h"

namespace kinescope::app {
namespace {

struct CompareOptions {
  options::Text one, other, out;
  options::Flag json;
};

int Compare(const CompareOptions& options) {
  const PictureVerdict verdict = ComparePictures(*options.one, *options.other, *options.out);
  if (*options.json) {
    Print("{}\n", JsonText(ToJson(verdict)));
  } else {
    for (const std::string& line : LinesOf(verdict)) Print("{}\n", line);
  }
  return verdict.is_same ? 0 : 1;
}

}  // namespace

Command GoldenCompareCommand() {
  const auto values = std::make_shared<CompareOptions>();
  Command compare;
  compare.name = "compare";
  compare.about = "Compares two PNG pictures by pixels, structure and light";
  compare.options("one", values->one, "the expected picture, a PNG file");
  compare.options("other", values->other, "the actual picture, a PNG file");
  compare.options("out", values->out,
                  "PNG file of the heat map, written if they differ: changed pixels in yellow to "
                  "dark purple, smoothed edges in blue");
  compare.options("json", values->json, "print the result as JSON");
  compare.positionals = {"one", "other"};
  compare.required = {"one", "other"};
  compare.footer =
      "Exit code: 0 the same pixels or the same to the eye, 1 they differ, 2 they could not be "
      "compared.";
  compare.run = [values](options::OptionList&) { return Compare(*values); };
  return compare;
}

}  // namespace kinescope::app
