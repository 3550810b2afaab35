/// Writes one output of `kinescope render`: pictures are added as futures and written on separate
/// threads. One thread calls it.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "render/camera/camera.h"
#include "render/video.h"
#include "server/app/render/draw_pool.h"
#include "server/app/render/output_plan.h"

namespace kinescope::app {

/// Metadata to write into a file about its picture; `k`: number in a sequence.
using MetadataOf =
    std::function<std::map<std::string, std::string>(const render::Camera& camera, long k)>;

class OutputSink {
 public:
  virtual ~OutputSink() = default;  // leaves no partial file
  OutputSink(const OutputSink&) = delete;
  OutputSink& operator=(const OutputSink&) = delete;

  /// Pictures of a clip must be added in order. @throws the error of an earlier picture.
  virtual void Put(long k, FuturePicture picture, const render::Camera& camera) = 0;

  /// Waits until the file is complete. @throws std::runtime_error with the file and the reason.
  virtual void Finish() = 0;

 protected:
  OutputSink() = default;
};

/// One PNG, or a sequence of them on `threads` threads. `layer_path`: the vector file of the
/// overlays of one picture (DrawnPicture::layer); "": none. `px_per_m`: as WritePng.
std::unique_ptr<OutputSink> MakePngSink(const std::string& path, int threads, MetadataOf metadata,
                                        const std::string& layer_path = {}, double px_per_m = 0);

/// A clip on its own thread. `options`: without metadata.
/// @throws the exceptions of MakeVideoWriter, here and from Put.
std::unique_ptr<OutputSink> MakeClipSink(const std::string& path, const render::PictureSpec& spec,
                                         render::VideoOptions options, MetadataOf metadata);

}  // namespace kinescope::app
