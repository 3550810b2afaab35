#include "render/video.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/imgutils.h>
#include <libswscale/swscale.h>
}

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <random>

#include "core/system/errors.h"
#include "render/canvas.h"
#include "render/frame_code.h"
#include "render/image/resample.h"
#include "tests/shared_data.h"
#include "tests/temp_folder.h"

namespace kinescope::render {
namespace {

using kinescope::testing::ReadFile;
using kinescope::testing::TempFolder;

constexpr int kClipWidth = 322, kClipHeight = 182;

// Grey that depends on the frame, with an orange field: colour and order can be checked.
Image Frame(int k, int width = kClipWidth, int height = kClipHeight) {
  Image image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool is_field = x > width / 2 && y > height / 2;
      const auto grey = static_cast<std::uint8_t>(40 + 4 * k);
      if (is_field) {
        image.rgba.insert(image.rgba.end(), {255, 140, 0, 255});
      } else {
        image.rgba.insert(image.rgba.end(), {grey, grey, grey, 255});
      }
    }
  }
  return image;
}

struct Clip {
  AVRational rate{};
  double duration_secs = 0;
  std::string codec, title;
  int width = 0, height = 0;
  AVColorSpace color_space{};
  AVColorPrimaries primaries{};
  AVColorTransferCharacteristic transfer{};
  AVColorRange range{};
  AVPixelFormat pixel_format{};
  std::vector<Image> frames;
  std::vector<int> keys;  // indices of the frames that a player can begin with
  std::vector<double> times_secs;
};

Image ToRgb(const AVFrame& frame) {
  Image image{frame.width, frame.height, {}};
  image.rgba.resize(static_cast<std::size_t>(4 * frame.width * frame.height));
  SwsContext* scaler =
      sws_getContext(frame.width, frame.height, AV_PIX_FMT_YUV420P, frame.width, frame.height,
                     AV_PIX_FMT_RGBA, SWS_BILINEAR | SWS_ACCURATE_RND, nullptr, nullptr, nullptr);
  const int* bt709 = sws_getCoefficients(SWS_CS_ITU709);
  sws_setColorspaceDetails(scaler, bt709, 0, bt709, 1, 0, 1 << 16, 1 << 16);
  std::uint8_t* rows[] = {image.rgba.data()};
  const int strides[] = {4 * frame.width};
  sws_scale(scaler, frame.data, frame.linesize, 0, frame.height, rows, strides);
  sws_freeContext(scaler);
  return image;
}

// As any player reads it.
Clip ReadClip(const std::filesystem::path& path) {
  Clip clip;
  AVFormatContext* format = nullptr;
  if (avformat_open_input(&format, path.c_str(), nullptr, nullptr) < 0) return clip;
  avformat_find_stream_info(format, nullptr);
  const AVStream* stream = format->streams[0];
  const AVCodecParameters& codec = *stream->codecpar;
  clip.rate = stream->avg_frame_rate;
  clip.duration_secs = static_cast<double>(format->duration) / AV_TIME_BASE;
  clip.codec = avcodec_get_name(codec.codec_id);
  clip.width = codec.width;
  clip.height = codec.height;
  clip.color_space = codec.color_space;
  clip.primaries = codec.color_primaries;
  clip.transfer = codec.color_trc;
  clip.range = codec.color_range;
  clip.pixel_format = static_cast<AVPixelFormat>(codec.format);
  if (const auto* title = av_dict_get(format->metadata, "title", nullptr, 0))
    clip.title = title->value;
  AVCodecContext* decoder = avcodec_alloc_context3(avcodec_find_decoder(codec.codec_id));
  avcodec_parameters_to_context(decoder, &codec);
  avcodec_open2(decoder, nullptr, nullptr);
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  bool has_more = true;
  while (has_more) {
    has_more = av_read_frame(format, packet) >= 0;
    avcodec_send_packet(decoder, has_more ? packet : nullptr);
    av_packet_unref(packet);
    while (avcodec_receive_frame(decoder, frame) >= 0) {
      if (frame->key_frame != 0) clip.keys.push_back(static_cast<int>(clip.frames.size()));
      clip.frames.push_back(ToRgb(*frame));
      clip.times_secs.push_back(static_cast<double>(frame->pts) * av_q2d(stream->time_base));
    }
  }
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&decoder);
  avformat_close_input(&format);
  return clip;
}

void WriteClip(const std::filesystem::path& path, int frames, FrameRate rate) {
  VideoOptions options;
  options.rate = rate;
  options.metadata = {{"title", "trial 3"}};
  const auto video = MakeVideoWriter(path, kClipWidth, kClipHeight, options);
  for (int k = 0; k < frames; ++k) video->Add(Frame(k));
  video->Finish();
}

