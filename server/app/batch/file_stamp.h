/// What the file system knows of the files of a job, to see cheaply whether they are the same as
/// before. Reads the file system; any thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/app/command.h"

namespace kinescope::app {

struct FileStamp {
  std::string path;
  std::int64_t files = 0;  // 0: nothing is there; of a folder, those in it and in its folders
  std::int64_t bytes = 0;  // of all of them
  std::int64_t modified_nanos = 0;  // of the newest, since 1970

  bool operator==(const FileStamp& other) const {
    return path == other.path && files == other.files && bytes == other.bytes &&
           modified_nanos == other.modified_nanos;
  }
};

/// Of a file or a folder.
FileStamp StampOf(const std::string& path);

/// Of an output; of numbered files all that are there from number 0 on.
FileStamp StampOf(const DeclaredOutput& output);

/// SHA-256: of a file, its content; of several, of a line "<SHA-256>  <name>" for each, in the
/// order of their names. @throws SourceError
std::string HashOf(const DeclaredOutput& output);

}  // namespace kinescope::app
