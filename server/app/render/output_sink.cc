#include "server/app/render/output_sink.h"

#include <utility>

#include "render/image/new_file.h"
#include "render/image/png_file.h"
#include "server/app/render/writer_threads.h"

namespace kinescope::app {
namespace {

struct Item {
  long k;
  FuturePicture picture;
  render::Camera camera;
};

class PngSink : public OutputSink {
 public:
  PngSink(std::string path, int threads, MetadataOf metadata, std::string layer_path,
          double px_per_m)
      : path_(std::move(path)),
        layer_path_(std::move(layer_path)),
        px_per_m_(px_per_m),
        metadata_(std::move(metadata)),
        threads_(threads, [this](Item& item) { Write(item); }) {}

  void Put(long k, FuturePicture picture, const render::Camera& camera) override {
    threads_.Put({k, std::move(picture), camera});
  }
  void Finish() override { threads_.Finish(); }

 private:
  // The picture last: where it is there, the layer is, too.
  void Write(const Item& item) const {
    const DrawnPicture& picture = *item.picture.get();
    if (!layer_path_.empty()) render::WriteNewFile(layer_path_, picture.layer);
    render::WritePng(PathOfPicture(path_, item.k), picture, metadata_(item.camera, item.k),
                     px_per_m_);
  }

  const std::string path_, layer_path_;
  const double px_per_m_;
  const MetadataOf metadata_;
  WriterThreads<Item> threads_;  // last: it uses the others
};

class ClipSink : public OutputSink {
 public:
  ClipSink(const std::string& path, const render::PictureSpec& spec, render::VideoOptions options,
           MetadataOf metadata)
      : path_(path),
        spec_(spec),
        options_(std::move(options)),
        metadata_(std::move(metadata)),
        thread_(1, [this](Item& item) { video_->Add(*item.picture.get()); }) {}

  void Put(long k, FuturePicture picture, const render::Camera& camera) override {
    if (video_ == nullptr) {  // what is written into it names the first picture's camera
      options_.metadata = metadata_(camera, k);
      video_ = render::MakeVideoWriter(path_, spec_.width, spec_.height, options_);
    }
    thread_.Put({k, std::move(picture), camera});
  }

  void Finish() override {
    thread_.Finish();
    if (video_ != nullptr) video_->Finish();
  }

 private:
  const std::string path_;
  const render::PictureSpec spec_;
  render::VideoOptions options_;
  const MetadataOf metadata_;
  std::unique_ptr<render::VideoWriter> video_;  // made before the first item, then the thread's
  WriterThreads<Item> thread_;                  // last: it uses the others
};

}  // namespace

std::unique_ptr<OutputSink> MakePngSink(const std::string& path, int threads, MetadataOf metadata,
                                        const std::string& layer_path, double px_per_m) {
  return std::make_unique<PngSink>(path, threads, std::move(metadata), layer_path, px_per_m);
}

std::unique_ptr<OutputSink> MakeClipSink(const std::string& path, const render::PictureSpec& spec,
                                         render::VideoOptions options, MetadataOf metadata) {
  return std::make_unique<ClipSink>(path, spec, std::move(options), std::move(metadata));
}

}  // namespace kinescope::app
