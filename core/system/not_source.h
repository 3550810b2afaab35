/// Keeps commands from replacing the file that they read. Reads the file system; any thread.
#pragma once

#include <string>

namespace kinescope {

/// @throws UsageError that begins with `given` ("--csv=a.mvnx") if `path` is the file `source`,
/// also under another name. "-", addresses and files that do not exist are none.
void CheckIsNotSource(const std::string& source, const std::string& path, const std::string& given);

}  // namespace kinescope
