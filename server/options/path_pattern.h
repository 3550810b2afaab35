/// Patterns of file names, as shells know them: *, ? and [a-z]. Reads the file system; any thread.
#pragma once

#include <string>
#include <vector>

namespace kinescope::options {

/// The files and folders that match, sorted by name; none if nothing does.
std::vector<std::string> FilesMatching(const std::string& pattern);

/// The pattern that only `name` matches.
std::string PatternOfName(const std::string& name);

}  // namespace kinescope::options
