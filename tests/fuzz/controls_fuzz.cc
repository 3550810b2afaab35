// Any text as the body of an order of an operator, as the file of a trial, and as a name of a
// person or a file: each is understood or refused with a reason, within its bounds.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "core/system/check.h"
#include "core/system/utf8.h"
#include "server/http/control_orders.h"
#include "server/recording/folder.h"
#include "server/recording/trial.h"

namespace controls_fuzz {
namespace {

using namespace kinescope;

template <class Order>
void CheckError(const http::Parsed<Order>& order) {
  if (order) return;
  KINESCOPE_CHECK(!order.error().empty() && order.error().find('\n') == std::string::npos);
}

void CheckLabel(const std::string& label) {
  KINESCOPE_CHECK(DecodeUtf8(label).size() <= http::kLongestLabel);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto recording = http::ParseRecordingOrder(text);
  CheckError(recording);
  if (recording) CheckLabel(recording->label);
  const auto clip = http::ParseClipOrder(text);
  CheckError(clip);
  if (clip) KINESCOPE_CHECK(clip->from_micros.has_value() == clip->to_micros.has_value());
  const auto person = http::ParsePersonOrder(text);
  CheckError(person);
  if (person && person->change.mass_kg) KINESCOPE_CHECK(std::isfinite(*person->change.mass_kg));
  if (person && person->change.name) CheckLabel(*person->change.name);
  CheckError(http::ParseLimitsOrder(text));
  const auto trial = http::ParseTrialOrder(text);
  CheckError(trial);
  if (trial) KINESCOPE_CHECK(trial->number >= 1 && trial->number <= 9999);
  if (const auto read = recording::ReadTrial(text)) {
    KINESCOPE_CHECK(std::isfinite(recording::LengthSecs(*read)));
    const auto again = recording::ReadTrial(recording::TrialText(*read));
    KINESCOPE_CHECK(again && recording::TrialText(*again) == recording::TrialText(*read));
  }
  const std::string part = recording::NamePart(text, "name");
  KINESCOPE_CHECK(!part.empty() && part.size() <= 40 &&
                  part.find_first_of("/.\\") == std::string::npos);
  const recording::Folder folder(std::filesystem::temp_directory_path(), false);
  const auto found = folder.Find(text);
  KINESCOPE_CHECK(!found || found->parent_path() == folder.path());
  return 0;
}

}  // namespace controls_fuzz
