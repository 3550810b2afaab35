/// What a browser says over its debugging pipe (the Chrome DevTools Protocol): messages of JSON,
/// each ended by a NUL. A page decides much of what is in them, so all of it is checked. Pure; any
/// thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinescope::app {

/// Splits what comes into messages.
class MessageSplitter {
 public:
  /// `most_bytes`: of one message.
  explicit MessageSplitter(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  void Add(std::string_view bytes);
  /// The next whole message; nullopt: none yet. @throws std::runtime_error if it is longer, also if
  /// only its beginning has come.
  std::optional<std::string> Take();

 private:
  const std::size_t most_bytes_;
  std::string bytes_;
  std::size_t begin_ = 0;  // of what was not taken yet
};

/// The answer to a call, or an event.
// NOLINTNEXTLINE(bugprone-exception-escape): nlohmann's json moves without exceptions
struct BrowserMessage {
  std::optional<std::int64_t> call;  // its number; nullopt: an event
  std::string method;                // of an event
  std::string session;               // ""; of the browser itself
  nlohmann::json content;  // an object: the result of the call, or the parameters of the event
  std::optional<std::string> error;  // why the call failed, in one line
};

/// @throws std::runtime_error with the reason if it is none.
BrowserMessage ParseBrowserMessage(const std::string& text);

/// The text of a call, with its NUL.
std::string CallText(std::int64_t number, const std::string& method,
                     const nlohmann::json& parameters, const std::string& session);

/// A thing on a page that a person sees: a text, a control, a picture.
struct PageElement {
  /// Unique on the page, and the same whatever its text is: its id, what labels it, or where it is.
  std::string name;
  std::string role;  // as a screen reader says it: "heading", "button"; "text" without one
  std::string text;  // that is shown, in one line; "" of a thing that changes by itself
  double x_px = 0, y_px = 0, width_px = 0, height_px = 0;  // the part that is visible
  /// It changes with the time of day or the load of the machine, not with what the page shows: the
  /// page says so by the attribute data-changing.
  bool is_changing = false;
};

bool operator==(const PageElement& a, const PageElement& b);

/// Of an array as page_script.h makes it; equal names get numbers. @throws std::runtime_error with
/// the reason if it is none.
std::vector<PageElement> ElementsFrom(const nlohmann::json& array);

/// The bytes of a base64 text. @throws std::runtime_error if it is none
std::vector<std::uint8_t> BytesFromBase64(std::string_view text);

}  // namespace kinescope::app
