/// Opens an input file and decompresses it while it is read. gzip, xz, zstd, bzip2 and lz4 are
/// detected by the first bytes; the file name does not matter. Reads from front to back only, so
/// pipes and standard input work too. Memory use is constant, however large the decompressed
/// content is. One thread.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace kinescope {

/// For an error: "<path>: cannot read this file", and in which folder a relative path begins: that
/// in which the program was started.
std::string CannotRead(const std::string& path);

/// An open file; knows why reading failed. Movable; the destructor closes the file.
class InputFile {
 public:
  /// Takes ownership of `file`, which has no head().
  InputFile(std::FILE* file);  // not explicit: any FILE is an input

  std::FILE* get() const { return file_.get(); }

  /// Transfers the file to a library that closes it; failure() keeps working while it is open.
  std::FILE* release() { return file_.release(); }

  /// The first bytes of the content, at most kHeadBytes. Reading still starts with them.
  std::string_view head() const;

  /// True if the content is decompressed while it is read, or if seeking is impossible for another
  /// reason (a pipe).
  bool is_packed() const;

  /// Why the last read failed, such as "truncated gzip input"; "" without a failure. Call it when
  /// std::ferror() is set: the reader of the file sees a damaged archive as a read error.
  std::string failure() const;

  static constexpr std::size_t kHeadBytes = 8192;  // contains the next MXTP wherever a stream was
                                                   // cut

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
/// @throws SourceError with the file, the reason (missing, a folder, not readable, a damaged
/// archive) and the remedy.
InputFile OpenInputFile(const std::string& path);

/// `path` as shown in messages: "standard input" for "-".
std::string NameOfInput(const std::string& path);

}  // namespace kinescope