TEST(Video, ContainsEveryFrameInOrderAndInColour) {
  const TempFolder folder;
  WriteClip(folder / "clip.mp4", 45, {30, 1});
  const Clip clip = ReadClip(folder / "clip.mp4");
  EXPECT_EQ(clip.codec, "h264");
  EXPECT_EQ(clip.width, kClipWidth);
  EXPECT_EQ(clip.height, kClipHeight);
  EXPECT_EQ(clip.title, "trial 3");
  EXPECT_NEAR(clip.duration_secs, 45 / 30.0, 1e-3);
  ASSERT_EQ(clip.frames.size(), 45u);
  for (std::size_t k = 0; k < clip.frames.size(); ++k) {
    const Image& frame = clip.frames[k];
    EXPECT_NEAR(frame.rgba[4 * (20 * kClipWidth + 20)], 40 + 4 * static_cast<int>(k), 3)
        << "picture " << k;
    EXPECT_NEAR(clip.times_secs[k], static_cast<double>(k) / 30, 1e-6);
    const std::uint8_t* field =
        &frame.rgba[4 * ((kClipHeight - 20) * kClipWidth + kClipWidth - 20)];
    EXPECT_NEAR(field[0], 255, 4);
    EXPECT_NEAR(field[1], 140, 4);
    EXPECT_NEAR(field[2], 0, 4);
  }
}

TEST(Video, HasAKeyPictureWhereSeekingNeedsOne) {
  const TempFolder folder;
  const auto keys = [&](int frames, FrameRate rate, int encoding) {
    VideoOptions options;
    options.rate = rate;
    options.encoding = encoding;
    const auto video = MakeVideoWriter(folder / "clip.mp4", 32, 32, options);
    for (int k = 0; k < frames; ++k) video->Add(Frame(0, 32, 32));
    video->Finish();
    return ReadClip(folder / "clip.mp4").keys;
  };
  EXPECT_EQ(keys(310, {30, 1}, kClipEncoding), (std::vector<int>{0, 150, 300}));
  EXPECT_EQ(keys(12, {1, 1}, kClipEncoding), (std::vector<int>{0, 5, 10}));
  EXPECT_EQ(keys(310, {240, 1}, kClipEncoding), (std::vector<int>{0, 250}));
  EXPECT_EQ(keys(130, {30, 1}, 1), (std::vector<int>{0, 60, 120})) << "of earlier versions";
}

TEST(Video, HasTheColourTagsThatPlayersNeed) {
  const TempFolder folder;
  WriteClip(folder / "clip.mp4", 3, {25, 1});
  const Clip clip = ReadClip(folder / "clip.mp4");
  EXPECT_EQ(clip.pixel_format, AV_PIX_FMT_YUV420P);
  EXPECT_EQ(clip.color_space, AVCOL_SPC_BT709);
  EXPECT_EQ(clip.primaries, AVCOL_PRI_BT709);
  EXPECT_EQ(clip.transfer, AVCOL_TRC_BT709);
  EXPECT_EQ(clip.range, AVCOL_RANGE_MPEG);
}

TEST(Video, KeepsTheFrameRateExactly) {
  const TempFolder folder;
  for (const FrameRate& rate :
       {FrameRate{60, 1}, {30000, 1001}, {60000, 1001}, {24000, 1001}, {25, 2}, {240, 1}, {1, 1}}) {
    const AVRational exact = {rate.numerator, rate.denominator};
    WriteClip(folder / "clip.mp4", 8, rate);
    const Clip clip = ReadClip(folder / "clip.mp4");
    EXPECT_EQ(av_cmp_q(clip.rate, exact), 0)
        << rate.hz() << " became " << clip.rate.num << "/" << clip.rate.den;
    EXPECT_NEAR(clip.duration_secs, 8 / av_q2d(exact), 2e-3);
    EXPECT_EQ(clip.frames.size(), 8u);
  }
}

// A disc that moves, on glass or on grey: what the new formats must keep.
Image Disc(int k, bool is_glass) {
  Image image{64, 48, {}};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int dx = x - 16 - 4 * k, dy = y - 24;
      const bool is_disc = dx * dx + dy * dy < 100;
      const auto ground = static_cast<std::uint8_t>(is_disc ? 255 : is_glass ? 0 : 255);
      const std::array<std::uint8_t, 4> pixel =
          is_disc ? std::array<std::uint8_t, 4>{220, 40, 40, 255}
                  : std::array<std::uint8_t, 4>{90, 90, 90, ground};
      image.rgba.insert(image.rgba.end(), pixel.begin(), pixel.end());
    }
  }
  return image;
}

