/// Stores pictures on disk without loss, to read them once more. The format is QuickTime Animation,
/// which compresses flat and unchanged areas, much faster than rendering them again. The file has
/// no name and is deleted with the object. One thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include "render/av/libav.h"
#include "render/image/new_file.h"

namespace kinescope::render::av {

class Spool {
 public:
  /// Creates the file in the folder of `beside`. All pictures are `width` x `height` in `format`,
  /// which is AV_PIX_FMT_ARGB. The constructor and all calls @throw std::runtime_error with
  /// `beside`.
  Spool(const std::filesystem::path& beside, AVPixelFormat format, int width, int height);

  void Add(const AVFrame& frame);

  /// Ends the writing; Next() returns the first picture again.
  void Rewind();

  /// @pre Rewind was called, and a picture is left
  AVFrame& Next();

 private:
  void Keep();

  std::filesystem::path path_;
  NewFile file_;  // never named
  CodecContext encoder_, decoder_;
  Packet packet_;
  Frame frame_;
  std::vector<int> sizes_;  // of the packets in the file
  std::size_t next_ = 0;
  std::ifstream in_;
};

}  // namespace kinescope::render::av
