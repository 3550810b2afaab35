#include "render/image/yuv.h"

#include <cstring>

#include "core/system/check.h"

namespace kinescope::render {
namespace {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "red is the lowest byte of a pixel");

// BT.709: Y = 0.2126 R + 0.7152 G + 0.0722 B, U = (B - Y) / 1.8556, V = (R - Y) / 1.5748; of
// levels, Y takes 219 and the others 224. In 65536ths, rounded so that each row keeps its sum:
// white is 235 and every grey is 128.
constexpr int kBits = 16;
constexpr int kYOfR = 11966, kYOfG = 40254, kYOfB = 4064;
constexpr int kUOfR = -6596, kUOfG = -22188, kUOfB = 28784;
constexpr int kVOfR = 28784, kVOfG = -26145, kVOfB = -2639;
static_assert(kUOfR + kUOfG + kUOfB == 0 && kVOfR + kVOfG + kVOfB == 0);

constexpr int kYOffset = (16 << kBits) + (1 << (kBits - 1));
// Of the sum of four pixels.
constexpr int kUvBits = kBits + 2;
constexpr int kUvOffset = (128 << kUvBits) + (1 << (kUvBits - 1));

#define KINESCOPE_INLINE inline __attribute__((always_inline))

KINESCOPE_INLINE std::uint32_t Load(const std::uint8_t* pixel) {
  std::uint32_t rgba = 0;
  std::memcpy(&rgba, pixel, sizeof rgba);
  return rgba;
}
KINESCOPE_INLINE int Red(std::uint32_t rgba) { return static_cast<int>(rgba & 0xFF); }
KINESCOPE_INLINE int Green(std::uint32_t rgba) { return static_cast<int>(rgba >> 8 & 0xFF); }
KINESCOPE_INLINE int Blue(std::uint32_t rgba) { return static_cast<int>(rgba >> 16 & 0xFF); }

// Plain loops, which the compiler turns into vectors (CMakeLists.txt asks it to).
KINESCOPE_INLINE void YOfRow(const std::uint8_t* __restrict rgba, int width,
                             std::uint8_t* __restrict out) {
  for (int x = 0; x < width; ++x) {
    const std::uint32_t pixel = Load(rgba + 4 * static_cast<std::size_t>(x));
    const int y = kYOfR * Red(pixel) + kYOfG * Green(pixel) + kYOfB * Blue(pixel) + kYOffset;
    out[x] = static_cast<std::uint8_t>(y >> kBits);
  }
}

KINESCOPE_INLINE void UvOfRows(const std::uint8_t* __restrict top,
                               const std::uint8_t* __restrict bottom, int width,
                               std::uint8_t* __restrict u, std::uint8_t* __restrict v) {
  for (int x = 0; x < width; ++x) {
    const std::size_t at = 8 * static_cast<std::size_t>(x);
    const std::uint32_t a = Load(top + at), b = Load(top + at + 4);
    const std::uint32_t c = Load(bottom + at), d = Load(bottom + at + 4);
    const int red = Red(a) + Red(b) + Red(c) + Red(d);
    const int green = Green(a) + Green(b) + Green(c) + Green(d);
    const int blue = Blue(a) + Blue(b) + Blue(c) + Blue(d);
    u[x] = static_cast<std::uint8_t>((kUOfR * red + kUOfG * green + kUOfB * blue + kUvOffset) >>
                                     kUvBits);
    v[x] = static_cast<std::uint8_t>((kVOfR * red + kVOfG * green + kVOfB * blue + kUvOffset) >>
                                     kUvBits);
  }
}

KINESCOPE_INLINE void ConvertRows(const std::uint8_t* rgba, std::size_t stride, int width,
                                  int height, YuvPlanes to) {
  for (int y = 0; y < height; y += 2) {
    const std::uint8_t* const below = rgba + stride;
    YOfRow(rgba, width, to.y);
    YOfRow(below, width, to.y + to.y_stride);
    UvOfRows(rgba, below, width / 2, to.u, to.v);
    rgba += 2 * stride;
    to.y += 2 * to.y_stride;
    to.u += to.u_stride;
    to.v += to.v_stride;
  }
}

using Convert = void (*)(const std::uint8_t*, std::size_t, int, int, YuvPlanes);

void ConvertAnywhere(const std::uint8_t* rgba, std::size_t stride, int width, int height,
                     YuvPlanes to) {
  ConvertRows(rgba, stride, width, height, to);
}

#ifdef __x86_64__
__attribute__((target("avx2"))) void ConvertWide(const std::uint8_t* rgba, std::size_t stride,
                                                 int width, int height, YuvPlanes to) {
  ConvertRows(rgba, stride, width, height, to);
}
#endif

Convert BestConvert() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") != 0) return ConvertWide;
#endif
  return ConvertAnywhere;
}

}  // namespace

void ToYuv(const Image& image, int x, int y, int width, int height, const YuvPlanes& planes) {
  KINESCOPE_CHECK(x >= 0 && y >= 0 && width >= 0 && height >= 0);
  KINESCOPE_CHECK(x + width <= image.width && y + height <= image.height);
  KINESCOPE_CHECK((x | y | width | height) % 2 == 0);
  static const Convert convert = BestConvert();
  const std::size_t stride = 4 * static_cast<std::size_t>(image.width);
  YuvPlanes to = planes;
  to.y += y * to.y_stride + x;
  to.u += y / 2 * to.u_stride + x / 2;
  to.v += y / 2 * to.v_stride + x / 2;
  convert(
      image.rgba.data() + static_cast<std::size_t>(y) * stride + 4 * static_cast<std::size_t>(x),
      stride, width, height, to);
}

void CopyAlpha(const Image& image, std::uint8_t* plane, std::ptrdiff_t stride) {
  const std::uint8_t* alpha = image.rgba.data() + 3;
  for (int y = 0; y < image.height; ++y, plane += stride) {
    for (int x = 0; x < image.width; ++x, alpha += 4) plane[x] = *alpha;
  }
}

}  // namespace kinescope::render
