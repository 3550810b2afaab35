/// A file to read, whatever it is packed in: its content of a file, decompressed on the way
/// where its first bytes are those of gzip, xz, zstd, bzip2 or lz4; its name does not matter. Read
/// from front to back only, so a pipe or standard input will do, and in constant memory however
/// much a file unpacks to. One thread.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace kinescope {

/// An open file and, if reading it fails, why. Movable; closes the file at the end.
class InputFile {
 public:
  /// Takes over `file`, which has no head().
  InputFile(std::FILE* file);  // not explicit: any FILE is an input

  std::FILE* get() const { return file_.get(); }

  /// Hands the file over to a library that closes it; failure() still works while it is open.
  std::FILE* release() { return file_.release(); }

  /// The first bytes of the content, at most kHeadBytes; reading begins with them all the same.
  std::string_view head() const;

  /// Whether the content is unpacked on the way, or cannot be sought in for another reason: a pipe.
  bool is_packed() const;

  /// Why the last read failed, such as "truncated gzip input"; "" where nothing failed. Ask when
  /// std::ferror() is set: to the reader of the file a broken archive is a read error.
  std::string failure() const;

  static constexpr std::size_t kHeadBytes = 8192;  // holds the next MXTP, wherever a stream is cut

 private:
  friend InputFile OpenInputFile(const std::string& path);
  struct Notes {
    std::string head;
    std::string failure;
    bool is_packed = false;
  };
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  class Content;

  std::unique_ptr<std::FILE, Close> file_;
  std::shared_ptr<Notes> notes_;  // shared with the file, which a library may own
};

/// Opens `path`; "-" is standard input.
/// @throws SourceError naming the file, what is wrong (missing, a folder, not to be read, a broken
/// archive) and the way out.
InputFile OpenInputFile(const std::string& path);

/// `path` as people should read it: "standard input" for "-".
std::string NameOfInput(const std::string& path);

}  // namespace kinescope
