#include "core/system/not_source.h"

#include <filesystem>
#include <system_error>

#include "core/system/errors.h"

namespace kinescope {

void CheckIsNotSource(const std::string& source, const std::string& path,
                      const std::string& given) {
  std::error_code ignored;  // equivalent() minds files that are not there
  if (!std::filesystem::equivalent(source, path, ignored)) return;
  throw UsageError(given + ": output and source are the same file; choose another name");
}

}  // namespace kinescope