class VideoFormat : public ::testing::TestWithParam<const char*> {
 protected:
  std::filesystem::path Write(const char* name, bool is_glass, FrameRate rate = {25, 1}) {
    const std::filesystem::path path = folder_ / (name + std::string(GetParam()));
    VideoOptions options;
    options.rate = rate;
    options.metadata = {{"comment", kComment}};
    const auto video = MakeVideoWriter(path, 64, 48, options);
    for (int k = 0; k < kPictures; ++k) video->Add(Disc(k, is_glass));
    video->Finish();
    return path;
  }

  static constexpr int kPictures = 8;
  // Longer than a block of a GIF's comment, with what XML would not like.
  const std::string kComment = "{\"a\": \"<b> & c\", \"long\": \"" + std::string(600, 'x') + "\"}";
  TempFolder folder_;
};

TEST_P(VideoFormat, IsReadInOrderWithItsTimesAndItsComment) {
  const auto video = OpenVideo(Write("disc", false));
  EXPECT_EQ(video->metadata()["comment"], kComment);
  Image image;
  for (int k = 0; k < kPictures; ++k) {
    ASSERT_TRUE(video->Next(image)) << "picture " << k << " is missing";
    EXPECT_NEAR(video->secs(), k / 25.0, 1e-6);
    const std::uint8_t* middle = &image.rgba[4 * static_cast<std::size_t>(24 * 64 + 16 + 4 * k)];
    EXPECT_NEAR(middle[0], 220, 12);
    EXPECT_NEAR(middle[1], 40, 12);
    EXPECT_EQ(middle[3], 255);
    EXPECT_NEAR(image.rgba[0], 90, 6);
    EXPECT_EQ(image.rgba[3], 255);
  }
  EXPECT_FALSE(video->Next(image));
}

TEST_P(VideoFormat, HasTheSameBytesForTheSameFrames) {
  const std::string first = ReadFile(Write("first", false));
  for (int again = 0; again < 8; ++again) {  // of memory that others have used
    EXPECT_TRUE(ReadFile(Write("again", false)) == first) << "clip " << again << " differs";
  }
}

TEST_P(VideoFormat, KeepsTransparencyOrReportsThatItCannot) {
  if (std::string(GetParam()) == ".mp4") {
    try {
      Write("glass", true);
      FAIL() << "H.264 took a transparent picture";
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(".webm"));
    }
    EXPECT_THAT(folder_.Names(), ::testing::IsEmpty());
    return;
  }
  const auto video = OpenVideo(Write("glass", true));
  Image image;
  for (int k = 0; k < kPictures; ++k) {
    ASSERT_TRUE(video->Next(image));
    EXPECT_GE(image.rgba[4 * static_cast<std::size_t>(24 * 64 + 16 + 4 * k) + 3], 250) << k;
    EXPECT_LE(image.rgba[3], 5) << k;
  }
}

// Colour is stored for two by two pixels: without care those at the edge would take on the colour
// that nobody sees beside them.
TEST(Video, KeepsTheColourOfEdgesBesideTransparentPixels) {
  const TempFolder folder;
  const auto video = MakeVideoWriter(folder / "a.webm", 64, 48, {});
  video->Add(Disc(3, true));
  video->Finish();
  Image decoded;
  ASSERT_TRUE(OpenVideo(folder / "a.webm")->Next(decoded));
  const Image drawn = Disc(3, true);
  int most = 0;
  for (std::size_t at = 0; at < drawn.rgba.size(); at += 4) {
    if (drawn.rgba[at + 3] != 255) continue;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      most = std::max(most, std::abs(drawn.rgba[at + channel] - decoded.rgba[at + channel]));
    }
  }
  EXPECT_LE(most, 12) << "levels";
}

TEST_P(VideoFormat, LeavesNothingOfAnUnfinishedClip) {
  {
    const auto video = MakeVideoWriter(folder_ / ("a" + std::string(GetParam())), 64, 48, {});
    video->Add(Disc(0, false));
  }
  EXPECT_THAT(folder_.Names(), ::testing::IsEmpty());
}

TEST_P(VideoFormat, ReadsNoFrameFromADamagedFile) {
  const std::filesystem::path path = Write("whole", false);
  const std::string bytes = ReadFile(path);
  const std::filesystem::path cut = folder_ / ("cut" + std::string(GetParam()));
  std::ofstream(cut, std::ios::binary) << bytes.substr(0, 40);
  try {
    Image image;
    EXPECT_FALSE(OpenVideo(cut)->Next(image));
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("cut"));
  }
  EXPECT_THROW(OpenVideo(folder_ / "missing"), std::runtime_error);
}

