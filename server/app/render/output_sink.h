/// One output of `kinescope render` while it is made: pictures go in as promises and are written by
/// threads of its own.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "render/camera.h"
#include "render/video.h"
#include "server/app/render/draw_pool.h"
#include "server/app/render/output_plan.h"

namespace kinescope::app {

/// What is written into a file about the picture in it; of a sequence, about its number `k`.
using MetadataOf =
    std::function<std::map<std::string, std::string>(const render::Camera& camera, long k)>;

class OutputSink {
 public:
  virtual ~OutputSink() = default;  // leaves no half file
  OutputSink(const OutputSink&) = delete;
  OutputSink& operator=(const OutputSink&) = delete;

  /// Pictures of a clip come in order. @throws what went wrong with an earlier one.
  virtual void Put(long k, FuturePicture picture, const render::Camera& camera) = 0;

  /// Waits until the file is there. @throws std::runtime_error naming it and the reason.
  virtual void Finish() = 0;

 protected:
  OutputSink() = default;
};

/// One PNG, or a sequence of them on `threads` threads. `layer_path`: the file for the layer of one
/// picture (DrawnPicture::layer); "" none.
std::unique_ptr<OutputSink> MakePngSink(const std::string& path, int threads, MetadataOf metadata,
                                        const std::string& layer_path = {});

/// A clip on a thread of its own. `options`: without metadata.
/// @throws what MakeVideoWriter throws, here and from Put.
std::unique_ptr<OutputSink> MakeClipSink(const std::string& path, const render::View& view,
                                         render::VideoOptions options, MetadataOf metadata);

}  // namespace kinescope::app
