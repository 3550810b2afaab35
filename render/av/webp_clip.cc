#include "render/av/webp_clip.h"

#include <webp/demux.h>
#include <webp/encode.h>
#include <webp/mux.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "render/av/libav.h"
#include "render/image/new_file.h"

namespace kinescope::render::av {
namespace {

struct DeleteEncoder {
  void operator()(WebPAnimEncoder* encoder) const { WebPAnimEncoderDelete(encoder); }
};
struct DeleteDecoder {
  void operator()(WebPAnimDecoder* decoder) const { WebPAnimDecoderDelete(decoder); }
};
struct DeleteMux {
  void operator()(WebPMux* mux) const { WebPMuxDelete(mux); }
};
// WebPData and WebPPicture are plain structs that own memory.
struct OwnedData : WebPData {
  OwnedData() { WebPDataInit(this); }
  ~OwnedData() { WebPDataClear(this); }
  OwnedData(const OwnedData&) = delete;
  OwnedData& operator=(const OwnedData&) = delete;
};
struct OwnedPicture : WebPPicture {
  OwnedPicture() { WebPPictureInit(this); }
  ~OwnedPicture() { WebPPictureFree(this); }
  OwnedPicture(const OwnedPicture&) = delete;
  OwnedPicture& operator=(const OwnedPicture&) = delete;
};

const std::pair<const char*, const char*> kEscapes[] = {
    {"&lt;", "<"}, {"&gt;", ">"}, {"&amp;", "&"}};

std::string Escape(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const char* escaped = nullptr;
    for (const auto& [name, plain] : kEscapes) {
      if (c == *plain) escaped = name;
    }
    escaped != nullptr ? out += escaped : out += c;
  }
  return out;
}

std::string Unescape(std::string text) {
  for (const auto& [name, plain] : kEscapes) {  // "&amp;" is the last one
    for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos; ++at) {
      text.replace(at, std::strlen(name), plain);
    }
  }
  return text;
}

// XMP, part 1: both are lists of one text for every language.
constexpr const char* kTextBegin = "<rdf:Alt><rdf:li xml:lang=\"x-default\">";
constexpr const char* kTextEnd = "</rdf:li></rdf:Alt>";
constexpr std::pair<const char*, const char*> kProperties[] = {{"title", "dc:title"},
                                                               {"comment", "dc:description"}};

std::string ToXmp(const std::map<std::string, std::string>& metadata) {
  std::string properties;
  for (const auto& [key, property] : kProperties) {
    const auto found = metadata.find(key);
    if (found == metadata.end()) continue;
    properties += std::string("<") + property + ">" + kTextBegin + Escape(found->second) +
                  kTextEnd + "</" + property + ">";
  }
  return "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF "
         "xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\"><rdf:Description "
         "rdf:about=\"\" xmlns:dc=\"http://purl.org/dc/elements/1.1/\">" +
         properties + "</rdf:Description></rdf:RDF></x:xmpmeta>";
}

std::map<std::string, std::string> FromXmp(const std::string& xmp) {
  std::map<std::string, std::string> metadata;
  for (const auto& [key, property] : kProperties) {
    const std::string before = std::string("<") + property + ">" + kTextBegin;
    const std::size_t begin = xmp.find(before);
    if (begin == std::string::npos) continue;
    const std::size_t from = begin + before.size();
    const std::size_t end = xmp.find(kTextEnd, from);
    if (end != std::string::npos) metadata[key] = Unescape(xmp.substr(from, end - from));
  }
  return metadata;
}

class WebpWriter : public VideoWriter {
 public:
  WebpWriter(const std::filesystem::path& path, int width, int height, const VideoOptions& options)
      : path_(path), width_(width), height_(height), options_(options), file_(path) {
    WebPAnimEncoderOptions settings;
    if (WebPAnimEncoderOptionsInit(&settings) == 0 || WebPConfigInit(&config_) == 0) {
      throw std::runtime_error("cannot encode " + path.string() +
                               ": libwebp has an incompatible version; install Debian's libwebp7");
    }
    config_.quality = static_cast<float>(options.quality);
    config_.lossless = options.quality == 100;
    config_.thread_level = 0;
    encoder_.reset(WebPAnimEncoderNew(width, height, &settings));
    if (!encoder_) throw std::runtime_error("cannot encode " + path.string() + ": out of memory");
  }

  void Add(const Image& image) override {
    CheckSameSize(image, width_, height_, path_);
    OwnedPicture picture;
    picture.width = width_;
    picture.height = height_;
    picture.use_argb = 1;
    const bool keeps_alpha = options_.alpha.value_or(true);
    const auto import = keeps_alpha ? WebPPictureImportRGBA : WebPPictureImportRGBX;
    Check(import(&picture, image.rgba.data(), 4 * width_) != 0 &&
          WebPAnimEncoderAdd(encoder_.get(), &picture, MillisOf(next_), &config_) != 0);
    ++next_;
  }

