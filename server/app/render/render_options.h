/// The options of `kinescope render`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/video.h"
#include "server/app/marks_option.h"
#include "server/options/option_list.h"
#include "server/picture/backend.h"
#include "server/picture/rviz_option.h"
#include "server/picture/view_options.h"
#include "server/scene/scene_options.h"

namespace kinescope::app {

/// Which moment a picture shows.
struct MomentOptions {
  MomentOptions();

  options::Optional<options::Whole> sample;
  options::Optional<options::Number> time;  // s
  options::Optional<options::Choice<render::LayerFormat>> overlay_layer;

  void List(options::OptionList& option);
};

/// "30", "12.5", "30000/1001"; 23.976, 29.97, 59.94 and the like mean their exact n * 1000 / 1001.
class FrameRateValue : public options::ValueOf<render::FrameRate> {
 public:
  FrameRateValue() : ValueOf({30, 1}) {}

  void Parse(const std::string& text) override;
  std::string ToText() const override { return text_; }
  std::string Expected() const override;

 private:
  std::string text_ = "30";
};

/// Which part of the motion a clip or a sequence shows, and how often.
struct ClipOptions {
  ClipOptions();

  FrameRateValue fps;
  options::Number start;  // s
  options::Optional<options::Number> seconds, end;

  void List(options::OptionList& option);
};

/// How a clip is packed.
struct PackOptions {
  PackOptions();

  options::Optional<options::Whole> crf;
  options::Whole quality;
  int encoding = render::kClipEncoding;  // no option: of the file that is verified

  void List(options::OptionList& option);
};

struct RenderOptions {
  RenderOptions();

  options::Texts sources, outs;
  MomentOptions moment;
  ClipOptions clip;
  PackOptions pack;
  ViewOptions view;
  BackendOptions backend;
  PersonOptions person;
  LoadOptions loads;
  options::FilePath marks, rviz;
  options::Whole jobs;  // 0: as many as are fastest here
  options::Flag force, no_sidecar, json;
  options::Text verify;  // a file; "": draws

  void List(options::OptionList& option);
};

/// The pictures of a clip: number k shows the moment `start_nanos` + NanosOf(k) after the first
/// sample, and there are those before `length_nanos`, or all that the source has.
struct TimeGrid {
  render::FrameRate rate;
  std::int64_t start_nanos = 0;
  std::optional<std::int64_t> length_nanos;

  std::int64_t NanosOf(long k) const { return start_nanos + rate.NanosOf(k); }
  bool Has(long k) const { return !length_nanos || rate.NanosOf(k) < *length_nanos; }
  /// How many; nullopt where the source decides.
  std::optional<long> count() const;
};

/// `is_endless`: a clip of a source without an end has 10 s by default.
/// @throws UsageError where options do not fit together.
TimeGrid ToTimeGrid(const ClipOptions& options, bool is_endless);

}  // namespace kinescope::app
