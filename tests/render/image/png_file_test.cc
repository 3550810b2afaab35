#include "render/image/png_file.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>

// clang-format off
#include <jpeglib.h>
// clang-format on

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include "tests/shared_data.h"
#include "tests/temp_folder.h"

namespace kinescope::render {
namespace {

namespace fs = std::filesystem;
using testing::TempFolder;

Image Noise(int width, int height, bool is_opaque, unsigned seed = 7) {
  Image image{width, height,
              std::vector<std::uint8_t>(static_cast<std::size_t>(4 * width * height))};
  std::mt19937 random(seed);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    image.rgba[i] = is_opaque && i % 4 == 3 ? 255 : static_cast<std::uint8_t>(random());
  }
  return image;
}

TEST(PngFile, IsReadAsItWasWritten) {
  const TempFolder folder;
  for (const bool is_opaque : {true, false}) {
    for (const int width : {1, 3, 64, 333}) {
      const Image image = Noise(width, 17, is_opaque);
      WritePng(folder / "noise.png", image);
      const Image back = ReadPng(folder / "noise.png");
      EXPECT_EQ(back.width, width);
      EXPECT_EQ(back.height, 17);
      EXPECT_EQ(back.rgba, image.rgba) << width << " px wide, opaque " << is_opaque;
    }
  }
}

TEST(PngFile, OmitsAlphaOnlyForOpaquePictures) {
  const auto color_type = [](const Image& image) { return EncodePng(image).at(25); };
  EXPECT_EQ(color_type(Noise(5, 5, true)), PNG_COLOR_TYPE_RGB);
  Image glass = Noise(5, 5, true);
  glass.rgba[4 * 12 + 3] = 254;
  EXPECT_EQ(color_type(glass), PNG_COLOR_TYPE_RGBA);
}

TEST(PngFile, ContainsTextInStandardChunks) {
  const std::vector<std::uint8_t> bytes =
      EncodePng(Noise(4, 4, true), {{"Software", "kinescope"}, {"Title", "trial 3"}});
  const std::string text(bytes.begin(), bytes.end());
  EXPECT_NE(text.find(std::string("tEXtSoftware\0kinescope", 22)), std::string::npos);
  EXPECT_NE(text.find(std::string("tEXtTitle\0trial 3", 17)), std::string::npos);
}

TEST(PngFile, HasTheSameBytesForTheSamePicture) {
  EXPECT_EQ(EncodePng(Noise(90, 40, true)), EncodePng(Noise(90, 40, true)));
}

TEST(PngFile, ReplacesAFileAndLeavesNoOtherFile) {
  const TempFolder folder;
  WritePng(folder / "a.png", Noise(4, 4, true, 1));
  WritePng(folder / "a.png", Noise(4, 4, true, 2));
  EXPECT_EQ(ReadPng(folder / "a.png").rgba, Noise(4, 4, true, 2).rgba);
  EXPECT_THAT(folder.Names(), ::testing::ElementsAre("a.png"));
}

TEST(PngFile, NamesAPathThatIsNotWritable) {
  const TempFolder folder;
  const auto message = [&](const fs::path& path) -> std::string {
    try {
      WritePng(path, Noise(4, 4, true));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "wrote it";
  };
  EXPECT_THAT(message(folder / "no/such/a.png"), ::testing::HasSubstr("no/such/a.png"));
  fs::create_directory(folder / "folder.png");
  EXPECT_THAT(message(folder / "folder.png"), ::testing::HasSubstr("directory"));
  EXPECT_THAT(message("/proc/a.png"), ::testing::HasSubstr("/proc/a.png"));
  EXPECT_THAT(folder.Names(), ::testing::ElementsAre("folder.png"));
}

TEST(PngFile, RejectsEveryTruncation) {
  const TempFolder folder;
  const std::vector<std::uint8_t> whole = EncodePng(Noise(6, 5, true));
  for (std::size_t size = 0; size + 12 < whole.size(); size += 3) {  // IEND is no loss
    std::ofstream(folder / "cut.png", std::ios::binary)
        .write(reinterpret_cast<const char*>(whole.data()), static_cast<std::streamsize>(size));
    EXPECT_THROW(ReadPng(folder / "cut.png"), std::runtime_error) << "took " << size << " bytes";
  }
}

TEST(PngFile, AllocatesNoMemoryForAFalseSizeInTheHeader) {
  const TempFolder folder;
  std::vector<std::uint8_t> bomb = EncodePng(Noise(6, 5, true));
  bomb[16] = 0x40;  // a width of 2^30 and more
  const uLong crc = crc32(0, bomb.data() + 12, 17);
  for (int i = 0; i < 4; ++i)
    bomb[static_cast<std::size_t>(29 + i)] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
  std::ofstream(folder / "bomb.png", std::ios::binary)
      .write(reinterpret_cast<const char*>(bomb.data()), static_cast<std::streamsize>(bomb.size()));
  EXPECT_THROW(ReadPng(folder / "bomb.png"), std::runtime_error);
}

TEST(PngFile, NamesAMissingFile) {
  try {
    ReadPng("/no/such/picture.png");
    FAIL() << "read a file that does not exist";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("/no/such/picture.png"));
  }
}

Image DecodeJpeg(const std::vector<std::uint8_t>& bytes) {
  jpeg_decompress_struct state = {};
  jpeg_error_mgr errors = {};
  state.err = jpeg_std_error(&errors);
  jpeg_create_decompress(&state);
  jpeg_mem_src(&state, bytes.data(), bytes.size());
  jpeg_read_header(&state, TRUE);
  state.out_color_space = JCS_EXT_RGBA;
  jpeg_start_decompress(&state);
  Image image{static_cast<int>(state.output_width), static_cast<int>(state.output_height), {}};
  image.rgba.resize(std::size_t{4} * state.output_width * state.output_height);
  while (state.output_scanline < state.output_height) {
    JSAMPROW row = &image.rgba[std::size_t{4} * state.output_scanline * state.output_width];
    jpeg_read_scanlines(&state, &row, 1);
  }
  jpeg_finish_decompress(&state);
  jpeg_destroy_decompress(&state);
  return image;
}

TEST(Jpeg, IsReadByAnotherDecoder) {
  Image image{121, 67, {}};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      image.rgba.insert(image.rgba.end(), {static_cast<std::uint8_t>(2 * x),
                                           static_cast<std::uint8_t>(3 * y), 80, 255});
    }
  }
  const Image back = DecodeJpeg(EncodeJpeg(image, 90));
  ASSERT_EQ(back.width, image.width);
  ASSERT_EQ(back.height, image.height);
  double sum = 0;
  for (std::size_t i = 0; i < image.rgba.size(); ++i) sum += std::abs(image.rgba[i] - back.rgba[i]);
  EXPECT_LT(sum / static_cast<double>(image.rgba.size()), 2.0) << "levels, on average";
}

TEST(Jpeg, IsSmallerAtLowerQuality) {
  const Image image = Noise(64, 64, true);
  EXPECT_LT(EncodeJpeg(image, 30).size(), EncodeJpeg(image, 95).size());
}

}  // namespace
}  // namespace kinescope::render
