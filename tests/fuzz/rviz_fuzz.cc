// Any text as a configuration of RViz: a reason with the file, or options that can be set.
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/system/check.h"
#include "core/system/errors.h"
#include "server/picture/rviz_file.h"
#include "server/picture/view_options.h"

namespace rviz_fuzz {

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinescope;
  const std::string text(reinterpret_cast<const char*>(data), size);
  app::RvizPicture picture;
  try {
    picture = app::ParseRvizFile("saved.rviz", text, 720);
  } catch (const UsageError& error) {
    KINESCOPE_CHECK(std::string(error.what()).rfind("saved.rviz:", 0) == 0);
    return 0;
  }
  app::ViewOptions view;
  options::OptionList list;
  view.List(list);
  for (const app::RvizPicture::Setting& setting : picture.settings) {
    options::Option* const option = list.Find(setting.option);
    KINESCOPE_CHECK(option != nullptr);
    list.Set(*option, setting.option, {setting.text}, options::Channel::kFile);
  }
  list.CheckEffects();
  for (const std::string& remark : picture.remarks) {
    KINESCOPE_CHECK(remark.find('\n') == std::string::npos &&
                    remark.find('\x1b') == std::string::npos);
  }
  return 0;
}

}  // namespace rviz_fuzz
