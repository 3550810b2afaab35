#include "core/system/input_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "core/system/decompressor.h"
#include "core/system/errors.h"
#include "core/system/starts_with.h"
#include "core/system/stop_signal.h"

namespace kinescope {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t kChunkBytes = 64 * 1024;
constexpr std::size_t kLongestMagic = 16;
constexpr int kLookEveryMillis = 100;  // whether the user stops this program

struct Magic {
  std::string_view bytes;
  const char* name;
};

constexpr Magic kPacked[] = {
    {"\x1f\x8b"sv, "gzip"}, {"\xfd\x37zXZ\0"sv, "xz"},     {"\x28\xb5\x2f\xfd"sv, "zstd"},
    {"BZh"sv, "bzip2"},     {"\x04\x22\x4d\x18"sv, "lz4"},
};

const Magic* FindPacking(std::string_view head) {
  const auto* found = std::find_if(std::begin(kPacked), std::end(kPacked), [&](const Magic& magic) {
    return StartsWith(head, magic.bytes);
  });
  return found == std::end(kPacked) ? nullptr : found;
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;

  int get() const { return number_; }

 private:
  int number_;
};

// False if the user stops this program before a pipe has more: what has come is all there will be.
// A signal alone would not tell: it may come just before the program waits, or to another thread.
bool WaitForMore(int descriptor) {
  pollfd file = {descriptor, POLLIN, 0};
  while (poll(&file, 1, kLookEveryMillis) <= 0) {
    if (StopRequested()) return false;
  }
  return true;
}

// Bytes read, 0 at the end, -1 with errno.
ssize_t ReadSome(int descriptor, char* to, std::size_t size) {
  while (WaitForMore(descriptor)) {
    const ssize_t count = read(descriptor, to, size);
    if (count >= 0 || (errno != EINTR && errno != EAGAIN)) return count;
  }
  return 0;
}

Descriptor Open(const std::string& path) {
  const bool is_stdin = path == "-";
  // A named pipe is open before it has a writer; reading waits for one.
  Descriptor file(is_stdin ? dup(STDIN_FILENO)
                           : open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) {
    const int error = errno;
    const char* way_out = "";
    if (error == ENOENT) way_out = "; check the path";
    if (error == EACCES) way_out = "; add read permission (chmod +r), or run as its owner";
    throw SourceError(NameOfInput(path) + ": cannot open the file: " + std::strerror(error) +
                      way_out);
  }
  struct stat about {};
  if (fstat(file.get(), &about) == 0 && S_ISDIR(about.st_mode)) {
    throw SourceError(path + ": is a folder; name a file in it");
  }
  return file;
}

}  // namespace

// What stands behind the FILE: the bytes of the descriptor, unpacked where they are packed.
class InputFile::Content {
 public:
  Content(Descriptor file, std::string name, std::shared_ptr<Notes> notes)
      : file_(std::move(file)), name_(std::move(name)), notes_(std::move(notes)) {}

  /// @throws SourceError when there is nothing to be read.
  void Start() {
    std::string raw_head = ReadHead([this](char* to, std::size_t size) {
      const ssize_t count = ReadSome(file_.get(), to, size);
      if (count < 0) notes_->failure = std::strerror(errno);
      return count;
    });
    const Magic* const packing = FindPacking(raw_head);
    notes_->is_packed = packing != nullptr || lseek(file_.get(), 0, SEEK_CUR) < 0;
    if (packing != nullptr) {
      packing_ = packing->name;
      raw_head_ = std::move(raw_head);
      unpacker_ =
          std::make_unique<Decompressor>([this](const void** bytes) { return ReadPacked(bytes); });
      notes_->head =
          ReadHead([this](char* to, std::size_t size) { return ReadUnpacked(to, size); });
    } else {
      notes_->head = std::move(raw_head);
    }
    if (!notes_->failure.empty() && notes_->head.empty()) {
      throw SourceError(name_ + ": cannot read the file: " + notes_->failure + WayOut());
    }
  }

