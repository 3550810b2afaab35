#include "server/app/render/render_options.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numeric>

#include "core/system/errors.h"
#include "server/scene/scene_reader.h"
#include "server/source/scheme.h"

namespace kinescope::app {
namespace {

using options::Number;
using options::Whole;

constexpr std::size_t kMaxCameras = 64;

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
  constexpr std::size_t kMaxDigits = 9;  // so that nothing overflows
  if (text.size() > 2 * kMaxDigits) return std::nullopt;
  if (const std::size_t slash = text.find('/'); slash != std::string::npos) {
    const auto above = ParseWhole(text.substr(0, slash));
    const auto below = ParseWhole(text.substr(slash + 1));
    if (!above || !below) return std::nullopt;
    return Fraction{*above, *below};
  }
  const std::size_t point = std::min(text.find('.'), text.size());
  const std::string decimals = text.substr(std::min(point + 1, text.size()));
  const auto whole = ParseWhole(text.substr(0, point) + decimals);
  if (!whole || decimals.size() > kMaxDigits) return std::nullopt;
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

std::int64_t ToNanos(double secs) { return std::llround(secs * 1e9); }

}  // namespace

MomentOptions::MomentOptions()
    : sample(Whole(0, {0, kLatestSample})),
      time(Number(0, {0, kLatestSecs, "s"})),
      overlay_layer(
          options::Choice<render::LayerFormat>({{"svg", render::LayerFormat::kSvg},
                                                {"pdf", render::LayerFormat::kPdf},
                                                {"pdf_page", render::LayerFormat::kPdfPage}},
                                               render::LayerFormat::kSvg)) {}

void MomentOptions::List(options::OptionList& option) {
  option("sample", sample, "index of the sample that one picture shows, from 0 (the default)");
  option.Formerly("frame");
  option("time", time, "time that one picture shows, after the first sample; between samples too");
  option("overlay_layer", overlay_layer,
         "format of a second file beside one picture, with the texts and plots over it as vectors; "
         "pdf_page: with the picture under them, which is then complete in both files");
}

void FrameRateValue::Parse(const std::string& text) {
  auto fraction = ParseFraction(text);
  if (fraction && fraction->denominator > 0) {
    if (text.find('/') == std::string::npos) fraction = AsBroadcast(*fraction);
    const long divisor = std::gcd(fraction->numerator, fraction->denominator);
    const Fraction rate = {fraction->numerator / std::max(1L, divisor),
                           fraction->denominator / std::max(1L, divisor)};
    const bool fits = rate.numerator <= 1'000'000 && rate.denominator <= 9'000;
    if (fits && rate.numerator > 0 && rate.numerator <= 1000 * rate.denominator) {
      value_ = {static_cast<int>(rate.numerator), static_cast<int>(rate.denominator)};
      text_ = text;
      return;
    }
  }
  RefuseText();
}

std::string FrameRateValue::Expected() const {
  return "a number above 0, at most 1000, such as 30, 12.5, 29.97 or 30000/1001";
}

ClipOptions::ClipOptions()
    : start(0, {0, kLatestSecs, "s"}),
      seconds(Number(0, {0, kLatestSecs, "s", true})),
      end(Number(0, {0, kLatestSecs, "s", true})) {}

void ClipOptions::List(options::OptionList& option) {
  option("fps", fps, "frame rate, pictures per second");
  option("start", start, "time after the first sample at which the clip begins");
  option("seconds", seconds, "length of the clip; default: to the end (demo: and pose: 10 s)");
  option("end", end, "time after the first sample at which the clip ends, in place of --seconds");
}

PackOptions::PackOptions()
    : crf(Whole(18, {0, 63})), quality(render::VideoOptions().quality, {0, 100}) {}

void PackOptions::List(options::OptionList& option) {
  option(
      "crf", crf,
      "constant rate factor, less is better: .mp4 0 (lossless) to 51, default 18; .webm 0 to 63, "
      "default 24");
  option("quality", quality, "quality of .webp, more is better; 100: lossless");
}

RenderOptions::RenderOptions()
    : outs("FILE.png, .mp4, .webm, .webp or .gif"),
      view(kMaxCameras),
      jobs(0, {0, 64, "", false, "0: as many as are fastest here"}) {}

void RenderOptions::List(options::OptionList& option) {
  option.Group("Files");
  option("source", sources,
         "source of the people, once or several times: " + RecordedSourceKinds());
  option("out", outs,
         "file to write, once or several times; its ending selects the format. A .png with %05d or "
         "##### in its name is a numbered sequence. {source} and {camera} are replaced");
  option("force", force, "draw again although the output is up to date");
  option("no_sidecar", no_sidecar, "write no FILE.json beside each output");
  option("jobs", jobs, "number of drawing threads; any number makes the same files");
  option("json", json, "print the result as JSON, one line per output");
  option(
      "verify", verify,
      "draw FILE again from its provenance and compare. Exit code 0: equal, 1: different. Give the "
      "source if it has moved");
  option.Group("Moments");
  moment.List(option);
  clip.List(option);
  pack.List(option);
  option("marks", marks, kMarksHelp);
  option("rviz", rviz, kRvizHelp);
  view.List(option);
  backend.List(option);
  person.List(option);
  loads.List(option);
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
  grid.rate = *options.fps;
  grid.start_nanos = ToNanos(*options.start);
  if (options.seconds && options.end) {
    throw UsageError("--seconds and --end both set the end of the clip; give only one of them");
  }
  if (options.seconds) grid.length_nanos = ToNanos(*options.seconds);
  if (options.end) {
    const std::int64_t end = ToNanos(*options.end);
    if (end <= grid.start_nanos) {
      throw UsageError(fmt::format("--end={}: expected a time after --start, {} s", *options.end,
                                   *options.start));
    }
    grid.length_nanos = end - grid.start_nanos;
  }
  if (!grid.length_nanos && is_endless) grid.length_nanos = ToNanos(kSubjectClipSecs);
  return grid;
}

}  // namespace kinescope::app
