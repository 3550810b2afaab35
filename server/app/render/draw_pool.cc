#include "server/app/render/draw_pool.h"

#include <algorithm>
#include <utility>

#include "core/system/check.h"
#include "server/picture/cores.h"

namespace kinescope::app {

// The memory of pictures, used over and over: a large block fresh from the system costs as much as
// drawing on it.
class DrawPool::ImagePool : public std::enable_shared_from_this<ImagePool> {
 public:
  explicit ImagePool(std::size_t most) : most_(most), left_(most) {}

  /// Waits until none is out.
  void SetMost(std::size_t most) {
    std::unique_lock lock(mutex_);
    returned_.wait(lock, [&] { return left_ == most_; });
    if (most != most_) used_.clear();  // of pictures of another size
    most_ = left_ = most;
  }

  /// Waits until fewer than the most are out.
  void Reserve() {
    std::unique_lock lock(mutex_);
    returned_.wait(lock, [&] { return left_ > 0; });
    --left_;
  }

  /// One of those reserved.
  std::shared_ptr<DrawnPicture> Take() {
    std::unique_ptr<DrawnPicture> image = std::make_unique<DrawnPicture>();
    {
      const std::lock_guard lock(mutex_);
      if (!used_.empty()) {
        image = std::move(used_.back());
        used_.pop_back();
      }
    }
    return {image.release(), [images = shared_from_this()](DrawnPicture* back) {
              images->Return(std::unique_ptr<DrawnPicture>(back));
            }};
  }

 private:
  void Return(std::unique_ptr<DrawnPicture> image) {
    {
      const std::lock_guard lock(mutex_);
      ++left_;
      used_.push_back(std::move(image));
    }
    returned_.notify_one();
  }

  std::mutex mutex_;
  std::condition_variable returned_;
  std::size_t most_, left_;                          // guarded by mutex_
  std::vector<std::unique_ptr<DrawnPicture>> used_;  // guarded by mutex_
};

DrawPool::DrawPool(int jobs, std::size_t most_pictures, MakeRenderer make)
    : make_(std::move(make)), images_(std::make_shared<ImagePool>(most_pictures)) {
  KINESCOPE_CHECK(jobs >= 1 && most_pictures >= static_cast<std::size_t>(jobs));
  std::promise<render::RendererInfo> promise;
  std::future<render::RendererInfo> started = promise.get_future();
  threads_.emplace_back([this, promise = std::move(promise)]() mutable { Work(&promise); });
  try {
    info_ = started.get();
  } catch (...) {
    threads_.front().join();
    throw;
  }
  for (int i = 1; i < jobs; ++i) threads_.emplace_back([this] { Work(nullptr); });
}

DrawPool::~DrawPool() {
  {
    const std::lock_guard lock(mutex_);
    is_closing_ = true;
    tasks_.clear();  // breaks their promises, so no thread waits for them
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void DrawPool::SetMostPictures(std::size_t most) { images_->SetMost(most); }

FuturePicture DrawPool::Draw(RenderRequest request) {
  images_->Reserve();
  DrawTask task{std::move(request), {}};
  FuturePicture picture = task.picture.get_future().share();
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  changed_.notify_one();
  return picture;
}

namespace {

// What is in a layer of vectors is not in the picture, but in the page of a PDF file.
render::PictureSpec SpecOfPicture(const RenderRequest& request) {
  render::PictureSpec spec = request.spec;
  if (request.layer && *request.layer != render::LayerFormat::kPdfPage) {
    spec.overlays = spec.marker_texts = spec.lines = false;
  }
  return spec;
}

}  // namespace

void DrawPool::Work(std::promise<render::RendererInfo>* started) {
  std::unique_ptr<render::Renderer> renderer;
  if (started != nullptr) {
    try {
      renderer = make_();
      started->set_value(renderer->info());
    } catch (...) {
      started->set_exception(std::current_exception());
      return;
    }
  }
  while (true) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return is_closing_ || !tasks_.empty(); });
    if (is_closing_) return;
    DrawTask task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    std::shared_ptr<DrawnPicture> image = images_->Take();
    try {
      if (renderer == nullptr) renderer = make_();
      const RenderRequest& request = task.request;
      renderer->RenderInto(*image, request.state, request.camera, SpecOfPicture(request));
      if (request.layer) {
        image->layer =
            renderer->OverlayLayer(request.state, request.camera, request.spec, *request.layer);
      }
      task.picture.set_value(std::move(image));
    } catch (...) {
      image.reset();
      task.picture.set_exception(std::current_exception());
    }
  }
}

int DefaultJobs(int cores, const render::PictureSpec& spec) {
  // llvmpipe fills pixels on threads of its own, but nothing of what comes before and after them;
  // another picture does. Each renderer has three textures of what is drawn at once:
  // colour, depth, and the floor that is kept.
  constexpr int kMostRenderers = 8;
  constexpr std::int64_t kTextures = 3, kMaxBytes = std::int64_t{350} << 20, kLargestSide = 4096;
  const auto side = [&](int px) {
    return std::min(std::int64_t{px} * spec.supersample, kLargestSide);
  };
  const std::int64_t bytes = kTextures * 4 * side(spec.width) * side(spec.height);
  const int fitting = static_cast<int>(
      std::clamp(kMaxBytes / bytes, std::int64_t{1}, std::int64_t{kMostRenderers}));
  return std::clamp(cores / 2, 1, fitting);
}

int JobsFor(std::int64_t asked, const render::PictureSpec& spec) {
  return asked > 0 ? static_cast<int>(asked) : DefaultJobs(CoresHere(), spec);
}

std::size_t MostPictures(int jobs, int width, int height) {
  constexpr std::size_t kMaxBytes = 64u << 20;
  const std::size_t bytes = 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const auto threads = static_cast<std::size_t>(jobs);
  return std::clamp(kMaxBytes / bytes, threads + 1, 2 * threads + 1);
}

}  // namespace kinescope::app
