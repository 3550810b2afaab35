/// Pictures kept on disk without loss, to be read once more: QuickTime Animation, which packs what
/// is flat or does not change, at a cost far below that of drawing it. The file has no name and is
/// gone with the object.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include "render/av/libav.h"
#include "render/new_file.h"

namespace kinescope::render::av {

class Spool {
 public:
  /// In the folder of `beside`. All pictures are `width` x `height` and of `format`, which is
  /// AV_PIX_FMT_ARGB. @throws std::runtime_error naming `beside`, here and from every call.
  Spool(const std::filesystem::path& beside, AVPixelFormat format, int width, int height);

  void Add(const AVFrame& frame);

  /// From here on they are read, the first one first.
  void Rewind();

  /// @pre Rewind was called, and there is one left
  AVFrame& Next();

 private:
  void Keep();

  std::filesystem::path path_;
  NewFile file_;  // never given its name
  CodecContext encoder_, decoder_;
  Packet packet_;
  Frame frame_;
  std::vector<int> sizes_;  // of the packets in the file
  std::size_t next_ = 0;
  std::ifstream in_;
};

}  // namespace kinescope::render::av