  void Finish() override {
    if (next_ == 0) throw std::runtime_error(path_.string() + ": a clip needs at least one frame");
    Check(WebPAnimEncoderAdd(encoder_.get(), nullptr, MillisOf(next_), nullptr) != 0);
    OwnedData clip;
    Check(WebPAnimEncoderAssemble(encoder_.get(), &clip) != 0);
    OwnedData whole;
    const std::unique_ptr<WebPMux, DeleteMux> mux(WebPMuxCreate(&clip, 0));
    const std::string xmp = ToXmp(options_.metadata);
    const WebPData chunk = {reinterpret_cast<const std::uint8_t*>(xmp.data()), xmp.size()};
    if (!mux || WebPMuxSetChunk(mux.get(), "XMP ", &chunk, 0) != WEBP_MUX_OK ||
        WebPMuxAssemble(mux.get(), &whole) != WEBP_MUX_OK) {
      throw std::runtime_error("cannot tag " + path_.string() + ": out of memory");
    }
    file_.Write(whole.bytes, whole.size);
    file_.Commit();
  }

 private:
  void Check(bool ok) const {
    if (ok) return;
    throw std::runtime_error("cannot encode " + path_.string() + ": " +
                             WebPAnimEncoderGetError(encoder_.get()));
  }

  int MillisOf(std::int64_t k) const {
    return static_cast<int>((options_.rate.NanosOf(k) + 500'000) / 1'000'000);
  }

  const std::filesystem::path path_;
  const int width_, height_;
  const VideoOptions options_;
  NewFile file_;
  WebPConfig config_{};
  std::unique_ptr<WebPAnimEncoder, DeleteEncoder> encoder_;
  std::int64_t next_ = 0;  // index of the next picture
};

class WebpReader : public VideoReader {
 public:
  explicit WebpReader(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(file), {});
    if (!file.is_open() || file.bad()) {
      throw std::runtime_error("cannot read " + path.string() + ": " + std::strerror(errno));
    }
    const WebPData data = {reinterpret_cast<const std::uint8_t*>(bytes_.data()), bytes_.size()};
    WebPAnimDecoderOptions settings;
    if (WebPAnimDecoderOptionsInit(&settings) != 0) {
      settings.color_mode = MODE_RGBA;
      decoder_.reset(WebPAnimDecoderNew(&data, &settings));
    }
    if (!decoder_ || WebPAnimDecoderGetInfo(decoder_.get(), &info_) == 0) {
      throw std::runtime_error("cannot read " + path.string() +
                               ": not a WebP file that libwebp can read");
    }
    path_ = path;
  }

  bool Next(Image& image) override {
    if (WebPAnimDecoderHasMoreFrames(decoder_.get()) == 0) return false;
    std::uint8_t* rgba = nullptr;
    int ends_millis = 0;
    if (WebPAnimDecoderGetNext(decoder_.get(), &rgba, &ends_millis) == 0) {
      throw std::runtime_error("cannot decode " + path_.string() + ": the file is damaged");
    }
    secs_ = next_millis_ / 1000.0;
    next_millis_ = ends_millis;
    image.width = static_cast<int>(info_.canvas_width);
    image.height = static_cast<int>(info_.canvas_height);
    image.rgba.assign(
        rgba, rgba + 4 * static_cast<std::size_t>(info_.canvas_width) * info_.canvas_height);
    return true;
  }

  double secs() const override { return secs_; }

  std::map<std::string, std::string> metadata() const override {
    WebPChunkIterator chunk;
    std::string xmp;
    if (WebPDemuxGetChunk(WebPAnimDecoderGetDemuxer(decoder_.get()), "XMP ", 1, &chunk) != 0) {
      xmp.assign(reinterpret_cast<const char*>(chunk.chunk.bytes), chunk.chunk.size);
      WebPDemuxReleaseChunkIterator(&chunk);
    }
    return FromXmp(xmp);
  }

 private:
  std::filesystem::path path_;
  std::string bytes_;  // which the decoder reads in place
  std::unique_ptr<WebPAnimDecoder, DeleteDecoder> decoder_;
  WebPAnimInfo info_{};
  int next_millis_ = 0;
  double secs_ = 0;
};

}  // namespace

std::unique_ptr<VideoWriter> MakeWebpWriter(const std::filesystem::path& path, int width,
                                            int height, const VideoOptions& options) {
  return std::make_unique<WebpWriter>(path, width, height, options);
}

std::unique_ptr<VideoReader> OpenWebp(const std::filesystem::path& path) {
  return std::make_unique<WebpReader>(path);
}

}  // namespace kinescope::render::av