INSTANTIATE_TEST_SUITE_P(All, VideoFormat, ::testing::Values(".mp4", ".webm", ".webp", ".gif"),
                         [](const auto& each) { return std::string(each.param).substr(1); });

TEST(FrameRate, ReturnsTheNearestNanosecondOfEveryFrame) {
  EXPECT_EQ((FrameRate{30, 1}.NanosOf(1)), 33'333'333);
  EXPECT_EQ((FrameRate{30, 1}.NanosOf(1800)), 60'000'000'000);
  EXPECT_EQ((FrameRate{30000, 1001}.NanosOf(30000)), 1'001'000'000'000);
  // A day at the largest numbers that --fps takes: nothing overflows, nothing drifts.
  EXPECT_EQ((FrameRate{1'000'000, 9000}.NanosOf(9'600'000)), 86'400'000'000'000);
}

TEST(Video, HasItsIndexBeforeItsDataForStreaming) {
  const TempFolder folder;
  WriteClip(folder / "clip.mp4", 10, {30, 1});
  const std::string bytes = ReadFile(folder / "clip.mp4");
  ASSERT_NE(bytes.find("moov"), std::string::npos);
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
}

TEST(Video, HasTheSameBytesForTheSameFrames) {
  const TempFolder folder;
  WriteClip(folder / "a.mp4", 20, {30, 1});
  WriteClip(folder / "b.mp4", 20, {30, 1});
  EXPECT_EQ(ReadFile(folder / "a.mp4"), ReadFile(folder / "b.mp4"));
}

// A square that goes over a still floor.
TEST(Video, HasTheSameBytesIfTheFloorOfItsFramesIsKnown) {
  const TempFolder folder;
  const Image still = Frame(3);
  const auto floor = std::make_shared<const std::vector<std::uint8_t>>(still.rgba);
  const auto write = [&](const char* name, bool is_known) {
    const auto writer = MakeVideoWriter(folder / name, kClipWidth, kClipHeight, VideoOptions());
    for (int k = 0; k < 30; ++k) {
      Image image = still;
      const Tile square{7 * k, 5 * k, 31, 40};
      for (int y = square.y; y < square.y + square.height && y < kClipHeight; ++y) {
        const auto row = image.rgba.begin() + 4 * (y * kClipWidth + square.x);
        std::fill(row, row + 4 * square.width, static_cast<std::uint8_t>(200 + k));
        for (int x = 0; x < square.width; ++x) row[4 * x + 3] = 255;
      }
      image.changed = CellSet(kClipWidth, kClipHeight);
      image.changed.Add(square);
      const bool is_of_another = k == 12;  // a camera that moved for once
      if (is_known && !is_of_another) image.floor = floor;
      writer->Add(image);
    }
    writer->Finish();
    return ReadFile(folder / name);
  };
  EXPECT_TRUE(write("known.mp4", true) == write("unknown.mp4", false));
}

TEST(Video, PrintsNothingToStandardError) {
  const TempFolder folder;
  ::testing::internal::CaptureStderr();
  WriteClip(folder / "clip.mp4", 5, {30, 1});
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Video, HasTheSameFramesAccordingToFfprobe) {
  if (std::system("command -v ffprobe >/dev/null 2>&1") != 0) GTEST_SKIP() << "no ffprobe here";
  const TempFolder folder;
  WriteClip(folder / "clip.mp4", 31, {30000, 1001});
  const std::string command =
      "ffprobe -v error -count_frames -show_entries stream=nb_read_frames,r_frame_rate,color_space"
      " -of csv=p=0 " +
      (folder / "clip.mp4").string();
  FILE* pipe = ::popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  char line[200] = "";
  EXPECT_NE(std::fgets(line, sizeof line, pipe), nullptr);
  EXPECT_EQ(::pclose(pipe), 0);
  EXPECT_STREQ(line, "bt709,30000/1001,31\n");
}

TEST(Video, LeavesNothingOfAnUnfinishedClip) {
  const TempFolder folder;
  {
    const auto video = MakeVideoWriter(folder / "clip.mp4", kClipWidth, kClipHeight, {});
    for (int k = 0; k < 5; ++k) video->Add(Frame(k));
    EXPECT_THAT(folder.Names(), ::testing::Not(::testing::Contains("clip.mp4")))
        << "half a clip is there";
  }
  EXPECT_THAT(folder.Names(), ::testing::IsEmpty());
}

TEST(Video, KeepsTheOldClipUntilTheNewOneIsComplete) {
  const TempFolder folder;
  std::ofstream(folder / "clip.mp4") << "old";
  {
    const auto video = MakeVideoWriter(folder / "clip.mp4", kClipWidth, kClipHeight, {});
    video->Add(Frame(0));
    EXPECT_EQ(ReadFile(folder / "clip.mp4"), "old");
    video->Finish();
  }
  EXPECT_EQ(ReadClip(folder / "clip.mp4").frames.size(), 1u);
  EXPECT_THAT(folder.Names(), ::testing::ElementsAre("clip.mp4"));
}

TEST(Video, RejectsAFrameOfAnotherSize) {
  const TempFolder folder;
  const auto video = MakeVideoWriter(folder / "clip.mp4", kClipWidth, kClipHeight, {});
  video->Add(Frame(0));
  EXPECT_THROW(video->Add(Frame(1, 64, 64)), std::runtime_error);
  video->Add(Frame(1));  // the clip goes on
  video->Finish();
  EXPECT_EQ(ReadClip(folder / "clip.mp4").frames.size(), 2u);
}

TEST(Video, RejectsAnEmptyClip) {
  const TempFolder folder;
  const auto video = MakeVideoWriter(folder / "clip.mp4", kClipWidth, kClipHeight, {});
  EXPECT_THROW(video->Finish(), std::runtime_error);
}

TEST(Video, RejectsSizesAndRatesThatCannotBeEncoded) {
  const TempFolder folder;
  EXPECT_THROW(MakeVideoWriter(folder / "c.mp4", 321, 180, {}), UsageError);
  EXPECT_THROW(MakeVideoWriter(folder / "c.mp4", 320, 181, {}), UsageError);
  EXPECT_THROW(MakeVideoWriter(folder / "c.mp4", 0, 0, {}), UsageError);
  VideoOptions options;
  for (const FrameRate rate : {FrameRate{0, 1}, {-30, 1}, {30, 0}, {2000, 1}}) {
    options.rate = rate;
    EXPECT_THROW(MakeVideoWriter(folder / "c.mp4", 320, 180, options), UsageError) << rate.hz();
  }
  options.rate = {60, 1};
  EXPECT_THROW(MakeVideoWriter(folder / "c.gif", 320, 180, options), UsageError);
  EXPECT_THROW(MakeVideoWriter(folder / "c.avi", 320, 180, {}), UsageError);
  options = {};
  options.crf = 52;
  EXPECT_THROW(MakeVideoWriter(folder / "c.mp4", 320, 180, options), UsageError);
  EXPECT_THAT(folder.Names(), ::testing::IsEmpty());
}

TEST(Video, NamesAPathThatIsNotWritable) {
  try {
    MakeVideoWriter("/no/such/folder/clip.mp4", 320, 180, {});
    FAIL() << "writes into a folder that does not exist";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("/no/such/folder/clip.mp4"));
  }
}

