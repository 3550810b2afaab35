#include "server/picture/rviz_option.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <string>

#include "server/picture/rviz_file.h"

namespace kinescope::app {
namespace {

using options::Channel;

// A view belongs together: the field of view of a file is not that of a camera that was given.
bool IsPartOfView(const std::string& option) {
  return option == "camera" || option == "fov" || option == "projection";
}

}  // namespace

void ApplyRviz(const options::FilePath& file, int height_px, options::OptionList& list) {
  if (!file.IsGiven()) return;
  const RvizPicture picture = ReadRvizFile(*file, height_px);
  const options::Option* const camera = list.Find("camera");
  const bool has_camera = camera != nullptr && camera->channel != Channel::kDefault;
  std::string missing;
  for (const RvizPicture::Setting& setting : picture.settings) {
    options::Option* const option = list.Find(setting.option);
    if (option == nullptr) {
      missing += (missing.empty() ? "" : ", ") + setting.option;
    } else if (option->channel == Channel::kDefault &&
               !(has_camera && IsPartOfView(setting.option))) {
      const std::string origin = fmt::format("{}:{}: ", *file, setting.line);
      list.Set(*option, setting.option, {setting.text, origin}, Channel::kFile);
    }
  }
  for (const std::string& remark : picture.remarks) spdlog::warn("{}", remark);
  if (!missing.empty()) spdlog::warn("{}: {}: only render takes this", *file, missing);
  list.CheckEffects();
}

}  // namespace kinescope::app
