#include "server/app/golden/page_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "core/system/json_parse.h"
#include "core/system/json_text.h"
#include "core/system/utf8.h"

namespace kinescope::app {
namespace {

using nlohmann::json;

constexpr int kMostMessageDepth = 40;
constexpr std::size_t kMostElements = 5000, kMostTextBytes = 2000;
constexpr double kMostPx = 1e5;

[[noreturn]] void ThrowMessage(const std::string& why) {
  throw std::runtime_error("the browser has sent what is no message: " + why);
}

json ParseBounded(const std::string& text) {
  const auto check_depth = [](int depth, json::parse_event_t, json&) {
    if (depth > kMostMessageDepth) ThrowMessage("nested too deeply");
    return true;
  };
  try {
    return ParseJsonOrThrow(text, check_depth);
  } catch (const json::exception& error) {
    ThrowMessage(PrintableLine(error.what()));
  }
}

// "" if it is missing.
std::string TextMember(const json& object, const char* name) {
  const auto member = object.find(name);
  if (member == object.end()) return "";
  if (!member->is_string()) ThrowMessage(std::string(name) + " is no text");
  return member->get<std::string>();
}

json ObjectMember(json& object, const char* name) {
  const auto member = object.find(name);
  if (member == object.end()) return json::object();
  if (!member->is_object()) ThrowMessage(std::string(name) + " is no object");
  return std::move(*member);
}

[[noreturn]] void ThrowElement(const std::string& why) {
  throw std::runtime_error("the browser has described the page wrongly: " + why);
}

std::string ElementText(const json& element, const char* name) {
  const auto member = element.find(name);
  if (member == element.end() || !member->is_string())
    ThrowElement(std::string(name) + " is no text");
  const auto& text = member->get_ref<const std::string&>();
  if (text.size() > kMostTextBytes) {
    ThrowElement(
        fmt::format("{} has {} bytes; expected at most {}", name, text.size(), kMostTextBytes));
  }
  return PrintableLine(text);
}

PageElement ElementFrom(const json& element) {
  if (!element.is_object()) ThrowElement("an element is no object");
  const auto box = element.find("box");
  if (box == element.end() || !box->is_array() || box->size() != 4) {
    ThrowElement("an element has no box");
  }
  std::array<double, 4> px{};
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(*box)[i].is_number()) ThrowElement("a box is no numbers");
    px[i] = (*box)[i].get<double>();
    if (!(std::abs(px[i]) <= kMostPx)) ThrowElement("a box is too large");
  }
  PageElement read;
  read.name = ElementText(element, "name");
  read.role = ElementText(element, "role");
  read.text = ElementText(element, "text");
  if (read.name.empty() || read.role.empty()) ThrowElement("an element has no name or no role");
  read.x_px = px[0];
  read.y_px = px[1];
  read.width_px = px[2];
  read.height_px = px[3];
  const auto is_changing = element.find("is_changing");
  if (is_changing == element.end() || !is_changing->is_boolean()) {
    ThrowElement("is_changing is neither true nor false");
  }
  read.is_changing = is_changing->get<bool>();
  return read;
}

// -1: it is none.
int ValueOfDigit(char digit) {
  if (digit >= 'A' && digit <= 'Z') return digit - 'A';
  if (digit >= 'a' && digit <= 'z') return digit - 'a' + 26;
  if (digit >= '0' && digit <= '9') return digit - '0' + 52;
  if (digit == '+') return 62;
  return digit == '/' ? 63 : -1;
}

}  // namespace

void MessageSplitter::Add(std::string_view bytes) {
  bytes_.erase(0, std::exchange(begin_, 0));
  bytes_ += bytes;
}

std::optional<std::string> MessageSplitter::Take() {
  const std::size_t end = bytes_.find('\0', begin_);
  const std::size_t size = (end == std::string::npos ? bytes_.size() : end) - begin_;
  if (size > most_bytes_) {
    throw std::runtime_error(
        fmt::format("the browser has sent a message of more than {} bytes", most_bytes_));
  }
  if (end == std::string::npos) return std::nullopt;
  std::string message = bytes_.substr(begin_, size);
  begin_ = end + 1;
  return message;
}

BrowserMessage ParseBrowserMessage(const std::string& text) {
  json all = ParseBounded(text);
  if (!all.is_object()) ThrowMessage("it is no object");
  BrowserMessage message;
  message.session = TextMember(all, "sessionId");
  const auto call = all.find("id");
  if (call == all.end()) {
    message.method = TextMember(all, "method");
    if (message.method.empty()) ThrowMessage("it has neither id nor method");
    message.content = ObjectMember(all, "params");
    return message;
  }
  if (!call->is_number_integer()) ThrowMessage("id is no whole number");
  message.call = call->get<std::int64_t>();
  if (all.contains("error")) {
    message.error = PrintableLine(TextMember(ObjectMember(all, "error"), "message"));
    message.content = json::object();
  } else {
    message.content = ObjectMember(all, "result");
  }
  return message;
}

std::string CallText(std::int64_t number, const std::string& method, const json& parameters,
                     const std::string& session) {
  json call = {{"id", number}, {"method", method}, {"params", parameters}};
  if (!session.empty()) call["sessionId"] = session;
  return JsonText(call) + '\0';
}

bool operator==(const PageElement& a, const PageElement& b) {
  return a.name == b.name && a.role == b.role && a.text == b.text && a.x_px == b.x_px &&
         a.y_px == b.y_px && a.width_px == b.width_px && a.height_px == b.height_px &&
         a.is_changing == b.is_changing;
}

std::vector<PageElement> ElementsFrom(const json& array) {
  if (!array.is_array()) ThrowElement("its elements are no list");
  if (array.size() > kMostElements) {
    ThrowElement(fmt::format("{} elements; expected at most {}", array.size(), kMostElements));
  }
  std::vector<PageElement> elements;
  elements.reserve(array.size());
  std::set<std::string> used;
  std::map<std::string, int> next;
  for (const json& element : array) {
    elements.push_back(ElementFrom(element));
    std::string& name = elements.back().name;
    if (used.insert(name).second) continue;
    const std::string base = name;
    int& number = next.try_emplace(base, 2).first->second;
    do {
      name = fmt::format("{} ({})", base, number++);
    } while (!used.insert(name).second);
  }
  return elements;
}

std::vector<std::uint8_t> BytesFromBase64(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char digit : text) {
    const int value = ValueOfDigit(digit);
    if (value < 0) throw std::runtime_error("the browser has sent a picture that is no base64");
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> count));
    bits &= (1U << count) - 1;
  }
  return bytes;
}

}  // namespace kinescope::app
