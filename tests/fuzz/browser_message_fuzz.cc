// Any bytes as what a browser sends over its debugging pipe: a reason, or messages, and elements of
// a page whose names are unique.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <set>
#include <string>

#include "core/system/check.h"
#include "server/app/golden/page_messages.h"

namespace browser_message_fuzz {
namespace {

using namespace kinescope;

constexpr std::size_t kMostBytes = 4000;

void TryElements(const nlohmann::json& content) {
  const auto elements = content.find("elements");
  if (elements == content.end()) return;
  std::set<std::string> names;
  for (const app::PageElement& each : app::ElementsFrom(*elements)) {
    KINESCOPE_CHECK(names.insert(each.name).second);
    KINESCOPE_CHECK(std::isfinite(each.x_px + each.y_px + each.width_px + each.height_px));
    KINESCOPE_CHECK(each.text.find('\n') == std::string::npos);
  }
}

void TryPicture(const nlohmann::json& content) {
  const auto data = content.find("data");
  if (data == content.end() || !data->is_string()) return;
  const auto& text = data->get_ref<const std::string&>();
  KINESCOPE_CHECK(app::BytesFromBase64(text).size() <= text.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  app::MessageSplitter messages(kMostBytes);
  try {
    for (std::size_t at = 0; at < size; at += 64) {
      messages.Add(bytes.substr(at, 64));
      while (const auto text = messages.Take()) {
        KINESCOPE_CHECK(text->size() <= kMostBytes);
        try {
          const app::BrowserMessage message = app::ParseBrowserMessage(*text);
          KINESCOPE_CHECK(message.content.is_object());
          KINESCOPE_CHECK(message.call || !message.method.empty());
          TryElements(message.content);
          TryPicture(message.content);
        } catch (const std::exception& error) {
          KINESCOPE_CHECK(error.what()[0] != '\0');
        }
      }
    }
  } catch (const std::exception& error) {
    KINESCOPE_CHECK(error.what()[0] != '\0');
  }
  return 0;
}

}  // namespace browser_message_fuzz