TEST(Video, KeepsTheFrameCodeReadable) {
  const TempFolder folder;
  const auto path = folder.path() / "strip.mp4";
  VideoOptions options;
  options.crf = 23;
  constexpr int kFrames = 12;
  // Noise above it takes the bits that the encoder would rather spend there.
  std::mt19937 random(1);
  const auto code = [](int k) { return FrameCode{1000000007u * (k + 1u), 33 * k + 12'345}; };
  for (const auto& [width, height] : {std::pair{320, 240}, {1280, 96}}) {
    const auto writer = MakeVideoWriter(path, width, height, options);
    for (int k = 0; k < kFrames; ++k) {
      Image image = Frame(k, width, height);
      for (std::size_t i = 0; i < image.rgba.size(); ++i) {
        if (i % 4 != 3) image.rgba[i] ^= random() & 0x3F;
      }
      Canvas canvas(image);
      PaintFrameCode(canvas, width, height, code(k));
      writer->Add(image);
    }
    writer->Finish();
    const Clip clip = ReadClip(path);
    ASSERT_EQ(clip.frames.size(), static_cast<std::size_t>(kFrames));
    for (int k = 0; k < kFrames; ++k) {
      const Image& frame = clip.frames[static_cast<std::size_t>(k)];
      EXPECT_EQ(ReadFrameCode(frame), code(k)) << "frame " << k << ", " << width << " px wide";
      Image half{width / 2, height / 2, {}};
      half.rgba.resize(static_cast<std::size_t>(4 * half.width * half.height));
      AverageInto(frame.rgba.data(), half.width, half.height, 2, half, 0, 0);
      EXPECT_EQ(ReadFrameCode(half), code(k))
          << "half of frame " << k << ", " << width << " px wide";
    }
  }
}

}  // namespace
}  // namespace kinescope::render
