/// Threads that draw. Each has a renderer of its own, made and used there; a picture depends on its
/// Shot alone, so it does not matter which of them draws it, or when.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "render/image.h"
#include "render/renderer.h"
#include "server/picture/shots.h"

namespace kinescope::app {

struct DrawnPicture : render::Image {
  std::string layer;  // what is written over it as a file, where Shot::layer asks for it
};

/// A picture whose memory goes back to the pool when nobody holds it any more.
using PicturePtr = std::shared_ptr<const DrawnPicture>;
using FuturePicture = std::shared_future<PicturePtr>;

class DrawPool {
 public:
  using MakeRenderer = std::function<std::unique_ptr<render::Renderer>()>;

  /// Starts the first thread and waits for its renderer; the other `jobs` - 1 make theirs when
  /// there is work for them. At most `most_pictures` are drawn or held at a time, which bounds
  /// memory.
  /// @throws what `make` throws. @pre jobs >= 1, most_pictures >= jobs
  DrawPool(int jobs, std::size_t most_pictures, MakeRenderer make);

  /// Waits for pictures that are being drawn, and for nothing else.
  ~DrawPool();
  DrawPool(const DrawPool&) = delete;
  DrawPool& operator=(const DrawPool&) = delete;

  /// Waits until there is room for one more picture, which is then drawn. The future has the
  /// picture or what went wrong; it is ready when the pool is destroyed, too. Any one thread.
  [[nodiscard]] FuturePicture Draw(Shot shot);

  /// Of the renderers, which are all alike.
  const render::RendererInfo& info() const { return info_; }

 private:
  class Shelf;
  struct Job {
    Shot shot;
    std::promise<PicturePtr> picture;
  };

  void Work(std::promise<render::RendererInfo>* started);

  const MakeRenderer make_;
  const std::shared_ptr<Shelf> shelf_;  // shared with pictures that may outlive the pool
  render::RendererInfo info_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;     // guarded by mutex_
  bool is_closing_ = false;  // guarded by mutex_
  std::vector<std::thread> threads_;
};

/// How many threads draw fastest here, and how many pictures of that size may be held by `jobs`
/// threads and the encoders behind them: some in hand for each, up to half a gigabyte.
int DefaultJobs();
std::size_t MostPictures(int jobs, int width, int height);

}  // namespace kinescope::app
