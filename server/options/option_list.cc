#include "server/options/option_list.h"

namespace kinescope::app {

YamlValues::YamlValues(const std::string& path) : path_(path) {
  try {
    root_ = YAML::LoadFile(path);
  } catch (const YAML::BadFile&) {
    throw UsageError("--config=" + path + ": no such file, or it may not be read");
  } catch (const YAML::Exception& error) {
    throw UsageError("--config=" + path + ": line " + std::to_string(error.mark.line + 1) + ": " +
                     error.msg);
  }
  if (!root_.IsMap()) throw UsageError("--config=" + path + ": expected lines of 'name: value'");
}

std::optional<std::string> YamlValues::operator()(const std::string& name) const {
  const YAML::Node value = root_[name];
  if (!value) return std::nullopt;
  if (!value.IsScalar()) throw UsageError(path_ + ": " + name + ": expected one value");
  return value.Scalar();
}

void YamlValues::RefuseUnknown(const std::set<std::string>& known) const {
  for (const auto& entry : root_) {
    const std::string key = entry.first.Scalar();
    if (known.count(key) > 0) continue;
    throw UsageError(path_ + ": line " + std::to_string(entry.first.Mark().line + 1) +
                     ": no option is called '" + key + "' (see --help)");
  }
}

}  // namespace kinescope::app
