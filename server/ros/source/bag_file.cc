#include "server/ros/source/bag_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "core/system/errors.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::string_view kBagBegins = "#ROSBAG V";
constexpr std::size_t kBlockBytes = 1 << 18;

SourceError Error(const std::string& path, const std::string& what) {
  return SourceError("bag '" + path + "': " + what);
}

int OpenTemporary(const std::string& for_path) {
  std::error_code failed;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(failed);
  std::string name = (folder / "kinescope-bag-XXXXXX").string();
  const int file = failed ? -1 : mkostemp(name.data(), O_CLOEXEC);
  if (file < 0) {
    const std::string why = failed ? failed.message() : std::strerror(errno);
    throw Error(for_path,
                "is compressed, and no temporary file can be created (" + why +
                    "); decompress it first, or set TMPDIR to a folder with write permission");
  }
  unlink(name.c_str());
  return file;
}

bool WriteAll(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

BagFile::BagFile(const std::string& path) : path_(path) {
  InputFile file = OpenInputFile(path);
  if (file.head().substr(0, kBagBegins.size()) != kBagBegins) {
    throw Error(path, "not a ROS 1 bag; convert a ROS 2 bag with rosbags-convert");
  }
  if (file.is_packed()) Unpack(std::move(file));
}

BagFile::Descriptor::~Descriptor() {
  if (number >= 0) close(number);
}

void BagFile::Unpack(InputFile packed) {
  unpacked_.number = OpenTemporary(path_);
  std::vector<char> block(kBlockBytes);
  while (const std::size_t size = std::fread(block.data(), 1, block.size(), packed.get())) {
    if (!WriteAll(unpacked_.number, {block.data(), size})) {
      throw Error(path_, std::string("cannot be decompressed to a temporary file (") +
                             std::strerror(errno) +
                             "); decompress it first, or set TMPDIR to a larger disk");
    }
  }
  if (std::ferror(packed.get()) != 0) {
    throw Error(path_,
                "cannot be decompressed: " + packed.failure() + "; copy it again from its origin");
  }
  path_ = "/proc/self/fd/" + std::to_string(unpacked_.number);
}

}  // namespace kinescope::ros_bridge
