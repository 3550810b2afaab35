/// Renders pictures on several threads. Each thread makes and uses its own renderer; a picture
/// depends only on its RenderRequest, so any of them may render it at any time.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "render/image/image.h"
#include "render/renderer.h"
#include "server/picture/render_planner.h"

namespace kinescope::app {

struct DrawnPicture : render::Image {
  std::string layer;  // its overlays as a vector file, if RenderRequest::layer requests it
};

/// A picture whose memory returns to the pool when the last owner releases it.
using PicturePtr = std::shared_ptr<const DrawnPicture>;
using FuturePicture = std::shared_future<PicturePtr>;

class DrawPool {
 public:
  using MakeRenderer = std::function<std::unique_ptr<render::Renderer>()>;

  /// Starts the first thread and waits for its renderer; the other `jobs` - 1 threads start when
  /// there is work for them. At most `most_pictures` are being rendered or held at a time, which
  /// limits memory.
  /// @throws the exceptions of `make`. @pre jobs >= 1, most_pictures >= jobs
  DrawPool(int jobs, std::size_t most_pictures, MakeRenderer make);

  /// Waits for the pictures that are being rendered; the other ones are dropped.
  ~DrawPool();
  DrawPool(const DrawPool&) = delete;
  DrawPool& operator=(const DrawPool&) = delete;

  /// Waits until there is room for one more picture, then queues it. The future contains the
  /// picture or the error; the pool's destructor also makes it ready. Call it on one thread, which
  /// may be any.
  [[nodiscard]] FuturePicture Draw(RenderRequest request);

  /// As the constructor's. Waits until no picture is being rendered or held.
  void SetMostPictures(std::size_t most);

  /// Of the renderers, which are all the same.
  const render::RendererInfo& info() const { return info_; }

 private:
  class ImagePool;
  struct DrawTask {
    RenderRequest request;
    std::promise<PicturePtr> picture;
  };

  void Work(std::promise<render::RendererInfo>* started);

  const MakeRenderer make_;
  const std::shared_ptr<ImagePool> images_;  // shared with pictures that may outlive the pool
  render::RendererInfo info_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<DrawTask> tasks_;  // guarded by mutex_
  bool is_closing_ = false;     // guarded by mutex_
  std::vector<std::thread> threads_;
};

/// The number of threads that draw pictures like `spec` without wasting time of so many cores; the
/// textures of all of them stay below 350 MB, if one alone does.
int DefaultJobs(int cores, const render::PictureSpec& spec);

/// `asked` (--jobs), or, if it is 0, DefaultJobs() of this machine.
int JobsFor(std::int64_t asked, const render::PictureSpec& spec);

/// The number of pictures of a size that `jobs` threads and the encoders behind them may hold: two
/// per thread and one more, up to 64 MiB, but always one more than threads.
std::size_t MostPictures(int jobs, int width, int height);

}  // namespace kinescope::app