  ssize_t Read(char* to, std::size_t size) {
    const std::string_view rest = std::string_view(notes_->head).substr(head_given_);
    if (!rest.empty()) {
      const std::size_t count = std::min(size, rest.size());
      std::memcpy(to, rest.data(), count);
      head_given_ += count;
      return static_cast<ssize_t>(count);
    }
    if (!notes_->failure.empty()) {  // met while the head was read
      errno = EIO;
      return -1;
    }
    if (unpacker_ != nullptr) return ReadUnpacked(to, size);
    const ssize_t count = ReadSome(file_.get(), to, size);
    if (count < 0) notes_->failure = std::strerror(errno);
    return count;
  }

 private:
  std::string WayOut() const {
    return packing_.empty() ? "" : "; the " + packing_ + " file is damaged; copy it again";
  }

  // Enough to tell what it is, and no more than comes by itself: a pipe may be slow.
  template <class ReadInto>
  std::string ReadHead(ReadInto&& read_into) {
    std::string head(kHeadBytes, '\0');
    std::size_t size = 0;
    while (size < kLongestMagic) {
      const ssize_t count = read_into(head.data() + size, head.size() - size);
      if (count <= 0) break;
      size += static_cast<std::size_t>(count);
    }
    head.resize(size);
    return head;
  }

  ssize_t ReadPacked(const void** bytes) {
    if (!std::exchange(raw_head_given_, true)) {
      *bytes = raw_head_.data();
      return static_cast<ssize_t>(raw_head_.size());
    }
    *bytes = chunk_.data();
    return ReadSome(file_.get(), chunk_.data(), chunk_.size());
  }

  ssize_t ReadUnpacked(char* to, std::size_t size) {
    const ssize_t count = unpacker_->Read(to, size);
    if (count >= 0) return count;
    notes_->failure = unpacker_->failure();
    errno = EIO;
    return -1;
  }

  Descriptor file_;
  std::string name_;
  std::string packing_;  // "": none
  std::shared_ptr<Notes> notes_;
  std::size_t head_given_ = 0;

  std::unique_ptr<Decompressor> unpacker_;  // null: plain
  std::string raw_head_;                    // shows whether it is compressed
  bool raw_head_given_ = false;
  std::vector<char> chunk_ = std::vector<char>(kChunkBytes);
};

std::string CannotRead(const std::string& path) {
  std::string text = path + ": cannot read this file";
  if (std::filesystem::path(path).is_absolute()) return text;
  std::error_code unknown;
  return text + ", in the folder " + std::filesystem::current_path(unknown).string();
}

InputFile::InputFile(std::FILE* file) : file_(file), notes_(std::make_shared<Notes>()) {}

std::string_view InputFile::head() const { return notes_->head; }

bool InputFile::is_packed() const { return notes_->is_packed; }

std::string InputFile::failure() const {
  if (!notes_->failure.empty()) return notes_->failure;
  return file_ != nullptr && std::ferror(file_.get()) != 0 ? std::strerror(errno) : "";
}

InputFile OpenInputFile(const std::string& path) {
  InputFile input(nullptr);
  auto content = std::make_unique<InputFile::Content>(Open(path), NameOfInput(path), input.notes_);
  content->Start();
  cookie_io_functions_t functions{};
  functions.read = [](void* self, char* to, std::size_t size) {
    return static_cast<InputFile::Content*>(self)->Read(to, size);
  };
  functions.close = [](void* self) {
    delete static_cast<InputFile::Content*>(self);
    return 0;
  };
  input.file_.reset(fopencookie(content.get(), "rb", functions));
  if (input.file_ == nullptr) {
    throw SourceError(NameOfInput(path) + ": cannot open the file: " + std::strerror(errno));
  }
  static_cast<void>(content.release());  // the FILE owns it now
  std::setvbuf(input.file_.get(), nullptr, _IOFBF, kChunkBytes);
  return input;
}

std::string NameOfInput(const std::string& path) { return path == "-" ? "standard input" : path; }

}  // namespace kinescope
