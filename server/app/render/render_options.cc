#include "server/app/render/render_options.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numeric>

#include "core/errors.h"
#include "server/scene/scene_reader.h"

namespace kinescope::app {
namespace {

// An endless source (the built-in subject) gives a clip of this length unless told otherwise.
constexpr double kDefaultClipSecs = 10;

std::optional<long> ParseWhole(const std::string& text) {
  long value = 0;
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  if (text.empty() || parsed.ec != std::errc() || parsed.ptr != end || value < 0) {
    return std::nullopt;
  }
  return value;
}

struct Fraction {
  long numerator, denominator;
};

// "30000/1001", "12.5", "30".
std::optional<Fraction> ParseFraction(const std::string& text) {
  constexpr std::size_t kMostDigits = 9;  // so that nothing overflows
  if (text.size() > 2 * kMostDigits) return std::nullopt;
  if (const std::size_t slash = text.find('/'); slash != std::string::npos) {
    const auto above = ParseWhole(text.substr(0, slash));
    const auto below = ParseWhole(text.substr(slash + 1));
    if (!above || !below) return std::nullopt;
    return Fraction{*above, *below};
  }
  const std::size_t point = std::min(text.find('.'), text.size());
  const std::string decimals = text.substr(std::min(point + 1, text.size()));
  const auto whole = ParseWhole(text.substr(0, point) + decimals);
  if (!whole || decimals.size() > kMostDigits) return std::nullopt;
  long scale = 1;
  for (std::size_t i = 0; i < decimals.size(); ++i) scale *= 10;
  return Fraction{*whole, scale};
}

// What is written 29.97 is 30000/1001; so with every multiple of 6 but for 6 x 2.
Fraction AsBroadcast(Fraction given) {
  const double hz = static_cast<double>(given.numerator) / static_cast<double>(given.denominator);
  const double rounded = std::round(hz);
  const bool is_ntsc = rounded >= 24 && std::fmod(rounded, 6) == 0 &&
                       std::abs(hz - rounded * 1000 / 1001) < 0.0006 * rounded / 24;
  return is_ntsc ? Fraction{static_cast<long>(rounded) * 1000, 1001} : given;
}

std::int64_t ToNanos(const char* name, double secs, bool may_be_zero) {
  if (!(secs <= kLatestSecs && (secs > 0 || (may_be_zero && secs == 0)))) {
    throw UsageError(fmt::format("--{}={}: expected {} to {:.0f} s", name, secs,
                                 may_be_zero ? "0" : "more than 0", kLatestSecs));
  }
  return std::llround(secs * 1e9);
}

}  // namespace

render::LayerFormat ToLayerFormat(const std::string& text) {
  if (text == "svg") return render::LayerFormat::kSvg;
  if (text == "pdf") return render::LayerFormat::kPdf;
  throw UsageError(fmt::format("--overlay_layer={}: expected svg or pdf", text));
}

render::FrameRate ParseFrameRate(const std::string& text) {
  auto fraction = ParseFraction(text);
  if (fraction && fraction->denominator > 0) {
    if (text.find('/') == std::string::npos) fraction = AsBroadcast(*fraction);
    const long divisor = std::gcd(fraction->numerator, fraction->denominator);
    const Fraction rate = {fraction->numerator / std::max(1L, divisor),
                           fraction->denominator / std::max(1L, divisor)};
    const bool fits = rate.numerator <= 1'000'000 && rate.denominator <= 9'000;
    if (fits && rate.numerator > 0 && rate.numerator <= 1000 * rate.denominator) {
      return {static_cast<int>(rate.numerator), static_cast<int>(rate.denominator)};
    }
  }
  throw UsageError(fmt::format(
      "--fps={}: expected pictures a second, more than 0 and at most 1000, such as 30, 12.5, 29.97 "
      "or 30000/1001",
      text));
}

std::optional<long> TimeGrid::count() const {
  if (!length_nanos) return std::nullopt;
  auto k = static_cast<long>(static_cast<double>(*length_nanos) * 1e-9 * rate.hz());
  while (k > 0 && !Has(k - 1)) --k;
  while (Has(k)) ++k;
  return k;
}

TimeGrid ToTimeGrid(const ClipOptions& options, bool is_endless) {
  TimeGrid grid;
  grid.rate = ParseFrameRate(options.fps);
  grid.start_nanos = ToNanos("start", options.start, true);
  if (options.seconds && options.end) {
    throw UsageError("--seconds and --end both say where the clip ends; give one of them");
  }
  if (options.seconds) grid.length_nanos = ToNanos("seconds", *options.seconds, false);
  if (options.end) {
    const std::int64_t end = ToNanos("end", *options.end, false);
    if (end <= grid.start_nanos) {
      throw UsageError(
          fmt::format("--end={}: expected more than --start, {}", *options.end, options.start));
    }
    grid.length_nanos = end - grid.start_nanos;
  }
  if (!grid.length_nanos && is_endless) grid.length_nanos = std::llround(kDefaultClipSecs * 1e9);
  return grid;
}

}  // namespace kinescope::app
