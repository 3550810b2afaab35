// Any text as a YAML file of options, those of a golden case: a reason with file and line, or
// values in their ranges.
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/system/check.h"
#include "core/system/errors.h"
#include "server/app/golden/golden_case.h"
#include "server/options/yaml_options.h"
#include "server/scene/scene_reader.h"

namespace yaml_options_fuzz {

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinescope;
  app::GoldenCase golden_case;
  options::OptionList list;
  golden_case.List(list);
  try {
    const std::string text(reinterpret_cast<const char*>(data), size);
    options::YamlOptions("case.yaml", text).SetAll(list);
    list.CheckEffects();
  } catch (const UsageError& error) {
    KINESCOPE_CHECK(error.what()[0] != '\0');
    return 0;
  }
  KINESCOPE_CHECK(*golden_case.time >= 0 && *golden_case.time <= app::kLatestSecs);
  return 0;
}

}  // namespace yaml_options_fuzz
