// Any text as a line of a file of marks, as the body of POST /api/v1/mark, and as the query of
// /api/v1/series: each is understood or refused with a reason, within its bounds.
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/system/check.h"
#include "core/system/json_text.h"
#include "core/system/utf8.h"
#include "server/http/mark_order.h"
#include "server/http/series_json.h"
#include "server/http/target.h"
#include "server/marks/mark_json.h"

namespace marks_fuzz {

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinescope;
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (const auto mark = marks::ReadMark(text)) {
    const auto again = marks::ReadMark(JsonText(ToJson(*mark)));
    KINESCOPE_CHECK(again && ToJson(*again) == ToJson(*mark));
  }
  const auto order = http::ParseMarkOrder(text);
  if (order) {
    KINESCOPE_CHECK(order->id || order->button != 0 || !order->text.empty());
    KINESCOPE_CHECK(order->button >= 0 && order->button <= 9);
    KINESCOPE_CHECK(DecodeUtf8(order->text).size() <= http::kLongestMark);
  } else {
    KINESCOPE_CHECK(!order.error().empty() && order.error().find('\n') == std::string::npos);
  }
  if (const auto target = http::ParseTarget("/api/v1/series?" + text)) {
    const auto question = http::ParseSeriesQuestion(target->query);
    KINESCOPE_CHECK(question || !question.error().empty());
    if (question) KINESCOPE_CHECK(question->columns <= http::kMostSeriesColumns);
  }
  return 0;
}

}  // namespace marks_fuzz
