// JSON files of loads, which a study reads from folders of anyone.
#include <cstddef>
#include <cstdint>
#include <exception>
#include <string_view>

#include "core/system/check.h"
#include "server/app/study/study.h"
#include "server/app/study/trial_loads.h"

namespace trial_loads_fuzz {

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinescope::app;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  KindOfReason(std::string(text));
  try {
    for (const PersonLoads& person : ParseTrialLoads(text).people) {
      KINESCOPE_CHECK(person.joints.size() == 15);
    }
  } catch (const std::exception&) {
  }
  return 0;
}

}  // namespace trial_loads_fuzz
